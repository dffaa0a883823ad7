//! Reports of the impossible are accepted with a notice that names it.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, Charging, Scenario, Time, VertiportIx};
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
