//! Passengers who wait into the next demand period: who boards first, when they leave, and what
//! live days make of reports about them. The days are of one pair of vertiports, with numbers
//! worked out by hand.

use std::sync::Arc;

use vertifleet_core::{
    Aircraft, AircraftIx, AircraftType, Charging, Day, Disturbances, Fares, Matrix, Operations,
    Scenario, Time, TypeIx, Vertiport, VertiportIx,
};
use vertifleet_sim::check::check;
use vertifleet_sim::live::{Booking, LiveDay, Report, ReportError};
use vertifleet_sim::{Boarded, Simulation, Trace};

const A: VertiportIx = VertiportIx(0);
const B: VertiportIx = VertiportIx(1);
const HOUR: u32 = 3600;

fn time(seconds: u32) -> Time {
    Time::from_seconds(seconds)
}

fn vertiport(id: &str) -> Vertiport {
    Vertiport {
        id: id.to_owned(),
        x_mi: 0.0,
        y_mi: 0.0,
        stands: 9,
        chargers: None,
        charger_kw: None,
        busy: false,
        degrees: None,
        stand_cost_usd: 0.0,
        charger_cost_usd: 0.0,
    }
}

/// A day of three periods of an hour, from midnight on. 6, 3 and 1 passengers want to fly from A to
/// B, for 10, 20 and 40 dollars. There are 8 aircraft with 4 seats at A, which can decide every
/// minute.
fn day(passenger_wait_s: u32) -> Arc<Scenario> {
    let of_pair = |passengers: u32| {
        Matrix::from_fn(2, |from, to| if (from, to) == (A, B) { passengers } else { 0 })
    };
    let usd = |usd: f64| Matrix::from_fn(2, |from, to| if from == to { 0.0 } else { usd });
    let day = Day {
        name: "waiting".to_owned(),
        seed: 0,
        operations: Operations {
            start: time(0),
            end: time(3 * HOUR),
            takeoff_s: 60,
            landing_s: 60,
            hold_s: 60,
            passenger_wait_s,
            charging: Charging::ToFull,
        },
        vertiports: vec![vertiport("A"), vertiport("B")],
        aircraft_types: vec![AircraftType {
            id: "four seats".to_owned(),
            seats: 4,
            speed_mph: 60.0,
            battery_kwh: 100.0,
            energy_kwh_per_mi: 1.0,
            charge_kw: 60.0,
            self_discharge_per_h: 0.0,
            reserve_kwh: 0.0,
            turnaround_s: 0,
            charge_curve: None,
        }],
        aircraft: (1..=8)
            .map(|number| Aircraft {
                id: format!("A{number}"),
                kind: TypeIx::new(0),
                at: A,
                start_charge_kwh: None,
            })
            .collect(),
        distance_mi: usd(20.0),
        corridors: None,
        fare_usd: Fares::by_period(vec![usd(10.0), usd(20.0), usd(40.0)]),
        passenger_cost_usd: usd(1.0),
        flight_cost_usd: usd(0.0),
        aircraft_cost_usd: 0.0,
        periods: vec![time(0), time(HOUR), time(2 * HOUR)],
        demand: vec![of_pair(6), of_pair(3), of_pair(1)],
        energy_price_usd: vec![0.1; 3],
        disturbances: Disturbances::default(),
    };
    Arc::new(day.check("waiting").expect("a day within the rules"))
}

/// Every passenger is counted once, in the period in which they wanted to fly, and the checker
/// finds the same ones left.
fn account_for(day: &Scenario, trace: &Trace) {
    let (mut boarded, mut carried) = (Boarded::of(day), [0_u32; 3]);
    for row in &trace.rows {
        let there: u32 = boarded.waiting(row.time).map(|table| table[(row.from, row.to)]).sum();
        let parties = boarded.board(row);
        assert_eq!(parties.iter().map(|party| party.1).sum::<u16>(), row.passengers);
        for (period, passengers) in parties {
            carried[period] += u32::from(passengers);
        }
        let left: u32 = boarded.waiting(row.time).map(|table| table[(row.from, row.to)]).sum();
        assert_eq!(left, there - u32::from(row.passengers));
    }
    for (period, carried) in carried.into_iter().enumerate() {
        assert!(carried <= day.demand[period][(A, B)], "{period}");
    }
}

/// Plays a day on which the aircraft that are asked first at these seconds fly from A to B, and all
/// others hold. Returns the passengers whom each flight found and took, and its revenue.
fn flights(day: &Arc<Scenario>, decided_s: &[u32]) -> Vec<(u32, u16, f64)> {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut next = decided_s.iter().peekable();
    let (mut flights, mut trace) = (Vec::new(), Trace::default());
    while let Some(decision) = simulation.next_decision() {
        let flies = decision.at == A && next.next_if(|&&due| time(due) == decision.time).is_some();
        let found = simulation.view().demand_left(simulation.view().period(), A, B);
        assert_eq!(simulation.view().demand_left_in(simulation.view().period())[1], found);
        let row = simulation.apply(if flies { B } else { decision.at }).expect("a free stand");
        if flies {
            flights.push((found, row.passengers, row.revenue_usd));
        }
        trace.rows.push(row);
    }
    assert_eq!(flights.len(), decided_s.len(), "an aircraft is ready at each of these times");
    let report = check(day, &trace);
    assert!(report.is_valid(), "{report}");
    let carried: u64 = flights.iter().map(|&(_, passengers, _)| u64::from(passengers)).sum();
    account_for(day, &trace);
    let totals = simulation.totals();
    assert_eq!((totals.passengers, totals.spilled_passengers), (carried, 10 - carried));
    flights
}

#[test]
fn those_who_have_waited_board_first_and_all_pay_the_fare_of_the_decision() {
    // 6 wait and 3 are new. The first flight takes 4 of the 6, so all of the 3 are there when the
    // others have left.
    assert_eq!(flights(&day(600), &[HOUR, HOUR + 600]), [(9, 4, 80.0), (3, 3, 60.0)]);
    // Two of the 6 are left, and board before two of the 3.
    assert_eq!(
        flights(&day(600), &[HOUR, HOUR, HOUR + 600]),
        [(9, 4, 80.0), (5, 4, 80.0), (1, 1, 20.0)]
    );
}

#[test]
fn passengers_wait_until_the_last_second_before_their_time_is_over() {
    assert_eq!(flights(&day(600), &[HOUR + 540]), [(9, 4, 80.0)]);
    assert_eq!(flights(&day(600), &[HOUR + 600]), [(3, 3, 60.0)]);
    assert_eq!(flights(&day(601), &[HOUR + 600]), [(9, 4, 80.0)]);
    assert_eq!(flights(&day(1), &[HOUR]), [(9, 4, 80.0)]);
    assert_eq!(flights(&day(0), &[HOUR]), [(3, 3, 60.0)]);
}

#[test]
fn no_passenger_waits_through_a_whole_period_into_the_one_after_it() {
    let all_hour = day(HOUR);
    assert_eq!(flights(&all_hour, &[2 * HOUR - 60]), [(9, 4, 80.0)]);
    assert_eq!(flights(&all_hour, &[2 * HOUR]), [(4, 4, 160.0)]);
    assert_eq!(
        flights(&all_hour, &[0, 2 * HOUR - 60, 2 * HOUR]),
        [(6, 4, 40.0), (5, 4, 80.0), (2, 2, 80.0),]
    );
}

#[test]
fn a_schedule_that_leaves_those_who_wait_behind_or_takes_those_who_have_left_breaks_a_rule() {
    let broken = |wait_s, decided_s, passengers: u16| {
        let simulated = day(0);
        let mut simulation = Simulation::new(Arc::clone(&simulated));
        let mut trace = Trace::default();
        while let Some(decision) = simulation.next_decision() {
            let flies = decision.time == time(decided_s) && decision.aircraft == AircraftIx(0);
            let mut row = simulation.apply(if flies { B } else { decision.at }).expect("free");
            if flies {
                row.passengers = passengers;
                row.revenue_usd = 20.0 * f64::from(passengers);
                row.passenger_cost_usd = f64::from(passengers);
            }
            trace.rows.push(row);
        }
        let report = check(&day(wait_s), &trace);
        report.broken.keys().map(|rule| rule.name()).collect::<Vec<_>>()
    };
    assert_eq!(broken(600, HOUR, 4), Vec::<&str>::new());
    assert_eq!(broken(600, HOUR, 3), ["boarding"]);
    assert_eq!(broken(600, HOUR + 600, 4), ["demand"]);
    assert_eq!(broken(600, HOUR + 600, 3), Vec::<&str>::new());
    assert_eq!(broken(0, HOUR, 4), ["demand"]);
}

/// The passengers who still want to fly, by the period in which each is counted.
fn left(live: &mut LiveDay) -> [u32; 3] {
    let view = live.view();
    [0, 1, 2].map(|period| view.demand_left(period, A, B))
}

fn boarded(live: &LiveDay) -> [u32; 3] {
    [0, 1, 2].map(|period| live.boarded_in(period)[1])
}

fn report_at(live: &mut LiveDay, seconds: u32, report: &Report) {
    live.take(time(seconds), report).expect("a report that fits");
}

fn decided() -> Report {
    Report::Decided { aircraft: AircraftIx(0), to: B }
}

#[test]
fn a_flight_that_is_undone_in_the_next_period_lets_its_passengers_wait_there() {
    let undone = Report::Undone { aircraft: AircraftIx(0) };
    let mut live = LiveDay::new(day(600));
    report_at(&mut live, HOUR - 60, &decided());
    assert_eq!((left(&mut live), boarded(&live)), ([2, 3, 1], [4, 0, 0]));
    report_at(&mut live, HOUR + 10, &undone);
    assert_eq!((left(&mut live), boarded(&live)), ([0, 9, 1], [0, 0, 0]));
    report_at(&mut live, HOUR + 20, &decided());
    assert_eq!((left(&mut live), boarded(&live)), ([0, 5, 1], [4, 0, 0]));
    // The four who had waited leave with the two who wait; they cannot be carried any more.
    report_at(&mut live, HOUR + 600, &Report::Clock);
    assert_eq!(left(&mut live), [2, 3, 1]);
    report_at(&mut live, HOUR + 600, &undone);
    assert_eq!((left(&mut live), boarded(&live)), ([6, 3, 1], [0, 0, 0]));
    assert_eq!(live.totals().spilled_passengers, 10);
}

#[test]
fn those_who_had_waited_are_on_board_before_others_when_their_number_is_corrected() {
    let departed = |passengers| Report::Departed { aircraft: AircraftIx(0), to: None, passengers };
    for (demand, on_board, later, expected) in [
        // Of six who wait, four are expected on board.
        (6, 1, 0, ([0, 8, 1], [1, 0, 0])),
        (6, 1, 600, ([5, 3, 1], [1, 0, 0])),
        // Of two who wait, both are expected, and two others.
        (2, 3, 0, ([0, 2, 1], [2, 1, 0])),
        (2, 3, 600, ([0, 2, 1], [2, 1, 0])),
        (2, 1, 600, ([1, 3, 1], [1, 0, 0])),
    ] {
        let mut live = LiveDay::new(day(600));
        report_at(&mut live, 0, &Report::Demand { period: 0, pairs: vec![(A, B, demand)] });
        report_at(&mut live, HOUR, &decided());
        report_at(&mut live, HOUR + later, &Report::Clock);
        report_at(&mut live, HOUR + later, &departed(Some(on_board)));
        assert_eq!((left(&mut live), boarded(&live)), expected);
        let totals = live.totals();
        assert_eq!(totals.passengers, u64::from(on_board));
        assert_eq!(totals.spilled_passengers, u64::from(demand) + 4 - u64::from(on_board));
        assert_eq!(totals.revenue_usd, 20.0 * f64::from(on_board));
    }
}

#[test]
fn reports_of_demand_count_the_passengers_of_a_period_and_not_those_who_wait_in_it() {
    let report = Report::Demand { period: 1, pairs: vec![(A, B, 5)] };
    for (begun, reported) in [(HOUR - 1, HOUR - 1), (HOUR - 1, HOUR), (HOUR, HOUR)] {
        let mut live = LiveDay::new(day(600));
        report_at(&mut live, begun, &Report::Clock);
        report_at(&mut live, reported, &report);
        report_at(&mut live, HOUR, &Report::Clock);
        assert_eq!(left(&mut live), [0, 11, 1]);
        let late = Report::Demand { period: 0, pairs: vec![(A, B, 2)] };
        report_at(&mut live, HOUR + 599, &late);
        assert_eq!(left(&mut live), [0, 7, 1]);
        report_at(&mut live, HOUR + 600, &Report::Clock);
        assert_eq!(left(&mut live), [2, 5, 1]);
    }
}

#[test]
fn passengers_who_wait_may_cancel_until_they_have_left() {
    let of = |period, passengers| Booking { period, from: A, to: B, passengers };
    let cancelled = |period, passengers| Report::Cancelled { booking: of(period, passengers) };
    let mut live = LiveDay::new(day(600));
    report_at(&mut live, HOUR, &Report::Clock);
    report_at(&mut live, HOUR, &cancelled(0, 2));
    report_at(&mut live, HOUR, &Report::Booked { booking: of(1, 2) });
    assert_eq!(left(&mut live), [0, 9, 1]);
    let too_many = live.take(time(HOUR), &cancelled(1, 6));
    assert_eq!(too_many, Err(ReportError::TooFewPassengers { cancelled: 6, left: 5 }));
    report_at(&mut live, HOUR + 600, &Report::Clock);
    let over = live.take(time(HOUR + 600), &cancelled(0, 1));
    assert_eq!(over, Err(ReportError::PeriodOver { start: time(0), now: time(HOUR + 600) }));
}

#[test]
fn the_rest_of_a_day_has_those_who_wait_in_the_period_before() {
    let mut live = LiveDay::new(day(600));
    report_at(&mut live, HOUR - 60, &decided());
    for (seconds, demand) in [(HOUR, [2, 3, 1]), (HOUR + 599, [2, 3, 1]), (HOUR + 600, [0, 3, 1])] {
        report_at(&mut live, seconds, &Report::Clock);
        let rest = live.remaining_day().expect("a day").expect("some of it");
        assert_eq!([0, 1, 2].map(|period: usize| rest.day.demand[period][(A, B)]), demand);
        let mut day = Simulation::new(Arc::new(rest.day));
        day.next_decision().expect("the day goes on");
        let view = live.view();
        assert_eq!(day.view().demand_left(1, A, B), view.demand_left(1, A, B));
    }
}
