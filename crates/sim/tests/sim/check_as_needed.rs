//! A day on which aircraft charge as needed, a schedule for it worked out by hand, and the rules
//! that only such days have.
//!
//! The day is that of `check_day`: a mile of cruise takes a minute and 1.1 kWh, take-off and
//! landing take 10 minutes and 1 kWh, and a minute charges 1 kWh. Besides, every flight leaves
//! 10 kWh in the battery, and every landing needs 5 minutes of turnaround.

use vertifleet_core::{
    AircraftIx, ChargeCurve, Charging, CurvePoint, Day, Outage, TakeoffDelays, Time,
};
use vertifleet_sim::check::{Report, Rule, check};
use vertifleet_sim::{Trace, TraceRow};

use crate::check_day::{self, flight, time};

/// The day in its open form, to be changed and checked.
pub(crate) fn day() -> Day {
    let mut day = check_day::day();
    day.operations.charging = Charging::AsNeeded;
    day.aircraft_types[0].reserve_kwh = 10.0;
    day.aircraft_types[0].turnaround_s = 300;
    day.aircraft[0].start_charge_kwh = Some(40.0);
    day
}

/// Seven decisions that keep every rule.
pub(crate) fn schedule() -> Trace {
    let rows = vec![
        // 45 kWh and the reserve are 55: A1 waits 15 minutes for 15 kWh, and lands with 10 kWh. The
        // price is that of the late period.
        charged(
            flight(
                ("06:00:00", 0),
                (0, 2),
                4,
                [200.0, 104.0, 45.0, 13.5],
                ("07:05:00", "07:10:00"),
            ),
            (40.0, "06:15:00"),
        ),
        // A2 takes the only stand of V1, next to which A1 still waits, and lands with 77 kWh.
        charged(
            flight(("06:00:00", 1), (1, 0), 3, [90.0, 39.0, 23.0, 4.6], ("06:30:00", "06:35:00")),
            (100.0, "06:00:00"),
        ),
        hold(("06:35:00", 1), 0, 82.0, "06:50:00"),
        // The 2 passengers left of the early period. A2 lands with 97 - 45 kWh.
        charged(
            flight(("06:50:00", 1), (0, 2), 2, [100.0, 52.0, 45.0, 13.5], ("07:40:00", "07:45:00")),
            (97.0, "06:50:00"),
        ),
        hold(("07:10:00", 0), 2, 15.0, "07:25:00"),
        // 30 miles take 34 kWh, so A1 needs 44: 34 minutes after it landed with 10.
        charged(
            flight(("07:25:00", 0), (2, 1), 4, [160.0, 80.0, 34.0, 10.2], ("08:19:00", "08:24:00")),
            (30.0, "07:39:00"),
        ),
        charged(
            flight(
                ("07:45:00", 1),
                (2, 0),
                0,
                [0.0, 0.0, 45.011_666_666_666_67, 13.503_5],
                ("08:35:01", "08:40:01"),
            ),
            (57.0, "07:45:00"),
        ),
    ];
    Trace { rows }
}

fn charged(row: TraceRow, (charge_kwh, takeoff): (f64, &str)) -> TraceRow {
    TraceRow { charge_kwh, takeoff: time(takeoff), ..row }
}

fn hold((at, aircraft): (&str, u16), place: u16, charge_kwh: f64, ready: &str) -> TraceRow {
    charged(flight((at, aircraft), (place, place), 0, [0.0; 4], (at, ready)), (charge_kwh, at))
}

/// The day with a curve: 60 kW up to half a battery, then falling to 30 kW.
pub(crate) fn with_taper(mut day: Day) -> Day {
    let points = [(0.0, 60.0), (0.5, 60.0), (1.0, 30.0)];
    let points = points.map(|(charge, kw)| CurvePoint { charge, kw }).to_vec();
    day.aircraft_types[0].charge_curve = Some(ChargeCurve::through(points));
    day
}

pub(crate) fn judge(day: Day, trace: &Trace) -> Report {
    check(&day.check("by hand").expect("a day within the rules"), trace)
}

pub(crate) fn names(report: &Report) -> Vec<&'static str> {
    report.broken.keys().map(|rule| rule.name()).collect()
}

/// Moves a decision and the times that follow from it.
fn shift(row: &mut TraceRow, seconds: u32) {
    for time in [&mut row.time, &mut row.takeoff, &mut row.arrival, &mut row.ready] {
        *time = *time + seconds;
    }
}

fn before(time: Time) -> Time {
    Time::from_seconds(time.seconds() - 1)
}

#[test]
fn a_schedule_that_charges_as_needed_has_no_findings() {
    assert_eq!(judge(day(), &schedule()).findings, []);
}

/// Each row's charge is judged apart: one that is wrong by 2 mWh is found in its own row only.
#[test]
fn a_wrong_charge_is_one_finding() {
    for at in 0..7 {
        for off in [2e-6, -2e-6, 5.0, -5.0, 5e-7] {
            let mut trace = schedule();
            trace.rows[at].charge_kwh += off;
            let report = judge(day(), &trace);
            assert_eq!(names(&report), ["charge"], "{at} {off} {report}");
            assert_eq!(report.broken_places(), 1, "{at} {off} {report}");
            assert_eq!(report.findings[0].row, Some(at + 1));
        }
    }
}

/// A schedule that goes on from a wrong charge is wrong once, where it begins.
#[test]
fn a_wrong_charge_that_later_rows_go_on_from_is_one_finding() {
    let mut trace = schedule();
    for at in [2, 3, 6] {
        trace.rows[at].charge_kwh -= 1e-6;
    }
    let report = judge(day(), &trace);
    assert_eq!(names(&report), ["charge"]);
    assert_eq!(report.broken_places(), 1, "{report}");
    trace.rows[6].charge_kwh -= 1e-6;
    assert_eq!(judge(day(), &trace).broken_places(), 2);
}

#[test]
fn a_take_off_a_second_too_soon_or_late_is_one_finding() {
    for at in [0, 5] {
        let due = schedule().rows[at].takeoff;
        for takeoff in [due + 1, before(due)] {
            let mut trace = schedule();
            trace.rows[at].takeoff = takeoff;
            let report = judge(day(), &trace);
            assert_eq!(names(&report), ["takeoff-time"], "{report}");
            assert_eq!(report.broken_places(), 1, "{report}");
        }
    }
    // Row 6 is A1's last, so nothing follows from its arrival.
    let mut trace = schedule();
    let row = &mut trace.rows[5];
    for time in [&mut row.takeoff, &mut row.arrival, &mut row.ready] {
        *time = *time + 1;
    }
    let report = judge(day(), &trace);
    assert_eq!(names(&report), ["takeoff-time"], "{report}");
    assert_eq!(
        report.findings[0].detail,
        "takes off 07:39:01, but the battery holds the 44 kWh that it needs at 07:39:00"
    );
}

#[test]
fn a_hold_does_not_take_off() {
    let mut trace = schedule();
    trace.rows[2].takeoff = trace.rows[2].takeoff + 1;
    assert_eq!(names(&judge(day(), &trace)), ["takeoff-time"]);
}

#[test]
fn a_flight_may_wait_for_its_battery_until_the_end_of_operations() {
    let until = |end: &str| {
        let mut day = day();
        day.operations.end = time(end);
        let mut trace = schedule();
        trace.rows.truncate(6);
        judge(day, &trace)
    };
    assert!(until("07:39:00").is_valid());
    let report = until("07:38:59");
    assert_eq!(names(&report), ["takeoff-by-end"]);
    assert_eq!(report.findings[0].detail, "takes off 07:39:00, but operations end at 07:38:59");
}

#[test]
fn the_turnaround_alone_decides_when_an_aircraft_is_ready() {
    let mut trace = schedule();
    trace.rows[6].ready = trace.rows[6].ready + 1;
    let report = judge(day(), &trace);
    assert_eq!(names(&report), ["ready-time"]);
    assert_eq!(
        report.findings[0].detail,
        "ready 08:40:02, but 300 s of turnaround from 08:35:01 on end at 08:40:01"
    );
}

/// 45 kWh and 55 of reserve fit in 100, and a milliwatt-hour more does not.
#[test]
fn the_reserve_limits_the_range() {
    let mut day = day();
    day.aircraft.truncate(1);
    day.aircraft_types[0].reserve_kwh = 55.0;
    day.operations.end = time("07:00:00");
    let mut trace = schedule();
    trace.rows.truncate(1);
    let row = &mut trace.rows[0];
    row.takeoff = time("07:00:00");
    row.arrival = time("07:50:00");
    row.ready = time("07:55:00");
    assert_eq!(judge(day.clone(), &trace).findings, []);
    day.aircraft_types[0].reserve_kwh = 55.000_001;
    let report = judge(day, &trace);
    assert_eq!(names(&report), ["range"]);
    assert_eq!(
        report.findings[0].detail,
        "the flight takes 45 kWh and leaves 55.000001 in reserve, but the battery holds 100"
    );
}

/// A1 leaves V1 60 s after its battery suffices, with 56 kWh, and lands with 11. The delay is that
/// of the slot in which the flight is decided.
#[test]
fn an_aircraft_charges_while_its_take_off_is_delayed() {
    let mut day = day();
    let mut delay_s = vec![vec![0; 3]; 9];
    delay_s[0][0] = 60;
    day.disturbances.takeoff_delays = Some(TakeoffDelays { slot_s: 900, delay_s });
    let mut trace = schedule();
    let rows = &mut trace.rows;
    rows[0].arrival = time("07:06:00");
    rows[0].ready = time("07:11:00");
    shift(&mut rows[4], 60);
    rows[4].charge_kwh = 16.0;
    rows[5].time = time("07:26:00");
    rows[5].charge_kwh = 31.0;
    assert_eq!(judge(day.clone(), &trace).findings, []);
    trace.rows[4].charge_kwh = 15.0;
    trace.rows[5].charge_kwh = 30.0;
    assert_eq!(names(&judge(day, &trace)), ["charge", "takeoff-time"]);
}

#[test]
fn an_aircraft_charges_while_it_is_out_of_service() {
    let mut day = day();
    let (start, end) = (time("07:00:00"), time("07:20:00"));
    day.disturbances.outages = vec![Outage { aircraft: AircraftIx(0), start, end }];
    let mut trace = schedule();
    let rows = &mut trace.rows;
    rows[0].ready = end;
    shift(&mut rows[4], 600);
    rows[4].charge_kwh = 25.0;
    rows[5].time = time("07:35:00");
    rows[5].charge_kwh = 40.0;
    assert_eq!(judge(day.clone(), &trace).findings, []);
    trace.rows[4].charge_kwh = 15.0;
    assert_eq!(names(&judge(day, &trace)), ["charge"]);
}

/// A vertiport's own limit: V3 charges at 30 kW, which is half a kilowatt-hour in a minute.
#[test]
fn a_weak_charger_makes_the_wait_longer() {
    let mut day = day();
    day.vertiports[2].charger_kw = Some(30.0);
    day.operations.end = time("08:10:00");
    let mut trace = schedule();
    let rows = &mut trace.rows;
    rows[4].charge_kwh = 12.5;
    rows[5].charge_kwh = 20.0;
    rows[5].takeoff = time("08:13:00");
    rows[5].arrival = time("08:53:00");
    rows[5].ready = time("08:58:00");
    rows[6].charge_kwh = 54.5;
    // 0.511667 kWh are missing: 61.40004 s, so the 62nd second is the first with enough.
    rows[6].takeoff = time("07:46:02");
    rows[6].arrival = time("08:36:03");
    rows[6].ready = time("08:41:03");
    assert_eq!(names(&judge(day.clone(), &trace)), ["takeoff-by-end"]);
    trace.rows[6].takeoff = time("07:46:01");
    assert_eq!(names(&judge(day, &trace)), ["takeoff-time", "takeoff-by-end"]);
}

/// With E kWh above half a battery, the power is 60 - 0.6 E, so E is 100 (1 - exp(-0.6 h)) after h
/// hours from 0. The numbers are from these formulas with 40 digits.
#[test]
fn a_taper_makes_the_last_kilowatt_hours_slow() {
    let mut trace = schedule();
    let rows = &mut trace.rows;
    // 10 kWh in 10 minutes, and 5 more in 307.76 s; a second later than needed, it holds 55.003804.
    rows[0].takeoff = time("06:15:08");
    rows[0].arrival = time("07:05:08");
    rows[0].ready = time("07:10:08");
    shift(&mut rows[4], 8);
    rows[4].charge_kwh = 15.003_804;
    shift(&mut rows[5], 8);
    rows[5].charge_kwh = 30.003_804;
    // From 77 kWh, 27 above the half.
    rows[2].charge_kwh = 80.560_252;
    rows[3].charge_kwh = 90.232_655;
    // 45.232655 kWh after the flight pass the half after 286 s.
    rows[6].charge_kwh = 50.232_385;
    rows[6].takeoff = time("07:49:55");
    rows[6].arrival = time("08:39:56");
    rows[6].ready = time("08:44:56");
    assert_eq!(judge(with_taper(day()), &trace).findings, []);
    for at in [2, 3, 4, 5, 6] {
        for off in [1e-6, -1e-6] {
            let mut trace = trace.clone();
            trace.rows[at].charge_kwh += off;
            assert_eq!(names(&judge(with_taper(day()), &trace)), ["charge"], "{at} {off}");
        }
    }
    for at in [0, 5, 6] {
        for takeoff in [before(trace.rows[at].takeoff), trace.rows[at].takeoff + 1] {
            let mut trace = trace.clone();
            trace.rows[at].takeoff = takeoff;
            assert_eq!(names(&judge(with_taper(day()), &trace)), ["takeoff-time"], "{at}");
        }
    }
}

/// Power of 50.4018 kW is 14000.5 mWh in a second, so charges after an odd number of seconds are
/// between two milliwatt-hours. A schedule may state either, and goes on from what it states.
#[test]
fn a_charge_between_two_milliwatt_hours_may_be_rounded_either_way() {
    let mut day = day();
    day.aircraft.truncate(1);
    day.aircraft_types[0].charge_kw = 50.401_8;
    day.aircraft_types[0].turnaround_s = 301;
    day.aircraft[0].start_charge_kwh = Some(60.0);
    day.operations.end = time("07:10:00");
    let mut trace = schedule();
    trace.rows.truncate(1);
    let row = &mut trace.rows[0];
    row.charge_kwh = 60.0;
    row.takeoff = row.time;
    row.arrival = time("06:50:00");
    row.ready = time("06:55:01");
    row.energy_cost_usd = 9.0;
    let hold = hold(("06:55:01", 0), 2, 15.0, "07:10:01");
    trace.rows.push(hold);
    // 301 s of charging give 4.2141505 kWh.
    for (charge_kwh, keeps) in
        [(19.214_149, false), (19.214_15, true), (19.214_151, true), (19.214_152, false)]
    {
        trace.rows[1].charge_kwh = charge_kwh;
        assert_eq!(judge(day.clone(), &trace).is_valid(), keeps, "{charge_kwh}");
    }
    // After a second of delay at V1, the battery held 60.0140005 kWh, and V3 adds an even number.
    day.aircraft_types[0].turnaround_s = 300;
    let mut delay_s = vec![vec![0; 3]; 5];
    delay_s[0][0] = 1;
    day.disturbances.takeoff_delays = Some(TakeoffDelays { slot_s: 900, delay_s });
    trace.rows[0].arrival = time("06:50:01");
    trace.rows[0].ready = time("06:55:01");
    for (charge_kwh, keeps) in
        [(19.214_149, false), (19.214_15, true), (19.214_151, true), (19.214_152, false)]
    {
        trace.rows[1].charge_kwh = charge_kwh;
        assert_eq!(judge(day.clone(), &trace).is_valid(), keeps, "{charge_kwh}");
    }
}

/// Only an aircraft that needs its charger no longer leaves it for a stand.
#[test]
fn a_hold_keeps_the_charger_until_the_battery_is_full() {
    let mut day = day();
    day.vertiports[2].chargers = Some(1);
    day.aircraft[0].start_charge_kwh = None;
    day.operations.end = time("07:00:00");
    let to_v3 = |charge_kw: f64, charge_kwh: f64| {
        let mut day = day.clone();
        day.aircraft_types[0].charge_kw = charge_kw;
        let wait = |at, ready| hold((at, 1), 1, 100.0, ready);
        let arrival = ("06:50:00", "06:55:00");
        let rows = vec![
            charged(
                flight(("06:00:00", 0), (0, 2), 4, [200.0, 104.0, 45.0, 9.0], arrival),
                (100.0, "06:00:00"),
            ),
            wait("06:00:00", "06:15:00"),
            wait("06:15:00", "06:30:00"),
            wait("06:30:00", "06:45:00"),
            wait("06:45:00", "07:00:00"),
            hold(("06:55:00", 0), 2, charge_kwh, "07:10:00"),
            charged(
                flight(
                    ("07:00:00", 1),
                    (1, 2),
                    4,
                    [160.0, 80.0, 34.0, 10.2],
                    ("07:40:00", "07:45:00"),
                ),
                (100.0, "07:00:00"),
            ),
        ];
        judge(day, &Trace { rows })
    };
    // 45 kWh in the 5 minutes of turnaround.
    assert_eq!(to_v3(540.0, 100.0).findings, []);
    // 36 mW less leave the battery 3 mWh short of full.
    assert_eq!(names(&to_v3(539.999_964, 99.999_997)), [Rule::ChargerBound.name()]);
    assert_eq!(names(&to_v3(60.0, 60.0)), [Rule::ChargerBound.name()]);
}
