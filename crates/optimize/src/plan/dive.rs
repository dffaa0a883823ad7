//! Price and dive: aircraft are planned one after another at the prices of a bound, which are found
//! again after each.
//!
//! The aircraft on whose itinerary the search for prices agrees most comes first. Its itinerary is
//! the best one that is feasible to the second, at the prices of stands and flights. Its stands and
//! passengers are gone for the others (C. Joncour et al., *Column generation based primal
//! heuristics*, Electronic Notes in Discrete Mathematics 36, 2010).
//!
//! Where time is limited, a dive is as thorough as it can be within its time: prices are found in
//! coarser slices of the day, and again after every few aircraft only.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use vertifleet_core::{AircraftIx, Scenario, Stop, VertiportIx};

use super::guiding_prices::GuidingPrices;
use super::itinerary_search::{Bias, Guided, ItinerarySearch};
use super::problem::Problem;
use super::schedule::{Flight, Schedule};
use super::tempo::{Tempo, seconds_until};
use crate::bound::{Rest, Way};

/// Steps of the search for prices after each aircraft.
const STEPS: u32 = 20;
/// The time that such a step takes, as a share of that of a step before the first aircraft is
/// planned, because fewer and fewer aircraft are left: 0.5 on `new-york-quick`, 0.3 on `new-york`.
const STEP_AFTER: f64 = 0.5;
/// The shares of the prices that aircraft pay, one for each dive. At whole prices very many
/// itineraries are worth the same, and one that earns little is as good as one that earns much. On
/// calm validation day 3000 of `dallas`, dives with shares of 1, 0.9, 0.8, 0.7 and 0.5 had 89,793,
/// 94,106, 94,738, 94,373 and 92,922 $, and `rolling` 90,241.
const SHARES: [f64; 2] = [0.8, 0.9];

/// The prices and the schedule that dives find: none if the day is too large for them.
#[derive(Default)]
pub(super) struct Dived {
    /// The prices before the first aircraft was planned.
    pub(super) prices: Option<GuidingPrices>,
    /// The best schedule of the dives that found a place for every aircraft.
    pub(super) schedule: Option<Schedule>,
}

/// Dives on a separate thread. They end soon after this is dropped.
pub(super) struct Dive {
    ended: Receiver<Dived>,
    stop: Stop,
}

impl Dive {
    /// Begins dives that seem to end by a time, if one is given.
    pub(super) fn begin(
        scenario: &Arc<Scenario>,
        problem: &Arc<Problem>,
        until: Option<Instant>,
    ) -> Self {
        let (send, ended) = sync_channel(1);
        let stop = Stop::default();
        let (scenario, problem, stopped) =
            (Arc::clone(scenario), Arc::clone(problem), stop.clone());
        std::thread::spawn(move || {
            let dived = dive(&scenario, &problem, until, &stopped);
            // The receiver may be gone; then the result is not needed.
            let _ = send.send(dived.unwrap_or_default());
        });
        Self { ended, stop }
    }

    /// The result, once the dives have come to an end. This waits for them, but no longer than
    /// `patience`.
    pub(super) fn outcome(&self, patience: Duration) -> Option<Dived> {
        match self.ended.recv_timeout(patience) {
            Ok(dived) => Some(dived),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => panic!("a dive comes to an end"),
        }
    }
}

impl Drop for Dive {
    fn drop(&mut self) {
        self.stop.request();
    }
}

/// About how many steps of a search take as long as thorough dives.
pub(super) fn search_steps(scenario: &Scenario) -> f64 {
    /// Steps of a search that take as long as a step for prices with aircraft of one type: 6 to 9
    /// on cities, 13 on `paper`.
    const EACH: f64 = 8.0;
    let fleet = scenario.aircraft.len() as f64;
    let steps = f64::from(Rest::most_steps()) + SHARES.len() as f64 * f64::from(STEPS) * fleet;
    EACH * scenario.aircraft_types.len() as f64 * steps
}

/// The prices of a day and the best of the dives that there is time for; `None` if there is not
/// even time for prices.
fn dive(
    scenario: &Scenario,
    problem: &Problem,
    until: Option<Instant>,
    stopped: &Stop,
) -> Option<Dived> {
    let fleet = scenario.aircraft.len() as f64;
    let begun = Instant::now();
    let rest = Rest::of(scenario, stopped, &mut |steps, next| {
        // The first cut shows how long a step takes. A finer one should leave time to find prices
        // after each aircraft.
        let after_each = STEP_AFTER * f64::from(STEPS) * fleet;
        let to_come = if next == 0 { 0.0 } else { f64::from(next) + after_each };
        let takes_s = begun.elapsed().as_secs_f64() * to_come / f64::from(steps.max(1));
        until.is_none_or(|until| steps == 0 || takes_s < seconds_until(until))
    })?;
    let prices = GuidingPrices::of_rest(&problem.day, &rest);
    let mut best: Option<Schedule> = None;
    for share in SHARES {
        let begun = Instant::now();
        let found = plan_one_by_one(problem, rest.clone(), share, until, stopped);
        let by_value =
            |one: &Schedule, other: &Schedule| one.value_usd().total_cmp(&other.value_usd());
        best = best.into_iter().chain(found).max_by(by_value);
        if until.is_some_and(|until| begun.elapsed().as_secs_f64() > seconds_until(until)) {
            break;
        }
    }
    Some(Dived { prices: Some(prices), schedule: best })
}

/// Plans the fleet one aircraft after another, each at a share of the prices. Returns `None` if no
/// place is found for one of them, or if `stopped` is requested.
fn plan_one_by_one(
    problem: &Problem,
    rest: Rest,
    share: f64,
    until: Option<Instant>,
    stopped: &Stop,
) -> Option<Schedule> {
    let mut diver = Diver {
        problem,
        rest,
        bias: Bias { rent_share: share, flight_share: share, ..Bias::default() },
        schedule: Schedule::unplanned(problem),
        left: Vec::new(),
        planned: Vec::new(),
        search: ItinerarySearch::thorough(),
        flights: Vec::new(),
    };
    let schedule = &diver.schedule;
    diver.left = problem.day.fleet().filter(|&aircraft| !schedule.is_whole(aircraft)).collect();
    let mut may_take_back = diver.left.len();
    let mut tempo = Tempo::until(until);
    while let Some(aircraft) = diver.rest.clearest(diver.left.iter().copied()) {
        if stopped.is_requested() {
            return None;
        }
        tempo.planning.time(|| {
            while let Err(full) = diver.plan(aircraft) {
                may_take_back = may_take_back.checked_sub(1)?;
                diver.make_room(full)?;
            }
            Some(())
        })?;
        if tempo.is_time_to_price(diver.left.len()) {
            let left = diver.schedule.passengers.left(&problem.day);
            tempo.pricing.time(|| diver.rest.price(left, STEPS, stopped));
        }
    }
    Some(diver.schedule)
}

/// A dive in progress.
struct Diver<'a> {
    problem: &'a Problem,
    rest: Rest,
    bias: Bias,
    schedule: Schedule,
    left: Vec<AircraftIx>,
    /// In the order in which they were planned.
    planned: Vec<AircraftIx>,
    search: ItinerarySearch,
    /// Memory for the flights that are found.
    flights: Vec<Flight>,
}

impl Diver<'_> {
    /// Plans an aircraft, or returns a vertiport that has no place left for it.
    fn plan(&mut self, aircraft: AircraftIx) -> Result<(), VertiportIx> {
        let Self { problem, schedule, flights, .. } = self;
        let prices = GuidingPrices::of_rest(&problem.day, &self.rest);
        let guided = Guided { prices: &prices, bias: self.bias };
        if !self.search.complete(problem, guided, schedule, aircraft, flights) {
            return Err(problem.places[aircraft.at()]);
        }
        schedule.complete(problem, aircraft, flights);
        if let Some(full) = schedule.overfull() {
            schedule.cut(problem, aircraft, 0, &mut Vec::new());
            return Err(full);
        }
        self.rest.remove(aircraft, &way(problem, aircraft, &self.flights));
        self.left.retain(|&other| other != aircraft);
        self.planned.push(aircraft);
        Ok(())
    }

    /// Takes back the plan of the aircraft that was planned last of those that start at a vertiport
    /// or come to it. Returns `None` if there is no such aircraft.
    fn make_room(&mut self, place: VertiportIx) -> Option<()> {
        let Self { problem, schedule, flights, .. } = self;
        let comes = |other: &AircraftIx| {
            let lands = schedule.flights(*other).iter().any(|flight| flight.to == place);
            lands || problem.places[other.at()] == place
        };
        let last = self.planned.remove(self.planned.iter().rposition(comes)?);
        flights.clear();
        schedule.cut(problem, last, 0, flights);
        self.rest.take_back(last, &way(problem, last, flights));
        self.left.push(last);
        Some(())
    }
}

fn way(problem: &Problem, aircraft: AircraftIx, flights: &[Flight]) -> Way {
    let flights = flights.iter().map(|flight| (flight.take_off_s, flight.to)).collect();
    Way { start: problem.places[aircraft.at()], flights }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use vertifleet_core::{Matrix, Scenario, Stop};
    use vertifleet_policy::{Greedy, play};
    use vertifleet_sim::{Simulation, check::check};
    use vertifleet_testkit::{Size, any_day, any_extended_day, paper_day};

    use super::plan_one_by_one;
    use crate::bound::Rest;
    use crate::plan::problem::Problem;
    use crate::plan::schedule::Schedule;
    use crate::plan::start;

    fn dived(day: &Arc<Scenario>) -> Option<Schedule> {
        let never = Stop::default();
        let rest = Rest::of(day, &never, &mut |_, _| true).expect("a small day");
        plan_one_by_one(&Problem::of(day), rest, 0.8, None, &never)
    }

    #[test]
    fn a_dive_keeps_every_rule_and_its_account_is_the_checkers() {
        let small = Size { vertiports: 5, fleet: 8, hours: 4 };
        let days =
            (0..30).flat_map(|number| [any_day(number, small), any_extended_day(number, small)]);
        let mut found = 0;
        for day in days {
            let Some(schedule) = dived(&day) else { continue };
            let (trace, profit_usd) = start::flown(&day, &schedule);
            let difference_usd = schedule.value_usd() - profit_usd;
            assert!(difference_usd.abs() < 1e-6, "{}: {difference_usd}", day.name);
            let wanted: u32 = day.demand.iter().flat_map(Matrix::cells).sum();
            let left: u32 = schedule.passengers.left(&Problem::of(&day).day).iter().sum();
            assert_eq!(u64::from(wanted - left), check(&day, &trace).totals.passengers);
            found += 1;
        }
        assert!(found >= 40, "{found} dives found a place for each aircraft");
    }

    #[test]
    fn on_a_day_of_paper_a_dive_earns_more_than_greedy() {
        let day = paper_day(1);
        let mut simulation = Simulation::new(Arc::clone(&day));
        play(&mut simulation, &mut Greedy, |_| ()).expect("greedy always answers");
        let greedy_usd = simulation.ledger().profit_usd();
        let dive_usd = dived(&day).expect("room is made").value_usd();
        assert!(dive_usd > greedy_usd, "{dive_usd} is no more than {greedy_usd}");
    }
}
