//! A plan with a proof of how good it is. Search and proof run at the same time, and each helps the
//! other to end.

use std::sync::Arc;
use std::time::Instant;

use vertifleet_core::{Scenario, Stop};

use crate::Bound;
use crate::plan::{
    BestPlan, Budget, Plan, SearchProgress, SearchSettings, StartingPolicy, plan_known,
};
use crate::proof::{POLL_INTERVAL, Proof};

/// Where policies play their days alone, the proof begins at this share of the time at the latest.
const LATEST_PROOF: f64 = 0.8;

/// A plan, and the best bound that was proven meanwhile; `None` if there was no time for one, or
/// the day is too large for any.
#[derive(Debug, Clone)]
pub struct ProvenPlan {
    /// The best schedule found.
    pub plan: Plan,
    /// The upper bound of the day.
    pub bound: Option<Bound>,
}

/// Plans a day while a bound is proven in the background, and offers every better plan to `best`
/// at once. It ends early if the plan reaches the bound, or comes as close to it as `gap`, a share
/// of the bound. A limit of time holds for both; after a limit of steps, the whole proof is waited
/// for.
pub(crate) fn prove_and_plan(
    scenario: &Arc<Scenario>,
    settings: &SearchSettings,
    starts: Vec<StartingPolicy>,
    (gap, stop, best): (Option<f64>, &Stop, &BestPlan),
    watch: &mut dyn FnMut(&SearchProgress, Option<&Arc<Bound>>),
) -> ProvenPlan {
    let begun = Instant::now();
    let mut late = None;
    let early = (!settings.budget.leaves_policies_alone()).then(|| Proof::begin(scenario));
    let plan = plan_known(scenario, settings, starts, best, &mut |progress| {
        let profit_usd = progress.profit_usd;
        let is_due = progress.steps > 0 || progress.share > LATEST_PROOF;
        let Some(proof) = early
            .as_ref()
            .or_else(|| is_due.then(|| &*late.get_or_insert_with(|| Proof::begin(scenario))))
        else {
            watch(progress, None);
            return !stop.is_requested();
        };
        proof.record_profit(profit_usd);
        let bound = proof.best();
        watch(progress, bound.as_ref());
        let is_good_enough = bound.is_some_and(|bound| {
            bound.is_reached_by(profit_usd) || gap.is_some_and(|gap| bound.gap(profit_usd) <= gap)
        });
        !is_good_enough && !stop.is_requested()
    });
    let proof = early.or(late).unwrap_or_else(|| Proof::begin(scenario));
    let bound = match settings.budget {
        Budget::Time(limit) => proof.best_in_time(begun, limit),
        Budget::Steps(_) => {
            while !proof.wait(POLL_INTERVAL) && !stop.is_requested() {}
            proof.outcome()
        }
    };
    ProvenPlan { plan, bound }
}
