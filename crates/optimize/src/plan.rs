//! The planner, which searches for the best schedule of a day that is known.
//!
//! [`plan`] starts from the best day of any policy (`plan/start.rs`) and from a schedule that is
//! made of the prices of a bound (`plan/dive.rs`), and improves them by large-neighbourhood search
//! (`plan/searches.rs`). The moves of the search are exact: each finds the best rest of the day for
//! one aircraft while the others keep their flights (`plan/itinerary_search.rs`). The plan that is
//! returned has been played in the simulator.

mod batteries;
mod chargers;
mod day;
mod dive;
mod foresight;
mod guiding_prices;
mod hop;
mod itinerary_search;
mod passengers;
mod problem;
mod schedule;
mod search;
mod searches;
mod stand_times;
mod start;
mod tempo;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use vertifleet_core::Scenario;
use vertifleet_sim::{Simulation, Trace};

use dive::Dive;
use problem::Problem;
use searches::Searches;

pub use start::StartingPolicy;

/// Share of the remaining time for which a policy plays its day before it is judged whether it will
/// finish in time.
const JUDGED_FROM: f64 = 0.25;
/// A thorough day of the rolling horizon goes on unless it seems to take this many times as long as
/// there is time for.
const MISJUDGED: f64 = 2.0;
/// Dives take this share of the budget, or less. Within this share, a thorough day of the rolling
/// horizon is played in parallel.
const DIVE_SHARE: f64 = 0.5;
/// With less time than this, no dive is begun.
const LEAST_TO_DIVE: Duration = Duration::from_secs(5);
/// With less time than this, policies play their days alone if there is enough for that at all: on
/// networks of 20 vertiports and more the rolling horizon needs all threads.
const LEAST_TO_SHARE: Duration = Duration::from_secs(20);
/// Steps of each search in a round, after which the best schedule of all searches is kept.
const STEPS_A_ROUND: u64 = 50;
/// Seconds that a round takes at most where time is limited, so that `watch` is called many times a
/// second on days of any size.
const ROUND_S: f64 = 0.05;

/// The budget of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// A limit of time. How far the searches get by then depends on the machine.
    Time(Duration),
    /// A number of steps of each search. The plan then depends on nothing but scenario and
    /// settings.
    Steps(u64),
}

impl Budget {
    /// Whether policies play their days before dives and a proof begin, and not in parallel with
    /// them.
    pub(crate) fn leaves_policies_alone(self) -> bool {
        matches!(self, Self::Time(limit) if (LEAST_TO_DIVE..LEAST_TO_SHARE).contains(&limit))
    }
}

/// The settings of a search for a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// The budget of the search.
    pub budget: Budget,
    /// Number of searches in parallel, which share their results from time to time. At least 1.
    pub searches: usize,
    /// The seed of the random choices of the searches.
    pub seed: u64,
}

/// The progress of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchProgress {
    /// Share of the budget that is used.
    pub share: f64,
    /// Number of steps of each search.
    pub steps: u64,
    /// Profit of the best day so far, dollars.
    pub profit_usd: f64,
}

/// A finished plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Every decision of the day.
    pub trace: Trace,
    /// Profit of the day, as the simulator accounts for it, dollars.
    pub profit_usd: f64,
    /// Name of the best policy whose day was played within the budget. One search began with that
    /// day.
    pub best_policy: String,
    /// Profit of that policy, dollars. The plan is never worse.
    pub best_policy_usd: f64,
    /// Number of steps of each search.
    pub steps: u64,
}

/// The best plan of a search so far, for those who may not wait for its end.
#[derive(Clone, Default)]
pub(crate) struct BestPlan(Arc<Mutex<Option<Plan>>>);

impl BestPlan {
    /// Records the best plan so far.
    fn record(&self, plan: &Plan) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(plan.clone());
    }

    /// The best plan so far; `None` before the first policy has played the day.
    pub(crate) fn so_far(&self) -> Option<Plan> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl From<start::PlayedDay> for Plan {
    fn from(day: start::PlayedDay) -> Self {
        let start::PlayedDay { policy, trace, profit_usd } = day;
        Self { trace, profit_usd, best_policy: policy, best_policy_usd: profit_usd, steps: 0 }
    }
}

/// The number of search steps on this day that take about as much work as `paper_steps` on a day of
/// `paper`; at least one. A step looks at every flight from every vertiport in every slot of time.
pub fn steps_of_equal_work(scenario: &Scenario, paper_steps: u64) -> u64 {
    const PAPER_LOOKS: u64 = 8 * 8 * 720;
    (paper_steps * PAPER_LOOKS / looks_a_step(scenario).max(PAPER_LOOKS)).max(1)
}

fn looks_a_step(scenario: &Scenario) -> u64 {
    let minutes = u64::from(scenario.operations.end.since(scenario.operations.start)) / 60;
    (scenario.vertiports.len() as u64).pow(2) * minutes
}

/// Plans a day that is known in full: actual demand, delays, closures and outages. The plan is
/// never worse than the day of any policy that needs no learning, nor of any of `more`, if these
/// days can be played within the budget; the rolling horizon comes last. `watch` is called many
/// times a second with the progress, and returns whether to continue; if not, the plan is the best
/// found by then.
///
/// A limit of time is kept to within a second or a tenth of the limit, on days of any size.
pub fn plan(
    scenario: &Arc<Scenario>,
    settings: &SearchSettings,
    more: Vec<StartingPolicy>,
    watch: &mut dyn FnMut(&SearchProgress) -> bool,
) -> Plan {
    plan_known(scenario, settings, more, &BestPlan::default(), watch)
}

/// Does the same as [`plan()`], and records every better plan in `best` at once.
pub(crate) fn plan_known(
    scenario: &Arc<Scenario>,
    settings: &SearchSettings,
    more: Vec<StartingPolicy>,
    best: &BestPlan,
    watch: &mut dyn FnMut(&SearchProgress) -> bool,
) -> Plan {
    let clock = Clock { budget: settings.budget, begun: Instant::now() };
    let problem = Arc::new(Problem::of(scenario));
    // Where no passenger pays for a seat, no flight earns anything.
    let can_earn = Simulation::new(Arc::clone(scenario)).potential_usd() > 0.0;
    let dives = can_earn && clock.leaves_time_to_dive(scenario);
    let begin_dive = || Dive::begin(scenario, &problem, clock.end_of_dive());
    // A plan without a limit of time is one of several, perhaps, and takes one thread.
    let shares = !clock.waits_for_dive() && !clock.budget.leaves_policies_alone();
    let early = (dives && shares).then(begin_dive);
    let mut stopped = false;
    // The time that the prices of a day take at its start. The search needs them too.
    let mut first = Duration::ZERO;
    let mut plan = start::best_policy(scenario, more, best, &mut {
        let mut day = DayTimer::begin(clock.left(), 1.0);
        let (clock, stopped, first, watch) = (&clock, &mut stopped, &mut first, &mut *watch);
        move |profit_usd, day_share: Option<f64>| {
            *stopped |= !watch(&SearchProgress { share: clock.share(0), steps: 0, profit_usd });
            let Some(day_share) = day_share else {
                day = DayTimer::begin(clock.left(), 1.0);
                return !*stopped && clock.left() > *first;
            };
            day.has_decided();
            *first = (*first).max(day.first.unwrap_or_default());
            !*stopped && day.can_end(clock.left(), day_share)
        }
    });
    // Until the dives have ended, another day to begin with is worth more than improving the best
    // one so far.
    if dives && !stopped && (early.is_some() || clock.waits_for_dive()) {
        let decisions = plan.trace.rows.len().max(1) as f64;
        let mut timer = DayTimer::begin(clock.left_to_dive(), MISJUDGED);
        let day = start::rolled_thoroughly(scenario, &mut |taken| {
            let (share, profit_usd) = (clock.share(0), plan.profit_usd);
            stopped |= !watch(&SearchProgress { share, steps: 0, profit_usd });
            timer.has_decided();
            let day_share = (taken as f64 / decisions).min(1.0);
            !stopped && timer.can_end(clock.left_to_dive(), day_share)
        });
        if let Some(day) = day.filter(|day| day.profit_usd > plan.profit_usd) {
            (plan.trace, plan.profit_usd) = (day.trace, day.profit_usd);
            best.record(&plan);
        }
    }
    if can_earn && !stopped && clock.left() > first {
        let first = start::schedule_of(&problem, &plan.trace);
        let dive = early.or_else(|| dives.then(begin_dive));
        let searches = Searches::begin(scenario, settings, &problem, &first, dive);
        searches.improve(&clock, &mut plan, best, watch);
    }
    plan
}

/// A budget that is being used up.
struct Clock {
    budget: Budget,
    begun: Instant,
}

impl Clock {
    /// Share of the budget that is used after a number of steps, at most 1.
    fn share(&self, steps: u64) -> f64 {
        let share = match self.budget {
            Budget::Time(limit) => {
                self.begun.elapsed().as_secs_f64() / limit.as_secs_f64().max(1e-9)
            }
            Budget::Steps(0) => 1.0,
            Budget::Steps(limit) => steps as f64 / limit as f64,
        };
        share.min(1.0)
    }

    /// The time that is left. Practically infinite where time is not limited.
    fn left(&self) -> Duration {
        match self.budget {
            Budget::Time(limit) => limit.saturating_sub(self.begun.elapsed()),
            Budget::Steps(_) => Duration::MAX,
        }
    }

    /// The time that is left for dives. Practically infinite where time is not limited.
    fn left_to_dive(&self) -> Duration {
        match self.budget {
            Budget::Time(limit) => limit.mul_f64(DIVE_SHARE).saturating_sub(self.begun.elapsed()),
            Budget::Steps(_) => Duration::MAX,
        }
    }

    /// Whether to begin dives: with a limit of time if there are a few seconds, and otherwise if
    /// there are steps for whole ones.
    fn leaves_time_to_dive(&self, scenario: &Scenario) -> bool {
        match self.budget {
            Budget::Time(limit) => limit >= LEAST_TO_DIVE,
            Budget::Steps(limit) => dive::search_steps(scenario) <= DIVE_SHARE * limit as f64,
        }
    }

    /// When dives that begin now have to end, if time is limited.
    fn end_of_dive(&self) -> Option<Instant> {
        match self.budget {
            Budget::Time(_) => Some(Instant::now() + self.left().mul_f64(DIVE_SHARE)),
            Budget::Steps(_) => None,
        }
    }

    /// The most steps of each search in the next round.
    fn steps_a_round(&self, done: u64) -> u64 {
        match self.budget {
            Budget::Time(_) => STEPS_A_ROUND,
            Budget::Steps(limit) => STEPS_A_ROUND.min(limit - done),
        }
    }

    /// Whether searches wait for the dive before their first step, so that chance of time has no
    /// effect on the plan.
    fn waits_for_dive(&self) -> bool {
        matches!(self.budget, Budget::Steps(_))
    }

    /// The latest end of the next round, where time is limited.
    fn end_of_round(&self) -> Option<Instant> {
        let Budget::Time(limit) = self.budget else { return None };
        Some((self.begun + limit).min(Instant::now() + Duration::from_secs_f64(ROUND_S)))
    }
}

/// Measures the time that a policy takes to play a day.
struct DayTimer {
    begun: Instant,
    judged_after: Duration,
    /// How many times as long as there is time for a day may seem to take.
    misjudged: f64,
    /// Duration of the first decision, which includes much preparation.
    first: Option<Duration>,
    /// The time of the latest decision, and the longest duration of any decision after the first.
    latest: Instant,
    longest: Duration,
}

impl DayTimer {
    /// A day that begins with some time left.
    fn begin(left: Duration, misjudged: f64) -> Self {
        let now = Instant::now();
        let judged_after = left.mul_f64(JUDGED_FROM);
        let longest = Duration::ZERO;
        Self { begun: now, judged_after, misjudged, first: None, latest: now, longest }
    }

    fn has_decided(&mut self) {
        let now = Instant::now();
        let took = now - self.latest;
        self.latest = now;
        if self.first.is_some() {
            self.longest = self.longest.max(took);
        } else {
            self.first = Some(took);
        }
    }

    /// Whether a policy may continue with the day, of which a share has been played, with some time
    /// left: there must be time for one more decision, and the day must seem to end in time.
    fn can_end(&self, left: Duration, day_share: f64) -> bool {
        let played = self.begun.elapsed();
        let seems_to_end = || to_come_s(played, day_share) <= self.misjudged * left.as_secs_f64();
        left > self.longest && (played < self.judged_after || seems_to_end())
    }
}

/// Seconds that the rest of a day will take, if a share of the day took `played`. Policies look
/// ahead to the end of the day, so the time of a decision is about proportional to the rest of the
/// day: the first half of a day takes three quarters of its time.
fn to_come_s(played: Duration, day_share: f64) -> f64 {
    let to_come = (1.0 - day_share).powi(2);
    played.as_secs_f64() * to_come / (1.0 - to_come)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::to_come_s;

    #[test]
    fn the_first_half_of_a_day_takes_three_quarters_of_its_time() {
        let played = Duration::from_secs(3);
        assert!((to_come_s(played, 0.5) - 1.0).abs() < 1e-12);
        assert_eq!((to_come_s(played, 1.0), to_come_s(played, 0.0)), (0.0, f64::INFINITY));
    }
}
