//! Live days: with the reports of a simulated day they are that day, and with any other reports
//! they keep every rule that reality does.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::shown::shown;
use proptest::prelude::{
    ProptestConfig, Strategy, any, prop, prop_assert, prop_assert_eq, prop_oneof, proptest,
};
use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};
use vertifleet_sim::Simulation;
use vertifleet_sim::live::{Booking, LiveDay, Phase, Report, ReportError, Reporter, Routes};
use vertifleet_testkit::{energy_day, paper_day};

/// Plays a day by a rule and reports it to a live day. At every decision both show the same.
fn simulated_and_live(day: &Arc<Scenario>, draws: &[u32]) -> (Simulation, LiveDay) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut reporter = Reporter::new(day);
    let mut live = LiveDay::new(Arc::clone(day));
    let mut room = None;
    let mut draws = draws.iter().cycle();
    while let Some(decision) = simulation.next_decision() {
        assert_eq!(reporter.next_decision(), Some(decision));
        while let Some((time, report)) = reporter.next_report(decision.time) {
            let notices = live.take(time, &report).expect("a report of what the rules allow");
            assert!(notices.is_empty(), "{notices:?}");
        }
        let asked = live.decision(decision.aircraft, decision.time).expect("it is ready");
        assert_eq!(asked, decision);
        let view = live.view_at(&asked, &mut room);
        assert_eq!(shown(view, &asked), shown(simulation.view(), &decision));
        let mask = simulation.view().feasible(&decision);
        let draw = draws.next().expect("round and round");
        let choice = mask.nth(draw % mask.len()).expect("a rank within the mask");
        reporter.apply(choice).expect("a feasible choice");
        simulation.apply(choice).expect("a feasible choice");
        let decided = Report::Decided { aircraft: decision.aircraft, to: choice };
        live.take(decision.time, &decided).expect("a feasible choice");
    }
    while let Some((time, report)) = reporter.next_report(Time::from_seconds(u32::MAX)) {
        live.take(time, &report).expect("a report of what the rules allow");
    }
    (simulation, live)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_live_day_with_the_reports_of_a_simulated_day_is_that_day(
        day in energy_day(), draws in prop::collection::vec(any::<u32>(), 30)
    ) {
        let (simulation, mut live) = simulated_and_live(&day, &draws);
        prop_assert_eq!(live.totals(), simulation.totals());
        prop_assert!(live.aircraft().all(|aircraft| aircraft.phase == Phase::Standing));
    }
}

#[test]
fn others_are_expected_to_depart_as_late_as_the_latest_flight() {
    let mut live = LiveDay::new(paper_day(1));
    let start = live.scenario().operations.start;
    let mut day = live.rest();
    let first = day.next_decision().expect("a day has decisions");
    let to = day.view().feasible(&first).iter().find(|&to| to != first.at).expect("a free stand");
    let aircraft = first.aircraft;
    live.take(start, &Report::Decided { aircraft, to }).expect("it is feasible");
    let departed = Report::Departed { aircraft, to: None, passengers: None };
    live.take(start + 240, &departed).expect("it was sent off");
    let mut rest = live.rest();
    let mut late = BTreeSet::new();
    while let Some(decision) = rest.next_decision()
        && decision.time < start + 3_600
    {
        let view = rest.view();
        let flight = view.feasible(&decision).iter().find(|&to| to != decision.at);
        let to = flight.unwrap_or(decision.at);
        let flight_s = view.leg(view.kind(decision.aircraft), decision.at, to).flight_s;
        let row = rest.apply(to).expect("it is feasible");
        if row.to != row.from {
            let is_early = row.time < start + 900;
            let late_s = row.arrival.since(row.time + flight_s);
            late.insert((row.from == first.at, is_early, late_s));
        }
    }
    assert!(late.contains(&(true, true, 240)), "{late:?}");
    assert!(late.iter().all(|&(same, early, late_s)| (late_s == 240) == (same && early)));
}

/// A report about anything at all, most of it possible on small days.
fn any_report() -> impl Strategy<Value = Report> {
    let aircraft = || (0..4_u16).prop_map(AircraftIx);
    let vertiport = || (0..5_u16).prop_map(VertiportIx);
    let time = || (20_000..60_000_u32).prop_map(Time::from_seconds);
    let routes = prop_oneof![
        (vertiport(), vertiport()).prop_map(|(from, to)| Routes::Way { from, to }),
        vertiport().prop_map(Routes::Of),
    ];
    let booking = (0..4_usize, vertiport(), vertiport(), 0..20_u32)
        .prop_map(|(period, from, to, passengers)| Booking { period, from, to, passengers });
    let decided =
        (aircraft(), vertiport()).prop_map(|(aircraft, to)| Report::Decided { aircraft, to });
    prop_oneof![
        6 => decided,
        2 => aircraft().prop_map(|aircraft| Report::Undone { aircraft }),
        4 => (aircraft(), prop::option::of(vertiport()), prop::option::of(0..6_u16))
            .prop_map(|(aircraft, to, passengers)| Report::Departed { aircraft, to, passengers }),
        4 => (aircraft(), prop::option::of(vertiport()), prop::option::of(-10.0..120.0))
            .prop_map(|(aircraft, at, charge_kwh)| Report::Landed { aircraft, at, charge_kwh }),
        1 => (aircraft(), time()).prop_map(|(aircraft, ready)| Report::Charging { aircraft, ready }),
        2 => aircraft().prop_map(|aircraft| Report::Ready { aircraft }),
        1 => (aircraft(), time()).prop_map(|(aircraft, until)| Report::Delayed { aircraft, until }),
        1 => (aircraft(), prop::option::of(time()))
            .prop_map(|(aircraft, until)| Report::OutOfService { aircraft, until }),
        1 => aircraft().prop_map(|aircraft| Report::BackInService { aircraft }),
        1 => (routes.clone(), prop::option::of(time()))
            .prop_map(|(routes, until)| Report::Closed { routes, until }),
        1 => routes.prop_map(|routes| Report::Reopened { routes }),
        1 => (0..4_usize, vertiport(), vertiport(), 0..20_u32)
            .prop_map(|(period, from, to, left)| Report::Demand { period, pairs: vec![(from, to, left)] }),
        1 => booking.clone().prop_map(|booking| Report::Booked { booking }),
        1 => booking.prop_map(|booking| Report::Cancelled { booking }),
        1 => (vertiport(), 0..4_u16).prop_map(|(vertiport, stands)| Report::Stands { vertiport, stands }),
    ]
}

/// Everything that a live day shows, without its clock.
fn all_of(live: &LiveDay) -> String {
    let mut live = live.clone();
    let states: Vec<_> = live.aircraft().collect();
    let notices: Vec<_> = live.notices().collect();
    let periods = live.scenario().periods.len();
    let boarded: Vec<u32> =
        (0..periods).flat_map(|period| live.boarded_in(period).to_vec()).collect();
    let (totals, trace) = (live.totals(), live.trace());
    let view = live.view();
    let left: Vec<u32> =
        (0..periods).flat_map(|period| view.demand_left_in(period).to_vec()).collect();
    let taken = (
        view.stands_taken(),
        VertiportIx::all(view.vertiports()).map(|v| view.parked(v)).collect::<Vec<_>>(),
    );
    format!("{states:?} {notices:?} {totals:?} {trace:?} {left:?} {boarded:?} {taken:?}")
}

/// Properties of every live day, after any reports.
fn check(live: &mut LiveDay) {
    let states: Vec<_> = live.aircraft().collect();
    let view = live.view();
    for vertiport in VertiportIx::all(view.vertiports()) {
        let there = states.iter().filter(|aircraft| aircraft.place == vertiport).count();
        let counted = view.stands_taken()[vertiport.at()] + view.parked(vertiport).0;
        assert_eq!(there, usize::from(counted), "every aircraft has one place at {vertiport:?}");
    }
    let totals = live.totals();
    let trace = live.trace();
    let profit: f64 = trace.rows.iter().map(vertifleet_sim::TraceRow::profit_usd).sum();
    let fleet_usd = live.scenario().fixed_cost_usd();
    assert!((totals.profit_usd - (profit - fleet_usd)).abs() < 1e-6 * profit.abs().max(1.0));
    let carried: u64 = trace.rows.iter().map(|row| u64::from(row.passengers)).sum();
    assert_eq!(totals.passengers, carried);
    // The rest of the day can always be played out.
    let mut rest = live.rest();
    while let Some(decision) = rest.next_decision() {
        let mask = rest.view().feasible(&decision);
        let choice = mask.nth(decision.index % mask.len()).expect("the mask is never empty");
        rest.apply(choice).expect("a choice from the mask");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_live_day_stays_sound_after_any_reports(
        day in energy_day(),
        reports in prop::collection::vec((0..900_u32, any_report()), 1..60),
    ) {
        let mut live = LiveDay::new(Arc::clone(&day));
        let mut time = day.operations.start;
        let mut accepted = Vec::new();
        for (later_s, report) in reports {
            let before = all_of(&live);
            match live.take(time + later_s, &report) {
                Ok(_) => {
                    time = time + later_s;
                    accepted.push((time, report.clone()));
                    prop_assert_eq!(live.now(), time);
                }
                Err(unfit) => {
                    prop_assert_eq!(&all_of(&live), &before, "{:?}: {}", report, unfit);
                }
            }
            check(&mut live);
        }
        // The day is a function of the reports that were taken.
        let mut again = LiveDay::new(day);
        for (time, report) in &accepted {
            again.take(*time, report).expect("it was taken before");
        }
        prop_assert_eq!(all_of(&again), all_of(&live));
    }

    #[test]
    fn a_corrected_report_leaves_no_trace(
        day in energy_day(),
        reports in prop::collection::vec((0..900_u32, any_report()), 1..40),
        which in any::<prop::sample::Index>(),
    ) {
        let mut live = LiveDay::new(Arc::clone(&day));
        let mut time = day.operations.start;
        let mut accepted = Vec::new();
        for (later_s, report) in reports {
            if live.take(time + later_s, &report).is_ok() {
                time = time + later_s;
                accepted.push((time, report));
            }
        }
        if accepted.is_empty() {
            return Ok(());
        }
        let at = which.index(accepted.len());
        let before = (all_of(&live), live.now());
        let event = at as u64 + 1;
        let corrected = live.take(time, &Report::Corrected { event });
        accepted.remove(at);
        let mut without = LiveDay::new(day);
        let refused = accepted.iter().find_map(|(time, report)| without.take(*time, report).err());
        match corrected {
            Ok(_) => {
                prop_assert_eq!(refused, None);
                prop_assert_eq!(all_of(&live), all_of(&without));
                prop_assert_eq!(live.now(), without.now());
                let told = |day: &LiveDay| {
                    day.past_notices().map(|(_, notice)| notice.clone()).collect::<Vec<_>>()
                };
                prop_assert_eq!(told(&live), told(&without));
                check(&mut live);
                let again = live.take(time, &Report::Corrected { event });
                let is_refused = matches!(again, Err(ReportError::CannotCorrect { .. }));
                prop_assert!(is_refused);
            }
            Err(ReportError::NeededLater { cause, .. }) => {
                prop_assert_eq!(refused, Some(*cause));
                prop_assert_eq!((all_of(&live), live.now()), before);
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    #[test]
    fn an_undone_decision_leaves_no_trace(
        day in energy_day(),
        reports in prop::collection::vec((0..900_u32, any_report()), 0..40),
        choice in any::<u32>(),
    ) {
        let mut live = LiveDay::new(Arc::clone(&day));
        let mut time = day.operations.start;
        for (later_s, report) in reports {
            if live.take(time + later_s, &report).is_ok() {
                time = time + later_s;
            }
        }
        for aircraft in AircraftIx::all(day.aircraft.len()) {
            let Ok(decision) = live.decision(aircraft, time) else { continue };
            let mut room = None;
            let mask = live.view_at(&decision, &mut room).feasible(&decision);
            let to = mask.nth(choice % mask.len()).expect("the mask is never empty");
            let before = all_of(&live);
            live.take(decision.time, &Report::Decided { aircraft, to }).expect("a feasible choice");
            live.take(decision.time, &Report::Undone { aircraft }).expect("it has not departed");
            prop_assert_eq!(all_of(&live), before);
            let undone = live.take(decision.time, &Report::Undone { aircraft });
            let nothing = matches!(undone, Err(ReportError::NothingToUndo { .. }));
            prop_assert!(nothing);
        }
    }
}
