//! A plan with a proof of how good it is: search and proof go on beside each other, and each helps the other to its end.

use std::sync::Arc;
use std::time::{Duration, Instant};

use vertifleet_core::{Scenario, Stop};

use crate::plan::{Budget, Plan, SearchProgress, SearchSettings, StartingPolicy, plan};
use crate::proof::Proof;
use crate::{Bound, Error};

/// How often a stop is looked for while the rest of a proof is waited for.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// A plan, and the best bound that was proven meanwhile; none where there was no time for one, or the day is too large for any.
#[derive(Debug, Clone)]
pub struct ProvenPlan {
    /// The best schedule found.
    pub plan: Plan,
    /// What no schedule earns more than.
    pub bound: Option<Bound>,
}

/// Plans a day as [`plan()`] does while a bound is proven beside it, and ends early where the plan reaches the bound or comes as close
/// to it as `gap`, a share of it. A limit of time is one for both; after a limit of steps the whole proof is waited for.
///
/// `watch` is told how far the plan is and the best bound so far, many times a second. Soon after `stop` is raised, the best plan and
/// bound by then are returned.
///
/// # Errors
/// As [`plan()`].
pub fn plan_with_proof(
    scenario: &Arc<Scenario>,
    settings: &SearchSettings,
    starts: Vec<StartingPolicy>,
    gap: Option<f64>,
    stop: &Stop,
    watch: &mut dyn FnMut(&SearchProgress, Option<&Bound>),
) -> Result<ProvenPlan, Error> {
    let begun = Instant::now();
    let proof = Proof::begin(scenario);
    let plan = plan(scenario, settings, starts, &mut |progress| {
        let profit_usd = progress.profit_usd;
        proof.knows(profit_usd);
        let bound = proof.best();
        watch(progress, bound.as_deref());
        let is_good_enough = bound.is_some_and(|bound| {
            bound.is_reached_by(profit_usd) || gap.is_some_and(|gap| bound.gap(profit_usd) <= gap)
        });
        !is_good_enough && !stop.is_requested()
    })?;
    let bound = match settings.budget {
        Budget::Time(limit) => proof.best_in_time(begun, limit),
        Budget::Steps(_) => {
            while !proof.wait(POLL_INTERVAL) && !stop.is_requested() {}
            proof.outcome()
        }
    };
    Ok(ProvenPlan { plan, bound })
}
