//! Progress bars for work that plays many days with many policies.

use vertifleet_study::Watch;

use crate::Bar;

/// One bar for each policy. A single bar could not show the time left, since one policy may need a
/// million times as long for a day as another, and the later policies' times are not known yet.
pub struct Bars;

impl Watch for Bars {
    type Bar = Box<dyn Fn() + Sync>;

    fn bounds(&self, days: usize) -> Self::Bar {
        bar(days, "bounds")
    }

    fn policy(&self, name: &str, position: usize, policies: usize, days: usize) -> Self::Bar {
        bar(days, format!("days of {name} ({position} of {policies} policies)"))
    }
}

fn bar(days: usize, units: impl Into<String>) -> Box<dyn Fn() + Sync> {
    let bar = Bar::new(days as u64, units);
    Box::new(move || bar.advance(1))
}
