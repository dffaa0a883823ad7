//! A progress bar with the time left, on stderr. It is not drawn if stderr is not a terminal, or
//! for work that is done in a moment.

use std::convert::Infallible;
use std::fmt::Write;
use std::io::{IsTerminal as _, stderr};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// How long work must last before its bar appears.
const SHOWN_AFTER: Duration = Duration::from_secs(1);
/// How often a bar is drawn again while nothing else changes, so that its times advance.
const TICK: Duration = Duration::from_secs(1);
const TEMPLATE: &str =
    "{bar:30} {human_pos}/{human_len} {prefix}  {elapsed} gone, {left} left  {msg}";

/// A bar that appears once the work has lasted a while, and disappears when it is dropped.
pub struct Bar {
    drawn: ProgressBar,
    pace: Arc<Mutex<Pace>>,
    _alive: Option<Sender<Infallible>>,
}

impl Bar {
    /// Creates a bar over `total` units of work that take about the same time each; `units` names
    /// them.
    pub fn new(total: u64, units: impl Into<String>) -> Self {
        let pace = Arc::new(Mutex::new(Pace::begin(total)));
        let shown = Arc::clone(&pace);
        let time_left = move |_: &ProgressState, text: &mut dyn Write| {
            let written = match locked(&shown).time_left(Instant::now()) {
                Some(left) => write!(text, "{:#}", HumanDuration(left)),
                None => text.write_char('?'),
            };
            written.expect("a String takes any text");
        };
        let style = ProgressStyle::with_template(TEMPLATE).expect("a template without mistakes");
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden())
            .with_prefix(units.into())
            .with_style(style.with_key("left", time_left));
        let alive = stderr().is_terminal().then(|| appear_late(bar.clone()));
        Self { drawn: bar, pace, _alive: alive }
    }

    /// Records that `units` more are done.
    pub fn advance(&self, units: u64) {
        locked(&self.pace).advance(units, Instant::now());
        self.drawn.inc(units);
    }

    /// Records units that an earlier run did, which do not count for the time left.
    pub fn already_done(&self, units: u64) {
        locked(&self.pace).skip(units);
        self.drawn.set_position(units);
    }

    /// Shows a message next to the bar.
    pub fn show_message(&self, message: String) {
        self.drawn.set_message(message);
    }
}

impl Bar {
    /// Removes the bar permanently.
    pub(crate) fn clear(&self) {
        self.drawn.finish_and_clear();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.clear();
    }
}

/// Draws a bar once it has lasted a while, unless the returned value is dropped sooner.
fn appear_late(bar: ProgressBar) -> Sender<Infallible> {
    let (alive, gone) = channel();
    thread::spawn(move || {
        let waited = gone.recv_timeout(SHOWN_AFTER);
        if waited == Err(RecvTimeoutError::Timeout) && !bar.is_finished() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(TICK);
        }
    });
    alive
}

fn locked(pace: &Mutex<Pace>) -> MutexGuard<'_, Pace> {
    pace.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The mean time of a unit so far. The bar's own estimate forgets a unit within seconds, but units
/// may last minutes.
struct Pace {
    begun: Instant,
    /// The time at which the last unit was done.
    last: Instant,
    done: u64,
    remaining: u64,
}

impl Pace {
    fn begin(total: u64) -> Self {
        let now = Instant::now();
        Self { begun: now, last: now, done: 0, remaining: total }
    }

    fn advance(&mut self, units: u64, now: Instant) {
        self.done += units;
        self.skip(units);
        self.last = now;
    }

    /// Takes `units` off what remains without counting them as done.
    fn skip(&mut self, units: u64) {
        self.remaining = self.remaining.saturating_sub(units);
    }

    /// The time left, which is not known before the first unit is done.
    fn time_left(&self, now: Instant) -> Option<Duration> {
        if self.done == 0 {
            return None;
        }
        let unit_s = (self.last - self.begun).as_secs_f64() / self.done as f64;
        let left_s = unit_s * self.remaining as f64 - (now - self.last).as_secs_f64();
        Some(Duration::from_secs_f64(left_s.max(0.0)))
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::Pace;

    #[test]
    fn the_time_left_follows_the_units_done_and_counts_down_between_them() {
        let mut pace = Pace::begin(8);
        let at = |seconds| pace.begun + Duration::from_secs(seconds);
        let (first, soon, late) = (at(30), at(40), at(500));
        assert_eq!(pace.time_left(first), None);
        pace.advance(2, first);
        assert_eq!(pace.time_left(first), Some(Duration::from_secs(90)));
        assert_eq!(pace.time_left(soon), Some(Duration::from_secs(80)));
        assert_eq!(pace.time_left(late), Some(Duration::ZERO));
    }
}
