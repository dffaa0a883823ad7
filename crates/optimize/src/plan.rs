//! The planner: the best schedule it can find for a day that is known.
//!
//! [`plan`] starts from the best day of the policies that need no learning and improves it by large-neighbourhood search (`plan/search.rs`), whose
//! moves are exact: the best way on for one aircraft while the others keep their flights (`plan/route_search.rs`). What it
//! returns has been played in the simulator.

mod day;
mod foresight;
mod problem;
mod route_search;
mod schedule;
mod search;
mod stand_prices;
mod stand_times;
mod start;

use std::sync::Arc;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use vertifleet_core::Scenario;
use vertifleet_policy::draw;
use vertifleet_sim::Trace;

use crate::Error;
use problem::Problem;
use search::Search;

/// Steps that a search takes between two looks at what the others found.
const STEPS_A_ROUND: u64 = 50;
/// Rounds after which the search that stands worst goes on from where the best one stands.
const ROUNDS_A_MEETING: u64 = 100;
/// Temperatures at which annealing begins and ends, dollars. From 20, days of `paper` earned 0.2 % less after 100,000 steps:
/// that is hotter than where the search starts.
const HOT_USD: f64 = 4.0;
const COLD_USD: f64 = 1.0;

/// Share of the time that the rolling horizon may take for a day to start from.
const ROLLING: f64 = 0.5;

/// How long to search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// Until so much time has gone; how far the searches get by then depends on the machine.
    Time(Duration),
    /// So many steps of each search. The plan then depends on nothing but scenario and settings.
    Steps(u64),
}

/// Settings of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How long to search.
    pub budget: Budget,
    /// Searches side by side, which share what they find now and then. At least 1.
    pub searches: usize,
    /// What chance follows.
    pub seed: u64,
}

/// How far a plan is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Share of the budget that is gone.
    pub share: f64,
    /// Steps of each search.
    pub steps: u64,
    /// Profit of the best day so far, dollars.
    pub profit_usd: f64,
}

/// A finished plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Every decision of the day.
    pub trace: Trace,
    /// What the day earns, as the simulator accounts for it, dollars.
    pub profit_usd: f64,
    /// What the best policy that needs no learning earns, dollars; the plan is never worse.
    pub best_policy_usd: f64,
    /// Steps of each search.
    pub steps: u64,
}

/// Whether a day can be planned.
///
/// # Errors
/// [`Error::SeparateChargers`] if a vertiport has chargers beside its stands: what a hold does there, the planner does not know.
pub fn can_plan(scenario: &Scenario) -> Result<(), Error> {
    let separate = scenario.vertiports.iter().find(|vertiport| vertiport.chargers.is_some());
    separate.map_or(Ok(()), |vertiport| {
        Err(Error::SeparateChargers { vertiport: vertiport.id.clone() })
    })
}

/// Plans a day that is known in full: actual demand, delays, closures and outages. `watch` sees how far the plan is, many
/// times a second on networks of usual size, and says whether to go on; when it says no, the plan is the best found by then.
///
/// # Errors
/// As [`can_plan`].
pub fn plan(
    scenario: &Arc<Scenario>,
    settings: &Settings,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Plan, Error> {
    can_plan(scenario)?;
    let begun = Instant::now();
    let (trace, profit_usd) = start::best_policy(scenario, |profit_usd| {
        let share = share(settings.budget, begun, 0);
        let late = matches!(settings.budget, Budget::Time(_)) && share > ROLLING;
        !late && watch(&Progress { share, steps: 0, profit_usd })
    });
    let mut plan = Plan { trace, profit_usd, best_policy_usd: profit_usd, steps: 0 };
    let problem = Problem::of(scenario);
    let first = start::schedule_of(&problem, &plan.trace);
    let mut searches: Vec<Search> = (0_u32..)
        .take(settings.searches.max(1))
        .map(|number| Search::new(first.clone(), draw(settings.seed, scenario.seed, number)))
        .collect();
    for round in 1.. {
        let share = share(settings.budget, begun, plan.steps);
        let progress = Progress { share, steps: plan.steps, profit_usd: plan.profit_usd };
        if !watch(&progress) || share >= 1.0 {
            break;
        }
        let temperature_usd = HOT_USD * (COLD_USD / HOT_USD).powf(share);
        let steps = match settings.budget {
            Budget::Time(_) => STEPS_A_ROUND,
            Budget::Steps(limit) => STEPS_A_ROUND.min(limit - plan.steps),
        };
        searches.par_iter_mut().for_each(|search| {
            for _ in 0..steps {
                search.step(&problem, temperature_usd);
            }
        });
        plan.steps += steps;
        if round % ROUNDS_A_MEETING == 0 {
            meet(&mut searches);
        }
        keep_best(scenario, &searches, &mut plan);
    }
    Ok(plan)
}

/// Share of a budget that is gone, at most 1.
fn share(budget: Budget, begun: Instant, steps: u64) -> f64 {
    let share = match budget {
        Budget::Time(limit) => begun.elapsed().as_secs_f64() / limit.as_secs_f64().max(1e-9),
        Budget::Steps(0) => 1.0,
        Budget::Steps(limit) => steps as f64 / limit as f64,
    };
    share.min(1.0)
}

/// The search that stands worst goes on from where the best one stands.
fn meet(searches: &mut [Search]) {
    let by_value = |&one: &usize, &other: &usize| {
        searches[one].current.value_usd().total_cmp(&searches[other].current.value_usd())
    };
    let best = (0..searches.len()).max_by(by_value).expect("there is a search");
    let worst = (0..searches.len()).min_by(by_value).expect("there is a search");
    if best != worst {
        let current = searches[best].current.clone();
        searches[worst].current.clone_from(&current);
    }
}

/// Plays the best schedule of all searches and keeps it if it earns more than the plan so far.
fn keep_best(scenario: &Arc<Scenario>, searches: &[Search], plan: &mut Plan) {
    let best = searches
        .iter()
        .map(|search| &search.best)
        .max_by(|one, other| one.value_usd().total_cmp(&other.value_usd()))
        .expect("there is a search");
    if best.value_usd() > plan.profit_usd {
        let (trace, profit_usd) = start::flown(scenario, best);
        if profit_usd > plan.profit_usd {
            (plan.trace, plan.profit_usd) = (trace, profit_usd);
        }
    }
}
