//! Plays days in parallel, with one inference for all of them.

use std::sync::Arc;

use vertifleet_core::Scenario;
use vertifleet_policy::Policy;
use vertifleet_sim::{DayTotals, Simulation};

/// Plays days in lockstep. Returns their totals in the order of the days.
pub(crate) fn play_together(policy: &mut dyn Policy, days: &[Arc<Scenario>]) -> Vec<DayTotals> {
    let mut simulations: Vec<Simulation> =
        days.iter().map(|day| Simulation::new(Arc::clone(day))).collect();
    let mut open = Vec::with_capacity(days.len());
    let mut choices = Vec::with_capacity(days.len());
    loop {
        open.clear();
        open.extend(
            simulations
                .iter_mut()
                .enumerate()
                .filter_map(|(at, day)| day.next_decision().map(|decision| (at, decision))),
        );
        if open.is_empty() {
            return simulations.iter().map(Simulation::totals).collect();
        }
        choices.clear();
        let mut asked = open.iter().map(|&(at, decision)| (decision, simulations[at].view()));
        policy
            .choose_batch(&mut asked, &mut choices)
            .expect("a trained network always has an answer");
        for (&(at, _), &choice) in open.iter().zip(&choices) {
            simulations[at].apply(choice).expect("a trained network chooses from the mask");
        }
    }
}
