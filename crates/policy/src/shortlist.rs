//! The choices that deserve a closer look than the bid prices alone.

use vertifleet_sim::{Decision, View};

use crate::{DayPrices, PricedChoice};

/// The shortlist of a decision: the choices that are worth most at the prices.
#[derive(Debug, Clone, Default)]
pub struct Shortlist {
    /// The choices with their worth at the prices, dollars: the best first, and of equals the
    /// vertiport listed first.
    ranked: Vec<PricedChoice>,
}

impl Shortlist {
    /// The most choices that are kept.
    pub const MOST: usize = 5;
    /// The most by which a kept choice may be worth less than the best, in
    /// [units](DayPrices::unit_usd).
    const TOO_BAD: f64 = 0.5;

    /// Ranks the choices that the base rule permits and keeps those that are nearly as good as the
    /// best one. A flight without passengers is kept only if it is the best choice: its gain comes
    /// later and is known from the prices alone, and they prefer another choice.
    pub fn rank(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[PricedChoice] {
        self.rank_near(prices, view, decision);
        let best = self.ranked[0].to;
        let choices = prices.choices(view, decision);
        self.ranked.retain(|&PricedChoice { to, .. }| to == best || !choices.is_repositioning(to));
        self.keep_most()
    }

    /// Ranks choices like [`rank`](Self::rank), but keeps flights without passengers, for an
    /// evaluator that [confirms](crate::RolloutEvaluator::best_choice) them.
    pub fn rank_with_repositioning(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[PricedChoice] {
        self.rank_near(prices, view, decision);
        self.keep_most()
    }

    /// Ranks the choices that the base rule permits and that are nearly as good as the best one.
    /// Only these are sorted, because on a large network they are few.
    fn rank_near(&mut self, prices: &DayPrices, view: View<'_>, decision: &Decision) {
        self.ranked.clear();
        self.ranked.extend(prices.open_choices(view, decision));
        let worths_usd = self.ranked.iter().map(|choice| choice.worth_usd);
        let best_usd = worths_usd.fold(f64::NEG_INFINITY, f64::max);
        let too_bad_usd = Self::TOO_BAD * prices.unit_usd(view.kind(decision.aircraft));
        self.ranked.retain(|choice| choice.worth_usd >= best_usd - too_bad_usd);
        // The sort is stable, so of equals the vertiport listed first comes first.
        self.ranked.sort_by(|one, other| other.worth_usd.total_cmp(&one.worth_usd));
    }

    fn keep_most(&mut self) -> &[PricedChoice] {
        self.ranked.truncate(Self::MOST);
        &self.ranked
    }
}
