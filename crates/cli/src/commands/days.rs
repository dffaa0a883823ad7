//! What commands share that play many days with many policies: a bar for each of them, and the command as typed.

use vertifleet_study::comparison::Watch;

use crate::progress::Progress;

/// Bars on the terminal. One for each policy, since a day of one may take a million times as long as that of another: how long
/// those take that come later is not known.
pub(super) struct Bars;

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
    let progress = Progress::new(days as u64, units);
    Box::new(move || progress.advance(1))
}

/// The command as anyone can type it, wherever the program lies.
pub(super) fn command() -> String {
    std::iter::once("vertifleet".to_owned())
        .chain(std::env::args().skip(1))
        .collect::<Vec<_>>()
        .join(" ")
}
