//! Days that charge to full, with curves, weak chargers, turnarounds and batteries that are not
//! full when operations start. The numbers are worked out by hand for the day of `check_day`, on
//! which a kilowatt-hour is charged in a minute.

use vertifleet_core::Day;
use vertifleet_sim::Trace;

use crate::check_as_needed::{judge, names, with_taper};
use crate::check_day::{self, flight, time};

/// The day with the first aircraft only, until just after its first flight was decided.
fn day() -> Day {
    let mut day = check_day::day();
    day.aircraft.truncate(1);
    day.operations.end = time("07:00:00");
    day
}

/// One flight of 40 miles and 45 kWh, which lands with 55 kWh.
fn ready_at(ready: &str) -> Trace {
    let amounts = [200.0, 104.0, 45.0, 9.0];
    let row = flight(("06:00:00", 0), (0, 2), 4, amounts, ("06:50:00", ready));
    Trace { rows: vec![row] }
}

/// Asserts that the aircraft is ready at this second, and at neither of its neighbours.
fn assert_ready_at(day: &Day, ready: &str) {
    let mut trace = ready_at(ready);
    let due_s = trace.rows[0].ready.seconds();
    assert_eq!(judge(day.clone(), &trace).findings, []);
    for wrong_s in [due_s - 1, due_s + 1] {
        trace.rows[0].ready = vertifleet_core::Time::from_seconds(wrong_s);
        assert_eq!(names(&judge(day.clone(), &trace)), ["ready-time"], "{wrong_s}");
    }
}

#[test]
fn an_aircraft_is_ready_when_it_is_charged_and_turned_around() {
    let mut day = day();
    assert_ready_at(&day, "07:35:00");
    day.aircraft_types[0].turnaround_s = 2_700;
    assert_ready_at(&day, "07:35:00");
    day.aircraft_types[0].turnaround_s = 2_701;
    assert_ready_at(&day, "07:35:01");
}

#[test]
fn the_weaker_of_aircraft_and_vertiport_limits_the_power() {
    let mut day = day();
    day.vertiports[2].charger_kw = Some(90.0);
    assert_ready_at(&day, "07:35:00");
    day.vertiports[2].charger_kw = Some(30.0);
    assert_ready_at(&day, "08:20:00");
}

/// From 57 kW at 55 kWh to 30 kW at 100 kWh: ln(57 / 30) / 0.6 hours are 3851.12 s.
#[test]
fn a_curve_makes_charging_to_full_longer() {
    let mut day = with_taper(day());
    assert_ready_at(&day, "07:54:11");
    // At most 45 kW: 20 kWh in 1600 s, then ln(45 / 30) / 0.6 hours, or 2432.79 s.
    day.vertiports[2].charger_kw = Some(45.0);
    assert_ready_at(&day, "07:57:13");
    let report = judge(day, &ready_at("07:57:14"));
    assert_eq!(
        report.findings[0].detail,
        "ready 07:57:14, but charging 45 kWh at up to 45 kW from 06:50:00 on ends at 07:57:13"
    );
}

/// 30 kWh at 30 kW are charged in an hour.
#[test]
fn an_aircraft_that_is_not_full_first_decides_when_it_is() {
    let mut day = day();
    day.vertiports[0].charger_kw = Some(30.0);
    day.aircraft[0].start_charge_kwh = Some(70.0);
    let amounts = [200.0, 104.0, 45.0, 13.5];
    let row = flight(("07:00:00", 0), (0, 2), 4, amounts, ("07:50:00", "08:35:00"));
    let trace = Trace { rows: vec![row] };
    assert_eq!(judge(day.clone(), &trace).findings, []);

    let report = judge(day.clone(), &ready_at("07:35:00"));
    assert_eq!(names(&report), ["first-decision"]);
    assert_eq!(
        report.findings[0].detail,
        "the battery is full at 07:00:00, when the aircraft decides first"
    );
    let report = judge(day.clone(), &Trace::default());
    assert_eq!(names(&report), ["missing-decision"]);
    assert_eq!(report.findings[0].time, time("07:00:00"));

    day.operations.end = time("06:59:59");
    assert!(judge(day, &Trace::default()).is_valid(), "full only after the end of operations");
}

/// The curve holds for the first charge too: 20 kWh from 80 kWh on, from 42 kW to 30 kW, take
/// ln(42 / 30) / 0.6 hours, or 2018.83 s.
#[test]
fn the_first_charge_follows_the_curve() {
    let mut day = with_taper(day());
    day.aircraft[0].start_charge_kwh = Some(80.0);
    let report = judge(day, &Trace::default());
    assert_eq!(report.findings[0].time, time("06:33:39"));
}

#[test]
fn the_reserve_limits_the_range() {
    let mut day = day();
    day.aircraft_types[0].reserve_kwh = 55.0;
    assert!(judge(day.clone(), &ready_at("07:35:00")).is_valid());
    day.aircraft_types[0].reserve_kwh = 55.000_001;
    assert_eq!(names(&judge(day, &ready_at("07:35:00"))), ["range"]);
}
