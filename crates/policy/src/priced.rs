//! `prices`: takes the choice that is worth most at the bid prices of the day, which are found anew every quarter of an
//! hour.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, View};

use crate::{DayMemory, DayPrices, Policy, PolicyError};

/// Decides by bid prices ([`DayPrices`]): a choice is worth its flight's profit plus the worth of being ready where and
/// when it ends, less the prices of its passengers and of its stand.
#[derive(Debug, Clone, Default)]
pub struct BidPricePolicy {
    day: DayMemory<DayPrices>,
}

impl Policy for BidPricePolicy {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.day.of_day(*view, decision, || DayPrices::of(*view, decision.time));
        prices.refresh(*view, decision.time);
        Ok(prices.best_choice(*view, decision))
    }
}
