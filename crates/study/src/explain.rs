//! Where a day's money is, and where it is lost: demand that is spilled, stands that are full,
//! aircraft that wait; and what one more stand, aircraft, seat or a minute less would be worth on
//! this day.
//!
//! What a change is worth is measured by solving the changed day again, once by the policy and once
//! by the bound. The policy's difference is that of a single day, which chance moves by more than
//! most changes are worth; the bound's is that of what is possible (`explain/proven.rs`). A
//! [sweep](crate::sweep) measures changes over many days.

mod proven;
mod worth;

use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;
use vertifleet_core::{Scenario, Stop};
use vertifleet_optimize::{Bound, Step, upper_bound_unless};

use crate::account::Account;
use crate::error::Error;
use crate::resolved_policy::ResolvedPolicy;

use proven::{Across, Proven};
use worth::Change;

pub use worth::Worth;

/// The format of the explanation as JSON.
pub const FORMAT: &str = "vertifleet-explanation/1";

/// A day, explained.
#[derive(Debug, Clone, Serialize)]
pub struct Explanation {
    /// [`FORMAT`].
    pub format: &'static str,
    /// The numbers of the day as the policy played it, and what its stands are worth.
    #[serde(flatten)]
    pub account: Account,
    /// What no schedule of the day can pass, dollars. It may be a little lower than the bound of
    /// the day alone, because the bounds of the changed days prove something about the day too.
    pub upper_bound_usd: f64,
    /// The length of the bound's slices, seconds.
    pub bound_step_s: u32,
    /// What changes of the day are worth, by kind.
    pub worth: Vec<Worth>,
}

/// The most levels of charge of the bounds on days that charge as needed. More take several times
/// as long, and each explanation proves a dozen bounds or more.
const LEVELS: u16 = 16;

/// Plays a day with a policy, bounds it, and solves it again with one thing more or less at a time.
/// `solved` is called with the number of changes once they are known, and with 0 after each of
/// them, from any thread.
///
/// # Errors
/// Returns an error if the policy cannot play the day or the day is too large for a bound, and
/// [`Error::Stopped`] soon after `stop` is requested.
pub fn explain(
    scenario: &Arc<Scenario>,
    name: &str,
    policy: &ResolvedPolicy,
    slices: Step,
    stop: &Stop,
    solved: &(impl Fn(usize) + Sync),
) -> Result<Explanation, Error> {
    let slices = slices.with_levels(LEVELS)?;
    let (trace, totals) = policy.play(name, scenario, stop)?;
    let bound = bound_of(scenario, slices, stop)?;
    let changes = worth::changes(scenario, &bound);
    solved(changes.len());
    // A replay knows nothing of other days.
    let plays_again = !matches!(policy, ResolvedPolicy::Replay(_));
    let solve = |change: Change| {
        let again = plays_again.then(|| policy.play(name, &change.day, stop)).transpose()?;
        let policy_usd = again.map(|(_, again)| again.profit_usd - totals.profit_usd);
        let bounded = bound_of(&change.day, slices, stop)?;
        let across = Across::of((scenario, &bound), &change, &bounded, stop);
        if stop.is_requested() {
            return Err(Error::Stopped);
        }
        solved(0);
        Ok((change, policy_usd, bounded, across))
    };
    let solved = changes.into_par_iter().map(solve).collect::<Result<Vec<_>, Error>>()?;
    let bounds = solved.iter().map(|(change, _, bounded, _)| (change, bounded));
    let proven = Proven::of(scenario, &bound, bounds)?;
    let worth = solved.iter().map(|(change, policy_usd, bounded, across)| {
        let rise = proven.rise(change, bounded, across);
        Worth {
            change: change.words.clone(),
            cost_usd: change.cost_usd,
            policy_usd: *policy_usd,
            bound_usd: rise.usd,
            is_within_error: rise.is_within_error,
        }
    });
    Ok(Explanation {
        format: FORMAT,
        account: Account::of(scenario, name, trace, totals).with_worth_of_stands(proven.best()),
        upper_bound_usd: proven.upper_bound_usd(),
        bound_step_s: proven.best().step_s(),
        worth: worth.collect(),
    })
}

impl Explanation {
    /// The explanation as JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain data")
    }
}

fn bound_of(scenario: &Scenario, slices: Step, stop: &Stop) -> Result<Bound, Error> {
    upper_bound_unless(stop, scenario, slices)?.ok_or(Error::Stopped)
}
