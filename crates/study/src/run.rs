//! Plays every policy on every day of a comparison, on all threads that there are.
//!
//! A policy plays a day the same way whatever else it plays, so the records are the same on any number of threads.
//! Only the times per decision are measurements of this machine, taken while its other threads play too.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{Scenario, Stop, VertiportIx};
use vertifleet_policy::{Policy, PolicyError, Replay, Stoppable, play};
use vertifleet_sim::{Decision, Simulation, Trace, View};

use crate::error::Error;
use crate::record::{DayRecord, LatencySummary, PolicyRecord};

/// A day of a comparison.
pub struct BoundedDay {
    /// What every policy meets.
    pub scenario: Arc<Scenario>,
    /// What no schedule of it earns more than, dollars, where that is asked for.
    pub upper_bound_usd: Option<f64>,
}

impl BoundedDay {
    /// A day whose bound is not asked for.
    pub fn unbounded(scenario: Arc<Scenario>) -> Self {
        Self { scenario, upper_bound_usd: None }
    }
}

/// Who takes part: its name and how it comes to its decisions.
pub struct Contender<'a> {
    /// Name as the user gave it.
    pub name: String,
    /// What it does, in one short sentence.
    pub description: String,
    /// How it comes to its decisions.
    pub way: Way<'a>,
}

/// How a contender comes to its decisions.
pub enum Way<'a> {
    /// A policy, made anew for each thread, decides while the day goes on.
    Online(Box<dyn Fn() -> Box<dyn Policy> + Sync + 'a>),
    /// The planner plans the day, knowing all of it: a reference for policies, which do not.
    Offline(Planner<'a>),
}

/// The whole schedule of a day that is known; some schedule soon once the flag is raised.
pub type Planner<'a> = Box<dyn Fn(&Arc<Scenario>, &Stop) -> Trace + Sync + 'a>;

/// Those who take part, no two of the same name: everything after this tells them apart by it.
pub struct Contenders<'a>(Vec<Contender<'a>>);

impl<'a> Contenders<'a> {
    /// These policies, in this order.
    ///
    /// # Errors
    /// [`Error::DuplicatePolicy`] if two have the same name.
    pub fn new(contenders: Vec<Contender<'a>>) -> Result<Self, Error> {
        for (position, Contender { name, .. }) in contenders.iter().enumerate() {
            if contenders[..position].iter().any(|other| other.name == *name) {
                return Err(Error::DuplicatePolicy { name: name.clone() });
            }
        }
        Ok(Self(contenders))
    }
}

/// Plays all days with every contender, one contender after the other. `begin` is given the name of the one that begins, and
/// gives what is called after each of its days, from any thread.
///
/// # Errors
/// [`Error::Stuck`] if a policy cannot play a day to its end; [`Error::Stopped`] soon after `stop` is raised.
pub fn run<Played: Fn() + Sync>(
    days: &[BoundedDay],
    contenders: &Contenders<'_>,
    stop: &Stop,
    mut begin: impl FnMut(&str) -> Played,
) -> Result<Vec<PolicyRecord>, Error> {
    let mut play = |(position, contender): (usize, &Contender<'_>)| {
        play_days(position, contender, (days, stop), &begin(&contender.name))
    };
    contenders.0.iter().enumerate().map(&mut play).collect()
}

fn play_days(
    position: usize,
    contender: &Contender<'_>,
    (days, stop): (&[BoundedDay], &Stop),
    played: &(impl Fn() + Sync),
) -> Result<PolicyRecord, Error> {
    let (records, decision_ns) = match &contender.way {
        Way::Online(make) => {
            let results: Vec<(DayRecord, Vec<u64>)> = days
                .par_iter()
                .map_init(make, |policy, day| {
                    let policy = Stoppable { policy: policy.as_mut(), stop };
                    let mut timed = Timed { policy, nanoseconds: Vec::new() };
                    let record = play_day(position, contender, &mut timed, day)?;
                    played();
                    Ok((record, timed.nanoseconds))
                })
                .collect::<Result<_, Error>>()?;
            let (records, nanoseconds): (Vec<DayRecord>, Vec<Vec<u64>>) =
                results.into_iter().unzip();
            (records, Some(latency(nanoseconds.concat())))
        }
        Way::Offline(plan) => {
            let records = days
                .par_iter()
                .map(|day| {
                    let mut planned = Replay::new(Arc::new(plan(&day.scenario, stop)));
                    if stop.is_requested() {
                        return Err(Error::Stopped);
                    }
                    let record = play_day(position, contender, &mut planned, day)?;
                    played();
                    Ok(record)
                })
                .collect::<Result<_, Error>>()?;
            (records, None)
        }
    };
    Ok(PolicyRecord {
        name: contender.name.clone(),
        description: contender.description.clone(),
        days: records,
        decision_ns,
    })
}

fn play_day(
    position: usize,
    contender: &Contender<'_>,
    policy: &mut dyn Policy,
    day: &BoundedDay,
) -> Result<DayRecord, Error> {
    let mut simulation = Simulation::new(Arc::clone(&day.scenario));
    play(&mut simulation, policy, |_| ())
        .map_err(|cause| Error::of_play(&contender.name, &day.scenario.name, cause))?;
    Ok(record(position, day, &simulation.summary()))
}

fn record(policy: usize, day: &BoundedDay, summary: &vertifleet_sim::DayTotals) -> DayRecord {
    DayRecord {
        policy,
        day: day.scenario.name.clone(),
        seed: day.scenario.seed,
        profit_usd: summary.profit,
        revenue_usd: summary.revenue,
        passenger_cost_usd: summary.passenger_cost,
        energy_cost_usd: summary.energy_cost,
        flight_cost_usd: summary.flight_cost,
        aircraft_cost_usd: summary.aircraft_cost,
        energy_kwh: summary.energy_kwh,
        potential_usd: summary.potential,
        reward: summary.reward,
        flights: summary.flights,
        repositioning_flights: summary.repositioning_flights,
        holds: summary.holds,
        decisions: summary.decisions,
        passengers: summary.passengers,
        spilled_passengers: summary.spilled_passengers,
        load_factor: summary.load_factor,
        upper_bound_usd: day.upper_bound_usd,
    }
}

/// A policy whose every choice is timed, one by one as a dispatcher would ask, until it is stopped.
struct Timed<'a> {
    policy: Stoppable<'a, dyn Policy>,
    nanoseconds: Vec<u64>,
}

impl Policy for Timed<'_> {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let start = Instant::now();
        let choice = self.policy.choose(decision, view);
        self.nanoseconds.push(u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX));
        choice
    }
}

/// Median and 99th percentile as values that did occur (nearest rank); zero if nothing was decided.
fn latency(mut nanoseconds: Vec<u64>) -> LatencySummary {
    nanoseconds.sort_unstable();
    let at_rank = |percent: usize| {
        let rank = (nanoseconds.len() * percent).div_ceil(100);
        rank.checked_sub(1).map_or(0, |position| nanoseconds[position])
    };
    LatencySummary { median_ns: at_rank(50), p99_ns: at_rank(99) }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use vertifleet_core::{Coded, DaySeed, Network, Stop};
    use vertifleet_policy::{Greedy, Random, play};
    use vertifleet_sim::{Simulation, Trace};

    use super::{
        BoundedDay, Contender, Contenders, LatencySummary, PolicyRecord, Way, latency, run,
    };
    use crate::summary::ComparisonReport;
    use crate::{ComparisonRecords, DayRecord, NetworkOrigin};

    fn greedy(name: &str) -> Contender<'static> {
        Contender {
            name: name.to_owned(),
            description: String::new(),
            way: Way::Online(Box::new(|| Box::new(Greedy))),
        }
    }

    fn contenders() -> Contenders<'static> {
        let random = Contender {
            name: "random".to_owned(),
            description: String::new(),
            way: Way::Online(Box::new(|| Box::new(Random::new(7)))),
        };
        // Knows no more than greedy does, but that is no matter here.
        let plan = Contender {
            name: "plan".to_owned(),
            description: String::new(),
            way: Way::Offline(Box::new(|day, _| {
                let mut trace = Trace::default();
                let mut simulation = Simulation::new(Arc::clone(day));
                play(&mut simulation, &mut Greedy, |row| trace.rows.push(*row)).expect("a day");
                trace
            })),
        };
        Contenders::new(vec![random, plan, greedy("greedy")]).expect("different names")
    }

    #[test]
    fn a_name_that_comes_twice_is_refused_before_any_day_is_played() {
        let repeated = vec![greedy("one"), greedy("two"), greedy("one")];
        let error = Contenders::new(repeated).err().expect("a name that comes twice");
        assert_eq!(error.code().to_string(), "V404");
        assert!(error.to_string().contains("\"one\""), "{error}");
    }

    fn played_on(threads: usize) -> Vec<PolicyRecord> {
        let network = Network::shipped("paper").expect("a shipped network");
        let seeds = (11..17).map(|seed| DaySeed::comparison(seed).expect("a seed for comparison"));
        let day = |seed| BoundedDay {
            scenario: Arc::new(network.draw(seed)),
            upper_bound_usd: Some(50_000.0),
        };
        let days: Vec<BoundedDay> = seeds.map(day).collect();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| run(&days, &contenders(), &Stop::default(), |_| || ()))
            .expect("every day is played")
    }

    #[test]
    fn records_are_the_same_on_any_number_of_threads() {
        let records = |policies: Vec<PolicyRecord>| {
            policies.into_iter().map(|policy| policy.days).collect::<Vec<Vec<DayRecord>>>()
        };
        assert_eq!(records(played_on(1)), records(played_on(3)));
    }

    #[test]
    fn a_run_that_is_stopped_says_so() {
        let network = Network::shipped("paper").expect("a shipped network");
        let day = network.draw(DaySeed::comparison(1).expect("a seed for comparison"));
        let days = [BoundedDay::unbounded(Arc::new(day))];
        let stop = Stop::default();
        stop.request();
        let error =
            run(&days, &contenders(), &stop, |_| || ()).expect_err("nothing was to be played");
        assert_eq!(error.code().to_string(), "V408");
    }

    #[test]
    fn played_days_sum_up_to_a_comparison() {
        let study = ComparisonRecords {
            network: "paper".to_owned(),
            network_origin: NetworkOrigin::Shipped,
            seed: Some(11),
            days_from: None,
            days: 6,
            bound_step_s: Some(300),
            command: "vertifleet compare".to_owned(),
            policies: played_on(2),
            curves: Vec::new(),
            trainings: Vec::new(),
        };
        let summary = ComparisonReport::of(&study).expect("records of one run");
        assert_eq!(summary.day_seeds, Some((11, 16)));
        let [plan, greedy, random] = &summary.policies[..] else { panic!("three took part") };
        assert_eq!(plan.profit_usd, greedy.profit_usd, "its days are greedy's, flown once more");
        assert!(plan.is_offline() && plan.decision_ns.is_none());
        for policy in [greedy, random] {
            assert!(policy.decision_ns.is_some_and(|time| time.p99 > 0));
        }
        assert_eq!(summary.best().name, "greedy", "a reference that knows the day is no policy");
        for day in study.policies.iter().flat_map(|policy| &policy.days) {
            assert_eq!(day.decisions, day.flights + day.holds);
        }
    }

    #[test]
    fn percentiles_are_times_that_occurred() {
        let summary = |median_ns, p99_ns| LatencySummary { median_ns, p99_ns };
        assert_eq!(latency(Vec::new()), summary(0, 0));
        assert_eq!(latency(vec![9]), summary(9, 9));
        assert_eq!(latency((1..=200).rev().collect()), summary(100, 198));
    }
}
