//! The bid prices of the day that a policy plays, kept from one decision to the next.

use vertifleet_sim::{DayKey, Decision, View};

use crate::DayPrices;

/// The prices of one day at a time. If a policy plays several days by turns, the prices of each are dropped for the next,
/// which costs time but never mixes days up.
#[derive(Debug, Clone, Default)]
pub struct PriceMemory {
    kept: Option<Kept>,
}

#[derive(Debug, Clone)]
struct Kept {
    day: DayKey,
    /// Index of the latest decision that was asked for.
    decision: u32,
    prices: DayPrices,
}

impl PriceMemory {
    /// The prices for a decision, refreshed where they are due to be. They are found anew if the day is not the one
    /// before, or starts again.
    pub fn at(&mut self, view: View<'_>, decision: &Decision) -> &mut DayPrices {
        let day = view.day();
        // A proposal may have been asked for a later time; its prices say nothing about the time before it.
        let goes_on = |kept: &Kept| {
            kept.day == day
                && kept.decision <= decision.index
                && kept.prices.made_at() <= decision.time
        };
        let mut prices = match self.kept.take() {
            Some(kept) if goes_on(&kept) => kept.prices,
            _ => DayPrices::of(view, decision.time),
        };
        prices.refresh(view, decision.time);
        &mut self.kept.insert(Kept { day, decision: decision.index, prices }).prices
    }
}
