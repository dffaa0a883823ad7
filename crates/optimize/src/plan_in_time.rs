//! A plan that is there in time, whatever the day.
//!
//! The search and the proof look at the clock and at the stop request many times a second, but a
//! policy or a step may take long on a day of an unusual kind. So they run on a separate thread,
//! and the caller does not wait for that thread longer than a grace time. The best plan until
//! then is never lost.

use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, sleep};
use std::time::{Duration, Instant};

use rayon::ThreadPoolBuilder;
use vertifleet_core::{Scenario, Stop};

use crate::plan::{BestPlan, Budget, SearchProgress, SearchSettings, StartingPolicy};
use crate::proof::POLL_INTERVAL;
use crate::proven_plan::prove_and_plan;
use crate::{Bound, Error, ProvenPlan};

/// The time past a stop request, and past a limit of less than ten times as much, after which the
/// best plan so far is returned. The search itself needs up to 0.8 seconds for a first bound.
const GRACE: Duration = Duration::from_secs(1);
/// The grace time past a limit as a share of it, if that is more.
const GRACE_SHARE: f64 = 0.1;
/// The time past its limit that a search has for its first plan, the day of greedy.
const FIRST_GRACE: Duration = Duration::from_secs(5);
/// The stack of the main thread on most systems, bytes.
const STACK: usize = 8 << 20;

/// The state that the search and its caller share.
#[derive(Default)]
struct Latest {
    plan: BestPlan,
    seen: Mutex<Option<(SearchProgress, Option<Arc<Bound>>)>>,
}

impl Latest {
    fn seen(&self) -> MutexGuard<'_, Option<(SearchProgress, Option<Arc<Bound>>)>> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Plans a day like [`plan`](crate::plan()) while a bound is proven in the background. It ends
/// early if the plan reaches the bound, or comes as close to it as `gap`, a share of the bound. A
/// limit of time holds for both; after a limit of steps, the whole proof is waited for.
///
/// It always returns soon after the limit of time and soon after `stop` is requested, with the best
/// plan and bound until then. A search that is not over by then continues on its threads until it
/// notices the request.
///
/// `watch` is called many times a second with the progress of the plan and the best bound so far.
///
/// # Errors
/// [`Error::NoPlanInTime`] if no policy has played the day by then.
///
/// # Panics
/// Panics if the search does, or the system has no thread for it.
pub fn plan_in_time(
    scenario: &Arc<Scenario>,
    settings: &SearchSettings,
    starts: Vec<StartingPolicy>,
    gap: Option<f64>,
    stop: &Stop,
    watch: &mut dyn FnMut(&SearchProgress, Option<&Bound>),
) -> Result<ProvenPlan, Error> {
    let (scenario, settings, heard) = (Arc::clone(scenario), *settings, stop.clone());
    // The threads end with the search: a process that is forked later would not have them.
    let pool = ThreadPoolBuilder::new().num_threads(settings.searches).stack_size(STACK).build();
    in_time(settings.budget, stop, watch, move |latest| {
        let plan = || {
            prove_and_plan(
                &scenario,
                &settings,
                starts,
                (gap, &heard, &latest.plan),
                &mut |progress, bound| *latest.seen() = Some((*progress, bound.cloned())),
            )
        };
        match pool {
            Ok(pool) => pool.install(plan),
            Err(_) => plan(),
        }
    })
}

/// Runs a search on a thread, and returns its outcome, or the best plan that it has when time is
/// over.
fn in_time(
    budget: Budget,
    stop: &Stop,
    watch: &mut dyn FnMut(&SearchProgress, Option<&Bound>),
    search: impl FnOnce(&Latest) -> ProvenPlan + Send + 'static,
) -> Result<ProvenPlan, Error> {
    let (begun, mut asked) = (Instant::now(), None);
    let latest = Arc::new(Latest::default());
    let shared = Arc::clone(&latest);
    let thread = Builder::new().name("plan".to_owned()).stack_size(STACK);
    let worker = thread.spawn(move || search(&shared)).expect("the system has a thread to spare");
    while !worker.is_finished() {
        sleep(POLL_INTERVAL);
        let seen = latest.seen().clone();
        if let Some((progress, bound)) = &seen {
            watch(progress, bound.as_deref());
        }
        if stop.is_requested() {
            asked.get_or_insert_with(Instant::now);
        }
        let plan = latest.plan.so_far();
        let limit_is_over = match budget {
            Budget::Time(limit) => {
                let grace = GRACE.max(limit.mul_f64(GRACE_SHARE));
                let grace = if plan.is_some() { grace } else { grace.max(FIRST_GRACE) };
                begun.elapsed() > limit.saturating_add(grace)
            }
            Budget::Steps(_) => false,
        };
        if limit_is_over || asked.is_some_and(|asked| asked.elapsed() > GRACE) {
            stop.request();
            let bound = seen.and_then(|(_, bound)| bound).as_deref().cloned();
            return plan.map(|plan| ProvenPlan { plan, bound }).ok_or(Error::NoPlanInTime);
        }
    }
    Ok(worker.join().unwrap_or_else(|panic| resume_unwind(panic)))
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use vertifleet_core::{Coded, Stop};

    use super::{FIRST_GRACE, GRACE, in_time};
    use crate::plan::Budget;

    fn never_ends() -> ! {
        loop {
            std::thread::sleep(Duration::from_mins(1));
        }
    }

    #[test]
    fn a_search_without_a_plan_ends_with_an_error_at_its_limit_and_at_a_stop() {
        let begun = Instant::now();
        let budget = Budget::Time(Duration::ZERO);
        let over = in_time(budget, &Stop::default(), &mut |_, _| {}, |_| never_ends());
        assert_eq!(over.expect_err("no plan").code().to_string(), "V506");
        assert!((FIRST_GRACE..FIRST_GRACE + GRACE * 5).contains(&begun.elapsed()));

        let (stop, begun) = (Stop::default(), Instant::now());
        stop.request();
        let stopped = in_time(Budget::Steps(9), &stop, &mut |_, _| {}, |_| never_ends());
        assert_eq!(stopped.expect_err("no plan").code().to_string(), "V506");
        assert!((GRACE..FIRST_GRACE).contains(&begun.elapsed()), "{:?}", begun.elapsed());
    }

    #[test]
    #[should_panic(expected = "a broken invariant")]
    fn the_panic_of_a_search_reaches_the_caller() {
        let search = |_: &super::Latest| panic!("a broken invariant");
        let _ = in_time(Budget::Steps(1), &Stop::default(), &mut |_, _| {}, search);
    }
}
