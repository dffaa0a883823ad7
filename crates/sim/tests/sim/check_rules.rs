//! Every rule of the checker on a schedule worked out by hand, both kept and broken by the smallest
//! possible edit.

use vertifleet_core::{AircraftIx, Closure, Day, Outage, Route, TakeoffDelays, Time, VertiportIx};
use vertifleet_sim::check::{Report, Rule, check};
use vertifleet_sim::{Trace, TraceRow};

use crate::check_as_needed as as_needed;
use crate::check_day::{day, schedule, time};

fn judge(day: Day, trace: &Trace) -> Report {
    check(&day.check("by hand").expect("a day within the rules"), trace)
}

fn names(report: &Report) -> Vec<&'static str> {
    report.broken.keys().map(|rule| rule.name()).collect()
}

/// Moves a decision and the times that follow from it.
fn shift(row: &mut TraceRow, seconds: u32) {
    for time in [&mut row.time, &mut row.takeoff, &mut row.arrival, &mut row.ready] {
        *time = *time + seconds;
    }
}

/// Sets the passengers and their fares and costs, at a fare of 50 and a cost of 26.
fn carry(row: &mut TraceRow, passengers: u16) {
    row.passengers = passengers;
    row.revenue_usd = 50.0 * f64::from(passengers);
    row.passenger_cost_usd = 26.0 * f64::from(passengers);
}

fn route(from: u16, to: u16) -> Route {
    Route { from: VertiportIx(from), to: VertiportIx(to), both_ways: false }
}

/// Breaks one rule. Returns `false` if that unavoidably breaks others too.
fn break_rule(rule: Rule, day: &mut Day, rows: &mut Vec<TraceRow>) -> bool {
    match rule {
        Rule::KnownIds => {
            rows[4].to = VertiportIx(3);
            return false;
        }
        Rule::Order => rows.swap(0, 1),
        Rule::OperatingHours => {
            let ready = rows[2].ready;
            let place = rows[2].to;
            rows.push(TraceRow {
                time: ready,
                aircraft: AircraftIx(1),
                from: place,
                arrival: ready,
                ready: ready + 900,
                ..rows[3]
            });
        }
        Rule::FirstDecision => {
            shift(&mut rows[1], 60);
            shift(&mut rows[2], 60);
        }
        Rule::DecisionTime => shift(&mut rows[4], 1),
        Rule::MissingDecision => rows.truncate(4),
        Rule::Place => {
            rows[3].from = VertiportIx(1);
            rows[3].to = VertiportIx(1);
        }
        Rule::HoldEmpty => rows[3].energy_cost_usd = 0.01,
        Rule::HoldTime => {
            rows[3].ready = rows[3].ready + 1;
            shift(&mut rows[4], 1);
        }
        Rule::ArrivalTime => rows[0].arrival = rows[0].arrival + 1,
        Rule::ReadyTime => rows[4].ready = Time::from_seconds(rows[4].ready.seconds() - 1),
        Rule::Energy => rows[0].energy_kwh += 0.001,
        Rule::Range => {
            // The battery holds 45 kWh and not 45.0117; its losses are unchanged.
            let kind = &mut day.aircraft_types[0];
            kind.self_discharge_per_h *= kind.battery_kwh / 45.005;
            kind.battery_kwh = 45.005;
        }
        Rule::Seats => {
            carry(&mut rows[0], 5);
            carry(&mut rows[2], 1);
        }
        Rule::Demand => carry(&mut rows[2], 3),
        Rule::Boarding => carry(&mut rows[2], 1),
        Rule::Revenue => rows[0].revenue_usd -= 0.01,
        Rule::PassengerCost => rows[4].passenger_cost_usd = 0.01,
        Rule::EnergyCost => rows[2].energy_cost_usd = 45.0 * 0.2,
        Rule::FlightCost => rows[2].flight_cost_usd = 0.01,
        Rule::StandBound => day.vertiports[2].stands = 1,
        Rule::ChargerBound => day.vertiports[2].chargers = Some(1),
        Rule::Charge | Rule::TakeoffTime | Rule::TakeoffByEnd => {
            *day = as_needed::day();
            *rows = as_needed::schedule().rows;
            break_rule_of_charge(rule, day, rows);
        }
        Rule::Corridor => day.corridors = Some(vec![route(0, 2), route(2, 0)]),
        Rule::Closure => {
            let (start, end) = (rows[2].time, rows[2].time + 1);
            day.disturbances.closures =
                vec![Closure { route: route(0, 2), start, end, known: false }];
        }
        Rule::TakeoffDelay => {
            // Row 4 leaves V3 in the second hour, a minute late; the price of its energy stays the
            // same.
            let delay_s = vec![vec![0, 0, 0], vec![0, 0, 60], vec![0, 0, 0]];
            day.disturbances.takeoff_delays = Some(TakeoffDelays { slot_s: 3600, delay_s });
            rows[4].ready = rows[4].ready + 60;
        }
        Rule::OutOfService => {
            let (start, end) = (rows[4].arrival, rows[4].ready + 1);
            day.disturbances.outages = vec![Outage { aircraft: AircraftIx(0), start, end }];
        }
    }
    true
}

/// Breaks one rule of days that charge as needed.
fn break_rule_of_charge(rule: Rule, day: &mut Day, rows: &mut Vec<TraceRow>) {
    match rule {
        Rule::Charge => rows[2].charge_kwh += 2e-6,
        Rule::TakeoffTime => rows[5].takeoff = rows[5].takeoff + 1,
        _ => {
            // Row 6 is decided in time, but its battery suffices a second too late. Row 7 is then
            // decided after the end.
            rows.truncate(6);
            day.operations.end = time("07:38:59");
        }
    }
}

#[test]
fn a_schedule_that_keeps_every_rule_has_no_findings() {
    let report = judge(day(), &schedule());
    assert_eq!(report.findings, []);
    assert!(report.is_valid());
}

#[test]
fn totals_are_those_worked_out_by_hand() {
    let totals = judge(day(), &schedule()).totals;
    let counts = (
        totals.flights,
        totals.repositioning_flights,
        totals.holds,
        totals.decisions,
        totals.passengers,
    );
    assert_eq!(counts, (4, 1, 1, 5, 9));
    for (found, due) in [
        (totals.revenue_usd, 390.0),
        (totals.passenger_cost_usd, 195.0),
        (totals.energy_cost_usd, 40.603_5),
        (totals.energy_kwh, 158.011_666_666_666_67),
        (totals.profit_usd, 154.396_5),
    ] {
        assert!((found - due).abs() < 1e-9, "{found} and not {due}");
    }
}

#[test]
fn every_rule_is_found_broken_by_name_and_where_possible_alone() {
    for &rule in Rule::ALL {
        let (mut day, mut trace) = (day(), schedule());
        let alone = break_rule(rule, &mut day, &mut trace.rows);
        let report = judge(day, &trace);
        assert!(!report.is_valid(), "{rule}");
        assert!(report.findings.iter().any(|finding| finding.rule == rule), "{rule}: {report}");
        if alone {
            assert_eq!(names(&report), [rule.name()], "{report}");
        }
    }
}

#[test]
fn rules_have_different_names() {
    let mut names: Vec<_> = Rule::ALL.iter().map(|rule| rule.name()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Rule::ALL.len());
}

#[test]
fn the_last_instant_of_operations_is_one_for_decisions() {
    let mut on_the_dot = day();
    on_the_dot.operations.end = schedule().rows[4].time;
    assert!(judge(on_the_dot, &schedule()).is_valid());
    let mut too_late = day();
    too_late.operations.end = Time::from_seconds(schedule().rows[4].time.seconds() - 1);
    assert_eq!(names(&judge(too_late, &schedule())), ["operating-hours"]);
}

#[test]
fn an_empty_schedule_misses_the_first_decision_of_every_aircraft() {
    let report = judge(day(), &Trace::default());
    assert_eq!(report.broken[&Rule::MissingDecision], 2);
    assert_eq!(names(&report), ["missing-decision"]);
}

#[test]
fn a_place_is_not_left_by_more_aircraft_than_are_there() {
    let mut trace = schedule();
    trace.rows[1].from = VertiportIx(2);
    let report = judge(day(), &trace);
    let stands = report.findings.iter().find(|finding| finding.rule == Rule::StandBound);
    assert_eq!(stands, None, "aircraft A1 is on its way to V3 then");
    trace.rows[0].to = VertiportIx(0);
    let report = judge(day(), &trace);
    let stands = report.findings.iter().find(|finding| finding.rule == Rule::StandBound);
    assert_eq!(stands.expect("no aircraft was at V3").detail, "leaves -1 aircraft at V3");
}

/// An aircraft waits on a stand if it can, so that its charger is free for another.
#[test]
fn a_hold_gives_the_charger_back_where_a_stand_is_free() {
    let with = |stands| {
        let mut day = day();
        day.vertiports[2].stands = stands;
        day.vertiports[2].chargers = Some(2);
        day
    };
    // Both aircraft fly to V3; A1 holds there and flies on.
    for stands in [1, 2] {
        assert!(judge(with(stands), &schedule()).is_valid());
    }
    let mut scarce = with(1);
    scarce.vertiports[2].chargers = Some(1);
    let mut trace = schedule();
    // A2 leaves V1 only after A1 has begun to wait at V3.
    shift(&mut trace.rows[2], 45 * 60);
    trace.rows[2].passengers = 4;
    let report = judge(scarce, &trace);
    assert!(!report.broken.contains_key(&Rule::ChargerBound), "{report}");
}

#[test]
fn the_report_reads_well() {
    let (mut day, mut trace) = (day(), schedule());
    day.vertiports[2].stands = 1;
    trace.rows[0].passengers = 5;
    trace.rows[3].ready = trace.rows[3].ready + 60;
    trace.rows.truncate(4);
    insta::assert_snapshot!(judge(day, &trace), @r#"
    the schedule breaks 7 of 29 rules; findings: 7
            1 x missing-decision An aircraft that is ready no later than the end of operations decides.
            1 x hold-time        A hold arrives when it is decided and is ready after the scenario's hold time (Eq. 8).
            1 x seats            A flight carries no more passengers than its aircraft has seats (Eq. 11).
            1 x demand           A flight carries no more passengers than still want to fly when it is decided.
            1 x revenue          A flight's revenue is its passengers times the fare of the period of its decision (Eq. 4).
            1 x passenger-cost   A flight's passenger cost is its passengers times the pair's cost a passenger (Eq. 2).
            1 x stand-bound      At every instant the aircraft standing at a vertiport and in the air towards it are 0 to its stands (Eq. 16).
    row 1, 06:00:00, aircraft A1: 5 passengers, but the aircraft has 4 seats [seats]
    row 1, 06:00:00, aircraft A1: states 200 dollars, but it comes to 250 [revenue]
    row 1, 06:00:00, aircraft A1: states 104 dollars, but it comes to 130 [passenger-cost]
    row 3, 06:53:00, aircraft A2: 2 passengers, but only 1 left who want to fly in this period [demand]
    row 3, 06:53:00, aircraft A2: makes 2 aircraft at V3 or on their way there, but its stands are 1 [stand-bound]
    row 4, 07:35:00, aircraft A1: arrives 07:35:00, ready 07:51:00, but a hold from now on is over at 07:50:00 [hold-time]
    07:51:00, aircraft A1: ready no later than 08:00:00, the end of operations, but row 4 is its last [missing-decision]
    recomputed: decisions 4, flights 3 (without passengers 0), holds 1, passengers 10
    profit $191.90 = revenue $440.00 - passenger cost $221.00 - energy cost $27.10 (113.00 kWh)
    "#);
}

#[test]
fn machines_get_the_same_report() {
    let (day, mut trace) = (day(), schedule());
    trace.rows.truncate(4);
    let json = serde_json::to_string_pretty(&judge(day, &trace)).expect("a report");
    insta::assert_snapshot!(json, @r#"
    {
      "valid": false,
      "totals": {
        "profit_usd": 167.9,
        "revenue_usd": 390.0,
        "passenger_cost_usd": 195.0,
        "energy_cost_usd": 27.1,
        "flight_cost_usd": 0.0,
        "aircraft_cost_usd": 0.0,
        "site_cost_usd": 0.0,
        "energy_kwh": 113.0,
        "flights": 3,
        "repositioning_flights": 0,
        "holds": 1,
        "decisions": 4,
        "passengers": 9
      },
      "broken": {
        "missing-decision": 1
      },
      "findings": [
        {
          "rule": "missing-decision",
          "row": null,
          "time": "07:50:00",
          "aircraft": "A1",
          "detail": "ready no later than 08:00:00, the end of operations, but row 4 is its last"
        }
      ]
    }
    "#);
}

#[test]
fn a_thousand_findings_of_a_rule_are_kept_and_all_are_counted() {
    let mut trace = schedule();
    trace.rows = std::iter::repeat_n(trace.rows[3], 3_000).collect();
    let report = judge(day(), &trace);
    assert_eq!(report.broken[&Rule::Order], 2_999);
    let kept = report.findings.iter().filter(|finding| finding.rule == Rule::Order).count();
    assert_eq!(kept, 1_000);
    let text = report.to_string();
    assert!(text.contains(&format!("and {} more", report.broken_places() - 100)), "{text}");
}
