//! Plays many days side by side with a policy that is asked about all of them at once, which is how
//! networks in Python decide fast.

use std::sync::Arc;
use std::time::Instant;

use vertifleet_core::{Stop, VertiportIx};
use vertifleet_policy::{PlayError, Policy, PolicyError};
use vertifleet_sim::Simulation;

use super::{BoundedDay, Kept, latency, record};
use crate::error::Error;
use crate::record::{DayRecord, LatencySummary};
use crate::resolved_policy::ResolvedPolicy;

/// The most days that are played side by side.
const MOST: usize = 256;

/// A day in progress.
struct DayInPlay<'a> {
    day: &'a BoundedDay,
    simulation: Simulation,
    choices: Vec<VertiportIx>,
    keeps_choices: bool,
}

impl<'a> DayInPlay<'a> {
    fn begin(day: &'a BoundedDay, keeps_choices: bool) -> Self {
        let simulation = Simulation::new(Arc::clone(&day.scenario));
        Self { day, simulation, choices: Vec::new(), keeps_choices }
    }
}

/// Plays all days. The time of a decision is its share of the time of its batch.
pub(super) fn play(
    name: &str,
    policy: &ResolvedPolicy,
    days: &[BoundedDay],
    kept: Kept,
    stop: &Stop,
    played: &(impl Fn() + Sync),
) -> Result<(Vec<DayRecord>, LatencySummary), Error> {
    let (mut records, mut nanoseconds) = (Vec::with_capacity(days.len()), Vec::new());
    let mut waiting = days.iter().enumerate();
    loop {
        let next = waiting.by_ref().take(MOST);
        let mut batch: Vec<DayInPlay<'_>> =
            next.map(|(position, day)| DayInPlay::begin(day, kept.has_choices(position))).collect();
        if batch.is_empty() {
            break;
        }
        let mut built = policy.build();
        while step(name, built.as_mut(), &mut batch, stop, &mut nanoseconds)? {}
        for DayInPlay { day, simulation, choices, .. } in batch {
            records.push(record(day, &simulation, choices));
            played();
        }
    }
    Ok((records, latency(nanoseconds)))
}

/// Takes one decision of each day that is not over. Returns whether there was any.
fn step(
    name: &str,
    policy: &mut dyn Policy,
    batch: &mut [DayInPlay<'_>],
    stop: &Stop,
    nanoseconds: &mut Vec<u64>,
) -> Result<bool, Error> {
    if stop.is_requested() {
        return Err(Error::Stopped);
    }
    let decisions: Vec<_> = batch.iter_mut().map(|day| day.simulation.next_decision()).collect();
    let asked = decisions.iter().zip(&*batch);
    let mut asked = asked.filter_map(|(decision, day)| Some(((*decision)?, day.simulation.view())));
    let (start, mut choices) = (Instant::now(), Vec::new());
    let answered = policy.choose_batch(&mut asked, &mut choices);
    drop(asked);
    let stuck = |cause| Error::of_play(name, &batch[0].day.scenario.name, cause);
    answered.map_err(|error: PolicyError| stuck(PlayError::from(error)))?;
    let share_ns = start.elapsed().as_nanos() / choices.len().max(1) as u128;
    nanoseconds.extend(choices.iter().map(|_| u64::try_from(share_ns).unwrap_or(u64::MAX)));
    let waiting = decisions.iter().zip(batch).filter(|(decision, _)| decision.is_some());
    for ((_, day), &choice) in waiting.zip(&choices) {
        let row = day.simulation.apply(choice).map_err(|refusal| {
            Error::of_play(name, &day.day.scenario.name, PlayError::from(refusal))
        })?;
        if day.keeps_choices {
            day.choices.push(row.to);
        }
    }
    Ok(!choices.is_empty())
}
