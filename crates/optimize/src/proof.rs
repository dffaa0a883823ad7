//! A bound that is being proven while something else goes on, such as the search for a plan.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use vertifleet_core::{Scenario, Stop};

use crate::bound::{Watch, fits, search};
use crate::{Bound, Step};

/// Minutes of the bound's slices, finest first; those after the first are for days that are too large for it.
const STEPS_MIN: [u32; 4] = [3, 5, 15, 60];

/// The bound that a day is not too large for, with the finest slices, being proven on a thread of its own. At any time there is the best bound so
/// far, as soon as there is one at all.
pub struct Proof {
    shared: Arc<Shared>,
}

/// What the thread and its owner share.
struct Shared {
    stopped: Stop,
    /// The bits of a share.
    has_come: AtomicU64,
    /// The bits of the most that is known to be earned, dollars.
    known_usd: AtomicU64,
    state: Mutex<State>,
    ended: Condvar,
}

#[derive(Default)]
struct State {
    best: Option<Arc<Bound>>,
    ended: bool,
    panicked: bool,
}

impl Proof {
    /// Begins to prove.
    pub fn begin(scenario: &Arc<Scenario>) -> Self {
        let shared = Arc::new(Shared {
            stopped: Stop::default(),
            has_come: AtomicU64::new(0.0_f64.to_bits()),
            known_usd: AtomicU64::new(f64::NEG_INFINITY.to_bits()),
            state: Mutex::default(),
            ended: Condvar::new(),
        });
        let (scenario, watch) = (Arc::clone(scenario), Ending(Arc::clone(&shared)));
        // Not joined: a caller in a hurry need not wait for it.
        std::thread::spawn(move || {
            prove(&scenario, &watch.0);
            watch.0.lock().ended = true;
        });
        Self { shared }
    }

    /// The best bound so far.
    pub fn best(&self) -> Option<Arc<Bound>> {
        self.shared.lock().best.clone()
    }

    /// How far the search for the bound has come, as a share of its work.
    pub fn share(&self) -> f64 {
        f64::from_bits(self.shared.has_come.load(Ordering::Relaxed))
    }

    /// Whether the search has come to its end, so that [`Proof::best`] will not change any more.
    pub fn has_ended(&self) -> bool {
        self.shared.lock().ended
    }

    /// Some schedule earns so many dollars: a bound that comes down to it is as low as any can be, and the search ends.
    pub fn knows(&self, profit_usd: f64) {
        self.shared.known_usd.store(profit_usd.to_bits(), Ordering::Relaxed);
    }

    /// Waits until the search has come to its end, but no longer than `patience`; whether it has.
    ///
    /// # Panics
    /// If the thread that proves did.
    pub fn wait(&self, patience: Duration) -> bool {
        let state = self.shared.lock();
        let goes_on = |state: &mut State| !state.ended && !state.panicked;
        let (state, _) = self
            .shared
            .ended
            .wait_timeout_while(state, patience, goes_on)
            .unwrap_or_else(PoisonError::into_inner);
        assert!(!state.panicked, "a proof comes to an end");
        state.ended
    }

    /// Asks the search to end, within about a tenth of a second; the best bound so far stays.
    pub fn stop(&self) {
        self.shared.stopped.request();
    }

    /// The best bound that a search for a plan may report that began at `begun` and had `limit` to take: the best by now. Where
    /// there is none at all yet, the first one is waited for, no longer than for most of a second past the limit.
    pub fn best_in_time(self, begun: Instant, limit: Duration) -> Option<Bound> {
        let latest = limit + GRACE;
        while self.best().is_none() && begun.elapsed() < latest && !self.wait(POLL_INTERVAL) {}
        self.outcome()
    }

    /// What has come of it by now: the best bound so far, none if there is none yet or the day is too large for any. The search ends
    /// if it has not.
    pub fn outcome(self) -> Option<Bound> {
        self.best().as_deref().cloned()
    }
}

impl Drop for Proof {
    fn drop(&mut self) {
        self.stop();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // No code that can panic runs while it is locked.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Tells the owner that the thread is over, however it ended.
struct Ending(Arc<Shared>);

impl Drop for Ending {
    fn drop(&mut self) {
        self.0.lock().panicked = std::thread::panicking();
        self.0.ended.notify_all();
    }
}

impl Watch for Shared {
    fn stopped(&self) -> &Stop {
        &self.stopped
    }

    fn has_come(&self, share: f64) {
        self.has_come.store(share.to_bits(), Ordering::Relaxed);
    }

    fn has_found(&self, bound: &Bound) {
        let bound = Arc::new(bound.clone());
        self.lock().best = Some(bound);
    }

    fn is_lowest(&self, bound_usd: f64) -> bool {
        bound_usd <= f64::from_bits(self.known_usd.load(Ordering::Relaxed)) + CENT_USD
    }
}

/// How long past its limit a plan waits for a first bound, and how often it looks.
const GRACE: Duration = Duration::from_millis(800);
const POLL_INTERVAL: Duration = Duration::from_millis(10);
/// Less than anyone would plan for.
const CENT_USD: f64 = 0.01;

impl Bound {
    /// Whether a profit is at the bound, to the cent: no schedule earns more.
    pub fn is_reached_by(&self, profit_usd: f64) -> bool {
        self.upper_bound_usd() <= profit_usd + CENT_USD
    }

    /// [`gap`] of a profit to this bound.
    pub fn gap(&self, profit_usd: f64) -> f64 {
        gap(self.upper_bound_usd(), profit_usd)
    }
}

/// Share of a bound by which a profit is below it. Where nothing can be earned, or only a loss be kept small, it is the share of
/// the loss that might be avoided, 0 to 1.
pub fn gap(bound_usd: f64, profit_usd: f64) -> f64 {
    if bound_usd > 0.0 {
        (bound_usd - profit_usd) / bound_usd
    } else if profit_usd < 0.0 {
        (bound_usd - profit_usd) / -profit_usd
    } else {
        0.0
    }
}

/// Searches for the bound with the finest slices that the day is not too large for; nothing is found if it is too large for all.
fn prove(scenario: &Scenario, watch: &Shared) {
    let mut steps = STEPS_MIN.into_iter().filter_map(|minutes| Step::from_minutes(minutes).ok());
    let Some(step) = steps.find(|&step| fits(scenario, step).is_ok()) else { return };
    if let Ok(Some(bound)) = search(scenario, step, watch) {
        watch.has_found(&bound);
    }
}

#[cfg(test)]
mod tests {
    use super::gap;

    #[test]
    fn a_gap_is_a_share_of_what_can_be_earned_or_of_the_loss() {
        for (bound_usd, profit_usd, share) in [
            (200.0, 150.0, 0.25),
            (200.0, -100.0, 1.5),
            (0.0, 0.0, 0.0),
            (0.0, -70.0, 1.0),
            // 100 $ of the loss cannot be helped, 25 $ can.
            (-100.0, -125.0, 0.2),
            (-100.0, -100.0, 0.0),
        ] {
            let found = gap(bound_usd, profit_usd);
            assert!((found - share).abs() < 1e-12, "{bound_usd}, {profit_usd}: {found}");
        }
    }
}
