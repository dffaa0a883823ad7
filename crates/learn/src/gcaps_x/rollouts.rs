//! `gcaps-x` with roll-outs: its best choices are played on while it decides for every aircraft, and the choice after which the
//! fleet stands best in the mean is taken. Each choice is rolled out several times, with the values of all choices perturbed by a
//! little noise, the same for every choice that is compared.
//!
//! All roll-outs go on side by side, one decision of each at a time, so that the network scores them together.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_policy::{DayPrices, Shortlist, fleet_worth_usd, noise};
use vertifleet_sim::{Decision, Imagined, View};

use crate::gcaps_x::ROLLOUTS;
use crate::gcaps_x::features::Scene;
use crate::gcaps_x::scorer::Scorer;

/// Why a rollout that is asked has a decision.
const ASKED: &str = "rollouts that have come to their end are not asked";

/// What trying out needs.
#[derive(Default)]
pub(crate) struct RolloutPlayer {
    /// Courses of all choices, choice by choice; behind `used`, room of earlier ones.
    rollouts: Vec<Rollout>,
    used: usize,
    begun: Option<Imagined>,
    shortlist: Shortlist,
    /// The rollouts behind the scorer's rows.
    asked: Vec<usize>,
}

/// A choice played on.
struct Rollout {
    /// Its number among those of the same choice; the first has no noise.
    number: u32,
    simulation: Imagined,
    /// What the fleet has earned and is worth at the end, once it is reached.
    usd: Option<f64>,
    /// The decision to be taken, between the choices of a list.
    next: Option<Decision>,
    listed: Vec<(f64, VertiportIx)>,
}

impl RolloutPlayer {
    /// The choice after which the fleet stands best, among some with what they are worth to the aircraft alone.
    pub(crate) fn best(
        &mut self,
        scorer: &mut Scorer,
        prices: &DayPrices,
        (view, decision): (View<'_>, &Decision),
        candidates: &[(f64, VertiportIx)],
    ) -> VertiportIx {
        let until = decision.time + ROLLOUTS.horizon_s;
        self.used = 0;
        for &(_, choice) in candidates {
            self.begin((view, choice));
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
        let mut best = (f64::NEG_INFINITY, decision.at);
        for (&(alone_usd, choice), rollouts) in candidates
            .iter()
            .zip(self.rollouts[..self.used].chunks_exact(ROLLOUTS.rollouts as usize))
        {
            let sum_usd: f64 = rollouts.iter().filter_map(|rollout| rollout.usd).sum();
            let usd = ROLLOUTS.price_weight * alone_usd + sum_usd / f64::from(ROLLOUTS.rollouts);
            if usd > best.0 {
                best = (usd, choice);
            }
        }
        best.1
    }

    /// Sets out on the rollouts of a choice.
    fn begin(&mut self, (view, choice): (View<'_>, VertiportIx)) {
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
    /// Goes on to the next decision between more than one choice; false at the rollout's end.
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
            if let [(_, only)] = *listed {
                simulation.apply(only).expect("lists are of feasible choices");
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
        scorer.rows.push(Scene::of(self.simulation.view(), decision, prices), &self.listed);
    }

    /// Takes the choice of a row.
    fn follow(&mut self, scorer: &Scorer, prices: &DayPrices, row: usize) {
        let decision = self.next.as_ref().expect(ASKED);
        let addition_usd = Scene::of(self.simulation.view(), decision, prices).addition_usd();
        let noise_usd = if self.number == 0 { 0.0 } else { ROLLOUTS.noise * prices.stake_usd() };
        let mut best = (f64::NEG_INFINITY, decision.at);
        for &listed in &self.listed {
            let noise = noise(self.number, decision, listed.1);
            let usd = scorer.worth_usd(row, addition_usd, listed) + noise_usd * noise;
            if usd > best.0 {
                best = (usd, listed.1);
            }
        }
        let choice = best.1;
        self.simulation.apply(choice).expect("lists are of feasible choices");
    }
}
