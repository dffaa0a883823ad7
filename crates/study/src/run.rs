//! Plays every policy on every day of a comparison, on all available threads.
//!
//! A policy plays a day the same way regardless of the rest of the comparison, so the records are
//! the same on any number of threads. Only the times per decision are measurements of this machine,
//! taken while its other threads are busy too.

mod batches;

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{Scenario, Stop, VertiportIx};
use vertifleet_policy::{Policy, PolicyError, Replay, Stoppable, play};
use vertifleet_sim::{Decision, Simulation, TraceRow, View};

use crate::competitor::{Competitor, Kind, Planner};
use crate::error::Error;
use crate::record::{DayRecord, LatencySummary, PolicyRecord};
use crate::resolved_policy::ResolvedPolicy;

/// A day of a comparison.
pub(crate) struct BoundedDay {
    /// The scenario that every policy plays.
    pub scenario: Arc<Scenario>,
    /// Its upper bound in dollars, if one was asked for.
    pub upper_bound_usd: Option<f64>,
}

impl From<Arc<Scenario>> for BoundedDay {
    fn from(scenario: Arc<Scenario>) -> Self {
        Self { scenario, upper_bound_usd: None }
    }
}

/// What is kept of a day that was played.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kept {
    /// Its totals.
    Totals,
    /// Every choice of every day too.
    Choices,
    /// Every choice of the first days too; of the others, their totals.
    ChoicesOfFirst(usize),
}

impl Kept {
    /// Whether the choices of the day at this position are kept.
    fn has_choices(self, position: usize) -> bool {
        match self {
            Self::Totals => false,
            Self::Choices => true,
            Self::ChoicesOfFirst(days) => position < days,
        }
    }
}

/// Plays all days with a competitor. `played` is called after each of them, from any thread.
///
/// # Errors
/// Returns [`Error::Stuck`] if a policy cannot play a day to its end; [`Error::Stopped`] soon after
/// `stop` is requested.
pub(crate) fn play_all(
    competitor: &Competitor,
    days: &[BoundedDay],
    kept: Kept,
    stop: &Stop,
    played: &(impl Fn() + Sync),
) -> Result<PolicyRecord, Error> {
    let name = &competitor.name;
    let (days, decision_ns) = match &competitor.kind {
        Kind::Policy(policy) => {
            let (days, time) = play_policy(name, policy, days, kept, stop, played)?;
            (days, Some(time))
        }
        Kind::Planner(planner) => (play_plans(name, planner, days, kept, stop, played)?, None),
    };
    Ok(competitor.record(days, decision_ns))
}

/// Plays all days with a policy that decides while they are played, one policy per thread, and
/// measures the time of its decisions.
fn play_policy(
    name: &str,
    policy: &ResolvedPolicy,
    days: &[BoundedDay],
    kept: Kept,
    stop: &Stop,
    played: &(impl Fn() + Sync),
) -> Result<(Vec<DayRecord>, LatencySummary), Error> {
    if policy.plays_in_batches() {
        return batches::play(name, policy, days, kept, stop, played);
    }
    let play = |policy: &mut Box<dyn Policy>, (position, day): (usize, &BoundedDay)| {
        let policy = Stoppable { policy: policy.as_mut(), stop };
        let mut timed = Timed { policy, nanoseconds: Vec::new() };
        let record = play_day(name, &mut timed, day, kept.has_choices(position))?;
        played();
        Ok((record, timed.nanoseconds))
    };
    let results: Vec<(DayRecord, Vec<u64>)> = days
        .par_iter()
        .enumerate()
        .map_init(|| policy.build(), play)
        .collect::<Result<_, Error>>()?;
    let (records, nanoseconds): (Vec<DayRecord>, Vec<Vec<u64>>) = results.into_iter().unzip();
    Ok((records, latency(nanoseconds.concat())))
}

/// Plans all days, each with the whole day known, and plays the plans.
fn play_plans(
    name: &str,
    planner: &Planner,
    days: &[BoundedDay],
    kept: Kept,
    stop: &Stop,
    played: &(impl Fn() + Sync),
) -> Result<Vec<DayRecord>, Error> {
    let play = |(position, day): (usize, &BoundedDay)| {
        let mut replay = Replay::new(Arc::new(planner.plan(&day.scenario, stop)));
        if stop.is_requested() {
            return Err(Error::Stopped);
        }
        let record = play_day(name, &mut replay, day, kept.has_choices(position))?;
        played();
        Ok(record)
    };
    days.par_iter().enumerate().map(play).collect()
}

fn play_day(
    name: &str,
    policy: &mut dyn Policy,
    day: &BoundedDay,
    keeps_choices: bool,
) -> Result<DayRecord, Error> {
    let mut simulation = Simulation::new(Arc::clone(&day.scenario));
    let mut choices = Vec::new();
    let keep = |row: &TraceRow| {
        if keeps_choices {
            choices.push(row.to);
        }
    };
    play(&mut simulation, policy, keep)
        .map_err(|cause| Error::of_play(name, &day.scenario.name, cause))?;
    Ok(record(day, &simulation, choices))
}

/// The record of a day that has been played.
fn record(day: &BoundedDay, simulation: &Simulation, choices: Vec<VertiportIx>) -> DayRecord {
    DayRecord {
        day: day.scenario.name.clone(),
        seed: day.scenario.seed,
        totals: simulation.totals(),
        upper_bound_usd: day.upper_bound_usd,
        choices,
    }
}

/// A policy whose every choice is timed separately, as a dispatcher would ask for it, until a stop
/// is requested.
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

/// The median and the 99th percentile as times that did occur (nearest rank); zero if there were no
/// decisions.
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

    use super::{BoundedDay, Kept, LatencySummary, PolicyRecord, latency, play_all};
    use crate::comparison::ComparisonReport;
    use crate::competitor::{Competitor, Kind, Planner};
    use crate::resolved_policy::ResolvedPolicy;
    use crate::{ComparisonRecords, DayRecord, NetworkOrigin};

    fn competitors() -> Vec<Competitor> {
        let kinds = [
            ("random", Kind::Policy(ResolvedPolicy::Random(7))),
            // With one step the planner finds nothing better than its start, which does not matter
            // here.
            ("plan", Kind::Planner(Planner { paper_steps: 1, seed: 7 })),
            ("greedy", Kind::Policy(ResolvedPolicy::Greedy)),
        ];
        kinds.map(|(name, kind)| Competitor { name: name.to_owned(), kind }).into()
    }

    fn played_on(threads: usize) -> Vec<PolicyRecord> {
        let network = Network::shipped("paper").expect("a shipped network");
        let seeds = (11..14).map(|seed| DaySeed::comparison(seed).expect("a seed for comparison"));
        let day = |seed| BoundedDay {
            scenario: Arc::new(network.draw(seed)),
            upper_bound_usd: Some(50_000.0),
        };
        let days: Vec<BoundedDay> = seeds.map(day).collect();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let play = |competitor: &Competitor| {
            play_all(competitor, &days, Kept::Totals, &Stop::default(), &|| ())
        };
        pool.install(|| competitors().iter().map(play).collect::<Result<_, _>>())
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
        let days = [BoundedDay::from(Arc::new(day))];
        let stop = Stop::default();
        stop.request();
        for competitor in competitors() {
            let error = play_all(&competitor, &days, Kept::Totals, &stop, &|| ())
                .expect_err("nothing was to be played");
            assert_eq!(error.code().to_string(), "V408", "{}", competitor.name);
        }
    }

    #[test]
    fn played_days_sum_up_to_a_comparison() {
        let study = ComparisonRecords {
            network: "paper".to_owned(),
            network_origin: NetworkOrigin::Shipped,
            seed: Some(11),
            split: vertifleet_core::Purpose::Comparison,
            days_from: None,
            days: 3,
            bound_step_s: Some(300),
            command: "vertifleet compare".to_owned(),
            policies: played_on(2),
            curves: Vec::new(),
            trainings: Vec::new(),
            replayed: Vec::new(),
        };
        let summary = ComparisonReport::of(&study).expect("records of one run");
        assert_eq!(summary.day_seeds, Some((11, 13)));
        let [plan, greedy, random] = &summary.policies[..] else { panic!("three took part") };
        assert!(
            plan.profit_usd.mean > greedy.profit_usd.mean,
            "it begins from the best policy's days"
        );
        assert!(plan.knows_the_day() && plan.decision_ns.is_none());
        for policy in [greedy, random] {
            assert!(policy.decision_ns.is_some_and(|time| time.p99 > 0));
        }
        assert_eq!(summary.best().name, "greedy", "a reference that knows the day is no policy");
        for day in study.policies.iter().flat_map(|policy| &policy.days) {
            assert_eq!(day.totals.decisions, day.totals.flights + day.totals.holds);
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
