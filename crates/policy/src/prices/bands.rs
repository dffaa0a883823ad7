//! Bands of charge between two levels, and where flights from each of them may lead.
//!
//! Ranks (`ranks.rs`) bound the worth of a flight for all decisions in a slot. On days that charge
//! as needed they do so for each band, because an aircraft with little charge waits for it.

use vertifleet_core::{TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::charged_flights::{ChargedFlight, ChargedFlights};
use super::choices::wait_s;
use super::levels::{Level, Levels};

/// More than the errors of single precision, seconds.
const ROUNDING_S: f64 = 0.05;

/// Where flights to one vertiport that are decided in a band may lead, seconds from the decision.
#[derive(Debug, Clone)]
pub(super) struct Arrivals {
    /// The first and the last take-off.
    pub(super) takeoff_s: (u32, u32),
    /// The levels at which the aircraft may be ready, and the first and the last time for each.
    pub(super) ready: Vec<(Level, u32, u32)>,
}

/// The bands of a day: one on a day that charges to full.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bands<'a> {
    view: View<'a>,
    levels: &'a Levels,
    flights: &'a ChargedFlights,
}

impl<'a> Bands<'a> {
    pub(super) fn of(view: View<'a>, (levels, flights): (&'a Levels, &'a ChargedFlights)) -> Self {
        Self { view, levels, flights }
    }

    /// Where flights of a type may lead, band by band.
    pub(super) fn arrivals(
        &self,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
    ) -> Vec<Arrivals> {
        let block_s = self.view.leg(kind, from, to).block_s();
        if !self.view.charges_as_needed() {
            return vec![Arrivals { takeoff_s: (0, 0), ready: vec![(0, block_s, block_s)] }];
        }
        let flight = &self.flights.from(kind, from)[to.at()];
        let edges_s = self.levels.of_kind(kind)[from.at()].levels_s().into_iter();
        let least_s = std::iter::once(0.0).chain(edges_s.clone());
        let most_s = edges_s.chain([self.view.charge_rate(kind, from).full_s()]);
        let bands = least_s.zip(most_s);
        bands.map(|band_s| self.arrivals_from(kind, to, (flight, block_s), band_s)).collect()
    }

    /// The same for a band, given by the least and the most seconds to a full battery in it.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "as in `wait_s`")]
    fn arrivals_from(
        &self,
        kind: TypeIx,
        to: VertiportIx,
        (flight, block_s): (&ChargedFlight, u32),
        (least_s, most_s): (f64, f64),
    ) -> Arrivals {
        let ends_s = [least_s - ROUNDING_S, most_s + ROUNDING_S].map(|to_full_s| to_full_s as f32);
        let waits_s = ends_s.map(|to_full_s| wait_s(to_full_s - flight.most_s));
        let [fullest_s, emptiest_s] =
            ends_s.map(|to_full_s| f64::from(flight.when_ready_s(to_full_s.min(flight.most_s))));
        let (fullest_s, emptiest_s) = (fullest_s - ROUNDING_S, emptiest_s + ROUNDING_S);
        let mut ready = Vec::new();
        for (level, (level_s, (from_s, until_s))) in
            (0..).zip(self.levels.of_kind(kind)[to.at()].cells_s())
        {
            let (from_s, until_s) = (from_s.max(fullest_s), until_s.min(emptiest_s));
            if from_s <= until_s {
                let moved_s = |base_s: u32, by_s: f64| (f64::from(base_s) + by_s).max(0.0) as u32;
                let earliest_s = moved_s(waits_s[0] + block_s, from_s - level_s - 1.0);
                let latest_s = moved_s(waits_s[1] + block_s, until_s - level_s + 1.0);
                ready.push((level, earliest_s, latest_s));
            }
        }
        Arrivals { takeoff_s: waits_s.into(), ready }
    }
}
