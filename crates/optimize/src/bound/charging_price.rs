//! The search for a good price of charging time, on days that charge as needed.
//!
//! The bound is convex in the price of a second of charging (`charging_time.rs`), so a golden
//! section closes in on the best one. Its values come from short searches for all other prices on
//! the coarse clock, first in the coarsest slices and then, around the best so far, in finer ones.

use vertifleet_core::Charging;

use super::charging_time::Charge;
use super::ladder::{CUTS, Cut, Relaxed, TICK_S, Watch};
use super::prices::{Pace, Prices, whole};
use super::step::LEVELS;
use crate::Error;

/// The ratio of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Number of sections in the coarsest slices, and then in finer ones.
const SECTIONS: (usize, usize) = (9, 5);
/// Around a price, finer slices may have a better one that is cheaper or dearer by this share.
const AROUND: f64 = 0.1;

impl Relaxed<'_> {
    /// The same day with a good price of charging; unchanged if it charges to full.
    ///
    /// # Errors
    /// [`Error::TooManyFlights`].
    pub(super) fn with_charging_price(self, watch: &dyn Watch) -> Result<Self, Error> {
        if self.scenario.operations.charging == Charging::ToFull {
            return Ok(self);
        }
        let dearest = self.at(0.0).day(CUTS[0].step)?.dearest_second();
        let price = self.section(&CUTS[0], (0.0, dearest), SECTIONS.0, watch)?;
        let around = ((1.0 - AROUND) * price, (1.0 + AROUND) * price);
        let price = self.section(&CUTS[1], around, SECTIONS.1, watch)?;
        Ok(self.at(price))
    }

    /// The same day with a price of charging.
    fn at(self, price: f64) -> Self {
        Self { charge: Charge { price: whole(price), levels: LEVELS[0] }, ..self }
    }

    /// The best price between two that some golden sections find.
    fn section(
        self,
        cut: &Cut,
        (mut low, mut high): (f64, f64),
        sections: usize,
        watch: &dyn Watch,
    ) -> Result<f64, Error> {
        let mut start = None;
        let mut value = |price: f64| self.value(cut, price, &mut start, watch);
        let inner =
            |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let [mut cheaper, mut dearer] = inner(low, high);
        let (mut of_cheaper, mut of_dearer) = (value(cheaper)?, value(dearer)?);
        for _ in 0..sections {
            if of_cheaper <= of_dearer {
                (high, dearer, of_dearer) = (dearer, cheaper, of_cheaper);
                cheaper = inner(low, high)[0];
                of_cheaper = value(cheaper)?;
            } else {
                (low, cheaper, of_cheaper) = (cheaper, dearer, of_dearer);
                dearer = inner(low, high)[1];
                of_dearer = value(dearer)?;
            }
        }
        Ok(if of_cheaper <= of_dearer { cheaper } else { dearer })
    }

    /// About the bound at a price, micro-dollars. The search for all other prices begins with those
    /// of the one before.
    fn value(
        self,
        cut: &Cut,
        price: f64,
        start: &mut Option<Prices>,
        watch: &dyn Watch,
    ) -> Result<f64, Error> {
        let day = self.at(price).day(cut.step)?.on_coarse_clock(TICK_S);
        let first = start.take().unwrap_or_else(|| Prices::first(&day));
        let pace = Pace::of(&day.slices);
        let found = cut.on_coarse_clock.run(&day, &pace, &first, watch.stopped(), &mut |_| true);
        Ok(found.map_or(f64::INFINITY, |found| {
            let bound = found.bound(&day) as f64;
            *start = Some(found.prices);
            bound
        }))
    }
}
