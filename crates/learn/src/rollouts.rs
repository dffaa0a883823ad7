//! Roll-outs in which a learned policy decides for every aircraft. Each choice of a decision is
//! played on several times. The policy's scores of all later choices are perturbed by a little
//! noise, which is the same for every choice that is compared. The value of a choice is the mean,
//! over its roll-outs, of the profit at their end plus the worth of the fleet there.
//!
//! `gcaps-x` can decide by them, and any policy that learns by imitation can learn from its
//! roll-outs. All roll-outs advance in parallel, one decision each at a time, so that the network
//! scores them together.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_observe::PricedDecision;
use vertifleet_policy::{DayPrices, PricedChoice, RolloutSettings, Shortlist, fleet_worth_usd};
use vertifleet_sim::{Decision, Imagined};

use crate::scorer::Scorer;

/// The settings of the roll-outs that policies learn from, and of those of `gcaps-x`, if its
/// choices are rolled out at all.
pub(crate) const ROLLOUTS: RolloutSettings =
    RolloutSettings { horizon_s: 7_200, rollouts: 8, noise: 0.06, price_weight: 0.5 };
/// The reason why a roll-out that the network scores always has a decision.
const ASKED: &str = "rollouts that have come to their end are not asked";
/// Largest number of decisions that are scored at once: one of every roll-out of all choices, with
/// the usual number of roll-outs.
pub(crate) const MOST_ROWS: usize = Shortlist::MOST * ROLLOUTS.rollouts as usize;

/// The working memory of the roll-outs of a decision.
#[derive(Default)]
pub(crate) struct RolloutPlayer {
    /// The roll-outs of all choices, choice by choice; those from index `used` on are kept for
    /// their allocations.
    rollouts: Vec<Rollout>,
    used: usize,
    begun: Option<Imagined>,
    /// The roll-out of each row of the scorer.
    asked: Vec<usize>,
    /// The result of each roll-out of a choice, and the value of each choice, dollars.
    rollouts_usd: Vec<f64>,
    values_usd: Vec<f64>,
}

/// A roll-out of one choice.
struct Rollout {
    /// Its number among the roll-outs of the same choice; number 0 has no noise.
    number: u32,
    simulation: Imagined,
    /// The profit so far plus the worth of the fleet at the end of the roll-out; `None` before the
    /// end.
    usd: Option<f64>,
    /// The decision to be taken next, between the choices in `listed`.
    next: Option<Decision>,
    listed: Vec<PricedChoice>,
}

impl RolloutPlayer {
    /// The value of each candidate if the policy decides for every aircraft afterwards, dollars.
    /// Candidates come with their worth to the deciding aircraft alone.
    pub(crate) fn values_usd(
        &mut self,
        scorer: &mut Scorer,
        settings: &RolloutSettings,
        scene: PricedDecision<'_>,
        candidates: &[PricedChoice],
    ) -> &[f64] {
        let PricedDecision { view, decision, prices, .. } = scene;
        let until = decision.time + settings.horizon_s;
        self.begin(scene, settings.rollouts, candidates);
        loop {
            scorer.clear(view.vertiports());
            self.asked.clear();
            for (at, rollout) in self.rollouts[..self.used].iter_mut().enumerate() {
                if self.asked.len() < MOST_ROWS && rollout.go_on(scorer, prices, until) {
                    let PricedDecision { view, decision, .. } = rollout.scene(prices);
                    scorer.push(view, decision, Some((prices, &rollout.listed)));
                    self.asked.push(at);
                }
            }
            if self.asked.is_empty() {
                break;
            }
            scorer.forward();
            for (row, &at) in self.asked.iter().enumerate() {
                self.rollouts[at].follow(scorer, settings, prices, row);
            }
        }
        self.values_usd.clear();
        let rollouts = self.rollouts[..self.used].chunks_exact(settings.rollouts as usize);
        for (candidate, rollouts) in candidates.iter().zip(rollouts) {
            self.rollouts_usd.clear();
            self.rollouts_usd.extend(rollouts.iter().filter_map(|rollout| rollout.usd));
            self.values_usd.push(settings.value_usd(candidate.worth_usd, &self.rollouts_usd));
        }
        &self.values_usd
    }

    /// The candidate with the highest [value](Self::values_usd), the first of them if several are
    /// equal.
    pub(crate) fn best(
        &mut self,
        scorer: &mut Scorer,
        scene: PricedDecision<'_>,
        candidates: &[PricedChoice],
    ) -> VertiportIx {
        let values_usd = self.values_usd(scorer, &ROLLOUTS, scene, candidates);
        let valued = candidates.iter().zip(values_usd);
        let valued = valued.map(|(choice, &worth_usd)| PricedChoice { worth_usd, to: choice.to });
        PricedChoice::best(valued).unwrap_or(scene.decision.at)
    }

    /// Starts the roll-outs of all candidates.
    fn begin(&mut self, scene: PricedDecision<'_>, each: u32, candidates: &[PricedChoice]) {
        self.used = 0;
        for candidate in candidates {
            let begun = scene.view.imagined_in(&mut self.begun);
            begun.apply(candidate.to).expect("lists are of feasible choices");
            for number in 0..each {
                if let Some(rollout) = self.rollouts.get_mut(self.used) {
                    rollout.simulation.clone_from(begun);
                    (rollout.number, rollout.usd, rollout.next) = (number, None, None);
                } else {
                    let (simulation, listed) = (begun.clone(), Vec::new());
                    self.rollouts.push(Rollout {
                        number,
                        simulation,
                        usd: None,
                        next: None,
                        listed,
                    });
                }
                self.used += 1;
            }
        }
    }
}

impl Rollout {
    /// Advances to the next decision between more than one choice; returns false at the end of the
    /// roll-out.
    fn go_on(&mut self, scorer: &mut Scorer, prices: &DayPrices, until: Time) -> bool {
        if self.usd.is_some() {
            return false;
        }
        let simulation = &mut self.simulation;
        let mut worth_usd = 0.0;
        while let Some(next) = simulation.next_decision() {
            if next.time > until {
                worth_usd = fleet_worth_usd(prices, simulation.view(), next.time);
                break;
            }
            scorer.list(PricedDecision::of(simulation.view(), &next, prices), &mut self.listed);
            if let [only] = self.listed[..] {
                simulation.apply(only.to).expect("lists are of feasible choices");
                continue;
            }
            self.next = Some(next);
            return true;
        }
        self.usd = Some(simulation.ledger().profit_usd() + worth_usd);
        self.next = None;
        false
    }

    /// The decision to be taken next.
    fn scene<'a>(&'a self, prices: &'a DayPrices) -> PricedDecision<'a> {
        PricedDecision::of(self.simulation.view(), self.next.as_ref().expect(ASKED), prices)
    }

    /// Takes the choice that a row of the scorer returns.
    fn follow(
        &mut self,
        scorer: &Scorer,
        settings: &RolloutSettings,
        prices: &DayPrices,
        row: usize,
    ) {
        let scene = self.scene(prices);
        let rated = self.listed.iter().map(|&choice| scorer.rated(row, scene, choice));
        let choice = settings.perturbed_best(prices, scene.decision, self.number, rated);
        self.simulation.apply(choice).expect("lists are of feasible choices");
    }
}
