//! A view in Python shows every number that the rules of the program read from theirs.

use std::collections::BTreeSet;
use std::sync::Arc;

use vertifleet_core::{AircraftIx, Scenario, TypeIx, VertiportIx};
use vertifleet_observe::{Observer, Part, Scene, write_in_units};
use vertifleet_sim::{Decision, View};
use vertifleet_testkit::energy_day;

use crate::observation::{days, play};

/// Where a view in Python shows what a method of the views of rules returns.
enum Shown {
    /// In these parts.
    In(&'static [Part]),
    /// In a member of this name in `python/src/view.rs`.
    As(&'static str),
    /// Nowhere, for this reason.
    Not(&'static str),
}
use Shown::{As, In, Not};

/// Every method of a view.
#[rustfmt::skip]
const METHODS: &[(&str, Shown)] = &[
    ("vertiports", As("vertiports")),
    ("feasible", In(&[Part::ActionMask])),
    ("refusal", Not("the words of a message")),
    ("aircraft_id", Not("a name in messages")),
    ("kind", As("fleet_types")),
    ("aircraft_type", As("types")),
    ("aircraft_types", As("types")),
    ("leg", In(&[Part::TypeFlightTime, Part::TypeBlockTime, Part::TypeEnergy])),
    ("charges_as_needed", As("charges_as_needed")),
    ("outcome", In(&[Part::ChoiceWait, Part::ChoiceFlightTime, Part::ChoiceBlockTime, Part::ChoiceCharge])),
    ("charge_kwh", In(&[Part::FleetCharge])),
    ("charge_mwh", In(&[Part::FleetCharge])),
    ("charge_mwh_at", As("charge_kwh")),
    ("to_full_s", In(&[Part::FleetCharge, Part::FleetReady, Part::ChargerPower])),
    ("charge_rate", In(&[Part::ChargerPower])),
    ("charging_power_kw", In(&[Part::ChargerPower])),
    ("legs_from", In(&[Part::TypeFlightTime, Part::TypeBlockTime, Part::TypeEnergy])),
    ("within_range", In(&[Part::TypeReachable])),
    ("closed", In(&[Part::Closed])),
    ("closed_unexpectedly", In(&[Part::ClosedUnexpectedly])),
    ("known_closures", As("known_closures")),
    ("route_changes", Not("rules compare it with that of the decision before, to see that `closed_unexpectedly` has changed")),
    ("known_delay_s", In(&[Part::Delay])),
    ("places", As("fleet_places")),
    ("ready_at", In(&[Part::FleetReady])),
    ("arrives_at", In(&[Part::FleetLanding])),
    ("stands_taken", In(&[Part::StandsTaken])),
    ("period", As("period")),
    ("period_at", As("period_starts_s")),
    ("period_starts", As("period_starts_s")),
    ("demand_left", In(&[Part::Forecast])),
    ("demand_left_in", In(&[Part::Forecast])),
    ("demand_waiting", In(&[Part::DemandWaiting])),
    ("distances_mi", In(&[Part::Distance])),
    ("fares_usd", In(&[Part::Fares])),
    ("passenger_costs_usd", In(&[Part::PassengerCost])),
    ("flight_costs_usd", In(&[Part::FlightCost])),
    ("fixed_cost_usd", As("fixed_cost_usd")),
    ("energy_price_usd", In(&[Part::EnergyPrice])),
    ("energy_prices_usd", In(&[Part::EnergyPrice])),
    ("flight_profit_usd", Not("computed from fares, costs, energy and passengers")),
    ("departures", Not("the same for all destinations")),
    ("day_start", As("day_start_s")),
    ("day_end", As("day_end_s")),
    ("hold_s", As("hold_s")),
    ("passenger_wait_s", As("passenger_wait_s")),
    ("stands", In(&[Part::Stands])),
    ("parked", In(&[Part::Parked, Part::Parking])),
    ("is_parked", In(&[Part::FleetParked])),
    ("imagined", Not("a simulation that continues from the other numbers")),
    ("imagined_in", Not("the same in memory that exists already")),
    ("snapshot", Not("the view itself")),
    ("day", Not("tells days apart and reveals nothing")),
    ("day_seed", Not("`random` draws by it; it names the day, and so all that happens on it")),
];

#[test]
fn every_method_of_a_view_is_shown_in_python_or_needs_not_be() {
    let methods = include_str!("../../../sim/src/view.rs");
    let methods = methods.lines().filter_map(|line| line.trim().strip_prefix("pub fn "));
    let methods = methods.map(|line| line.split(['(', '<']).next().expect("a name"));
    let listed: BTreeSet<&str> = METHODS.iter().map(|(name, _)| *name).collect();
    assert_eq!(methods.collect::<BTreeSet<_>>(), listed);
    let (native, python) = (
        include_str!("../../../../python/src/view.rs"),
        include_str!("../../../../python/vertifleet/_view.py"),
    );
    for (method, shown) in METHODS {
        match shown {
            In(parts) => {
                for part in *parts {
                    let name = part.info().in_views.unwrap_or_else(|| panic!("{method}"));
                    assert!(python.contains(&format!("    {name}: Numbers")), "{method}: {name}");
                }
            }
            As(name) => {
                assert!(native.contains(&format!("    fn {name}(&self)")), "{method}: {name}");
                assert!(python.contains(&format!("    def {name}(self)")), "{method}: {name}");
            }
            Not(reason) => assert!(!reason.is_empty()),
        }
    }
}

/// The array of a part of a view in Python.
fn array(part: Part, scene: &Scene<'_>) -> Vec<f32> {
    let mut array = vec![f32::NAN; part.len(scene.sizes())];
    write_in_units(part, &mut array, scene, &Observer::default());
    array
}

#[test]
fn arrays_of_views_have_the_numbers_that_rules_read() {
    let energy = energy_days();
    for day in days().iter().chain(&energy) {
        play(day, |view, decision| {
            if decision.index.is_multiple_of(7) {
                check(view, decision);
            }
        });
    }
}

/// Days of every kind: several types, chargers, curves, patience, delays, closures and outages.
fn energy_days() -> Vec<Arc<Scenario>> {
    use proptest::strategy::{Strategy, ValueTree};
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let draw = |_| energy_day().new_tree(&mut runner).expect("a day").current();
    (0..40).map(draw).collect()
}

/// Compares the parts of [`METHODS`] with the methods, one number after another.
fn check(view: View<'_>, decision: &Decision) {
    let scene = Scene::of(view, decision);
    let compare = |part: Part, expected: Vec<f64>| {
        let found = array(part, &scene);
        assert_eq!(found.len(), expected.len(), "{part:?}");
        for (at, (&found, expected)) in found.iter().zip(expected).enumerate() {
            let allowed = 1e-6 * expected.abs().max(1e-6);
            let is_close = (f64::from(found) - expected).abs() <= allowed;
            assert!(is_close, "{part:?} {at}: {found}, {expected}");
        }
    };
    let all = || VertiportIx::all(view.vertiports());
    let pairs = || all().flat_map(|from| all().map(move |to| (from, to)));
    let types = || TypeIx::all(view.aircraft_types().len());
    let fleet = || AircraftIx::all(view.places().len());
    let periods = || 0..view.period_starts().len();
    let hours = |seconds: u32| f64::from(seconds) / 3600.0;
    let flag = |is_so: bool| f64::from(u8::from(is_so));
    let by_pair = |number: &dyn Fn(VertiportIx, VertiportIx) -> f64| {
        pairs().map(|(from, to)| number(from, to)).collect::<Vec<_>>()
    };
    let by_type = |number: &dyn Fn(TypeIx, VertiportIx, VertiportIx) -> f64| {
        types().flat_map(|kind| by_pair(&|from, to| number(kind, from, to))).collect::<Vec<_>>()
    };
    let by_period = |number: &dyn Fn(usize, VertiportIx, VertiportIx) -> f64| {
        periods().flat_map(|at| by_pair(&|from, to| number(at, from, to))).collect::<Vec<_>>()
    };
    let in_range = |kind, from, to| flag(view.within_range(kind, from).contains(to));
    compare(Part::TypeReachable, by_type(&in_range));
    let leg = |kind, from, to| (in_range(kind, from, to), view.leg(kind, from, to));
    let of_leg = |number: &dyn Fn(TypeIx, VertiportIx, VertiportIx) -> f64| by_type(number);
    compare(
        Part::TypeFlightTime,
        of_leg(&|kind, from, to| {
            let (flown, leg) = leg(kind, from, to);
            flown * hours(leg.flight_s)
        }),
    );
    compare(
        Part::TypeBlockTime,
        of_leg(&|kind, from, to| {
            let (flown, leg) = leg(kind, from, to);
            flown * hours(leg.block_s())
        }),
    );
    compare(
        Part::TypeEnergy,
        of_leg(&|kind, from, to| {
            let (flown, leg) = leg(kind, from, to);
            flown * leg.energy_kwh
        }),
    );
    let left = |period, from, to| {
        if period < view.period() { 0.0 } else { f64::from(view.demand_left(period, from, to)) }
    };
    compare(Part::Forecast, by_period(&left));
    compare(Part::Fares, by_period(&|at, from, to| view.fares_usd(at, from)[to.at()]));
    compare(Part::DemandWaiting, by_pair(&|from, to| f64::from(view.demand_waiting(from, to))));
    compare(
        Part::ClosedUnexpectedly,
        by_pair(&|from, to| flag(view.closed_unexpectedly(from).contains(to))),
    );
    compare(Part::PassengerCost, by_pair(&|from, to| view.passenger_costs_usd(from)[to.at()]));
    compare(Part::FlightCost, by_pair(&|from, to| view.flight_costs_usd(from)[to.at()]));
    compare(Part::Distance, by_pair(&|from, to| view.distances_mi(from)[to.at()]));
    compare(Part::EnergyPrice, view.energy_prices_usd().to_vec());
    let now = decision.time;
    compare(Part::Delay, all().map(|at| hours(view.known_delay_s(now, at))).collect());
    compare(Part::Stands, all().map(|at| f64::from(view.stands(at))).collect());
    compare(Part::StandsTaken, view.stands_taken().iter().copied().map(f64::from).collect());
    let power = |kind| all().map(move |at| view.charging_power_kw(kind, at));
    compare(Part::ChargerPower, types().flat_map(power).collect());
    compare(Part::FleetReady, fleet().map(|at| hours(view.ready_at(at).since(now))).collect());
    compare(Part::FleetLanding, fleet().map(|at| hours(view.arrives_at(at).since(now))).collect());
    compare(Part::FleetParked, fleet().map(|at| flag(view.is_parked(at))).collect());
    compare(Part::FleetCharge, fleet().map(|at| view.charge_kwh(at)).collect());
}

/// The view's delay is the one that imagined days continue with.
#[test]
fn flights_of_imagined_days_leave_with_the_delay_that_is_shown() {
    let mut delayed = 0;
    for day in energy_days().iter().chain(&days()) {
        play(day, |view, decision| {
            if view.charges_as_needed() {
                // A battery charges during the delay, so a flight may be less late.
                return;
            }
            let delay_h = array(Part::Delay, &Scene::of(view, decision))[decision.at.at()];
            let feasible = view.feasible(decision);
            let Some(to) = feasible.iter().find(|&to| to != decision.at) else { return };
            let on_time = view.outcome(decision, to).arrival;
            let row = view.imagined().apply(to).expect("it is feasible");
            let late_h = f64::from(row.arrival.since(on_time)) / 3600.0;
            assert!((f64::from(delay_h) - late_h).abs() < 1e-6, "{delay_h}, {late_h}");
            delayed += u32::from(late_h > 0.0);
        });
    }
    assert!(delayed > 100, "{delayed} flights are late");
}
