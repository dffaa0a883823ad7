//! Policies decide in every state that reports can lead to, such as vertiports with more aircraft
//! than stands.

use std::hash::{BuildHasher as _, BuildHasherDefault, DefaultHasher};
use std::sync::Arc;

use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};
use vertifleet_policy::Policy;
use vertifleet_sim::live::{Booking, LiveDay, Report, Routes};
use vertifleet_study::{PolicySpec, ResolveFor};
use vertifleet_testkit::{Size, any_extended_day};

const POLICIES: [&str; 6] =
    ["random", "greedy", "prices", "rolling", "gcaps-x", "gcaps-x:rollouts=2"];
const DAYS: u64 = 72;
const REPORTS: u32 = 40;

/// Numbers that look random and are the same in every run.
struct Draws {
    seed: u64,
    drawn: u32,
}

impl Draws {
    fn below(&mut self, limit: usize) -> usize {
        self.drawn += 1;
        let hash = BuildHasherDefault::<DefaultHasher>::default().hash_one((self.seed, self.drawn));
        usize::try_from(hash >> 33).expect("31 bits") % limit
    }

    fn few(&mut self, limit: u16) -> u16 {
        u16::try_from(self.below(usize::from(limit))).expect("it is below")
    }

    fn report(&mut self, day: &Scenario, now: Time) -> Report {
        let aircraft = AircraftIx::new(self.below(day.aircraft.len()));
        let vertiports = day.vertiports.len();
        let (one, other) =
            (VertiportIx::new(self.below(vertiports)), VertiportIx::new(self.below(vertiports)));
        let later = now + u32::from(self.few(9_000));
        let period = self.below(day.periods.len());
        match self.below(12) {
            0..=2 => Report::Departed { aircraft, to: Some(one), passengers: None },
            3..=5 => Report::Landed { aircraft, at: Some(one), charge_kwh: None },
            6 => Report::Ready { aircraft },
            7 => Report::Delayed { aircraft, until: later },
            8 => Report::OutOfService { aircraft, until: Some(later) },
            9 => {
                let until = (self.below(2) == 0).then_some(later);
                Report::Closed { routes: Routes::Way { from: one, to: other }, until }
            }
            10 => Report::Stands { vertiport: one, stands: self.few(3) },
            _ => {
                let passengers = u32::from(self.few(30));
                Report::Booked { booking: Booking { period, from: one, to: other, passengers } }
            }
        }
    }
}

/// Requests a proposal of every policy for every ready aircraft.
fn ask_all(live: &mut LiveDay, policies: &mut [(&str, Box<dyn Policy>)]) -> u32 {
    let mut asked = 0;
    let mut room = None;
    for aircraft in AircraftIx::all(live.scenario().aircraft.len()) {
        let Ok(decision) = live.decision(aircraft, live.now()) else { continue };
        let view = live.view_at(&decision, &mut room);
        for (name, policy) in policies.iter_mut() {
            let choice = policy.choose(&decision, &view).expect("policies have an answer");
            assert!(view.feasible(&decision).contains(choice), "{name} chooses {choice:?}");
            let mut values = vec![0.0; view.vertiports()];
            policy.values(&decision, &view, &mut values).expect("policies have values");
            let mut together = vec![0.0; view.vertiports()];
            let at_once = policy.choose_with_values(&decision, &view, &mut together);
            assert_eq!(at_once.expect("policies have an answer"), choice, "{name}");
            let bits = |values: &[f64]| values.iter().map(|usd| usd.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&together), bits(&values), "{name}");
            let most = values.iter().copied().fold(f64::NAN, f64::max);
            assert!(most.is_nan() || values[choice.at()] == most, "{name}: {choice:?} {values:?}");
            asked += 1;
        }
    }
    asked
}

#[test]
fn every_policy_decides_on_every_state() {
    let mut asked = 0;
    for number in 0..DAYS {
        let day = any_extended_day(number, Size { vertiports: 5, fleet: 6, hours: 3 });
        let mut live = LiveDay::new(Arc::clone(&day));
        let mut policies = POLICIES.map(|name| {
            let spec = PolicySpec::parse(name).expect("a policy");
            let resolved = spec.resolve(None, ResolveFor::Day(&day), number).expect("a policy");
            (name, resolved.build())
        });
        let mut draws = Draws { seed: number, drawn: 0 };
        let mut time = day.operations.start;
        for _ in 0..REPORTS {
            let later = time + u32::from(draws.few(900));
            if live.take(later, &draws.report(&day, time)).is_ok() {
                time = later;
            }
            if draws.below(4) == 0 {
                asked += ask_all(&mut live, &mut policies);
            }
        }
    }
    assert!(asked > 5_000, "{asked} decisions were asked for");
}
