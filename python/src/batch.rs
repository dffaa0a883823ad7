//! `Batch`: many days side by side, advanced by as many threads as there are; what the vector environment is made of.
//!
//! Observations of steps alternate between two sets of arrays, so that those of a step stay as they are while the next one is taken.
//! A third set is for resets of some seats, which come between two steps.

use std::sync::{Arc, Mutex};

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use vertifleet_core::DaySeed;
use vertifleet_sim::DayTotals;

use crate::buffers::{Observations, Outcomes, Paying, Showing};
use crate::environment::{Day, Outcome, World};
use crate::failure::Failure;
use crate::frames::plain;
use crate::network::Network;
use crate::scenario::Scenario;
use crate::shown::Shown;
use crate::threads::Threads;
use crate::whole::Whole;

/// Days that one thread advances at a time: some ten microseconds of work, far more than it costs to share it out.
const GRAIN: usize = 16;

/// What becomes of a day that is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Autoreset {
    /// The next step begins a new one, whatever the action.
    NextStep,
    /// The step that ends it begins a new one; how it ended is shown apart.
    SameStep,
    /// The caller begins a new one.
    Disabled,
}

/// A place of the batch and the day that is played there.
#[derive(Default)]
struct Seat {
    day: Option<Day>,
    /// The numbers of the day that the latest step ended.
    summary: Option<DayTotals>,
}

/// Many days side by side.
#[pyclass(module = "vertifleet")]
pub(crate) struct Batch {
    world: World,
    autoreset: Autoreset,
    seats: Vec<Seat>,
    /// Two for steps, one for resets of some seats.
    sets: [Observations; 3],
    /// How days ended that were followed by others in the same step.
    finals: Observations,
    outcomes: Outcomes,
    /// The set that the latest step wrote to.
    latest: usize,
    threads: Threads,
}

#[pymethods]
impl Batch {
    #[new]
    #[pyo3(signature = (network, reward, seats, autoreset, threads = None))]
    fn new(
        py: Python<'_>,
        network: &Network,
        reward: &str,
        seats: Whole,
        autoreset: &str,
        threads: Option<Whole>,
    ) -> Result<Self, Failure> {
        let seats = seats.of("num_envs")?;
        let world = World::new(network, reward)?;
        let autoreset = match autoreset {
            "NextStep" => Autoreset::NextStep,
            "SameStep" => Autoreset::SameStep,
            "Disabled" => Autoreset::Disabled,
            _ => {
                return Err(Failure::argument(format!("there is no autoreset mode {autoreset:?}")));
            }
        };
        if !(1..=1 << 20).contains(&seats) {
            return Err(Failure::argument(format!(
                "num_envs must be from 1 to 1048576, found {seats}"
            )));
        }
        let vertiports = world.vertiports();
        let set = || Observations::new(py, seats, vertiports);
        Ok(Self {
            sets: [set(), set(), set()],
            finals: set(),
            outcomes: Outcomes::new(py, seats),
            latest: 0,
            seats: std::iter::repeat_with(Seat::default).take(seats).collect(),
            threads: Threads::new(threads)?,
            autoreset,
            world,
        })
    }

    /// The arrays of the three sets of observations, of the final observations, and of the latest outcomes.
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

    /// Begins days at the seats that `which` has, the training days of these numbers or a given one; every seat shows where it is.
    /// Returns the set.
    fn reset(
        &mut self,
        py: Python<'_>,
        which: PyReadonlyArray1<'_, bool>,
        numbers: PyReadonlyArray1<'_, u64>,
        scenario: Option<&Scenario>,
    ) -> PyResult<usize> {
        if let Some(scenario) = scenario {
            self.world.network.check_fits(&scenario.scenario)?;
        }
        let which = self.one_each("which", which.as_slice()?)?;
        let numbers = self.one_each("numbers", numbers.as_slice()?)?;
        check_numbers(numbers)?;
        if let Some(seat) =
            (0..self.seats.len()).find(|&at| !which[at] && self.seats[at].day.is_none())
        {
            let message =
                format!("environment {seat} has no day yet: the first reset must be of all");
            return Err(Failure::argument(message).into());
        }
        let set = if which.contains(&false) { 2 } else { self.next() };
        self.on_all(py, set, |world, seat, mut row, at| {
            row.pay(0.0, false, false, which[at]);
            match scenario {
                _ if !which[at] => {}
                Some(scenario) => seat.day = Some(Day::new(Arc::clone(&scenario.scenario))),
                None => seat.begin(world, numbers[at]),
            }
            row.show(world, seat);
        })?;
        Ok(set)
    }

    /// Takes a decision at every seat; `numbers` are of the training days that begin where one is due. Returns the set, and whether
    /// any day is over or has begun.
    fn step(
        &mut self,
        py: Python<'_>,
        actions: PyReadonlyArray1<'_, i64>,
        numbers: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<(usize, bool)> {
        let actions = self.one_each("actions", actions.as_slice()?)?;
        let numbers = self.one_each("numbers", numbers.as_slice()?)?;
        check_numbers(numbers)?;
        self.check_can_step()?;
        let (autoreset, set) = (self.autoreset, self.next());
        let eventful = self.on_all(py, set, |world, seat, mut row, at| {
            if seat.is_over() && autoreset == Autoreset::NextStep {
                seat.summary = None;
                seat.begin(world, numbers[at]);
                row.pay(0.0, false, false, true);
                return row.show(world, seat);
            }
            let Outcome { reward, over, invalid, .. } = seat.step(world, actions[at]);
            let followed = over && autoreset == Autoreset::SameStep;
            row.pay(reward, over, invalid, followed);
            if followed {
                row.show_end(world, seat);
                seat.begin(world, numbers[at]);
            }
            row.show(world, seat);
        })?;
        Ok((set, eventful))
    }

    /// The day that is being played at a seat.
    fn scenario(&self, seat: usize) -> Option<Scenario> {
        self.seats.get(seat)?.day.as_ref().map(Day::scenario)
    }

    /// The numbers of the day that the latest step ended at a seat, as `vertifleet simulate --json` prints them.
    fn summary<'py>(&self, py: Python<'py>, seat: usize) -> PyResult<Option<Bound<'py, PyAny>>> {
        let summary = self.seats.get(seat).and_then(|seat| seat.summary);
        summary.map(|summary| plain(py, &summary)).transpose()
    }
}

impl Batch {
    /// An argument that must have an entry for each seat.
    fn one_each<'a, T>(&self, name: &str, entries: &'a [T]) -> Result<&'a [T], Failure> {
        if entries.len() == self.seats.len() {
            return Ok(entries);
        }
        let (expected, found) = (self.seats.len(), entries.len());
        Err(Failure::argument(format!("{name} must have {expected} entries, found {found}")))
    }

    fn check_can_step(&self) -> Result<(), Failure> {
        let waits = self.autoreset == Autoreset::Disabled;
        let stuck = |seat: &Seat| seat.day.is_none() || (waits && seat.is_over());
        match self.seats.iter().position(stuck) {
            Some(seat) => Err(Failure::argument(format!(
                "environment {seat} has no day in progress: call reset, with options={{\"reset_mask\": mask}} for some of them"
            ))),
            None => Ok(()),
        }
    }

    /// The set that is written to next.
    fn next(&mut self) -> usize {
        self.latest = 1 - self.latest;
        self.latest
    }

    /// Does something at every seat, on all threads if there are enough seats, and writes to a set. Returns whether any day is over or
    /// has begun.
    fn on_all(
        &mut self,
        py: Python<'_>,
        set: usize,
        each: impl Fn(&World, &mut Seat, Row<'_, '_>, usize) + Sync,
    ) -> PyResult<bool> {
        let Self { world, seats, sets, finals, outcomes, threads, .. } = self;
        let (mut showing, mut ending, mut outcomes) =
            (sets[set].lend(py)?, finals.lend(py)?, outcomes.lend(py)?);
        let (showing, ending, paying) = (showing.rows()?, ending.rows()?, outcomes.rows()?);
        let part = Part { seats, showing, ending, paying, first: 0 };
        let world = &*world;
        let each = |seat: &mut Seat, row: Row<'_, '_>, at: usize| each(world, seat, row, at);
        py.detach(|| {
            if part.seats.len() <= GRAIN {
                return part.each(&each);
            }
            let shares = Shares::of(part, threads.number());
            threads.all(|thread| shares.each(thread, &each));
        });
        let Paying { over, begun, .. } = outcomes.rows()?;
        Ok(over.iter().chain(&*begun).any(|&flag| flag))
    }
}

/// Numbers of training days.
fn check_numbers(numbers: &[u64]) -> Result<(), Failure> {
    Ok(numbers.iter().try_for_each(|&number| DaySeed::training_number(number).map(|_| ()))?)
}

impl Seat {
    fn is_over(&self) -> bool {
        self.day.as_ref().is_some_and(Day::is_over)
    }

    fn show(&self, world: &World, to: Shown<'_>) {
        self.day.as_ref().expect("every seat has a day").show(&world.scales, to);
    }

    fn begin(&mut self, world: &World, number: u64) {
        self.day = Some(world.day(number).expect("numbers have been checked"));
    }

    fn step(&mut self, world: &World, action: i64) -> Outcome {
        let day = self.day.as_mut().expect("every seat has a day in progress");
        let outcome = day.step(action, world.reward);
        self.summary = outcome.over.then(|| day.totals());
        outcome
    }
}

/// Some seats with their rows of all arrays.
struct Part<'a> {
    seats: &'a mut [Seat],
    showing: Showing<'a>,
    ending: Showing<'a>,
    paying: Paying<'a>,
    /// Position of the first of them in the batch.
    first: usize,
}

impl Part<'_> {
    /// Does something at every seat, one after the other.
    fn each(self, each: &impl Fn(&mut Seat, Row<'_, '_>, usize)) {
        let Self { seats, mut showing, mut ending, mut paying, first } = self;
        let (showing, ending, paying) = (&mut showing, &mut ending, &mut paying);
        for (at, seat) in seats.iter_mut().enumerate() {
            each(seat, Row { at, showing, ending, paying }, first + at);
        }
    }

    fn split(self, middle: usize) -> (Self, Self) {
        let (seats, other_seats) = self.seats.split_at_mut(middle);
        let (showing, other_showing) = self.showing.split(middle);
        let (ending, other_ending) = self.ending.split(middle);
        let (paying, other_paying) = self.paying.split(middle);
        let other = Self {
            seats: other_seats,
            showing: other_showing,
            ending: other_ending,
            paying: other_paying,
            first: self.first + middle,
        };
        (Self { seats, showing, ending, paying, first: self.first }, other)
    }
}

/// A share of the batch for every thread, the same in every step, so that its days stay in its core's cache.
struct Shares<'a>(Vec<Mutex<Option<Part<'a>>>>);

impl<'a> Shares<'a> {
    fn of(mut part: Part<'a>, threads: usize) -> Self {
        let mut shares = Vec::with_capacity(threads);
        for left in (1..threads).rev() {
            let seats = part.seats.len().div_ceil(left + 1);
            let (share, others) = part.split(seats);
            shares.push(Mutex::new(Some(share)));
            part = others;
        }
        shares.push(Mutex::new(Some(part)));
        Self(shares)
    }

    /// Does something at every seat of a thread's share, then of what others have not come to.
    fn each(&self, thread: usize, each: &(impl Fn(&mut Seat, Row<'_, '_>, usize) + Sync)) {
        let others = (thread..self.0.len()).chain(0..thread);
        for share in others.map(|share| &self.0[share]) {
            while let Some(part) = take(share) {
                part.each(each);
            }
        }
    }
}

/// Takes some seats of a share.
fn take<'a>(share: &Mutex<Option<Part<'a>>>) -> Option<Part<'a>> {
    let mut share = share.lock().expect("no thread ends while it takes a part");
    let part = share.take()?;
    if part.seats.len() <= GRAIN {
        return Some(part);
    }
    let (first, others) = part.split(GRAIN);
    *share = Some(others);
    Some(first)
}

/// One seat's row of all arrays.
struct Row<'part, 'a> {
    at: usize,
    showing: &'part mut Showing<'a>,
    ending: &'part mut Showing<'a>,
    paying: &'part mut Paying<'a>,
}

impl Row<'_, '_> {
    fn pay(&mut self, reward: f64, over: bool, invalid: bool, begun: bool) {
        self.paying.rewards[self.at] = reward;
        self.paying.over[self.at] = over;
        self.paying.invalid[self.at] = invalid;
        self.paying.begun[self.at] = begun;
    }

    fn show(&mut self, world: &World, seat: &Seat) {
        seat.show(world, self.showing.row(self.at));
    }

    /// Shows how a day ended that is followed by another in the same step.
    fn show_end(&mut self, world: &World, seat: &Seat) {
        seat.show(world, self.ending.row(self.at));
    }
}
