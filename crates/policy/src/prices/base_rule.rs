//! The base rule, by which the fleet is expected to decide: the prices, the prices without
//! repositioning, or greedy.
//!
//! Prices that a search has not settled promise too much. Where demand is thin, each aircraft of
//! the fleet counts on the same few passengers, and repositioning towards them costs more than it
//! earns. Once an hour the rest of the day is therefore played out as expected under each rule, and
//! the rule that earns the most decides until the next time.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, Imagined, View};

use super::{Choices, DayPrices, PricedChoice};
use crate::Greedy;

/// The rules by which the fleet may decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BaseRule {
    /// Takes the choice that is worth most at the prices.
    Prices,
    /// Takes the choice that is worth most at the prices among holding and the flights that carry
    /// passengers.
    PricesCarrying,
    /// Takes the flight with the highest profit per hour.
    Greedy,
}

impl BaseRule {
    /// The rule under which the rest of the day, played out as expected, earns the most; of equals,
    /// the first.
    pub(super) fn best(prices: &DayPrices, view: View<'_>, room: &mut Option<Imagined>) -> Self {
        let mut played_out = |rule: Self| {
            let day = view.imagined_in(room);
            let mut repositioning_flights = 0_u32;
            while let Some(decision) = day.next_decision() {
                let choice = rule.choice(prices, day.view(), &decision);
                let row = day.apply(choice).expect("every rule chooses from the mask");
                repositioning_flights += u32::from(row.to != row.from && row.passengers == 0);
            }
            (day.ledger().profit_usd(), repositioning_flights)
        };
        let (prices_usd, repositioning_flights) = played_out(Self::Prices);
        let mut best = (prices_usd, Self::Prices);
        let others: &[Self] = match repositioning_flights {
            0 => &[Self::Greedy],
            _ => &[Self::PricesCarrying, Self::Greedy],
        };
        for &rule in others {
            let usd = played_out(rule).0;
            if usd > best.0 {
                best = (usd, rule);
            }
        }
        best.1
    }

    /// The choice of an aircraft under this rule.
    #[inline]
    pub(super) fn choice(
        self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> VertiportIx {
        if self == Self::Greedy {
            return Greedy::flight_or_hold(view, decision);
        }
        let choices = prices.choices(view, decision);
        let open = view.feasible(decision).iter().filter(|&to| self.allows(&choices, to));
        PricedChoice::best(open.map(|to| choices.priced(to))).unwrap_or(decision.at)
    }

    /// Whether an aircraft may make a choice under a rule that decides by prices.
    #[inline]
    pub(super) fn allows(self, choices: &Choices<'_>, to: VertiportIx) -> bool {
        self == Self::Prices || !choices.is_repositioning(to)
    }
}
