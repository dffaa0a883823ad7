//! `record`: plays days with a policy, and records every decision with its observation, for
//! learning.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::Stop;
use vertifleet_policy::Policy;
use vertifleet_study::{Error, PolicySpec, ResolveFor, ResolvedPolicy};

use crate::day::{Day, World};
use crate::days::Days;
use crate::failure::{Failure, warn};
use crate::frames::{count, table};
use crate::interruptible::{self, interruptible};
use crate::layout::Layout;
use crate::network::Network;
use crate::policy_source::{OwnCalls, policy_source};
use crate::whole_number::WholeNumber;

/// The decisions of one day.
#[derive(Default)]
struct Recorded {
    day: String,
    rows: Vec<f32>,
    masks: Vec<i8>,
    actions: Vec<i64>,
    rewards: Vec<f64>,
    values: Vec<f64>,
}

/// Plays the days with these numbers, and returns a dict: `days` (names), `decisions` (number of
/// each day), `rows` [D, W], `mask` [D, N], `action` [D], `reward` [D] (each flight's share of the
/// day's reward), and `values` [D, N] if they are requested. `policy` is a name, or with `source`
/// the name of a model or of a policy of the caller, which observes the days as days of `network`.
#[pyfunction]
#[pyo3(signature = (days, layout, policy, source, network, *, first, number, values, seed, threads))]
#[expect(clippy::too_many_arguments, reason = "the Python side gives them names and defaults")]
pub(crate) fn record<'py>(
    py: Python<'py>,
    days: &Days,
    layout: &Layout,
    policy: &str,
    source: Option<Bound<'py, PyAny>>,
    network: Option<PyRef<'py, Network>>,
    first: WholeNumber,
    number: WholeNumber,
    values: bool,
    seed: WholeNumber,
    threads: Option<WholeNumber>,
) -> PyResult<Bound<'py, PyDict>> {
    let calls = OwnCalls::default();
    let source = source
        .map(|source| policy_source(&source, policy, network.as_deref(), &calls))
        .transpose()?;
    let home = network.as_ref().map_or("random", |network| network.network.name());
    let spec = PolicySpec::parse(policy).map_err(Failure::from)?;
    let resolved = spec.resolve(source.as_ref(), ResolveFor::DaysOf(home), seed.of("seed")?);
    let resolved = resolved.map_err(Failure::from)?;
    let world = World::new(days, layout, "dense")?;
    let (first, number): (u64, u64) = (first.of("first")?, number.of("days")?);
    if number == 0 {
        return Err(Failure::argument("days must be at least 1, found 0".to_owned()).into());
    }
    world.days.check(first.saturating_add(number.saturating_sub(1)))?;
    let (width, vertiports) = (layout.layout.width(), world.vertiports());
    let name = policy.to_owned();
    let outcome = interruptible(py, interruptible::threads(threads)?, move |stop| {
        // Each day has a separate policy, so that no state passes from day to day.
        let play = |number| {
            let mut policy = resolved.build();
            recorded(&world, (&name, &resolved), policy.as_mut(), number, values, stop)
        };
        (first..first + number).into_par_iter().map(play).collect::<Result<Vec<_>, Error>>()
    })?;
    let days = calls.answered(outcome)?;
    for warning in calls.warnings() {
        warn(py, &warning)?;
    }
    arrays(py, &days, [width, vertiports], values)
}

/// The decisions of all days, one after the other.
fn arrays<'py>(
    py: Python<'py>,
    days: &[Recorded],
    [width, vertiports]: [usize; 2],
    values: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    let all = days.iter().map(|day| day.actions.len()).sum::<usize>();
    let decisions: Vec<i64> = days.iter().map(|day| count(day.actions.len())).collect();
    result.set_item("days", days.iter().map(|day| day.day.as_str()).collect::<Vec<_>>())?;
    result.set_item("decisions", decisions)?;
    let rows = PyArray1::<f32>::zeros(py, all * width, false);
    let mut end = 0;
    for day in days {
        let begin = end;
        end += day.rows.len();
        rows.readwrite().as_slice_mut()?[begin..end].copy_from_slice(&day.rows);
    }
    result.set_item("rows", rows.reshape([all, width])?)?;
    let masks = days.iter().flat_map(|day| day.masks.iter().copied());
    result.set_item("mask", table(py, masks, [all, vertiports])?)?;
    let actions = days.iter().flat_map(|day| day.actions.iter().copied());
    result.set_item("action", PyArray1::from_iter(py, actions))?;
    let rewards = days.iter().flat_map(|day| day.rewards.iter().copied());
    result.set_item("reward", PyArray1::from_iter(py, rewards))?;
    if values {
        let values = days.iter().flat_map(|day| day.values.iter().copied());
        result.set_item("values", table(py, values, [all, vertiports])?)?;
    }
    Ok(result)
}

/// Plays one day.
fn recorded(
    world: &World,
    (name, resolved): (&str, &ResolvedPolicy),
    policy: &mut dyn Policy,
    number: u64,
    values: bool,
    stop: &Stop,
) -> Result<Recorded, Error> {
    let mut day: Day = world.day(number)?;
    resolved.check_fits(day.day())?;
    let (layout, vertiports) = (&world.layout.layout, world.vertiports());
    let mut kept = Recorded { day: day.day().name.clone(), ..Recorded::default() };
    while !day.is_over() {
        if stop.is_requested() {
            return Err(Error::Stopped);
        }
        let (row, mask) = (kept.rows.len(), kept.masks.len());
        kept.rows.resize(row + layout.width(), 0.0);
        kept.masks.resize(mask + vertiports, 0);
        day.show(layout, &mut kept.rows[row..], &mut kept.masks[mask..]);
        let scene = day.scene();
        let stuck =
            |error| Error::of_play(name, &kept.day, vertifleet_policy::PlayError::from(error));
        let (decision, view) = (scene.decision(), scene.view());
        let choice = if values {
            let begin = kept.values.len();
            kept.values.resize(begin + vertiports, f64::NAN);
            let real = begin..begin + view.vertiports();
            policy.choose_with_values(decision, &view, &mut kept.values[real])
        } else {
            policy.choose(decision, &view)
        };
        let choice = choice.map_err(stuck)?;
        let outcome = day.step(choice.0.into(), world.reward);
        kept.actions.push(outcome.row.to.0.into());
        kept.rewards.push(outcome.reward);
    }
    Ok(kept)
}
