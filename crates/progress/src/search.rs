//! The bar of a search for a schedule: how much of what it may take is gone, and how good the best schedule is.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use vertifleet_optimize::{Bound, SearchProgress};

use crate::Bar;

/// Units of the bar.
const WHOLE: u64 = 100;
/// How often the bar of a search with a limit of time moves on, whatever the search does meanwhile.
const TICK: Duration = Duration::from_millis(250);

/// Shows a search while this value lives.
pub struct SearchBar {
    shown: Arc<Shown>,
    _alive: Option<Sender<Infallible>>,
}

struct Shown {
    bar: Bar,
    done: AtomicU64,
}

impl SearchBar {
    /// The bar of a search that begins; `units` names hundredths of what it may take, which is time where there is a limit of it.
    pub fn new(units: &str, limit: Option<Duration>) -> Self {
        let bar = Bar::new(WHOLE, units);
        let shown = Arc::new(Shown { bar, done: AtomicU64::new(0) });
        let alive = limit.map(|limit| move_with_time(Arc::clone(&shown), limit));
        Self { shown, _alive: alive }
    }

    /// Says how far the search is, and how far from the bound where that is known.
    pub fn show(&mut self, now: &SearchProgress, bound: Option<&Bound>) {
        self.shown.advance_to(now.share);
        self.shown.bar.say(match bound {
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
        // The thread that moves it on may live a moment longer.
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

/// Moves a bar on until what is returned goes away: parts of a search may take seconds and say nothing.
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
