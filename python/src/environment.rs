//! `Environment`: one day at a time, and one decision at a time. The Gymnasium and PettingZoo environments are built on
//! it.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;
use vertifleet_core::{self as core, AircraftIx, DaySeed, VertiportIx};
use vertifleet_learn::{Reward, Scales};
use vertifleet_sim::{DayTotals, Decision, Simulation};

use crate::failure::Failure;
use crate::frames::plain;
use crate::network::Network;
use crate::observation::{Arrays, Observation, ObservationRow, Observer};
use crate::pickle::{Reduced, reduced};
use crate::scenario::Scenario;

/// The settings that all days of an environment share.
#[derive(Clone)]
pub(crate) struct World {
    pub(crate) network: Network,
    pub(crate) scales: Scales,
    pub(crate) reward: Reward,
}

/// A day that is being played, and its current decision.
#[derive(Clone)]
pub(crate) struct Day {
    simulation: Simulation,
    /// The decision to be taken. When the day is over, it is the last decision that was taken, seen from where its
    /// aircraft is now.
    decision: Decision,
    over: bool,
}

/// The result of a step.
pub(crate) struct Outcome {
    pub(crate) reward: f64,
    pub(crate) over: bool,
    /// Whether the action was infeasible, so that the aircraft held.
    pub(crate) invalid: bool,
    /// The choice that was applied.
    choice: VertiportIx,
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
        let scales = Scales::from(network.network.feature_scales());
        Ok(Self { network: network.clone(), scales, reward })
    }

    pub(crate) fn vertiports(&self) -> usize {
        self.network.network.vertiports().len()
    }

    /// The training day with this number.
    pub(crate) fn day(&self, number: u64) -> Result<Day, core::Error> {
        Ok(Day::new(Arc::new(self.network.network.draw(DaySeed::training_number(number)?))))
    }
}

impl Day {
    pub(crate) fn new(scenario: Arc<core::Scenario>) -> Self {
        let mut simulation = Simulation::new(scenario);
        let decision = simulation.next_decision().expect("an aircraft decides when the day starts");
        Self { simulation, decision, over: false }
    }

    /// Whether no aircraft has a decision left.
    pub(crate) fn is_over(&self) -> bool {
        self.over
    }

    pub(crate) fn totals(&self) -> DayTotals {
        self.simulation.totals()
    }

    pub(crate) fn scenario(&self) -> Scenario {
        Scenario { scenario: Arc::clone(self.simulation.scenario()) }
    }

    /// Takes the current decision. An action that is not feasible counts as a hold. The day must not be over.
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
        Outcome { reward, over: self.over, invalid: asked.is_none(), choice }
    }

    /// Writes the observation of the current decision. When the day is over, this is the last observation of the
    /// aircraft that decided last: no time is left, and only hold is feasible.
    pub(crate) fn show(&self, scales: &Scales, to: ObservationRow<'_>) {
        to.fill(&self.decision, self.simulation.view(), scales, self.to(&self.decision));
    }

    /// The observer that a decision of this day is shown to.
    fn to(&self, decision: &Decision) -> Observer {
        if self.over {
            Observer::Finished
        } else if decision.aircraft == self.decision.aircraft {
            Observer::Deciding
        } else {
            Observer::Waiting
        }
    }

    /// The decision that an aircraft would have if it decided now, from where it stands or will land.
    fn seen_by(&self, aircraft: AircraftIx) -> Decision {
        Decision { aircraft, at: self.simulation.view().places()[aircraft.at()], ..self.decision }
    }
}

/// Arguments of [`Environment::resumed`].
type Resumed = (Network, &'static str, Option<Scenario>, Vec<u16>);

/// Plays one day at a time. It can be copied and pickled in the middle of a day.
#[pyclass(module = "vertifleet._native")]
#[derive(Clone)]
pub(crate) struct Environment {
    world: World,
    day: Option<Day>,
    /// The choices of the current day so far.
    choices: Vec<u16>,
}

#[pymethods]
impl Environment {
    #[new]
    fn new(network: &Network, reward: &str) -> Result<Self, Failure> {
        Ok(Self { world: World::new(network, reward)?, day: None, choices: Vec::new() })
    }

    /// Begins the training day with this number, which must be below 2^52, and returns the observation of its first
    /// decision.
    fn reset<'py>(&mut self, py: Python<'py>, number: u64) -> PyResult<Observation<'py>> {
        self.day = Some(self.world.day(number).map_err(Failure::from)?);
        self.choices.clear();
        self.present(py)
    }

    /// Begins a given day, and returns the observation of its first decision.
    fn begin<'py>(&mut self, py: Python<'py>, day: &Scenario) -> PyResult<Observation<'py>> {
        self.world.network.check_fits(&day.scenario)?;
        self.day = Some(Day::new(Arc::clone(&day.scenario)));
        self.choices.clear();
        self.present(py)
    }

    /// The observation of an aircraft at the current time. For an aircraft that does not decide now, only hold is
    /// feasible.
    fn observe<'py>(&self, py: Python<'py>, aircraft: u16) -> PyResult<Observation<'py>> {
        let day = self.day.as_ref();
        let day = day.filter(|day| usize::from(aircraft) < day.simulation.view().places().len());
        let day = day.ok_or_else(|| {
            Failure::argument(format!("no day with an aircraft {aircraft} is being played"))
        })?;
        self.shown(py, day, &day.seen_by(AircraftIx(aircraft)))
    }

    /// Takes the current decision. Returns the observation of the next one, the reward, whether the day is over, and
    /// whether the action was infeasible.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        action: i64,
    ) -> PyResult<(Observation<'py>, f64, bool, bool)> {
        let reward = self.world.reward;
        let day = self.day.as_mut().filter(|day| !day.over);
        let day = day.ok_or_else(|| {
            Failure::argument("no day is being played: call reset first".to_owned())
        })?;
        let Outcome { reward, over, invalid, choice } = day.step(action, reward);
        self.choices.push(choice.0);
        Ok((self.present(py)?, reward, over, invalid))
    }

    /// Restores a pickled environment: begins its day again and repeats its choices.
    #[staticmethod]
    fn resumed(
        network: &Network,
        reward: &str,
        scenario: Option<&Scenario>,
        choices: Vec<u16>,
    ) -> Result<Self, Failure> {
        let mut environment = Self::new(network, reward)?;
        if let Some(scenario) = scenario {
            environment.world.network.check_fits(&scenario.scenario)?;
            let mut day = Day::new(Arc::clone(&scenario.scenario));
            for &choice in &choices {
                if day.over {
                    return Err(Failure::argument("more choices than the day has".to_owned()));
                }
                day.step(choice.into(), environment.world.reward);
            }
            (environment.day, environment.choices) = (Some(day), choices);
        }
        Ok(environment)
    }

    fn __copy__(&self) -> Self {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, Resumed> {
        let network = self.world.network.clone();
        let reward = match self.world.reward {
            Reward::Terminal => "terminal",
            Reward::Dense => "dense",
        };
        let scenario = self.scenario();
        reduced::<Self, _>(py, "resumed", (network, reward, scenario, self.choices.clone()))
    }

    /// The feasible actions, as booleans [N]. Before the first day all of them are false.
    fn mask<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        let mut mask = vec![false; self.world.vertiports()];
        if let Some(day) = &self.day {
            let to = day.to(&day.decision);
            for feasible in to.feasible(&day.decision, day.simulation.view()).iter() {
                mask[feasible.at()] = true;
            }
        }
        PyArray1::from_vec(py, mask)
    }

    /// Position of the aircraft that decides, or, when the day is over, of the aircraft that decided last.
    #[getter]
    fn aircraft(&self) -> Option<u16> {
        Some(self.day.as_ref()?.decision.aircraft.0)
    }

    /// The current time, seconds since midnight.
    #[getter]
    fn time_s(&self) -> Option<u32> {
        Some(self.day.as_ref()?.decision.time.seconds())
    }

    /// The day that is being played.
    #[getter]
    fn scenario(&self) -> Option<Scenario> {
        self.day.as_ref().map(Day::scenario)
    }

    /// The results of the day so far, as `vertifleet simulate --json` prints them.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.day.as_ref().map(|day| plain(py, &day.totals())).transpose()
    }
}

impl Environment {
    /// The observation of the current decision.
    fn present<'py>(&self, py: Python<'py>) -> PyResult<Observation<'py>> {
        let day = self.day.as_ref().expect("a day has begun");
        self.shown(py, day, &day.decision)
    }

    fn shown<'py>(
        &self,
        py: Python<'py>,
        day: &Day,
        decision: &Decision,
    ) -> PyResult<Observation<'py>> {
        let view = day.simulation.view();
        let arrays = Arrays::of(py, decision, view, &self.world.scales, day.to(decision))?;
        arrays.into_observation(py)
    }
}
