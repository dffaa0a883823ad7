//! `Environment`: one day at a time, one decision at a time; what the Gymnasium and PettingZoo environments are made of.

use std::sync::Arc;

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use vertifleet_core::{self as core, AircraftIx, TypeIx, VertiportIx};
use vertifleet_learn::{Reward, Scales};
use vertifleet_sim::{Decision, Simulation, Summary, View};

use crate::failure::Failure;
use crate::frames::plain;
use crate::network::{Network, training_seed};
use crate::scenario::Scenario;

/// What all days of an environment have in common.
#[derive(Clone)]
pub(crate) struct World {
    pub(crate) network: Arc<core::Network>,
    pub(crate) scales: Scales,
    pub(crate) reward: Reward,
}

/// A day being played, and the decision that it stands at.
pub(crate) struct Day {
    simulation: Simulation,
    /// The decision to be taken; the last one taken, from where its aircraft is now, once the day is over.
    decision: Decision,
    over: bool,
}

/// Room for what is shown at a decision.
pub(crate) struct Shown<'a> {
    /// [N x F].
    pub(crate) nodes: &'a mut [f32],
    /// [G].
    pub(crate) aircraft: &'a mut [f32],
    pub(crate) clock: &'a mut f32,
    /// [N x N].
    pub(crate) adjacency: &'a mut [f32],
    /// [N].
    pub(crate) mask: &'a mut [f32],
    /// [N], the same as whole numbers.
    pub(crate) mask_i8: &'a mut [i8],
}

/// What a step came to.
pub(crate) struct Outcome {
    pub(crate) reward: f64,
    pub(crate) over: bool,
    /// Whether the action was infeasible, so that the aircraft held.
    pub(crate) invalid: bool,
}

impl World {
    pub(crate) fn new(network: &Network, reward: &str) -> Result<Self, Failure> {
        let reward = match reward {
            "terminal" => Reward::Terminal,
            "dense" => Reward::Dense,
            _ => {
                return Err(Failure::argument(format!(
                    "reward must be \"terminal\" or \"dense\", found {reward:?}"
                )));
            }
        };
        let network = Arc::clone(&network.network);
        let scales = Scales::from(network.feature_scales());
        Ok(Self { network, scales, reward })
    }

    pub(crate) fn vertiports(&self) -> usize {
        self.network.vertiports().len()
    }

    /// The training day of this number.
    pub(crate) fn day(&self, number: u64) -> Result<Day, core::Error> {
        Ok(Day::new(Arc::new(self.network.draw(training_seed(number)?))))
    }
}

impl Day {
    fn new(scenario: Arc<core::Scenario>) -> Self {
        let mut simulation = Simulation::new(scenario);
        let decision = simulation.next_decision().expect("an aircraft decides when the day starts");
        Self { simulation, decision, over: false }
    }

    /// Whether no aircraft has a decision left.
    pub(crate) fn is_over(&self) -> bool {
        self.over
    }

    pub(crate) fn summary(&self) -> Summary {
        self.simulation.summary()
    }

    /// Takes the decision; an action that is not feasible holds. Nothing happens on a day that is over.
    pub(crate) fn step(&mut self, action: i64, reward: Reward) -> Outcome {
        let feasible = self.simulation.view().feasible(&self.decision);
        let asked =
            usize::try_from(action).ok().filter(|&at| at < self.simulation.view().vertiports());
        let asked = asked.map(VertiportIx::new).filter(|&at| feasible.contains(at));
        let choice = asked.unwrap_or(self.decision.at);
        let outcome = self.simulation.apply(choice).expect("hold is always feasible");
        if let Some(decision) = self.simulation.next_decision() {
            self.decision = decision;
        } else {
            self.over = true;
            self.decision.at = choice;
        }
        let reward = reward.of(&outcome, &self.simulation, self.over);
        Outcome { reward, over: self.over, invalid: asked.is_none() }
    }

    /// Shows the decision. A day that is over shows how it ended to the aircraft that decided last: no time is left, and nothing but
    /// hold is feasible.
    pub(crate) fn show(&self, scales: &Scales, to: Shown<'_>) {
        self.show_as(&self.decision, scales, to);
    }

    /// The decision as an aircraft would have it now, from where it stands or will land.
    fn seen_by(&self, aircraft: AircraftIx) -> Decision {
        Decision { aircraft, at: self.simulation.view().places()[aircraft.at()], ..self.decision }
    }

    fn show_as(&self, decision: &Decision, scales: &Scales, to: Shown<'_>) {
        let view = self.simulation.view();
        let left = scales.write((to.nodes, to.aircraft), decision, view);
        *to.clock = if self.over { 0.0 } else { left };
        show_adjacency(view, view.kind(decision.aircraft), to.adjacency);
        to.mask.fill(0.0);
        to.mask_i8.fill(0);
        let mut open = |vertiport: VertiportIx| {
            to.mask[vertiport.at()] = 1.0;
            to.mask_i8[vertiport.at()] = 1;
        };
        if self.over || decision.aircraft != self.decision.aircraft {
            open(decision.at);
        } else {
            view.feasible(decision).iter().for_each(open);
        }
    }
}

/// 1 where aircraft of a type may fly between two vertiports now: a corridor leads there, a full battery reaches it, and the route
/// is not closed.
fn show_adjacency(view: View<'_>, kind: TypeIx, adjacency: &mut [f32]) {
    adjacency.fill(0.0);
    for (from, row) in adjacency.chunks_exact_mut(view.vertiports()).enumerate() {
        let from = VertiportIx::new(from);
        for to in view.within_range(kind, from).without(&view.closed(from)).iter() {
            row[to.at()] = 1.0;
        }
    }
}

/// One day at a time.
#[pyclass(module = "vertifleet")]
pub(crate) struct Environment {
    world: World,
    day: Option<Day>,
}

#[pymethods]
impl Environment {
    #[new]
    fn new(network: &Network, reward: &str) -> Result<Self, Failure> {
        Ok(Self { world: World::new(network, reward)?, day: None })
    }

    /// Begins the training day of this number, below 2^52; returns what its first decision shows.
    fn reset<'py>(&mut self, py: Python<'py>, number: u64) -> PyResult<Bound<'py, PyTuple>> {
        self.day = Some(self.world.day(number).map_err(Failure::from)?);
        self.present(py)
    }

    /// Begins a given day.
    fn begin<'py>(&mut self, py: Python<'py>, day: &Scenario) -> PyResult<Bound<'py, PyTuple>> {
        let (expected, found) = (self.world.vertiports(), day.scenario.vertiports.len());
        if expected != found {
            return Err(Failure::argument(format!(
                "scenario {:?} has {found} vertiports, but this environment's network {:?} has {expected}",
                day.scenario.name,
                self.world.network.name()
            ))
            .into());
        }
        self.day = Some(Day::new(Arc::clone(&day.scenario)));
        self.present(py)
    }

    /// What the day shows to an aircraft now. To one that does not decide, only hold is feasible.
    fn observe<'py>(&self, py: Python<'py>, aircraft: u16) -> PyResult<Bound<'py, PyTuple>> {
        let day = self.day.as_ref();
        let day = day.filter(|day| usize::from(aircraft) < day.simulation.view().places().len());
        let day = day.ok_or_else(|| {
            Failure::argument(format!("no day with an aircraft {aircraft} is being played"))
        })?;
        self.shown(py, day, &day.seen_by(AircraftIx(aircraft)))
    }

    /// Takes the decision. Returns what the next one shows, the reward, whether the day is over, and whether the action was infeasible.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        action: i64,
    ) -> PyResult<(Bound<'py, PyTuple>, f64, bool, bool)> {
        let reward = self.world.reward;
        let day = self.day.as_mut().filter(|day| !day.over);
        let day = day.ok_or_else(|| {
            Failure::argument("no day is being played: call reset first".to_owned())
        })?;
        let Outcome { reward, over, invalid } = day.step(action, reward);
        Ok((self.present(py)?, reward, over, invalid))
    }

    /// The feasible actions, as booleans [N]; none before the first day.
    fn mask<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        let mut mask = vec![false; self.world.vertiports()];
        if let Some(day) = &self.day {
            mask[day.decision.at.at()] = true;
            if !day.over {
                for feasible in day.simulation.view().feasible(&day.decision).iter() {
                    mask[feasible.at()] = true;
                }
            }
        }
        PyArray1::from_vec(py, mask)
    }

    /// Position of the aircraft that decides; of the one that decided last once the day is over.
    #[getter]
    fn aircraft(&self) -> Option<u16> {
        Some(self.day.as_ref()?.decision.aircraft.0)
    }

    /// Now, seconds since midnight.
    #[getter]
    fn time_s(&self) -> Option<u32> {
        Some(self.day.as_ref()?.decision.time.seconds())
    }

    /// The day's name.
    #[getter]
    fn day(&self) -> Option<&str> {
        Some(&self.day.as_ref()?.simulation.scenario().name)
    }

    /// The day's numbers so far, as `vertifleet simulate --json` prints them.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let summary = self.day.as_ref().map(|day| day.simulation.summary());
        summary
            .map(|summary| plain(py, &serde_json::to_string(&summary).expect("plain data")))
            .transpose()
    }
}

impl Environment {
    /// What the decision to be taken shows.
    fn present<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let day = self.day.as_ref().expect("a day has begun");
        self.shown(py, day, &day.decision)
    }

    /// Nodes, aircraft, clock, adjacency, mask, and the mask as int8, in new arrays.
    fn shown<'py>(
        &self,
        py: Python<'py>,
        day: &Day,
        decision: &Decision,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let shape = vertifleet_learn::shape(self.world.vertiports());
        let size = shape.vertiports;
        let numbers = |len| PyArray1::<f32>::zeros(py, len, false);
        let (nodes, aircraft) =
            (numbers(size * shape.node_features), numbers(shape.aircraft_features));
        let (clock, adjacency, mask) = (numbers(1), numbers(size * size), numbers(size));
        let mask_i8 = PyArray1::<i8>::zeros(py, size, false);
        day.show_as(
            decision,
            &self.world.scales,
            Shown {
                nodes: nodes.readwrite().as_slice_mut()?,
                aircraft: aircraft.readwrite().as_slice_mut()?,
                clock: &mut clock.readwrite().as_slice_mut()?[0],
                adjacency: adjacency.readwrite().as_slice_mut()?,
                mask: mask.readwrite().as_slice_mut()?,
                mask_i8: mask_i8.readwrite().as_slice_mut()?,
            },
        );
        (nodes, aircraft, clock, adjacency, mask, mask_i8).into_pyobject(py)
    }
}
