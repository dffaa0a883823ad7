//! `Batch`: many days side by side, advanced by as many threads as there are; what the vector environment is made of.
//!
//! Observations alternate between two sets of arrays, so that those of a step stay as they are while the next one is taken.

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyList;
use rayon::{ThreadPool, ThreadPoolBuilder};
use vertifleet_sim::Summary;

use crate::buffers::{Observations, Outcomes, Paying, Showing};
use crate::environment::{Day, Outcome, Shown, World};
use crate::failure::Failure;
use crate::frames::plain;
use crate::network::Network;

/// Days that one thread advances at a time: some ten microseconds of work, far more than it costs to share it out.
const GRAIN: usize = 32;
/// Numbers of training days are below this.
const NUMBERS: u64 = 1 << 52;

/// What becomes of a day that is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Autoreset {
    /// The next step begins a new one, whatever the action.
    NextStep,
    /// The step that ends it begins a new one; how it ended is shown apart.
    SameStep,
    /// Whoever plays begins a new one.
    Disabled,
}

/// A place of the batch and the day that is played there.
#[derive(Default)]
struct Seat {
    day: Option<Day>,
    /// The numbers of the day that the latest step ended.
    summary: Option<Summary>,
}

/// Many days side by side.
#[pyclass(module = "vertifleet")]
pub(crate) struct Batch {
    world: World,
    autoreset: Autoreset,
    seats: Vec<Seat>,
    sets: [(Observations, Outcomes); 2],
    /// How days ended that were followed by others in the same step.
    finals: Observations,
    /// The set that the latest observations are in.
    latest: usize,
    threads: usize,
    /// Made when first needed: a process that forks has none of its parent's threads.
    pool: Option<ThreadPool>,
}

#[pymethods]
impl Batch {
    #[new]
    #[pyo3(signature = (network, reward, seats, autoreset, threads = None))]
    fn new(
        py: Python<'_>,
        network: &Network,
        reward: &str,
        seats: usize,
        autoreset: &str,
        threads: Option<usize>,
    ) -> Result<Self, Failure> {
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
        let set = || (Observations::new(py, seats, vertiports), Outcomes::new(py, seats));
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        Ok(Self {
            sets: [set(), set()],
            finals: Observations::new(py, seats, vertiports),
            latest: 0,
            seats: std::iter::repeat_with(Seat::default).take(seats).collect(),
            threads: threads.unwrap_or_else(cores).max(1),
            pool: None,
            autoreset,
            world,
        })
    }

    /// The arrays of both sets: observations and outcomes of set 0, then of set 1, then the final observations.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let arrays = PyList::empty(py);
        for (observations, outcomes) in &self.sets {
            arrays.append(observations.arrays(py)?)?;
            arrays.append(outcomes.arrays(py)?)?;
        }
        arrays.append(self.finals.arrays(py)?)?;
        Ok(arrays)
    }

    /// Begins the training days of these numbers at the seats that `which` has; every seat shows where it is. Returns the set.
    fn reset(
        &mut self,
        py: Python<'_>,
        which: PyReadonlyArray1<'_, bool>,
        numbers: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<usize> {
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
        let (set, _) = self.on_all(py, |world, seat, mut row, at| {
            row.pay(0.0, false, false, which[at]);
            if which[at] {
                seat.begin(world, numbers[at]);
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
        let autoreset = self.autoreset;
        self.on_all(py, |world, seat, mut row, at| {
            if seat.is_over() && autoreset == Autoreset::NextStep {
                seat.summary = None;
                seat.begin(world, numbers[at]);
                row.pay(0.0, false, false, true);
                return row.show(world, seat);
            }
            let Outcome { reward, over, invalid } = seat.step(world, actions[at]);
            let followed = over && autoreset == Autoreset::SameStep;
            row.pay(reward, over, invalid, followed);
            if followed {
                row.show_end(world, seat);
                seat.begin(world, numbers[at]);
            }
            row.show(world, seat);
        })
    }

    /// The numbers of the day that the latest step ended at a seat, as `vertifleet simulate --json` prints them.
    fn summary<'py>(&self, py: Python<'py>, seat: usize) -> PyResult<Option<Bound<'py, PyAny>>> {
        let summary = self.seats.get(seat).and_then(|seat| seat.summary);
        summary
            .map(|summary| plain(py, &serde_json::to_string(&summary).expect("plain data")))
            .transpose()
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

    /// Does something at every seat, on all threads if there are enough seats. Returns the set that was written to, and whether any
    /// day is over or has begun.
    fn on_all(
        &mut self,
        py: Python<'_>,
        each: impl Fn(&World, &mut Seat, Row<'_, '_>, usize) + Sync,
    ) -> PyResult<(usize, bool)> {
        self.latest = 1 - self.latest;
        if self.pool.is_none() && self.seats.len() > GRAIN && self.threads > 1 {
            self.pool = ThreadPoolBuilder::new().num_threads(self.threads).build().ok();
        }
        let Self { world, seats, sets, finals, latest, pool, .. } = self;
        let (observations, outcomes) = &sets[*latest];
        let (mut showing, mut ending, mut paying) =
            (observations.lend(py), finals.lend(py), outcomes.lend(py));
        let (showing, ending, paying) = (showing.rows()?, ending.rows()?, paying.rows()?);
        let mut part = Part { seats, showing, ending, paying, first: 0 };
        let world = &*world;
        let each = |seat: &mut Seat, row: Row<'_, '_>, at: usize| each(world, seat, row, at);
        py.detach(|| match pool {
            Some(pool) => pool.install(|| part.share_out(&each)),
            None => part.each(&each),
        });
        let eventful = part.paying.over.iter().chain(&*part.paying.begun).any(|&flag| flag);
        Ok((*latest, eventful))
    }
}

/// Numbers of training days.
fn check_numbers(numbers: &[u64]) -> Result<(), Failure> {
    match numbers.iter().find(|&&number| number >= NUMBERS) {
        Some(number) => {
            Err(Failure::argument(format!("a training day's number is below 2^52, found {number}")))
        }
        None => Ok(()),
    }
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
        self.summary = outcome.over.then(|| day.summary());
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
    /// Does something at every seat, on the threads of the pool that this is called in.
    fn share_out(&mut self, each: &(impl Fn(&mut Seat, Row<'_, '_>, usize) + Sync)) {
        let seats = self.seats.len();
        if seats <= GRAIN {
            return self.each(each);
        }
        let (mut one, mut other) = self.split(seats / 2);
        rayon::join(|| one.share_out(each), || other.share_out(each));
    }

    /// Does something at every seat, one after the other.
    fn each(&mut self, each: &impl Fn(&mut Seat, Row<'_, '_>, usize)) {
        let Self { seats, showing, ending, paying, first } = self;
        for (at, seat) in seats.iter_mut().enumerate() {
            each(seat, Row { at, showing, ending, paying }, *first + at);
        }
    }

    fn split(&mut self, middle: usize) -> (Part<'_>, Part<'_>) {
        let (seats, other_seats) = self.seats.split_at_mut(middle);
        let (showing, other_showing) = self.showing.split(middle);
        let (ending, other_ending) = self.ending.split(middle);
        let (paying, other_paying) = self.paying.split(middle);
        let other = Part {
            seats: other_seats,
            showing: other_showing,
            ending: other_ending,
            paying: other_paying,
            first: self.first + middle,
        };
        (Part { seats, showing, ending, paying, first: self.first }, other)
    }
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
