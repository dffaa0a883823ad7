//! The progress bar of a search for a schedule: the share of its budget that is used, and how good
//! the best schedule is.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use vertifleet_optimize::{Bound, SearchProgress};

use crate::Bar;

/// Number of units of the bar.
const WHOLE: u64 = 100;
/// How often the bar of a search with a time limit advances, even if the search reports nothing.
const TICK: Duration = Duration::from_millis(250);

/// Shows the progress of a search until it is dropped.
pub struct SearchBar {
    shown: Arc<Shown>,
    _alive: Option<Sender<Infallible>>,
}

struct Shown {
    bar: Bar,
    done: AtomicU64,
}

impl SearchBar {
    /// Creates the bar of a search; `units` names hundredths of its budget, which is time if there
    /// is a time limit.
    pub fn new(units: &str, limit: Option<Duration>) -> Self {
        let bar = Bar::new(WHOLE, units);
        let shown = Arc::new(Shown { bar, done: AtomicU64::new(0) });
        let alive = limit.map(|limit| move_with_time(Arc::clone(&shown), limit));
        Self { shown, _alive: alive }
    }

    /// Shows how far the search is, and the gap to the bound if the bound is known.
    pub fn show(&mut self, now: &SearchProgress, bound: Option<&Bound>) {
        self.shown.advance_to(now.share);
        self.shown.bar.show_message(match bound {
            Some(bound) => format!(
                "profit ${:.0}, bound ${:.0}, gap {:.2} %",
                now.profit_usd,
                bound.upper_bound_usd(),
                100.0 * bound.gap(now.profit_usd)
            ),
            None => format!("profit ${:.0}, bound not known yet", now.profit_usd),
        });
    }
}

impl Drop for SearchBar {
    fn drop(&mut self) {
        // The thread that advances the bar may live a moment longer, so the bar is removed here.
        self.shown.bar.clear();
    }
}

impl Shown {
    fn advance_to(&self, share: f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share")]
        let done = (share.min(1.0) * WHOLE as f64) as u64;
        let before = self.done.fetch_max(done, Ordering::Relaxed);
        self.bar.advance(done.saturating_sub(before));
    }
}

/// Advances a bar with the time until the returned value is dropped, because a search may report
/// nothing for seconds.
fn move_with_time(shown: Arc<Shown>, limit: Duration) -> Sender<Infallible> {
    let (alive, gone) = channel();
    let begun = Instant::now();
    thread::spawn(move || {
        while gone.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
            shown.advance_to(begun.elapsed().as_secs_f64() / limit.as_secs_f64().max(1e-9));
        }
    });
    alive
}
