//! `gcaps-x` with roll-outs. The best choices are played on with `gcaps-x` deciding for every aircraft, and the choice
//! with the highest mean worth of the fleet at the end is taken. Each choice is rolled out several times, with the
//! values of all choices perturbed by a little noise, the same for every choice that is compared.
//!
//! All roll-outs advance side by side, one decision each at a time, so that the network scores them together.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_policy::{DayPrices, PricedChoice, Shortlist, fleet_worth_usd};
use vertifleet_sim::{Decision, Imagined, View};

use crate::gcaps_x::ROLLOUTS;
use crate::gcaps_x::features::Scene;
use crate::gcaps_x::scorer::Scorer;

/// Why a roll-out that the network scores always has a decision.
const ASKED: &str = "rollouts that have come to their end are not asked";

/// The working memory of the roll-outs of a decision.
#[derive(Default)]
pub(crate) struct RolloutPlayer {
    /// The roll-outs of all choices, choice by choice; those from index `used` on are kept for their allocations.
    rollouts: Vec<Rollout>,
    used: usize,
    begun: Option<Imagined>,
    shortlist: Shortlist,
    /// The roll-out of each row of the scorer.
    asked: Vec<usize>,
    /// The result of each roll-out, choice by choice, dollars.
    usd: Vec<f64>,
}

/// A roll-out of one choice.
struct Rollout {
    /// Its number among the roll-outs of the same choice; number 0 has no noise.
    number: u32,
    simulation: Imagined,
    /// The profit so far plus the worth of the fleet at the end of the roll-out; `None` until it gets there.
    usd: Option<f64>,
    /// The decision to be taken next, between the choices in `listed`.
    next: Option<Decision>,
    listed: Vec<PricedChoice>,
}

impl RolloutPlayer {
    /// The candidate after which the fleet is worth most; each candidate comes with its worth to the deciding aircraft
    /// alone.
    pub(crate) fn best(
        &mut self,
        scorer: &mut Scorer,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        candidates: &[PricedChoice],
    ) -> VertiportIx {
        let until = decision.time + ROLLOUTS.horizon_s;
        self.used = 0;
        for candidate in candidates {
            self.begin(view, candidate.to);
        }
        loop {
            scorer.rows.clear();
            self.asked.clear();
            for (at, rollout) in self.rollouts[..self.used].iter_mut().enumerate() {
                if rollout.go_on(&mut self.shortlist, prices, until) {
                    rollout.show(scorer, prices);
                    self.asked.push(at);
                }
            }
            if self.asked.is_empty() {
                break;
            }
            scorer.forward();
            for (row, &at) in self.asked.iter().enumerate() {
                self.rollouts[at].follow(scorer, prices, row);
            }
        }
        let per_candidate = ROLLOUTS.rollouts as usize;
        self.usd.clear();
        self.usd.extend(self.rollouts[..self.used].iter().filter_map(|rollout| rollout.usd));
        let mut best = (f64::NEG_INFINITY, decision.at);
        for (candidate, usd) in candidates.iter().zip(self.usd.chunks_exact(per_candidate)) {
            let value_usd = ROLLOUTS.value_usd(candidate.worth_usd, usd);
            if value_usd > best.0 {
                best = (value_usd, candidate.to);
            }
        }
        best.1
    }

    /// Starts the roll-outs of a choice.
    fn begin(&mut self, view: View<'_>, choice: VertiportIx) {
        let begun = view.imagined_in(&mut self.begun);
        begun.apply(choice).expect("lists are of feasible choices");
        for number in 0..ROLLOUTS.rollouts {
            if let Some(rollout) = self.rollouts.get_mut(self.used) {
                rollout.simulation.clone_from(begun);
                (rollout.number, rollout.usd, rollout.next) = (number, None, None);
            } else {
                let simulation = begun.clone();
                let listed = Vec::new();
                self.rollouts.push(Rollout { number, simulation, usd: None, next: None, listed });
            }
            self.used += 1;
        }
    }
}

impl Rollout {
    /// Advances to the next decision between more than one choice; returns false at the end of the roll-out.
    fn go_on(&mut self, shortlist: &mut Shortlist, prices: &DayPrices, until: Time) -> bool {
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
            let listed = shortlist.rank(prices, simulation.view(), &next);
            if let [only] = listed {
                simulation.apply(only.to).expect("lists are of feasible choices");
                continue;
            }
            self.listed.clear();
            self.listed.extend(listed);
            self.next = Some(next);
            return true;
        }
        self.usd = Some(simulation.ledger().profit_usd() + worth_usd);
        self.next = None;
        false
    }

    /// Adds the decision to the scorer's rows.
    fn show(&self, scorer: &mut Scorer, prices: &DayPrices) {
        let decision = self.next.as_ref().expect(ASKED);
        scorer.push(Scene::of(self.simulation.view(), decision, prices), &self.listed);
    }

    /// Takes the choice that a row of the scorer gives.
    fn follow(&mut self, scorer: &Scorer, prices: &DayPrices, row: usize) {
        let decision = self.next.as_ref().expect(ASKED);
        let addition_usd = Scene::of(self.simulation.view(), decision, prices).addition_usd();
        let choices = self.listed.iter().map(|&choice| PricedChoice {
            worth_usd: scorer.worth_usd(row, addition_usd, choice),
            ..choice
        });
        let choice = ROLLOUTS.perturbed_best(prices, decision, self.number, choices);
        self.simulation.apply(choice).expect("lists are of feasible choices");
    }
}
