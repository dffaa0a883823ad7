//! The bar of a search for a schedule: how much of what it may take is gone, and how good the best schedule is.

use vertifleet_optimize::{Bound, Progress};

use crate::Bar;

/// Units of the bar.
const WHOLE: u64 = 100;

/// Shows a search while this value lives.
pub struct SearchBar {
    bar: Bar,
    shown: u64,
}

impl SearchBar {
    /// The bar of a search that begins; `units` names hundredths of what it may take.
    pub fn new(units: &str) -> Self {
        Self { bar: Bar::new(WHOLE, units), shown: 0 }
    }

    /// Says how far the search is, and how far from the bound where that is known.
    pub fn show(&mut self, now: &Progress, bound: Option<&Bound>) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share")]
        let done = (now.share * WHOLE as f64) as u64;
        self.bar.advance(done.saturating_sub(self.shown));
        self.shown = done;
        self.bar.say(match bound {
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
