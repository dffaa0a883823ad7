//! Trying choices out: each is played on for a while in the simulator, everybody else deciding by a rule; what the fleet has
//! earned and is worth by then tells good choices from bad ones.

use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::{Decision, View};

use crate::DayPrices;

/// The choices worth trying out: those that are worth most at the prices.
#[derive(Debug, Clone, Default)]
pub struct Shortlist {
    /// What each is worth at the prices, dollars; the best first, among equals the vertiport listed first.
    ranked: Vec<(f64, VertiportIx)>,
}

impl Shortlist {
    /// Ranks the feasible choices and keeps up to `most`, none of them more than `too_bad_usd` worse than the best.
    pub fn rank(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        (most, too_bad_usd): (usize, f64),
    ) -> &[(f64, VertiportIx)] {
        self.ranked.clear();
        let choices = view.feasible(decision).iter();
        self.ranked.extend(choices.map(|to| (prices.choice_usd(view, decision, to), to)));
        // A stable sort: among equals the vertiport listed first.
        self.ranked.sort_by(|one, other| other.0.total_cmp(&one.0));
        let least_usd = self.ranked[0].0 - too_bad_usd;
        let enough = self.ranked.iter().take(most).take_while(|choice| choice.0 >= least_usd);
        let count = enough.count();
        self.ranked.truncate(count);
        &self.ranked
    }
}

/// What the fleet has earned and is worth `horizon_s` seconds after a feasible choice, if everybody decides by `rule` until
/// then, dollars. `rule` must choose from the mask.
pub fn tried_out_usd(
    prices: &DayPrices,
    (view, decision): (View<'_>, &Decision),
    to: VertiportIx,
    horizon_s: u32,
    mut rule: impl FnMut(View<'_>, &Decision) -> VertiportIx,
) -> f64 {
    let mut imagined = view.imagined();
    let until = decision.time + horizon_s;
    imagined.apply(to).expect("only feasible choices are tried");
    while let Some(next) = imagined.next_decision() {
        if next.time > until {
            return imagined.ledger().profit_usd()
                + fleet_worth_usd(prices, imagined.view(), next.time);
        }
        let choice = rule(imagined.view(), &next);
        imagined.apply(choice).expect("rules choose from the mask");
    }
    imagined.ledger().profit_usd()
}

/// What it is worth that every aircraft is where it is, less the rent of its stand from now until it is ready, dollars.
pub fn fleet_worth_usd(prices: &DayPrices, view: View<'_>, now: Time) -> f64 {
    let worth_usd = |aircraft: AircraftIx| {
        let (place, ready) = (view.places()[aircraft.at()], view.ready_at(aircraft));
        prices.worth_usd(view.kind(aircraft), place, ready) - prices.rent_usd(place, now, ready)
    };
    AircraftIx::all(view.places().len()).map(worth_usd).sum()
}
