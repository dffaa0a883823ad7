//! A day that is being played, one decision at a time.

use std::sync::{Arc, Mutex, PoisonError};

use pyo3::IntoPyObject;
use vertifleet_core::{self as core, AircraftIx, VertiportIx};
use vertifleet_learn::Reward;
use vertifleet_observe::{self as observe, Observer, Scene, Sizes};
use vertifleet_sim::{DayTotals, Decision, Simulation, TraceRow, first_decision};

use crate::days::Days;
use crate::failure::Failure;
use crate::layout::Layout;
use crate::observation::{scene, show};
use crate::scenario::Scenario;
use crate::view::View;

/// The common properties of all days of an environment.
#[derive(Clone)]
pub(crate) struct World {
    pub(crate) days: Days,
    pub(crate) layout: Layout,
    pub(crate) reward: Reward,
}

/// A day that is being played, and its current decision.
pub(crate) struct Day {
    simulation: Simulation,
    observer: Observer,
    /// The state that the views of the day share.
    views: Arc<Mutex<Observer>>,
    /// The pending decision. When the day is over, it is the last decision, in the view of its
    /// aircraft's current place.
    decision: Decision,
    over: bool,
}

/// The result of a step.
#[derive(Clone, Copy)]
pub(crate) struct Outcome {
    pub(crate) reward: f64,
    pub(crate) over: bool,
    /// Whether the action was infeasible, so that the aircraft held.
    pub(crate) invalid: bool,
    /// The outcome of the choice that was applied.
    pub(crate) row: TraceRow,
}

/// The outcome of a choice, as a dict for the caller's reward functions.
#[derive(IntoPyObject)]
pub(crate) struct OutcomeFields {
    time_s: u32,
    aircraft: u16,
    origin: u16,
    destination: u16,
    passengers: u16,
    revenue_usd: f64,
    passenger_cost_usd: f64,
    energy_kwh: f64,
    energy_cost_usd: f64,
    flight_cost_usd: f64,
    profit_usd: f64,
    takeoff_s: u32,
    arrival_s: u32,
    ready_s: u32,
    invalid_action: bool,
    over: bool,
}

impl From<&Outcome> for OutcomeFields {
    fn from(Outcome { over, invalid, row, .. }: &Outcome) -> Self {
        Self {
            time_s: row.time.seconds(),
            aircraft: row.aircraft.0,
            origin: row.from.0,
            destination: row.to.0,
            passengers: row.passengers,
            revenue_usd: row.revenue_usd,
            passenger_cost_usd: row.passenger_cost_usd,
            energy_kwh: row.energy_kwh,
            energy_cost_usd: row.energy_cost_usd,
            flight_cost_usd: row.flight_cost_usd,
            profit_usd: row.profit_usd(),
            takeoff_s: row.takeoff.seconds(),
            arrival_s: row.arrival.seconds(),
            ready_s: row.ready.seconds(),
            invalid_action: *invalid,
            over: *over,
        }
    }
}

impl World {
    pub(crate) fn new(days: &Days, layout: &Layout, reward: &str) -> Result<Self, Failure> {
        let reward = match reward {
            "terminal" => Reward::Terminal,
            "dense" => Reward::Dense,
            _ => {
                return Err(Failure::argument(format!(
                    "reward must be \"terminal\" or \"dense\", found {reward:?}"
                )));
            }
        };
        Ok(Self { days: days.clone(), layout: layout.clone(), reward })
    }

    /// The name of the reward.
    pub(crate) fn reward_name(&self) -> &'static str {
        match self.reward {
            Reward::Terminal => "terminal",
            Reward::Dense => "dense",
        }
    }

    fn layout(&self) -> &observe::Layout {
        &self.layout.layout
    }

    /// Largest number of vertiports of a day.
    pub(crate) fn vertiports(&self) -> usize {
        self.layout().sizes().vertiports
    }

    /// The day with this number.
    pub(crate) fn day(&self, number: u64) -> Result<Day, core::Error> {
        let (scenario, observer) = self.days.day(number)?;
        Ok(Day::new(scenario, observer))
    }

    /// A given day.
    pub(crate) fn given(&self, scenario: &Scenario) -> Result<Day, Failure> {
        self.check_fits(&scenario.scenario)?;
        Ok(Day::new(Arc::clone(&scenario.scenario), self.days.observer()))
    }

    /// Checks that a day has decisions, and that observations have room for it.
    pub(crate) fn check_fits(&self, day: &core::Scenario) -> Result<(), Failure> {
        let mut fleet = AircraftIx::all(day.aircraft.len());
        let (most, found) = (self.layout().sizes(), Sizes::of_day(day));
        let is_of_one_size =
            self.layout().parts().iter().any(|placed| placed.part.is_of_one_size());
        let rule = if fleet.all(|aircraft| first_decision(day, aircraft) > day.operations.end) {
            "has no decisions: every battery is full only after operations end".to_owned()
        } else if is_of_one_size && found.vertiports != most.vertiports {
            format!(
                "has {} vertiports, but the environment has {}",
                found.vertiports, most.vertiports
            )
        } else if !found.fits(most) {
            format!(
                "has {} vertiports, {} aircraft, {} types of aircraft and {} demand periods, but the environment has room for {}, {}, {} and {}",
                found.vertiports,
                found.aircraft,
                found.types,
                found.periods,
                most.vertiports,
                most.aircraft,
                most.types,
                most.periods
            )
        } else {
            return Ok(());
        };
        Err(Failure::argument(format!("scenario {:?} {rule}", day.name)))
    }
}

impl Day {
    fn new(scenario: Arc<core::Scenario>, observer: Observer) -> Self {
        let mut simulation = Simulation::new(scenario);
        let decision = simulation.next_decision().expect("an aircraft decides when the day starts");
        let views = Arc::new(Mutex::new(observer.clone()));
        Self { simulation, observer, views, decision, over: false }
    }

    /// Whether no aircraft has a decision left.
    pub(crate) fn is_over(&self) -> bool {
        self.over
    }

    pub(crate) fn totals(&self) -> DayTotals {
        self.simulation.totals()
    }

    pub(crate) fn decision(&self) -> &Decision {
        &self.decision
    }

    pub(crate) fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    pub(crate) fn day(&self) -> &core::Scenario {
        self.simulation.scenario()
    }

    pub(crate) fn scenario(&self) -> Scenario {
        Scenario { scenario: Arc::clone(self.simulation.scenario()) }
    }

    /// Takes the current decision. An action that is not feasible counts as a hold. The day must
    /// not be over.
    pub(crate) fn step(&mut self, action: i64, reward: Reward) -> Outcome {
        let feasible = self.simulation.view().feasible(&self.decision);
        let asked =
            usize::try_from(action).ok().filter(|&at| at < self.simulation.view().vertiports());
        let asked = asked.map(VertiportIx::new).filter(|&at| feasible.contains(at));
        let choice = asked.unwrap_or(self.decision.at);
        let row = self.simulation.apply(choice).expect("hold is always feasible");
        if let Some(decision) = self.simulation.next_decision() {
            self.decision = decision;
        } else {
            self.over = true;
            self.decision.at = choice;
        }
        let reward = reward.of(&row, &self.simulation, self.over);
        Outcome { reward, over: self.over, invalid: asked.is_none(), row }
    }

    /// The current decision with the view of the day.
    pub(crate) fn view(&self) -> View {
        View::of(&self.scene(), &self.views)
    }

    /// The scene of the current decision: when the day is over, that of the aircraft that decided
    /// last.
    pub(crate) fn scene(&self) -> Scene<'_> {
        scene(self.simulation.view(), self.over, &self.decision)
    }

    /// Writes the observation of the current decision into a row, and its mask.
    pub(crate) fn show(&mut self, layout: &observe::Layout, row: &mut [f32], mask: &mut [i8]) {
        let Self { simulation, observer, decision, over, .. } = self;
        show(layout, &scene(simulation.view(), *over, decision), observer, row, mask);
    }

    /// Does the same for an aircraft as if it decided now, from the vertiport where it stands or
    /// will land.
    pub(crate) fn show_to(
        &mut self,
        aircraft: AircraftIx,
        layout: &observe::Layout,
        row: &mut [f32],
        mask: &mut [i8],
    ) {
        if aircraft == self.decision.aircraft {
            return self.show(layout, row, mask);
        }
        let Self { simulation, observer, decision, over, .. } = self;
        let at = simulation.view().places()[aircraft.at()];
        let decision = Decision { aircraft, at, ..*decision };
        let view = simulation.view();
        let scene =
            if *over { Scene::over(view, &decision) } else { Scene::waiting(view, &decision) };
        show(layout, &scene, observer, row, mask);
    }
}

impl Clone for Day {
    /// The copy plays on independently, so it has its own cache of prices.
    fn clone(&self) -> Self {
        let views = self.views.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Self {
            simulation: self.simulation.clone(),
            observer: self.observer.clone(),
            views: Arc::new(Mutex::new(views)),
            decision: self.decision,
            over: self.over,
        }
    }
}
