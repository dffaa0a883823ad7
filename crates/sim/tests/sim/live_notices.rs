//! Reports of the impossible are accepted with a notice that names it.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, Charging, Scenario, Time, VertiportIx};
use vertifleet_sim::TraceRow;
use vertifleet_sim::live::{LiveDay, Report};
use vertifleet_testkit::paper_day;

const A01: AircraftIx = AircraftIx(0);

/// A day that charges as needed, on which every aircraft starts with this charge.
fn as_needed(start_charge_kwh: f64) -> Arc<Scenario> {
    let mut day = Scenario::clone(&paper_day(1)).into_day();
    day.operations.charging = Charging::AsNeeded;
    for aircraft in &mut day.aircraft {
        aircraft.start_charge_kwh = Some(start_charge_kwh);
    }
    Arc::new(day.check("a day that charges as needed").expect("a day"))
}

fn codes(live: &mut LiveDay, time: Time, report: &Report) -> Vec<&'static str> {
    let notices = live.take(time, report).expect("it happened");
    notices.iter().map(vertifleet_sim::live::Notice::code).collect()
}

fn present(live: &LiveDay) -> Vec<&'static str> {
    let codes = live.notices().map(|notice| notice.code());
    // A flight against the rules may lead to a full vertiport.
    codes.filter(|code| *code != "more_than_stands").collect()
}

/// The vertiport that takes longest to reach, the duration of the flight, and its energy.
fn farthest(live: &mut LiveDay) -> (VertiportIx, u32, f64) {
    let at = live.aircraft_now(A01).place;
    let view = live.view();
    let kind = view.kind(A01);
    let leg = |to: VertiportIx| *view.leg(kind, at, to);
    let all = VertiportIx::all(view.vertiports()).filter(|&to| leg(to).flight_s < 1_000_000);
    let to = all.max_by_key(|&to| leg(to).flight_s).expect("a vertiport");
    (to, leg(to).flight_s, leg(to).energy_kwh)
}

fn departed(to: VertiportIx) -> Report {
    Report::Departed { aircraft: A01, to: Some(to), passengers: None }
}

fn landed(charge_kwh: Option<f64>) -> Report {
    Report::Landed { aircraft: A01, at: None, charge_kwh }
}

#[test]
fn a_departure_without_the_energy_of_the_flight_is_noticed_until_it_lands() {
    let mut live = LiveDay::new(as_needed(1.0));
    let start = live.now();
    let (to, flight_s, energy_kwh) = farthest(&mut live);
    assert!(energy_kwh > 5.0);
    assert!(codes(&mut live, start, &departed(to)).contains(&"without_energy"));
    assert_eq!(present(&live), ["without_energy"]);
    let lands = live.aircraft_now(A01).lands_with_kwh.expect("it is in the air");
    assert!((lands - (1.0 - energy_kwh)).abs() < 1e-5, "{lands}");
    let notices = codes(&mut live, start + flight_s, &landed(None));
    assert!(notices.is_empty(), "{notices:?}");
    assert!(present(&live).is_empty());
}

#[test]
fn a_departure_that_is_brought_forward_may_lack_energy() {
    let day = as_needed(1.0);
    let mut live = LiveDay::new(Arc::clone(&day));
    let start = live.now();
    let decision = live.decision(A01, start).expect("it is ready");
    let mut room = None;
    let mask = live.view_at(&decision, &mut room).feasible(&decision);
    let to = mask.iter().find(|&to| to != decision.at).expect("a flight after charging");
    assert!(codes(&mut live, start, &Report::Decided { aircraft: A01, to }).is_empty());
    let takeoff = live.flight(A01).expect("it was sent off").takeoff;
    let delayed = |until| Report::Delayed { aircraft: A01, until };
    assert!(takeoff > start + 120, "it has to charge first");
    assert_eq!(codes(&mut live, start, &delayed(start + 60)), ["without_energy"]);
    assert_eq!(present(&live), ["without_energy"]);
    assert!(codes(&mut live, start, &delayed(takeoff)).is_empty());
    assert!(present(&live).is_empty());
    // A flight that takes off some seconds early only lacks the reserve.
    let reserve_kwh = day.aircraft_types[0].reserve_kwh;
    if reserve_kwh > 0.0 {
        assert_eq!(
            codes(&mut live, start, &delayed(start + (takeoff.since(start) - 1))),
            ["below_reserve"]
        );
    }
}

#[test]
fn a_landing_that_is_faster_than_the_flight_is_noticed() {
    for (percent, is_noticed) in [(0, true), (50, true), (75, true), (90, false), (120, false)] {
        let mut live = LiveDay::new(paper_day(1));
        let start = live.now();
        let (to, flight_s, _) = farthest(&mut live);
        live.take(start, &departed(to)).expect("it happened");
        let lands = start + flight_s * percent / 100;
        let notices = codes(&mut live, lands, &landed(None));
        assert_eq!(notices == ["too_fast"], is_noticed, "{percent} %: {notices:?}");
        assert_eq!(notices.is_empty(), !is_noticed, "{percent} %: {notices:?}");
    }
    let mut live = LiveDay::new(paper_day(1));
    let start = live.now();
    let (to, ..) = farthest(&mut live);
    live.take(start, &departed(to)).expect("it happened");
    let delayed = Report::Delayed { aircraft: A01, until: start + 60 };
    assert_eq!(codes(&mut live, start, &delayed), ["too_fast"]);
}

#[test]
fn a_charge_that_cannot_be_is_noticed() {
    let day = as_needed(100.0);
    let mut live = LiveDay::new(day);
    let start = live.now();
    let (to, flight_s, energy_kwh) = farthest(&mut live);
    live.take(start, &departed(to)).expect("it happened");
    let lands = start + flight_s;
    let mut other = live.clone();
    assert_eq!(codes(&mut live, lands, &landed(Some(100.0))), ["charge_too_high"]);
    let expected = (100.0 - energy_kwh).max(0.0);
    assert!(codes(&mut other, lands, &landed(Some(expected))).is_empty());
}

#[test]
fn an_aircraft_that_is_ready_before_it_can_be_charged_is_noticed() {
    let mut live = LiveDay::new(paper_day(1));
    let start = live.now();
    let (to, flight_s, _) = farthest(&mut live);
    live.take(start, &departed(to)).expect("it happened");
    let lands = start + flight_s;
    live.take(lands, &landed(None)).expect("it happened");
    let ready = live.aircraft_now(A01).ready;
    assert!(ready > lands + 300, "it has to charge");
    for report in [
        Report::Ready { aircraft: A01 },
        Report::Charging { aircraft: A01, ready: lands + 60 },
        Report::Delayed { aircraft: A01, until: lands + 60 },
    ] {
        assert_eq!(codes(&mut live.clone(), lands, &report), ["ready_too_soon"], "{report:?}");
    }
    assert!(codes(&mut live, ready, &Report::Ready { aircraft: A01 }).is_empty());
    // It cannot leave before it has landed, or before it was ready.
    let back = Report::Departed { aircraft: A01, to: Some(VertiportIx(0)), passengers: None };
    let back = if to == VertiportIx(0) { departed(VertiportIx(1)) } else { back };
    let early = codes(&mut live.clone(), start + (flight_s - 60), &back);
    assert!(early.contains(&"departed_before_landing"), "{early:?}");
    assert!(!early.contains(&"departed_unready"), "{early:?}");
    assert!(codes(&mut live, lands + 60, &back).contains(&"departed_unready"));
}

/// Sends A01 away while it has too little charge, and returns the decided flight.
fn decided(live: &mut LiveDay) -> TraceRow {
    let start = live.now();
    let decision = live.decision(A01, start).expect("it is ready");
    let mut room = None;
    let mask = live.view_at(&decision, &mut room).feasible(&decision);
    let to = mask.iter().find(|&to| to != decision.at).expect("a flight after charging");
    assert!(codes(live, start, &Report::Decided { aircraft: A01, to }).is_empty());
    *live.flight(A01).expect("it was sent off")
}

/// The codes of a landing that the day does not keep, but for that of a crowded vertiport.
fn codes_of_landing(live: &LiveDay, time: Time, report: &Report) -> Vec<&'static str> {
    let mut codes = codes(&mut live.clone(), time, report);
    codes.retain(|code| *code != "more_than_stands");
    codes
}

#[test]
fn a_landing_before_the_battery_sufficed_is_noticed_if_no_departure_was_reported() {
    let mut live = LiveDay::new(as_needed(1.0));
    let start = live.now();
    let row = decided(&mut live);
    let flight_s = row.arrival.since(row.takeoff);
    assert!(row.takeoff.since(start) > flight_s / 4 + 120, "it has to charge first");
    for (lands, expected) in [
        (start + 60, vec!["too_fast"]),
        (start + flight_s, vec!["without_energy"]),
        (row.arrival, vec![]),
        (row.arrival + 900, vec![]),
    ] {
        assert_eq!(codes(&mut live.clone(), lands, &landed(None)), expected, "{lands}");
    }
    // On days that charge to full, the battery is full at the decision.
    let mut live = LiveDay::new(paper_day(1));
    let row = decided(&mut live);
    assert!(codes(&mut live, row.arrival, &landed(None)).is_empty());
}

#[test]
fn a_landing_elsewhere_without_a_departure_needs_the_energy_of_the_flight_there() {
    let mut live = LiveDay::new(as_needed(1.0));
    let start = live.now();
    let row = decided(&mut live);
    let (farther, flight_s, energy_kwh) = farthest(&mut live);
    assert!(energy_kwh > row.energy_kwh && farther != row.to);
    let at = |at, charge_kwh| Report::Landed { aircraft: A01, at: Some(at), charge_kwh };
    let codes = |lands, report| codes_of_landing(&live, lands, &report);
    assert_eq!(codes(start + flight_s, at(farther, None)), ["diverted", "without_energy"]);
    assert_eq!(codes(start + 7_200 + flight_s, at(farther, None)), ["diverted"]);
    // It may have charged until its landing permits no later take-off, or not have left at all.
    assert_eq!(codes(start + 7_200, at(row.from, Some(60.0))), ["diverted"]);
    assert_eq!(codes(start + 60, at(row.from, Some(60.0))), ["diverted", "charge_too_high"]);
}

#[test]
fn the_charge_of_an_aircraft_that_lands_elsewhere_is_that_of_the_flight_it_made() {
    let mut live = LiveDay::new(as_needed(100.0));
    let start = live.now();
    let from = live.aircraft_now(A01).place;
    let (to, ..) = farthest(&mut live);
    let view = live.view();
    let leg = |at| *view.leg(view.kind(A01), from, at);
    let others = VertiportIx::all(view.vertiports()).filter(|&at| at != from);
    let near = others.min_by_key(|&at| leg(at).flight_s).expect("a vertiport");
    let near_leg = leg(near);
    assert!(near_leg.energy_kwh < 0.6 * leg(to).energy_kwh, "much closer than {to:?}");
    live.take(start, &departed(to)).expect("it happened");
    let landed = |at, after_s, charge_kwh| {
        let report = Report::Landed { aircraft: A01, at: Some(at), charge_kwh: Some(charge_kwh) };
        codes_of_landing(&live, start + after_s, &report)
    };
    let left_kwh = 100.0 - near_leg.energy_kwh;
    assert_eq!(landed(near, near_leg.flight_s, left_kwh), ["diverted"]);
    assert_eq!(landed(near, near_leg.flight_s, 99.9), ["diverted", "charge_too_high"]);
    // A flight that came back at once has taken next to nothing.
    assert_eq!(landed(from, 300, 99.0), ["diverted"]);
    assert_eq!(landed(from, 300, 109.0), ["diverted", "charge_too_high"]);
}

#[test]
fn a_turnaround_that_is_too_short_is_noticed_on_days_that_charge_as_needed() {
    let mut day = Scenario::clone(&as_needed(100.0)).into_day();
    day.aircraft_types[0].turnaround_s = 240;
    let day = Arc::new(day.check("a day with turnarounds").expect("a day"));
    let mut live = LiveDay::new(day);
    let start = live.now();
    let (to, flight_s, _) = farthest(&mut live);
    live.take(start, &departed(to)).expect("it happened");
    let lands = start + flight_s;
    live.take(lands, &landed(None)).expect("it happened");
    let ready = |after_s: u32| {
        let mut live = live.clone();
        let notices = live.take(lands + after_s, &Report::Ready { aircraft: A01 });
        notices.expect("it happened").iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let [notice] = &ready(0)[..] else { panic!("{:?}", ready(0)) };
    assert!(notice.ends_with(", and its turnaround takes 240 s"), "{notice}");
    assert_eq!(ready(60).len(), 1);
    assert!(ready(200).is_empty());
}

#[test]
fn an_aircraft_that_came_back_at_once_may_be_ready_soon() {
    let mut live = LiveDay::new(paper_day(1));
    let start = live.now();
    let from = live.aircraft_now(A01).place;
    let (to, ..) = farthest(&mut live);
    live.take(start, &departed(to)).expect("it happened");
    let back = Report::Landed { aircraft: A01, at: Some(from), charge_kwh: None };
    live.take(start + 180, &back).expect("it happened");
    assert!(codes(&mut live, start + 240, &Report::Ready { aircraft: A01 }).is_empty());
}
