//! The flights that an aircraft may take from a vertiport: what is the same for all destinations is
//! looked up once.

use std::ops::Range;

use vertifleet_core::{Time, TypeIx, VertiportIx};

use crate::{Leg, Simulation, VertiportSet};

/// Later than any day.
const FOREVER: Time = Time::from_seconds(u32::MAX);

/// The flights of one type from a vertiport that are decided at one time. It is borrowed from the
/// day's tables.
#[derive(Debug, Clone, Copy)]
pub struct Departures<'a> {
    time: Time,
    seats: u32,
    /// By destination.
    legs: &'a [Leg],
    fares_usd: &'a [f64],
    passenger_costs_usd: &'a [f64],
    flight_costs_usd: &'a [f64],
    /// The starts of the present demand period and of all later ones, and the price of energy in
    /// each.
    starts: &'a [Time],
    energy_prices_usd: &'a [f64],
}

impl<'a> Departures<'a> {
    /// The flights decided at `time`, which is not before now.
    #[inline]
    pub(crate) fn of(
        simulation: &'a Simulation,
        time: Time,
        kind: TypeIx,
        from: VertiportIx,
    ) -> Self {
        let scenario = simulation.scenario();
        let period = simulation.period();
        Self {
            time,
            seats: scenario.aircraft_types[kind.at()].seats.into(),
            legs: simulation.legs().legs_from(kind, from),
            fares_usd: scenario.fare_usd.in_period(scenario.period_at(time)).row(from),
            passenger_costs_usd: scenario.passenger_cost_usd.row(from),
            flight_costs_usd: scenario.flight_cost_usd.row(from),
            starts: &scenario.periods[period..],
            energy_prices_usd: &scenario.energy_price_usd[period..],
        }
    }

    /// Profit in dollars of a flight that is on time if `waiting` passengers want to fly: fares
    /// less passenger cost, less energy at the price of its arrival, less the flight cost.
    #[inline]
    pub fn profit_usd(&self, to: VertiportIx, waiting: u32) -> f64 {
        self.profit_from_usd(self.time, to, waiting)
    }

    /// The profit of a flight that takes off at a time, which is not before the decision.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "most flights take off at the decision")]
    pub fn profit_from_usd(&self, takeoff: Time, to: VertiportIx, waiting: u32) -> f64 {
        let leg = &self.legs[to.at()];
        let margin_usd = self.fares_usd[to.at()] - self.passenger_costs_usd[to.at()];
        let arrival = takeoff + leg.flight_s;
        let mut periods_on = 0;
        while self.starts.get(periods_on + 1).is_some_and(|&start| start <= arrival) {
            periods_on += 1;
        }
        f64::from(waiting.min(self.seats)) * margin_usd
            - leg.energy_kwh * self.energy_prices_usd[periods_on]
            - self.flight_costs_usd[to.at()]
    }

    /// Times of decision around this one, in the same demand period, at which
    /// [`profit_usd`](Self::profit_usd) is the same for each of these destinations.
    pub fn steady(&self, destinations: &VertiportSet) -> Range<Time> {
        let begun = self.starts.partition_point(|&start| start <= self.time);
        let since = self.starts[begun.saturating_sub(1)];
        let until = self.starts.get(begun).copied().unwrap_or(FOREVER);
        destinations.iter().fold(since..until, |steady, to| {
            let flight_s = self.legs[to.at()].flight_s;
            let earlier = |time: Time| Time::from_seconds(time.seconds().saturating_sub(flight_s));
            let price = self.energy_price_around(self.time + flight_s);
            steady.start.max(earlier(price.start))..steady.end.min(earlier(price.end))
        })
    }

    /// The times around this one at which energy has the same price.
    fn energy_price_around(&self, time: Time) -> Range<Time> {
        let mut same = self.starts[0]..FOREVER;
        for (&start, prices) in self.starts[1..].iter().zip(self.energy_prices_usd.windows(2)) {
            if prices[0] == prices[1] {
                continue;
            }
            if start > time {
                same.end = start;
                break;
            }
            same.start = start;
        }
        same
    }

    /// The number of passengers that a flight can carry.
    #[inline]
    pub fn seats(&self) -> u32 {
        self.seats
    }

    /// Seconds from the decision until the aircraft is ready again.
    #[inline]
    pub fn block_s(&self, to: VertiportIx) -> u32 {
        self.legs[to.at()].block_s()
    }
}
