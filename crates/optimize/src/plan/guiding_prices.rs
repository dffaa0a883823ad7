//! The prices that guide the search, in the form that it reads fastest. They prove no bound.

use std::sync::Arc;

use vertifleet_core::{Scenario, Time, TypeIx, VertiportIx};
use vertifleet_policy::DayPrices;
use vertifleet_sim::Simulation;

use super::day::Day;
use super::passengers::Departure;
use crate::bound::Rest;

const MINUTE_S: u32 = 60;

/// Prices of stands and flights. Those of stands are running sums over time, so that the rent of
/// any stay is one subtraction.
#[derive(Debug, Clone)]
pub(super) struct GuidingPrices {
    origin_s: u32,
    minutes: usize,
    vertiports: usize,
    /// By minute, then vertiport: the price of a stand from the first minute until then, dollars.
    until_usd: Vec<f64>,
    /// By type, then before or after those have left who waited, then cell: what a flight sells
    /// for, dollars. Empty if it is not known.
    flights_usd: Vec<f64>,
    cells: usize,
}

impl GuidingPrices {
    /// The prices of stands that policies find at the start of the day, from the forecast.
    pub(super) fn of_policies(scenario: &Arc<Scenario>, day: &Day) -> Self {
        let simulation = Simulation::new(Arc::clone(scenario));
        let origin = scenario.operations.start;
        let prices = DayPrices::of(simulation.view(), origin);
        Self::of(day, Vec::new(), |vertiport, until_s| {
            until_s
                .map(|until_s| prices.rent_usd(vertiport, origin, Time::from_seconds(until_s)))
                .collect()
        })
    }

    /// The prices of the rest of a day.
    pub(super) fn of_rest(day: &Day, rest: &Rest) -> Self {
        let tables = day.types().flat_map(|kind| [true, false].map(|is_early| (kind, is_early)));
        let flights = tables.flat_map(|(kind, early)| rest.flights_usd(day.seats_of(kind), early));
        Self::of(day, flights.collect(), |vertiport, until_s| {
            rest.rents_usd(vertiport, until_s).collect()
        })
    }

    fn of(
        day: &Day,
        flights_usd: Vec<f64>,
        rents_usd: impl Fn(VertiportIx, &mut dyn Iterator<Item = u32>) -> Vec<f64>,
    ) -> Self {
        let minutes = ((day.end_s - day.first_s) / MINUTE_S + 1) as usize;
        let vertiports = day.vertiports;
        let mut until_usd = vec![0.0; vertiports * (minutes + 1)];
        for vertiport in VertiportIx::all(vertiports) {
            let mut times_s = (day.first_s..).step_by(MINUTE_S as usize).take(minutes + 1);
            let of_vertiport = until_usd.iter_mut().skip(vertiport.at()).step_by(vertiports);
            for (until_usd, rent_usd) in of_vertiport.zip(rents_usd(vertiport, &mut times_s)) {
                *until_usd = rent_usd;
            }
        }
        let cells = flights_usd.len() / (2 * day.types().len());
        Self { origin_s: day.first_s, minutes, vertiports, until_usd, flights_usd, cells }
    }

    /// Whether it is known what flights sell for.
    #[inline]
    pub(super) fn are_of_flights(&self) -> bool {
        !self.flights_usd.is_empty()
    }

    /// The minute of a time, as [`rent_usd`](Self::rent_usd) takes it. Times outside the prices are
    /// free.
    #[inline]
    pub(super) fn minute(&self, time_s: u32) -> usize {
        ((time_s.saturating_sub(self.origin_s) / MINUTE_S) as usize).min(self.minutes)
    }

    /// Price of a stand between two minutes, dollars.
    #[inline]
    pub(super) fn rent_usd(&self, vertiport: VertiportIx, from: usize, until: usize) -> f64 {
        let until_usd = |minute| self.until_usd[minute * self.vertiports + vertiport.at()];
        until_usd(until) - until_usd(from)
    }

    /// How much more a flight brings than it sells for, at least 0 dollars; 0 too if it is not
    /// known what flights sell for.
    #[inline]
    pub(super) fn above_price_usd(
        &self,
        day: &Day,
        kind: TypeIx,
        departure: Departure,
        brings_usd: f64,
    ) -> f64 {
        if !self.are_of_flights() {
            return 0.0;
        }
        let table = 2 * kind.at() + usize::from(!departure.is_early(day));
        (brings_usd - self.flights_usd[table * self.cells + departure.cell]).max(0.0)
    }
}
