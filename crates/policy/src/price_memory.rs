//! The bid prices of the day that a policy plays, kept from one decision to the next.

use vertifleet_sim::{DayKey, Decision, View};

use crate::DayPrices;

/// The prices of one day at a time. If a policy plays several days by turns, the prices of each are
/// dropped for the next, which costs time but never mixes days up.
#[derive(Debug, Clone, Default)]
pub struct PriceMemory {
    kept: Option<Kept>,
    /// Whether prices older than a quarter of an hour stay in use.
    keeps_old: bool,
}

#[derive(Debug, Clone)]
struct Kept {
    day: DayKey,
    /// Index of the latest decision that was asked for.
    decision: u32,
    prices: DayPrices,
}

impl PriceMemory {
    /// The prices for a decision, refreshed where they are due to be. They are recomputed if the
    /// day is not the one before, or starts again.
    pub fn at(&mut self, view: View<'_>, decision: &Decision) -> &mut DayPrices {
        let mut prices = match self.kept.take() {
            Some(kept) if kept.goes_on(view, decision) => kept.prices,
            _ => DayPrices::of(view, decision.time),
        };
        if !(self.keeps_old && prices.is_merely_old(view, decision.time)) {
            prices.refresh(view, decision.time);
        }
        let day = view.day();
        &mut self.kept.insert(Kept { day, decision: decision.index, prices }).prices
    }

    /// Whether [`at`](Self::at) would recompute the prices for no other reason than their age,
    /// which is less than an hour. A busy service may [keep the old ones](Self::keep_old) and
    /// [refresh](Self::refresh_briefly) a copy of this memory in the background.
    pub fn is_merely_old(&self, view: View<'_>, decision: &Decision) -> bool {
        self.kept.as_ref().is_some_and(|kept| {
            kept.goes_on(view, decision) && kept.prices.is_merely_old(view, decision.time)
        })
    }

    /// Recomputes the prices for a decision of the day that they are of, with a third of the effort
    /// of [`at`](Self::at).
    pub fn refresh_briefly(&mut self, view: View<'_>, decision: &Decision) {
        if let Some(kept) = self.kept.as_mut().filter(|kept| kept.goes_on(view, decision)) {
            kept.prices.refresh_briefly(view, decision.time);
            kept.decision = decision.index;
        }
    }

    /// Sets whether prices stay in use after a quarter of an hour. At first they do not.
    pub fn keep_old(&mut self, keeps_old: bool) {
        self.keeps_old = keeps_old;
    }
}

impl Kept {
    /// Whether a decision is a later one of the same day.
    fn goes_on(&self, view: View<'_>, decision: &Decision) -> bool {
        // A proposal may have been asked for a later time; its prices do not cover the time before
        // it.
        self.day == view.day()
            && self.decision <= decision.index
            && self.prices.made_at() <= decision.time
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use vertifleet_core::{DaySeed, Network};
    use vertifleet_sim::Simulation;

    use super::PriceMemory;

    #[test]
    fn old_prices_are_kept_while_a_copy_is_refreshed() {
        let network = Network::shipped("paper").expect("it is shipped");
        let day = network.draw(DaySeed::validation(1).expect("a seed"));
        let mut day = Simulation::new(Arc::new(day));
        let mut memory = PriceMemory::default();
        let (mut refreshed, mut agreements) = (0, 0);
        while let Some(decision) = day.next_decision() {
            let view = day.view();
            if memory.is_merely_old(view, &decision) {
                let mut copy = memory.clone();
                copy.refresh_briefly(view, &decision);
                memory.keep_old(true);
                assert!(memory.at(view, &decision).made_at() < decision.time);
                memory.keep_old(false);
                let choice = memory.at(view, &decision).best_choice(view, &decision);
                let prices = copy.at(view, &decision);
                assert_eq!(prices.made_at(), decision.time);
                agreements += usize::from(prices.best_choice(view, &decision) == choice);
                refreshed += 1;
            }
            let choice = memory.at(view, &decision).best_choice(view, &decision);
            day.apply(choice).expect("it is feasible");
        }
        assert!(refreshed > 30 && agreements > refreshed / 2, "{agreements} of {refreshed}");
    }
}
