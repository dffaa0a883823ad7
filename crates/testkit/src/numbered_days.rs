//! Small days of every kind, drawn from a number, for tests that search each day exhaustively or
//! with a planner.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use vertifleet_core::{
    Aircraft, AircraftIx, AircraftType, Charging, Closure, Day, Disturbances, Fares, Matrix,
    Operations, Outage, Route, Scenario, TakeoffDelays, Time, TypeIx, Vertiport, VertiportIx,
};

/// The largest size that a day may have.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    /// Largest number of vertiports of a day.
    pub vertiports: usize,
    /// Largest number of aircraft of a day.
    pub fleet: usize,
    /// Largest number of hours of operations of a day, to which up to half an hour is added.
    pub hours: u32,
}

/// A day of at most this size, with one or two types of aircraft, scarce stands, scarce or ample
/// demand, changing prices, periods of any length, and pairs that are out of range.
pub fn any_day(number: u64, most: Size) -> Arc<Scenario> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(number);
    let size = random.random_range(1..=most.vertiports);
    let types = random.random_range(1..=2_usize);
    let hours = random.random_range(1..=most.hours);
    let start_s = 6 * 3600;
    let end_s = start_s + hours * 3600 + random.random_range(0..1800);
    let fleet = random.random_range(1..=most.fleet);
    let aircraft: Vec<Aircraft> = (1..=fleet)
        .map(|number| Aircraft {
            id: format!("A{number}"),
            kind: TypeIx::new(random.random_range(0..types)),
            at: VertiportIx::new(random.random_range(0..size)),
            start_charge_kwh: None,
        })
        .collect();
    let vertiports: Vec<Vertiport> = (0..size)
        .map(|at| {
            let standing = aircraft.iter().filter(|one| one.at.at() == at).count();
            Vertiport {
                id: format!("V{at}"),
                x_mi: random.random_range(0.0..30.0),
                y_mi: random.random_range(0.0..30.0),
                stands: u16::try_from(standing).expect("few").max(1) + random.random_range(0..=1),
                chargers: None,
                charger_kw: None,
                busy: false,
                degrees: None,
                stand_cost_usd: if number.is_multiple_of(4) { 1.5 } else { 0.0 },
                charger_cost_usd: if number.is_multiple_of(4) { 4.75 } else { 0.0 },
            }
        })
        .collect();
    let distance_mi = Matrix::from_fn(size, |from, to| {
        let (from, to) = (&vertiports[from.at()], &vertiports[to.at()]);
        (from.x_mi - to.x_mi).hypot(from.y_mi - to.y_mi)
    });
    let mut periods = vec![start_s];
    while periods.last().is_some_and(|&last| last < end_s) && periods.len() < 6 {
        periods.push(periods[periods.len() - 1] + random.random_range(600..5400));
    }
    let most_waiting = random.random_range(1..14);
    let demand = periods
        .iter()
        .map(|_| {
            Matrix::from_fn(size, |from, to| {
                if from == to { 0 } else { random.random_range(0..=most_waiting) }
            })
        })
        .collect();
    let energy_price_usd = periods.iter().map(|_| random.random_range(0.0..0.8)).collect();
    let day = Day {
        name: format!("small-{number}"),
        seed: number,
        operations: Operations {
            start: Time::from_seconds(start_s),
            end: Time::from_seconds(end_s),
            takeoff_s: random.random_range(30..900),
            landing_s: random.random_range(30..900),
            hold_s: random.random_range(300..1800),
            passenger_wait_s: 0,
            charging: Charging::ToFull,
        },
        aircraft_types: (0..types)
            .map(|kind| AircraftType {
                id: format!("T{kind}"),
                seats: [4, 2][kind],
                speed_mph: [74.5, 150.0][kind],
                battery_kwh: [110.0, 60.0][kind],
                energy_kwh_per_mi: [2.2, 3.0][kind],
                charge_kw: 150.0,
                self_discharge_per_h: [0.0, 0.01][kind],
                reserve_kwh: 0.0,
                turnaround_s: 0,
                charge_curve: None,
            })
            .collect(),
        fare_usd: Matrix::from_fn(size, |from, to| 2.0 * distance_mi[(from, to)] + 1.25).into(),
        passenger_cost_usd: Matrix::from_fn(size, |from, to| 0.64 * distance_mi[(from, to)]),
        // Every third day has flight costs.
        flight_cost_usd: Matrix::from_fn(size, |from, to| {
            if number.is_multiple_of(3) { 1.5 + 0.4 * distance_mi[(from, to)] } else { 0.0 }
        }),
        aircraft_cost_usd: if number.is_multiple_of(3) { 20.0 } else { 0.0 },
        distance_mi,
        corridors: None,
        periods: periods.into_iter().map(Time::from_seconds).collect(),
        demand,
        energy_price_usd,
        disturbances: Disturbances::default(),
        vertiports,
        aircraft,
    };
    Arc::new(day.check("small day").expect("a day within the rules"))
}

/// A day of [`any_day`] with changing fares, corridors, separate chargers, delays, closures,
/// outages and passengers who wait, each of them on some days only. The demand differs from the
/// forecast.
pub fn any_extended_day(number: u64, most: Size) -> Arc<Scenario> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(!number);
    let mut day = Scenario::clone(&any_day(number, most)).into_day();
    let size = day.vertiports.len();
    let start = day.operations.start;
    let open_s = day.operations.end.since(start);
    let base = day.fare_usd.in_period(0).clone();
    let mut fares = || {
        let factor = random.random_range(0.3..2.0);
        Matrix::from_fn(size, |from, to| base[(from, to)] * factor)
    };
    day.fare_usd = Fares::by_period(day.periods.iter().map(|_| fares()).collect());
    let route = |random: &mut Xoshiro256PlusPlus| {
        let from = random.random_range(0..size);
        let to = (from + random.random_range(1..size.max(2))) % size;
        let (from, to) = (VertiportIx::new(from), VertiportIx::new(to));
        Route { from, to, both_ways: random.random() }
    };
    if size > 1 && number.is_multiple_of(3) {
        day.corridors = Some((0..2 * size).map(|_| route(&mut random)).collect());
    }
    if number.is_multiple_of(4) {
        for vertiport in &mut day.vertiports {
            vertiport.chargers = Some(random.random_range(1..=2));
        }
    }
    day.disturbances.forecast = Some(
        day.periods
            .iter()
            .map(|_| {
                Matrix::from_fn(
                    size,
                    |from, to| if from == to { 0 } else { random.random_range(0..14) },
                )
            })
            .collect(),
    );
    let slot_s = random.random_range(300..4000);
    let rows = TakeoffDelays::slots(slot_s, start, day.operations.end);
    let mut late = || (0..size).map(|_| random.random_range(0..1500) / 2).collect();
    let delay_s = (0..rows).map(|_| late()).collect();
    day.disturbances.takeoff_delays = Some(TakeoffDelays { slot_s, delay_s });
    for _ in 0..3 {
        let first = start + random.random_range(0..=open_s);
        let end = first + random.random_range(0..7200);
        if size > 1 {
            let route = route(&mut random);
            let known = number.is_multiple_of(2);
            day.disturbances.closures.push(Closure { route, start: first, end, known });
        }
        let aircraft = AircraftIx::new(random.random_range(0..day.aircraft.len()));
        day.disturbances.outages.push(Outage { aircraft, start: first, end });
    }
    let lengths_s = day.periods.windows(2).map(|pair| pair[1].since(pair[0]));
    if let Some(shortest_s) = lengths_s.min().filter(|_| random.random()) {
        day.operations.passenger_wait_s = random.random_range(1..=shortest_s);
    }
    Arc::new(day.check("extended day").expect("a day within the rules"))
}
