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
        if view.charges_as_needed() {
            return Self::best(decision.at, Self::rates_by_charge(view, decision));
        }
        Self::best(decision.at, Self::rates(view, decision))
    }

    /// The first of the highest rates above 0, or a hold.
    #[inline]
    fn best(own: VertiportIx, rates: impl Iterator<Item = (VertiportIx, f64)>) -> VertiportIx {
        let mut best = (own, 0.0);
        for (to, rate) in rates {
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
            let profit_usd = departures.profit_usd(to, waiting[to.at()]);
            (to, profit_usd / f64::from(departures.block_s(to)))
        })
    }

    /// The same where flights may wait for charge.
    #[inline(never)]
    fn rates_by_charge<'a>(
        view: View<'a>,
        decision: &'a Decision,
    ) -> impl Iterator<Item = (VertiportIx, f64)> + 'a {
        let departures = view.departures(decision.time, view.kind(decision.aircraft), decision.at);
        let waiting = &view.demand_left_in(view.period())[decision.at.at() * view.vertiports()..];
        view.feasible(decision).iter().filter(|&to| to != decision.at).map(move |to| {
            let Outcome { takeoff, ready, .. } = view.outcome(decision, to);
            let profit_usd = departures.profit_from_usd(takeoff, to, waiting[to.at()]);
            (to, profit_usd / f64::from(ready.since(decision.time)))
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
        let mut enter = |(to, rate): (VertiportIx, f64)| values[to.at()] = 3_600.0 * rate;
        if view.charges_as_needed() {
            Self::rates_by_charge(*view, decision).for_each(&mut enter);
        } else {
            Self::rates(*view, decision).for_each(&mut enter);
        }
        Ok(())
    }
}
