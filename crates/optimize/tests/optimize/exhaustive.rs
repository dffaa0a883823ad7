//! The best schedule of a tiny day by exhaustive search, to compare bound and planner with.

use vertifleet_sim::Simulation;

/// The highest profit of any sequence of decisions, by trying them all; `None` if there are more
/// than `most` of them.
pub(crate) fn best_of_all(simulation: &mut Simulation, most: &mut u32) -> Option<f64> {
    let Some(decision) = simulation.next_decision() else {
        *most = most.checked_sub(1)?;
        return Some(simulation.ledger().profit_usd());
    };
    let mask = simulation.view().feasible(&decision);
    let mut best = f64::NEG_INFINITY;
    for choice in mask.iter() {
        let mut after = simulation.clone();
        after.apply(choice).expect("a choice from the mask");
        best = best.max(best_of_all(&mut after, most)?);
    }
    Some(best)
}
