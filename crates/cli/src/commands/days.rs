//! What commands share that play many days with many policies: bounds and play, each with a bar, and the command as typed.

use std::sync::Arc;

use rayon::prelude::*;
use vertifleet_core::Scenario;
use vertifleet_optimize::Step;
use vertifleet_study::PolicyRecord;
use vertifleet_study::run::{Contenders, Day, run as play_all};

use crate::failure::Failure;
use crate::kept_bounds::KeptBounds;
use crate::progress::Progress;

/// Plays every day with everybody. A bar for each, since a day of one may take a million times as long as that of another:
/// how long those take that come later is not known.
pub(super) fn play(
    days: &[Day],
    contenders: &Contenders<'_>,
    number: usize,
) -> Result<Vec<PolicyRecord>, Failure> {
    let mut begun = 0;
    let policies = play_all(days, contenders, |name| {
        begun += 1;
        let units = format!("days of {name} ({begun} of {number} policies)");
        let progress = Progress::new(days.len() as u64, units);
        move || progress.advance(1)
    })?;
    Ok(policies)
}

/// The days with their upper bounds.
pub(super) fn bounded(scenarios: Vec<Arc<Scenario>>, step: Step) -> Result<Vec<Day>, Failure> {
    let kept = KeptBounds::of_this_user();
    let progress = Progress::new(scenarios.len() as u64, "bounds");
    let bound = |scenario: Arc<Scenario>| {
        let upper_bound_usd = kept.upper_bound_usd(&scenario, step)?;
        progress.advance(1);
        Ok(Day { scenario, upper_bound_usd: Some(upper_bound_usd) })
    };
    scenarios.into_par_iter().map(bound).collect()
}

/// The command as anyone can type it, wherever the program lies.
pub(super) fn command() -> String {
    std::iter::once("vertifleet".to_owned())
        .chain(std::env::args().skip(1))
        .collect::<Vec<_>>()
        .join(" ")
}
