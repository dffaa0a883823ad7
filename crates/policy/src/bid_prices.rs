//! `prices`: takes the choice that is worth most at the bid prices of the day, which are recomputed
//! every quarter of an hour.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, View};

use crate::{DayPrices, Policy, PolicyError, PriceMemory, PricedChoice};

/// Decides by bid prices ([`DayPrices`](crate::DayPrices)): a choice is worth its flight's profit
/// plus the worth of being ready where and when it ends, less the prices of its passengers and of
/// its stand.
#[derive(Debug, Clone, Default)]
pub struct BidPricePolicy {
    prices: PriceMemory,
}

impl Policy for BidPricePolicy {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.prices.at(*view, decision);
        Ok(prices.best_choice(*view, decision))
    }

    /// Worth at the day's bid prices of each choice that the base rule permits, dollars. Where
    /// greedy is expected to earn more over the rest of the day, that is its choice alone.
    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        let prices = self.prices.at(*view, decision);
        values.fill(f64::NAN);
        for PricedChoice { worth_usd, to } in prices.open_choices(*view, decision) {
            values[to.at()] = worth_usd;
        }
        Ok(())
    }

    fn prices(&mut self, decision: &Decision, view: &View<'_>) -> Option<&DayPrices> {
        Some(self.prices.at(*view, decision))
    }

    fn price_memory(&mut self) -> Option<&mut PriceMemory> {
        Some(&mut self.prices)
    }
}
