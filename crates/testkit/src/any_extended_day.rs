//! Small days with all or some of the features that go beyond the paper, as a proptest strategy.

use std::sync::Arc;

use proptest::prelude::{Just, Strategy, any, prop, prop_oneof};
use proptest::sample::Index;
use vertifleet_core::{
    AircraftIx, Closure, Day, Disturbances, Fares, Matrix, Outage, Route, Scenario, TakeoffDelays,
    Time, VertiportIx,
};

use crate::small_day;

/// Days of [`small_day`] with changing fares, corridors, separate chargers, forecasts, delays,
/// closures, outages and passengers who wait, each of them on some days only. The numbers that
/// proptest draws are used in turn, from the start again when they run out.
pub fn extended_day() -> impl Strategy<Value = Arc<Scenario>> {
    let parts = prop::collection::vec(any::<bool>(), 7);
    // Periods of small days last an hour.
    let passenger_wait_s = prop_oneof![Just(0), 1..=3600_u32];
    (small_day(), parts, prop::collection::vec(any::<Index>(), 30), passenger_wait_s).prop_map(
        |(day, parts, numbers, passenger_wait_s)| {
            let mut day = extended(&day, &parts, &numbers);
            day.operations.passenger_wait_s = passenger_wait_s;
            Arc::new(day.check("extended day").expect("a day within the rules"))
        },
    )
}

fn extended(day: &Arc<Scenario>, parts: &[bool], numbers: &[Index]) -> Day {
    let mut day = Scenario::clone(day).into_day();
    let mut numbers = numbers.iter().cycle();
    let mut below = move |limit: usize| {
        u32::try_from(numbers.next().expect("round and round").index(limit)).expect("small")
    };
    let size = day.vertiports.len();
    let start = day.operations.start;
    if parts[0] {
        let factors: Vec<f64> = day.periods.iter().map(|_| f64::from(below(40)) / 20.0).collect();
        let base = day.fare_usd.in_period(0).clone();
        let table = |factor: &f64| Matrix::from_fn(size, |from, to| base[(from, to)] * factor);
        day.fare_usd = Fares::by_period(factors.iter().map(table).collect());
    }
    let route = |below: &mut dyn FnMut(usize) -> u32| {
        let from = below(size) as usize;
        let to = (from + 1 + below(size - 1) as usize) % size;
        let both_ways = below(2) == 1;
        Route { from: VertiportIx::new(from), to: VertiportIx::new(to), both_ways }
    };
    let mut disturbances = Disturbances::default();
    if parts[1] && size > 1 {
        day.corridors = Some((0..3 * size).map(|_| route(&mut below)).collect());
    }
    if parts[2] {
        for at in 0..size {
            let chargers = u16::try_from(1 + below(3)).expect("few");
            day.vertiports[at].chargers = (below(3) > 0).then_some(chargers);
        }
    }
    if parts[3] {
        let mut forecast = day.demand.clone();
        for table in &mut forecast {
            for from in VertiportIx::all(size) {
                for to in VertiportIx::all(size).filter(|&to| to != from) {
                    table[(from, to)] = below(12);
                }
            }
        }
        disturbances.forecast = Some(forecast);
    }
    if parts[4] {
        let slot_s = 900 + below(3600);
        let rows = TakeoffDelays::slots(slot_s, start, day.operations.end);
        let delay_s = (0..rows).map(|_| (0..size).map(|_| below(1200)).collect()).collect();
        disturbances.takeoff_delays = Some(TakeoffDelays { slot_s, delay_s });
    }
    let span = |below: &mut dyn FnMut(usize) -> u32| {
        let first: Time = start + below(4 * 3600);
        (first, first + below(2 * 3600))
    };
    if parts[5] && size > 1 {
        for _ in 0..3 {
            let (start, end) = span(&mut below);
            let (route, known) = (route(&mut below), below(2) == 1);
            disturbances.closures.push(Closure { route, start, end, known });
        }
    }
    if parts[6] {
        for _ in 0..3 {
            let aircraft = AircraftIx::new(below(day.aircraft.len()) as usize);
            let (start, end) = span(&mut below);
            disturbances.outages.push(Outage { aircraft, start, end });
        }
    }
    day.disturbances = disturbances;
    day
}
