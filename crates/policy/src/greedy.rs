//! `greedy`: takes the flight with the highest profit per hour from take-off to ready.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, View};

use crate::{Policy, PolicyError};

/// Looks one flight ahead. Holds if no flight earns anything. Of equally good flights, it takes the one to the
/// vertiport listed first.
#[derive(Debug, Clone, Copy, Default)]
pub struct Greedy;

impl Greedy {
    /// The feasible flight with the highest profit per hour, or a hold if no flight earns anything.
    #[inline]
    pub(crate) fn flight_or_hold(view: View<'_>, decision: &Decision) -> VertiportIx {
        let kind = view.kind(decision.aircraft);
        let period = view.period();
        let mut best = (decision.at, 0.0);
        for to in view.feasible(decision).iter().filter(|&to| to != decision.at) {
            let waiting = view.demand_left(period, decision.at, to);
            let profit_usd =
                view.flight_profit_usd(decision.time, kind, (decision.at, to), waiting);
            let rate = profit_usd / f64::from(view.leg(kind, decision.at, to).block_s());
            if rate > best.1 {
                best = (to, rate);
            }
        }
        best.0
    }
}

impl Policy for Greedy {
    #[inline]
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        Ok(Self::flight_or_hold(*view, decision))
    }
}
