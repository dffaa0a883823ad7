//! Progress bars with time left, on stderr, for people who watch. Nothing is drawn where stderr is no terminal, and
//! nothing for work that is over in a moment.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How long work must last before it gets a bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar that appears once the work has lasted a while.
pub(crate) struct Progress {
    bar: ProgressBar,
    begun: Instant,
}

impl Progress {
    /// A bar over `total` units, named in the plural.
    pub(crate) fn new(total: u64, unit: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        let template = format!(
            "{{bar:30}} {{human_pos}}/{{human_len}} {unit}  {{elapsed}} gone, {{eta}} left  {{msg}}"
        );
        bar.set_style(
            ProgressStyle::with_template(&template).expect("a template without mistakes"),
        );
        Self { bar, begun: Instant::now() }
    }

    /// `units` more are done.
    pub(crate) fn advance(&self, units: u64) {
        if self.bar.is_hidden() && self.begun.elapsed() > PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
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

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
