//! Progress bars with time left, on stderr, for people who watch. Nothing is drawn where stderr is no terminal, and
//! nothing for work that is over in a moment.

use std::fmt::Write;
use std::thread;
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// How long work must last before it gets a bar.
const PATIENCE: Duration = Duration::from_secs(1);
/// How often a bar is drawn anew while nothing else changes, so that its times go on.
const TICK: Duration = Duration::from_secs(1);
const TEMPLATE: &str =
    "{bar:30} {human_pos}/{human_len} {prefix}  {elapsed} gone, {left} left  {msg}";

/// A bar that appears once the work has lasted a while, and goes away with this value.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar over `total` units of work that take about the same time each; `units` names them.
    pub(crate) fn new(total: u64, units: impl Into<String>) -> Self {
        let style = ProgressStyle::with_template(TEMPLATE).expect("a template without mistakes");
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden())
            .with_prefix(units.into())
            .with_style(style.with_key("left", time_left));
        let late = bar.clone();
        thread::spawn(move || {
            thread::sleep(PATIENCE);
            if !late.is_finished() {
                late.set_draw_target(ProgressDrawTarget::stderr());
                late.enable_steady_tick(TICK);
            }
        });
        Self { bar }
    }

    /// `units` more are done.
    pub(crate) fn advance(&self, units: u64) {
        self.bar.inc(units);
    }

    /// Work already done in an earlier run, not counted into the time left.
    pub(crate) fn already_done(&self, units: u64) {
        self.bar.set_position(units);
        self.bar.reset_eta();
    }

    /// Says something beside the bar.
    pub(crate) fn say(&self, message: String) {
        self.bar.set_message(message);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Nobody knows before the first unit is done.
fn time_left(state: &ProgressState, text: &mut dyn Write) {
    let written = if state.pos() == 0 {
        text.write_char('?')
    } else {
        write!(text, "{:#}", HumanDuration(state.eta()))
    };
    written.expect("a String takes any text");
}
