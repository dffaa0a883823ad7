//! The flights that an aircraft may take from a vertiport: what is the same for all destinations is looked up once.

use vertifleet_core::{Time, TypeIx, VertiportIx};

use crate::{Leg, Simulation};

/// The flights of one type from a vertiport that are decided at one time. It is borrowed from the day's tables.
#[derive(Debug, Clone, Copy)]
pub struct Departures<'a> {
    time: Time,
    seats: u32,
    /// By destination.
    legs: &'a [Leg],
    fares_usd: &'a [f64],
    passenger_costs_usd: &'a [f64],
    flight_costs_usd: &'a [f64],
    /// The starts of the demand periods after the present one, and the price of energy in the present one and these.
    later: &'a [Time],
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
            later: &scenario.periods[period + 1..],
            energy_prices_usd: &scenario.energy_price_usd[period..],
        }
    }

    /// Profit in dollars of a flight that is on time if `waiting` passengers want to fly: fares less passenger cost, less
    /// energy at the price of its arrival, less the flight cost.
    #[inline]
    pub fn profit_usd(&self, to: VertiportIx, waiting: u32) -> f64 {
        let leg = &self.legs[to.at()];
        let margin_usd = self.fares_usd[to.at()] - self.passenger_costs_usd[to.at()];
        let arrival = self.time + leg.flight_s;
        let mut periods_on = 0;
        while self.later.get(periods_on).is_some_and(|&start| start <= arrival) {
            periods_on += 1;
        }
        f64::from(waiting.min(self.seats)) * margin_usd
            - leg.energy_kwh * self.energy_prices_usd[periods_on]
            - self.flight_costs_usd[to.at()]
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
