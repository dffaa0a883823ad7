//! Simulator and checker, written independently, agree: the checker passes what the simulator
//! plays, and refuses it with one row edited.

use std::sync::Arc;

use proptest::prelude::{
    Just, Strategy, any, prop, prop_assert, prop_assert_eq, prop_oneof, proptest,
};
use proptest::sample::Index;
use proptest::test_runner::Config;
use vertifleet_core::{Charging, Scenario, Time, VertiportIx};
use vertifleet_sim::check::check;
use vertifleet_sim::{DayTotals, Simulation, Trace, TraceRow};

use vertifleet_testkit::{energy_day, extreme_energy_day, small_day};

/// Plays a day at random. Each draw chooses among the feasible vertiports; the draws are used
/// cyclically.
fn play(day: &Arc<Scenario>, draws: &[u32]) -> (DayTotals, Trace) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut trace = Trace::default();
    while let Some(decision) = simulation.next_decision() {
        let mask = simulation.view().feasible(&decision);
        let rank = draws[trace.rows.len() % draws.len()] % mask.len();
        let choice = mask.nth(rank).expect("a rank below the number of members");
        trace.rows.push(simulation.apply(choice).expect("a choice from the mask"));
    }
    (simulation.totals(), trace)
}

fn draws() -> impl Strategy<Value = Vec<u32>> {
    prop::collection::vec(any::<u32>(), 1..40)
}

/// The day with distances in tenths of a mile, and speeds at which many cruises last a whole number
/// of seconds and a half. Users type such numbers, and two ways to compute a duration may round
/// them differently.
fn in_round_numbers(day: &Arc<Scenario>) -> Arc<Scenario> {
    let mut day = Scenario::clone(day).into_day();
    for distance_mi in day.distance_mi.cells_mut() {
        *distance_mi = (*distance_mi * 10.0).round() / 10.0;
    }
    for kind in &mut day.aircraft_types {
        kind.speed_mph = 80.0;
        kind.charge_kw = 90.0;
    }
    Arc::new(day.check("day in round numbers").expect("a day within the rules"))
}

/// The day with every distance at the end of the first type's range, plus `off` millionths of a
/// mile.
fn at_the_end_of_the_range(day: &Arc<Scenario>, off: &[f64]) -> Arc<Scenario> {
    let mut day = Scenario::clone(day).into_day();
    let kind = &day.aircraft_types[0];
    let range_mi = kind.battery_kwh / kind.energy_kwh_per_mi;
    for (cell, off) in day.distance_mi.cells_mut().iter_mut().zip(off.iter().cycle()) {
        if *cell > 0.0 {
            *cell = range_mi + off * 1e-6;
        }
    }
    Arc::new(day.check("day at the end of the range").expect("a day within the rules"))
}

/// One edit of one row of a schedule.
#[derive(Debug, Clone, Copy)]
enum Edit {
    OneMorePassenger,
    OnePassengerLess,
    Sooner(Clock),
    Later(Clock),
    OtherCharge,
    OtherDestination(Index),
    Dropped,
    Doubled,
    SwappedWith(Index),
}

/// The time of a row that is edited.
#[derive(Debug, Clone, Copy)]
enum Clock {
    Decision,
    Arrival,
    Ready,
    /// Only days that charge as needed have it.
    TakeOff,
}

impl Clock {
    fn of(self, row: &mut TraceRow) -> &mut Time {
        match self {
            Self::Decision => &mut row.time,
            Self::Arrival => &mut row.arrival,
            Self::Ready => &mut row.ready,
            Self::TakeOff => &mut row.takeoff,
        }
    }
}

fn edits() -> impl Strategy<Value = Edit> {
    let clocks = || {
        prop_oneof![
            Just(Clock::Decision),
            Just(Clock::Arrival),
            Just(Clock::Ready),
            Just(Clock::TakeOff)
        ]
    };
    prop_oneof![
        Just(Edit::OneMorePassenger),
        Just(Edit::OnePassengerLess),
        clocks().prop_map(Edit::Sooner),
        clocks().prop_map(Edit::Later),
        Just(Edit::OtherCharge),
        any::<Index>().prop_map(Edit::OtherDestination),
        Just(Edit::Dropped),
        Just(Edit::Doubled),
        any::<Index>().prop_map(Edit::SwappedWith),
    ]
}

/// Carries an edit out. Returns `false` if it would leave the schedule unchanged.
fn carry_out(edit: Edit, day: &Scenario, rows: &mut Vec<TraceRow>, at: usize) -> bool {
    let as_needed = day.operations.charging == Charging::AsNeeded;
    let row = &mut rows[at];
    match edit {
        Edit::Sooner(Clock::TakeOff) | Edit::Later(Clock::TakeOff) | Edit::OtherCharge
            if !as_needed =>
        {
            return false;
        }
        // Charges are known to a milliwatt-hour or two.
        Edit::OtherCharge => row.charge_kwh += 1e-5,
        Edit::OneMorePassenger => row.passengers += 1,
        Edit::OnePassengerLess => match row.passengers.checked_sub(1) {
            Some(fewer) => row.passengers = fewer,
            None => return false,
        },
        Edit::Sooner(clock) => {
            let time = clock.of(row);
            *time = Time::from_seconds(time.seconds() - 1);
        }
        Edit::Later(clock) => {
            let time = clock.of(row);
            *time = *time + 1;
        }
        Edit::OtherDestination(to) => {
            let to = VertiportIx::new(to.index(day.vertiports.len()));
            if to == row.to {
                return false;
            }
            row.to = to;
        }
        Edit::Dropped => drop(rows.remove(at)),
        Edit::Doubled => rows.insert(at, rows[at]),
        Edit::SwappedWith(other) => {
            let other = other.index(rows.len());
            rows.swap(at, other);
            return other != at;
        }
    }
    true
}

/// Whether two sums are equal apart from the order of their terms.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1.0)
}

proptest! {
    #![proptest_config(Config::with_cases(200))]

    #[test]
    fn what_the_simulator_plays_keeps_every_rule(day in energy_day(), draws in draws()) {
        let (_, trace) = play(&day, &draws);
        let report = check(&day, &trace);
        prop_assert!(report.is_valid(), "{report}");
    }

    #[test]
    fn round_numbers_are_not_doubted(day in small_day(), draws in draws()) {
        let (_, trace) = play(&in_round_numbers(&day), &draws);
        let report = check(&in_round_numbers(&day), &trace);
        prop_assert!(report.is_valid(), "{report}");
    }

    #[test]
    fn both_agree_on_what_is_within_range(
        day in small_day(),
        draws in draws(),
        off in prop::collection::vec(-1.0_f64..1.0, 1..12),
    ) {
        let day = at_the_end_of_the_range(&day, &off);
        let (_, trace) = play(&day, &draws);
        let report = check(&day, &trace);
        prop_assert!(report.is_valid(), "{report}");
    }

    /// Curves with neighbouring numbers for charges, batteries of a milliwatt-hour and of
    /// 5,000 kWh, the least and the greatest powers.
    #[test]
    fn simulator_and_checker_agree_on_extreme_curves(day in extreme_energy_day(), draws in draws()) {
        let (_, trace) = play(&day, &draws);
        let report = check(&day, &trace);
        prop_assert!(report.is_valid(), "{}", report);
    }

    #[test]
    fn both_accounts_of_a_day_agree(day in energy_day(), draws in draws()) {
        let (summary, trace) = play(&day, &draws);
        let totals = check(&day, &trace).totals;
        for (theirs, ours) in [
            (totals.profit_usd, summary.profit_usd),
            (totals.revenue_usd, summary.revenue_usd),
            (totals.passenger_cost_usd, summary.passenger_cost_usd),
            (totals.energy_cost_usd, summary.energy_cost_usd),
            (totals.flight_cost_usd, summary.flight_cost_usd),
            (totals.aircraft_cost_usd, summary.aircraft_cost_usd),
            (totals.site_cost_usd, summary.site_cost_usd),
            (totals.energy_kwh, summary.energy_kwh),
        ] {
            prop_assert!(close(theirs, ours), "{theirs} and {ours}");
        }
        prop_assert_eq!(totals.flights, summary.flights);
        prop_assert_eq!(totals.repositioning_flights, summary.repositioning_flights);
        prop_assert_eq!(totals.holds, summary.holds);
        prop_assert_eq!(totals.decisions, summary.decisions);
        prop_assert_eq!(totals.passengers, summary.passengers);
    }

    #[test]
    fn a_simulated_trace_survives_its_file(day in energy_day(), draws in draws()) {
        let (_, trace) = play(&day, &draws);
        let read = Trace::from_csv(trace.to_csv(&day).as_bytes(), &day, "day.csv");
        prop_assert_eq!(read.expect("a written trace"), trace);
    }
}

proptest! {
    #![proptest_config(Config::with_cases(2_000))]

    #[test]
    fn one_edited_row_is_always_found(
        day in energy_day(), draws in draws(), at in any::<Index>(), edit in edits()
    ) {
        let (_, mut trace) = play(&day, &draws);
        // On a few days every aircraft is full too late to decide.
        if trace.rows.is_empty() {
            return Ok(());
        }
        let at = at.index(trace.rows.len());
        if carry_out(edit, &day, &mut trace.rows, at) {
            prop_assert!(!check(&day, &trace).is_valid(), "{edit:?} in row {at} was not found");
        }
    }
}
