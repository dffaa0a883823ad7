//! `Batch`: many days in parallel, advanced by several threads. The vector environment is built on
//! it.
//!
//! The observations of steps alternate between two sets of arrays, so that the observations of one
//! step stay unchanged during the next step. A third set is for resets of some slots, which happen
//! between two steps.

use std::sync::Mutex;

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use vertifleet_sim::DayTotals;

use crate::buffers::{ObservationRows, Observations, OutcomeRows, Outcomes};
use crate::day::{Day, Outcome, OutcomeFields, World};
use crate::days::Days;
use crate::failure::Failure;
use crate::frames::plain;
use crate::layout::Layout;
use crate::scenario::Scenario;
use crate::threads::Threads;
use crate::view::View;
use crate::whole_number::WholeNumber;

/// Number of days that one thread advances at a time. This is about ten microseconds of work, far
/// more than the cost of handing it to a thread.
const GRAIN: usize = 16;

/// The beginning of the day that follows a finished day.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Autoreset {
    /// The next step begins a new day and ignores the action.
    NextStep,
    /// The step that ends a day also begins a new one. The last observation of the old day goes to
    /// separate arrays.
    SameStep,
    /// The caller begins a new day.
    Disabled,
}

/// One position of the batch and the day that is played there.
#[derive(Default)]
struct Slot {
    day: Option<Day>,
    /// The totals of the day, if the latest step ended it.
    summary: Option<DayTotals>,
    /// The outcome of the latest step's choice; `None` if the step began a day instead.
    outcome: Option<Outcome>,
}

/// Many days in parallel.
#[pyclass(module = "vertifleet")]
pub(crate) struct Batch {
    world: World,
    autoreset: Autoreset,
    slots: Vec<Slot>,
    /// Two sets for steps, and one for resets of some slots.
    sets: [Observations; 3],
    /// The last observations of days that ended and were followed by another day in the same step.
    finals: Observations,
    outcomes: Outcomes,
    /// The index in `sets` of the set that the latest step, or the latest reset of all slots, wrote
    /// to.
    latest: usize,
    threads: Threads,
}

#[pymethods]
impl Batch {
    #[new]
    #[pyo3(signature = (days, layout, reward, slots, autoreset, threads = None))]
    fn new(
        py: Python<'_>,
        days: &Days,
        layout: &Layout,
        reward: &str,
        slots: WholeNumber,
        autoreset: &str,
        threads: Option<WholeNumber>,
    ) -> Result<Self, Failure> {
        let slots = slots.of("num_envs")?;
        let world = World::new(days, layout, reward)?;
        let autoreset = match autoreset {
            "NextStep" => Autoreset::NextStep,
            "SameStep" => Autoreset::SameStep,
            "Disabled" => Autoreset::Disabled,
            _ => {
                return Err(Failure::argument(format!("there is no autoreset mode {autoreset:?}")));
            }
        };
        if !(1..=1 << 20).contains(&slots) {
            return Err(Failure::argument(format!(
                "num_envs must be from 1 to 1048576, found {slots}"
            )));
        }
        let (width, vertiports) = (layout.layout.width(), world.vertiports());
        let set = || Observations::new(py, slots, width, vertiports);
        Ok(Self {
            sets: [set(), set(), set()],
            finals: set(),
            outcomes: Outcomes::new(py, slots),
            latest: 0,
            slots: std::iter::repeat_with(Slot::default).take(slots).collect(),
            threads: Threads::new(threads)?,
            autoreset,
            world,
        })
    }

    /// The arrays of the three sets of observations, of the final observations, and of the latest
    /// outcomes.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyTuple>; 5]> {
        let [first, second, third] = &self.sets;
        Ok([
            first.arrays(py)?,
            second.arrays(py)?,
            third.arrays(py)?,
            self.finals.arrays(py)?,
            self.outcomes.arrays(py)?,
        ])
    }

    /// Begins a day at each slot for which `which` is true: the day with the slot's number in
    /// `numbers`, or its scenario if these are given. Writes the observations of all slots, and
    /// returns the index of their set.
    fn reset(
        &mut self,
        py: Python<'_>,
        which: PyReadonlyArray1<'_, bool>,
        numbers: PyReadonlyArray1<'_, u64>,
        scenarios: Option<Vec<PyRef<'_, Scenario>>>,
    ) -> PyResult<usize> {
        let scenarios: Option<Vec<Scenario>> =
            scenarios.map(|days| days.iter().map(|day| (**day).clone()).collect());
        if let Some(scenarios) = &scenarios {
            self.one_each("option scenario", scenarios)?;
            scenarios.iter().try_for_each(|day| self.world.check_fits(&day.scenario))?;
        }
        let which = self.one_each("which", which.as_slice()?)?;
        let numbers = self.one_each("numbers", numbers.as_slice()?)?;
        self.check_numbers(numbers)?;
        if let Some(slot) =
            (0..self.slots.len()).find(|&at| !which[at] && self.slots[at].day.is_none())
        {
            let message =
                format!("environment {slot} has no day yet: the first reset must be of all");
            return Err(Failure::argument(message).into());
        }
        let set = if which.contains(&false) { 2 } else { self.next() };
        self.on_all(py, set, |world, slot, mut row, at| {
            row.pay(0.0, false, false, which[at]);
            match &scenarios {
                _ if !which[at] => {}
                Some(scenarios) => {
                    let day = world.given(&scenarios[at]);
                    slot.day = Some(day.expect("the scenarios have been checked"));
                }
                None => slot.begin(world, numbers[at]),
            }
            row.show(world, slot);
        })?;
        Ok(set)
    }

    /// Takes one decision at every slot. Where a new day is due, the day with the slot's number in
    /// `numbers` begins. Returns the index of the set of the observations, and whether any day is
    /// over or has begun.
    fn step(
        &mut self,
        py: Python<'_>,
        actions: PyReadonlyArray1<'_, i64>,
        numbers: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<(usize, bool)> {
        let actions = self.one_each("actions", actions.as_slice()?)?;
        let numbers = self.one_each("numbers", numbers.as_slice()?)?;
        self.check_numbers(numbers)?;
        self.check_can_step()?;
        let (autoreset, set) = (self.autoreset, self.next());
        let eventful = self.on_all(py, set, |world, slot, mut row, at| {
            if slot.is_over() && autoreset == Autoreset::NextStep {
                (slot.summary, slot.outcome) = (None, None);
                slot.begin(world, numbers[at]);
                row.pay(0.0, false, false, true);
                return row.show(world, slot);
            }
            let Outcome { reward, over, invalid, .. } = slot.step(world, actions[at]);
            let followed = over && autoreset == Autoreset::SameStep;
            row.pay(reward, over, invalid, followed);
            if followed {
                row.show_end(world, slot);
                slot.begin(world, numbers[at]);
            }
            row.show(world, slot);
        })?;
        Ok((set, eventful))
    }

    /// The day that is being played at a slot.
    fn scenario(&self, slot: usize) -> Option<Scenario> {
        self.slots.get(slot)?.day.as_ref().map(Day::scenario)
    }

    /// The view of the current decision of a slot.
    fn view(&self, slot: usize) -> Option<View> {
        self.slots.get(slot)?.day.as_ref().map(Day::view)
    }

    /// The outcome of the latest step's choice at a slot; `None` if the step began a day there
    /// instead.
    fn outcome(&self, slot: usize) -> Option<OutcomeFields> {
        self.slots.get(slot)?.outcome.as_ref().map(OutcomeFields::from)
    }

    /// The results of the day that the latest step ended at a slot, as `vertifleet simulate --json`
    /// prints them, or `None` if it ended no day there.
    fn summary<'py>(&self, py: Python<'py>, slot: usize) -> PyResult<Option<Bound<'py, PyAny>>> {
        let summary = self.slots.get(slot).and_then(|slot| slot.summary);
        summary.map(|summary| plain(py, &summary)).transpose()
    }
}

impl Batch {
    /// Checks that an argument has one entry for each slot.
    fn one_each<'a, T>(&self, name: &str, entries: &'a [T]) -> Result<&'a [T], Failure> {
        if entries.len() == self.slots.len() {
            return Ok(entries);
        }
        let (expected, found) = (self.slots.len(), entries.len());
        Err(Failure::argument(format!("{name} must have {expected} entries, found {found}")))
    }

    /// Checks that there is a day for every number.
    fn check_numbers(&self, numbers: &[u64]) -> Result<(), Failure> {
        numbers.iter().try_for_each(|&number| self.world.days.check(number))
    }

    fn check_can_step(&self) -> Result<(), Failure> {
        let waits = self.autoreset == Autoreset::Disabled;
        let stuck = |slot: &Slot| slot.day.is_none() || (waits && slot.is_over());
        match self.slots.iter().position(stuck) {
            Some(slot) => Err(Failure::argument(format!(
                "environment {slot} has no day in progress: call reset, with options={{\"reset_mask\": mask}} for some of them"
            ))),
            None => Ok(()),
        }
    }

    /// Switches to the other of the two sets for steps, and returns its index.
    fn next(&mut self) -> usize {
        self.latest = 1 - self.latest;
        self.latest
    }

    /// Calls `each` for every slot, on all threads if there are more than [`GRAIN`] slots. The
    /// observations go to the set with index `set`. Returns whether any day is over or has begun.
    fn on_all(
        &mut self,
        py: Python<'_>,
        set: usize,
        each: impl Fn(&World, &mut Slot, Row<'_, '_>, usize) + Sync,
    ) -> PyResult<bool> {
        let Self { world, slots, sets, finals, outcomes, threads, .. } = self;
        let (mut observations_lent, mut finals_lent, mut outcomes_lent) =
            (sets[set].lend(py)?, finals.lend(py)?, outcomes.lend(py)?);
        let (observations, finals, outcomes) =
            (observations_lent.rows()?, finals_lent.rows()?, outcomes_lent.rows()?);
        let part = Part { slots, observations, finals, outcomes, first: 0 };
        let world = &*world;
        let each = |slot: &mut Slot, row: Row<'_, '_>, at: usize| each(world, slot, row, at);
        py.detach(|| {
            if part.slots.len() <= GRAIN {
                return part.each(&each);
            }
            let shares = Shares::of(part, threads.number());
            threads.all(|thread| shares.each(thread, &each));
        });
        let OutcomeRows { over, begun, .. } = outcomes_lent.rows()?;
        Ok(over.iter().chain(&*begun).any(|&flag| flag))
    }
}

impl Slot {
    fn is_over(&self) -> bool {
        self.day.as_ref().is_some_and(Day::is_over)
    }

    fn show(&mut self, world: &World, (row, mask): (&mut [f32], &mut [i8])) {
        self.day.as_mut().expect("every slot has a day").show(&world.layout.layout, row, mask);
    }

    fn begin(&mut self, world: &World, number: u64) {
        self.day = Some(world.day(number).expect("numbers have been checked"));
    }

    fn step(&mut self, world: &World, action: i64) -> Outcome {
        let day = self.day.as_mut().expect("every slot has a day in progress");
        let outcome = *self.outcome.insert(day.step(action, world.reward));
        self.summary = outcome.over.then(|| day.totals());
        outcome
    }
}

/// A part of the slots, with their rows of all arrays.
struct Part<'a> {
    slots: &'a mut [Slot],
    observations: ObservationRows<'a>,
    finals: ObservationRows<'a>,
    outcomes: OutcomeRows<'a>,
    /// Position of the first of these slots in the batch.
    first: usize,
}

impl Part<'_> {
    /// Calls `each` for one slot after the other.
    fn each(self, each: &impl Fn(&mut Slot, Row<'_, '_>, usize)) {
        let Self { slots, mut observations, mut finals, mut outcomes, first } = self;
        let (observations, finals, outcomes) = (&mut observations, &mut finals, &mut outcomes);
        for (at, slot) in slots.iter_mut().enumerate() {
            each(slot, Row { at, observations, finals, outcomes }, first + at);
        }
    }

    fn split(self, middle: usize) -> (Self, Self) {
        let (slots, other_slots) = self.slots.split_at_mut(middle);
        let (observations, other_observations) = self.observations.split(middle);
        let (finals, other_finals) = self.finals.split(middle);
        let (outcomes, other_outcomes) = self.outcomes.split(middle);
        let other = Self {
            slots: other_slots,
            observations: other_observations,
            finals: other_finals,
            outcomes: other_outcomes,
            first: self.first + middle,
        };
        (Self { slots, observations, finals, outcomes, first: self.first }, other)
    }
}

/// One share of the batch for each thread. The shares are the same in every step, so that the days
/// of a share stay in the cache of the same core.
struct Shares<'a>(Vec<Mutex<Option<Part<'a>>>>);

impl<'a> Shares<'a> {
    fn of(mut part: Part<'a>, threads: usize) -> Self {
        let mut shares = Vec::with_capacity(threads);
        for left in (1..threads).rev() {
            let slots = part.slots.len().div_ceil(left + 1);
            let (share, others) = part.split(slots);
            shares.push(Mutex::new(Some(share)));
            part = others;
        }
        shares.push(Mutex::new(Some(part)));
        Self(shares)
    }

    /// Calls `each` for every slot of the thread's share, and then for the slots of other shares
    /// that no thread has taken yet.
    fn each(&self, thread: usize, each: &(impl Fn(&mut Slot, Row<'_, '_>, usize) + Sync)) {
        let others = (thread..self.0.len()).chain(0..thread);
        for share in others.map(|share| &self.0[share]) {
            while let Some(part) = take(share) {
                part.each(each);
            }
        }
    }
}

/// Takes up to [`GRAIN`] slots from a share.
fn take<'a>(share: &Mutex<Option<Part<'a>>>) -> Option<Part<'a>> {
    let mut share = share.lock().expect("no thread ends while it takes a part");
    let part = share.take()?;
    if part.slots.len() <= GRAIN {
        return Some(part);
    }
    let (first, others) = part.split(GRAIN);
    *share = Some(others);
    Some(first)
}

/// One slot's row of all arrays.
struct Row<'part, 'a> {
    at: usize,
    observations: &'part mut ObservationRows<'a>,
    finals: &'part mut ObservationRows<'a>,
    outcomes: &'part mut OutcomeRows<'a>,
}

impl Row<'_, '_> {
    fn pay(&mut self, reward: f64, over: bool, invalid: bool, begun: bool) {
        self.outcomes.rewards[self.at] = reward;
        self.outcomes.over[self.at] = over;
        self.outcomes.invalid[self.at] = invalid;
        self.outcomes.begun[self.at] = begun;
    }

    fn show(&mut self, world: &World, slot: &mut Slot) {
        slot.show(world, self.observations.row(self.at));
    }

    /// Writes the last observation of a day that is followed by another day in the same step.
    fn show_end(&mut self, world: &World, slot: &mut Slot) {
        slot.show(world, self.finals.row(self.at));
    }
}
