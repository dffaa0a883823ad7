//! Which choices deserve a closer look than the bid prices alone.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, View};

use crate::DayPrices;
use crate::prices::is_empty_flight;

/// The choices worth a closer look: those that are worth most at the prices.
#[derive(Debug, Clone, Default)]
pub struct Shortlist {
    /// What each is worth at the prices, dollars; the best first, among equals the vertiport listed first.
    ranked: Vec<(f64, VertiportIx)>,
}

impl Shortlist {
    /// Choices kept at most.
    pub const MOST: usize = 5;
    /// How much worse than the best a choice that is kept may be, in [units](DayPrices::unit_usd).
    const TOO_BAD: f64 = 0.5;

    /// Ranks the choices that are open at the prices and keeps those that come near the best one. Of flights without passengers
    /// only the best choice of all may be one: what another would lead to, the prices alone know, and they put it second.
    pub fn rank(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[(f64, VertiportIx)] {
        self.rank_open(prices, view, decision);
        let best = self.ranked[0].1;
        self.ranked.retain(|&(_, to)| to == best || !is_empty_flight(view, decision, to));
        self.keep_near(prices, view, decision)
    }

    /// The same with every flight without passengers, for an evaluator that [confirms](crate::RolloutEvaluator::best_choice) them.
    pub fn rank_with_empty_flights(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[(f64, VertiportIx)] {
        self.rank_open(prices, view, decision);
        self.keep_near(prices, view, decision)
    }

    fn rank_open(&mut self, prices: &DayPrices, view: View<'_>, decision: &Decision) {
        self.ranked.clear();
        self.ranked.extend(prices.open_choices(view, decision));
        // A stable sort: among equals the vertiport listed first.
        self.ranked.sort_by(|one, other| other.0.total_cmp(&one.0));
    }

    fn keep_near(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[(f64, VertiportIx)] {
        let too_bad_usd = Self::TOO_BAD * prices.unit_usd(view.kind(decision.aircraft));
        let least_usd = self.ranked[0].0 - too_bad_usd;
        let near = self.ranked.iter().take(Self::MOST).take_while(|choice| choice.0 >= least_usd);
        let count = near.count();
        self.ranked.truncate(count);
        &self.ranked
    }
}
