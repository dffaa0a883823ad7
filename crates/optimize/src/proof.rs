//! A bound that is proven in the background, for example while a plan is searched for.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use vertifleet_core::{Scenario, Stop};

use crate::bound::{Bound, CENT_USD, Watch, finest_bound};

/// The proof of a bound on a separate thread, with the finest slices for which the day is not too
/// large. The best bound so far is available at any time, as soon as there is a first one.
pub struct Proof {
    shared: Arc<Shared>,
}

/// The state that the thread and its owner share.
struct Shared {
    stopped: Stop,
    /// Share of the work that is done, as the bits of an `f64`.
    has_come: AtomicU64,
    /// The highest profit that is known to be possible, dollars, as the bits of an `f64`.
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
    /// Begins the proof.
    pub fn begin(scenario: &Arc<Scenario>) -> Self {
        let shared = Arc::new(Shared {
            stopped: Stop::default(),
            has_come: AtomicU64::new(0.0_f64.to_bits()),
            known_usd: AtomicU64::new(f64::NEG_INFINITY.to_bits()),
            state: Mutex::default(),
            ended: Condvar::new(),
        });
        let (scenario, watch) = (Arc::clone(scenario), Ending(Arc::clone(&shared)));
        // The thread is not joined, so that a caller in a hurry need not wait for it.
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

    /// Share of the work that the search for the bound has done.
    pub fn share(&self) -> f64 {
        f64::from_bits(self.shared.has_come.load(Ordering::Relaxed))
    }

    /// Whether the search has ended, so that [`Proof::best`] no longer changes.
    pub fn has_ended(&self) -> bool {
        self.shared.lock().ended
    }

    /// Records that some schedule earns this many dollars. A bound that has come down to it is as
    /// low as any can be, so the search ends.
    pub fn record_profit(&self, profit_usd: f64) {
        self.shared.known_usd.store(profit_usd.to_bits(), Ordering::Relaxed);
    }

    /// Waits until the search has ended, but no longer than `patience`. Returns whether it has
    /// ended.
    ///
    /// # Panics
    /// If the thread of the proof panicked.
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

    /// Asks the search to end, which takes about a tenth of a second. The best bound so far stays.
    pub fn stop(&self) {
        self.shared.stopped.request();
    }

    /// The best bound that a search for a plan may report that began at `begun` and had the time
    /// `limit`: the best one now. If there is none yet, the first one is waited for, but for less
    /// than a second past the limit.
    pub fn best_in_time(self, begun: Instant, limit: Duration) -> Option<Bound> {
        let latest = limit + GRACE;
        while self.best().is_none() && begun.elapsed() < latest && !self.wait(POLL_INTERVAL) {}
        self.outcome()
    }

    /// The best bound so far; `None` if there is none yet or the day is too large for any. Asks the
    /// search to end if it has not.
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
        // No code that can panic runs while the lock is held.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Signals the owner that the thread has ended, for any reason.
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

/// The time past its limit that a plan waits for a first bound.
const GRACE: Duration = Duration::from_millis(800);
/// The interval at which one who waits for a proof looks for the next thing to end the waiting.
pub(crate) const POLL_INTERVAL: Duration = Duration::from_millis(10);

/// Searches for the bound with the finest slices for which the day is not too large. Finds nothing
/// if it is too large for all.
fn prove(scenario: &Scenario, watch: &Shared) {
    if let Some(bound) = finest_bound(scenario, watch) {
        watch.has_found(&bound);
    }
}
