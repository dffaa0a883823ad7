//! The bound of all designs: with any fleet and any number of stands, no policy earns or carries
//! more.

use std::sync::Arc;

use proptest::prelude::{ProptestConfig, any, proptest};
use vertifleet_core::{Aircraft, AircraftIx, Outage, Scenario, TypeIx, VertiportIx};
use vertifleet_optimize::{DesignBound, Step, day_of_passengers, upper_bound};
use vertifleet_policy::{BidPricePolicy, Greedy, Policy, Random, play};
use vertifleet_sim::{DayTotals, Simulation};
use vertifleet_testkit::{Size, any_energy_day, any_extended_day};

fn played(day: &Arc<Scenario>, policy: &mut dyn Policy) -> DayTotals {
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, policy, |_| ()).expect("these policies always answer");
    simulation.totals()
}

fn aircraft(day: &Scenario) -> Vec<u32> {
    let of_type = |kind| day.aircraft.iter().filter(|one| one.kind == kind).count();
    let counts = TypeIx::all(day.aircraft_types.len()).map(of_type);
    counts.map(|count| u32::try_from(count).expect("few")).collect()
}

fn places(day: &Scenario) -> Vec<u32> {
    let room = |one: &vertifleet_core::Vertiport| {
        u32::from(one.stands) + u32::from(one.chargers.unwrap_or(0))
    };
    day.vertiports.iter().map(room).collect()
}

fn proven(day: &Scenario, minutes: u32) -> DesignBound {
    let step = Step::from_minutes(minutes).expect("a step");
    upper_bound(day, step).expect("a small day").of_designs(day, true).expect("a small day")
}

/// The day, on which nothing fails.
fn without_outages(day: &Scenario) -> Scenario {
    let mut day = day.clone().into_day();
    day.disturbances.outages.clear();
    day.check("a day without outages").expect("a day within the rules")
}

/// The day with other numbers of stands and of aircraft, which start elsewhere and of which some
/// fail.
fn redesigned(day: &Scenario, mix: u32) -> Scenario {
    let mut day = day.clone().into_day();
    let types = day.aircraft_types.len();
    let mut left = Vec::new();
    let mut digits = mix;
    for (at, vertiport) in day.vertiports.iter_mut().enumerate() {
        digits = digits.rotate_left(3);
        vertiport.stands = 1 + u16::try_from(digits % 5).expect("small");
        left.extend(std::iter::repeat_n(VertiportIx::new(at), vertiport.stands.into()));
    }
    let first = mix as usize % left.len();
    left.rotate_left(first);
    let fleet = 1 + mix as usize / 7 % left.len();
    let one = |(number, at)| {
        let kind = TypeIx::new((mix as usize + number) % types);
        Aircraft { id: format!("N{number}"), kind, at, start_charge_kwh: None }
    };
    day.aircraft = left.into_iter().take(fleet).enumerate().map(one).collect();
    let outage = |at: usize| {
        let start = day.operations.start
            + (u32::try_from((mix as usize).rotate_left(5) / (at + 1) % 7_200).expect("seconds"));
        Outage { aircraft: AircraftIx::new(at), start, end: start + 600 + mix % 4_000 }
    };
    day.disturbances.outages = (0..fleet).step_by(1 + mix as usize % 3).map(outage).collect();
    day.check("another design").expect("a day within the rules")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(80))]

    #[test]
    fn no_policy_earns_or_carries_more_in_any_design(
        number in any::<u32>(), mix in any::<u32>(), minutes in 5_u32..60
    ) {
        let size = Size { vertiports: 5, fleet: 8, hours: 4 };
        let day = [any_extended_day, any_energy_day][mix as usize / 2 % 2](number.into(), size);
        // The day that is bounded may have none of the outages that the other design has.
        let bounded = if mix % 2 == 0 { day.as_ref().clone() } else { without_outages(&day) };
        let (profit, carried) =
            (proven(&bounded, minutes), proven(&day_of_passengers(&bounded), minutes));
        let other = redesigned(&day, mix);
        let (aircraft, places) = (aircraft(&other), places(&other));
        let most_usd = profit.upper_bound_usd(&aircraft, &places) - other.fixed_cost_usd();
        let most = carried.upper_bound_usd(&aircraft, &places);
        let other = Arc::new(other);
        let policies: [&mut dyn Policy; 3] =
            [&mut Random::new(3), &mut Greedy, &mut BidPricePolicy::default()];
        for policy in policies {
            let totals = played(&other, policy);
            assert!(totals.profit_usd <= most_usd + 1e-6, "{} of {most_usd}", totals.profit_usd);
            assert!(totals.passengers as f64 <= most, "{} of {most}", totals.passengers);
        }
    }

    #[test]
    fn at_the_design_of_the_day_it_is_no_lower_than_the_bound_and_near_it(number in any::<u32>()) {
        let day = any_extended_day(number.into(), Size { vertiports: 5, fleet: 8, hours: 4 });
        let step = Step::from_minutes(15).expect("a step");
        let bound = upper_bound(&day, step).expect("a small day");
        let designs = bound.of_designs(&day, true).expect("a small day");
        let here = designs.upper_bound_usd(&aircraft(&day), &places(&day)) - day.fixed_cost_usd();
        assert!(here >= bound.upper_bound_usd() - 1e-3, "{here}, {}", bound.upper_bound_usd());
    }
}

#[test]
fn one_more_of_anything_raises_it_by_its_shadow_price() {
    let day = any_extended_day(5, Size { vertiports: 5, fleet: 8, hours: 4 });
    let designs = proven(&day, 15);
    let (mut aircraft, mut places) = (aircraft(&day), places(&day));
    let before = designs.upper_bound_usd(&aircraft, &places);
    aircraft[0] += 1;
    places[1] += 2;
    let expected = before
        + designs.aircraft_shadow_price_usd(TypeIx::new(0))
        + 2.0 * designs.place_shadow_price_usd(VertiportIx::new(1));
    assert!((designs.upper_bound_usd(&aircraft, &places) - expected).abs() < 1e-6);
}
