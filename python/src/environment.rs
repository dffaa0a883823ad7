//! `Environment`: one day at a time, and one decision at a time. The Gymnasium and PettingZoo
//! environments are built on it.

use numpy::PyArray1;
use pyo3::prelude::*;
use vertifleet_core::AircraftIx;

use crate::day::{Day, Outcome, OutcomeFields, World};
use crate::days::Days;
use crate::failure::Failure;
use crate::frames::plain;
use crate::layout::Layout;
use crate::observation::{Shown, shown};
use crate::pickle::{Reduced, reduced};
use crate::picture;
use crate::scenario::Scenario;
use crate::view::View;

/// Arguments of [`Environment::resumed`].
type Resumed = (Days, Layout, &'static str, Option<u64>, Option<Scenario>, Vec<u16>);

/// Plays one day at a time. It can be copied and pickled in the middle of a day.
#[pyclass(module = "vertifleet._native")]
#[derive(Clone)]
pub(crate) struct Environment {
    world: World,
    day: Option<Day>,
    /// The number of the day, if it was not given.
    number: Option<u64>,
    /// The choices of the current day so far.
    choices: Vec<u16>,
    /// The outcome of the latest choice.
    outcome: Option<Outcome>,
}

#[pymethods]
impl Environment {
    #[new]
    fn new(days: &Days, layout: &Layout, reward: &str) -> Result<Self, Failure> {
        let world = World::new(days, layout, reward)?;
        Ok(Self { world, day: None, number: None, choices: Vec::new(), outcome: None })
    }

    /// Begins the day with this number, and returns the observation of its first decision.
    fn reset<'py>(&mut self, py: Python<'py>, number: u64) -> PyResult<Shown<'py>> {
        let day = self.world.day(number).map_err(Failure::from)?;
        self.play(py, day, Some(number))
    }

    /// Begins a given day, and returns the observation of its first decision.
    fn begin<'py>(&mut self, py: Python<'py>, day: &Scenario) -> PyResult<Shown<'py>> {
        let day = self.world.given(day)?;
        self.play(py, day, None)
    }

    /// The observation of an aircraft at the current time. For an aircraft that does not decide
    /// now, only hold is feasible.
    fn observe<'py>(&mut self, py: Python<'py>, aircraft: u16) -> PyResult<Shown<'py>> {
        let Self { world, day, .. } = self;
        let fleet = |day: &Day| day.simulation().view().places().len();
        let day = day.as_mut().filter(|day| usize::from(aircraft) < fleet(day));
        let day = day.ok_or_else(|| {
            Failure::argument(format!("no day with an aircraft {aircraft} is being played"))
        })?;
        let layout = &world.layout.layout;
        shown(py, layout.width(), world.vertiports(), |row, mask| {
            day.show_to(AircraftIx(aircraft), layout, row, mask);
        })
    }

    /// Takes the current decision. Returns the observation of the next one, the reward, whether the
    /// day is over, and whether the action was infeasible.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        action: i64,
    ) -> PyResult<(Shown<'py>, f64, bool, bool)> {
        let reward = self.world.reward;
        let day = self.day.as_mut().filter(|day| !day.is_over());
        let day = day.ok_or_else(|| {
            Failure::argument("no day is being played: call reset first".to_owned())
        })?;
        let Outcome { reward, over, invalid, row } = *self.outcome.insert(day.step(action, reward));
        self.choices.push(row.to.0);
        Ok((self.present(py)?, reward, over, invalid))
    }

    /// Restores a pickled environment: begins its day again and repeats its choices.
    #[staticmethod]
    fn resumed(
        days: &Days,
        layout: &Layout,
        reward: &str,
        number: Option<u64>,
        scenario: Option<&Scenario>,
        choices: Vec<u16>,
    ) -> PyResult<Self> {
        let mut environment = Self::new(days, layout, reward)?;
        let world = &environment.world;
        let mut day = match (number, scenario) {
            (Some(number), _) => world.day(number).map_err(Failure::from)?,
            (None, Some(scenario)) => world.given(scenario)?,
            (None, None) => return Ok(environment),
        };
        for &choice in &choices {
            if day.is_over() {
                let rule = "more choices than the day has".to_owned();
                return Err(Failure::argument(rule).into());
            }
            day.step(choice.into(), world.reward);
        }
        environment.day = Some(day);
        (environment.number, environment.choices) = (number, choices);
        Ok(environment)
    }

    fn __copy__(&self) -> Self {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, Resumed> {
        let World { days, layout, .. } = self.world.clone();
        let (reward, choices) = (self.world.reward_name(), self.choices.clone());
        let scenario = self.scenario().filter(|_| self.number.is_none());
        let arguments = (days, layout, reward, self.number, scenario, choices);
        reduced::<Self, _>(py, "resumed", arguments)
    }

    /// The feasible actions, as booleans [N]. Before the first day all of them are false.
    fn mask<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        let mut mask = vec![false; self.world.vertiports()];
        if let Some(day) = &self.day {
            for feasible in day.scene().feasible().iter() {
                mask[feasible.at()] = true;
            }
        }
        PyArray1::from_vec(py, mask)
    }

    /// A map of the fleet: [height, width, 3], 0 to 255. None before the first day.
    fn frame<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.day.as_ref().map(|day| picture::frame(py, day, &self.choices)).transpose()
    }

    /// A table of the fleet as text. None before the first day.
    fn text(&self) -> Option<String> {
        self.day.as_ref().map(|day| picture::text(day, &self.choices))
    }

    /// The view of the current decision.
    #[getter]
    fn view(&self) -> Option<View> {
        self.day.as_ref().map(Day::view)
    }

    /// The outcome of the latest choice.
    #[getter]
    fn outcome(&self) -> Option<OutcomeFields> {
        self.outcome.as_ref().map(OutcomeFields::from)
    }

    /// Position of the aircraft that decides, or, when the day is over, of the aircraft that
    /// decided last.
    #[getter]
    fn aircraft(&self) -> Option<u16> {
        Some(self.day.as_ref()?.decision().aircraft.0)
    }

    /// The current time, seconds since midnight.
    #[getter]
    fn time_s(&self) -> Option<u32> {
        Some(self.day.as_ref()?.decision().time.seconds())
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
    fn play<'py>(
        &mut self,
        py: Python<'py>,
        day: Day,
        number: Option<u64>,
    ) -> PyResult<Shown<'py>> {
        (self.day, self.number) = (Some(day), number);
        self.choices.clear();
        self.present(py)
    }

    /// The observation of the current decision.
    fn present<'py>(&mut self, py: Python<'py>) -> PyResult<Shown<'py>> {
        let Self { world, day, .. } = self;
        let (layout, day) = (&world.layout.layout, day.as_mut().expect("a day has begun"));
        shown(py, layout.width(), world.vertiports(), |row, mask| day.show(layout, row, mask))
    }
}
