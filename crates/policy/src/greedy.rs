//! `greedy`: takes the flight with the highest profit per hour from take-off to ready.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, Outcome, View};

use crate::{Policy, PolicyError};

/// Looks one flight ahead. Holds if no flight earns anything. Of equally good flights, it takes the
/// one to the vertiport listed first.
#[derive(Debug, Clone, Copy, Default)]
pub struct Greedy;

impl Greedy {
    /// The feasible flight with the highest profit per hour, or a hold if no flight earns anything.
    #[inline]
    pub(crate) fn flight_or_hold(view: View<'_>, decision: &Decision) -> VertiportIx {
        let mut best = (decision.at, 0.0);
        for (to, rate) in Self::rates(view, decision) {
            if rate > best.1 {
                best = (to, rate);
            }
        }
        best.0
    }

    /// The feasible flights with their profit, dollars per second of block time.
    #[inline]
    fn rates<'a>(
        view: View<'a>,
        decision: &'a Decision,
    ) -> impl Iterator<Item = (VertiportIx, f64)> + 'a {
        let kind = view.kind(decision.aircraft);
        let departures = view.departures(decision.time, kind, decision.at);
        let waiting = &view.demand_left_in(view.period())[decision.at.at() * view.vertiports()..];
        view.feasible(decision).iter().filter(|&to| to != decision.at).map(move |to| {
            if view.charges_as_needed() {
                let Outcome { takeoff, ready, .. } = view.outcome(decision, to);
                let profit_usd = departures.profit_from_usd(takeoff, to, waiting[to.at()]);
                return (to, profit_usd / f64::from(ready.since(decision.time)));
            }
            let profit_usd = departures.profit_usd(to, waiting[to.at()]);
            (to, profit_usd / f64::from(departures.block_s(to)))
        })
    }
}

impl Policy for Greedy {
    #[inline]
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        Ok(Self::flight_or_hold(*view, decision))
    }

    /// Profit per hour of block time, dollars; 0 for hold.
    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        values.fill(f64::NAN);
        values[decision.at.at()] = 0.0;
        for (to, rate) in Self::rates(*view, decision) {
            values[to.at()] = 3_600.0 * rate;
        }
        Ok(())
    }
}
