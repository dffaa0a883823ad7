//! Plays every policy on every day of a comparison, on all threads that there are.
//!
//! A policy's choice depends on the decision and the view alone, so the records are the same on any number of threads.
//! Only the times per decision are measurements of this machine, taken while its other threads play too.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_policy::{Policy, PolicyError, play};
use vertifleet_sim::{Decision, Simulation, View};

use crate::error::Error;
use crate::record::{DayRecord, LatencySummary, PolicyRecord};

/// A policy that takes part: its name and how to make one for each thread.
pub struct Contender<'a> {
    /// Name as the user gave it.
    pub name: String,
    /// What the policy does, in one short sentence.
    pub description: String,
    /// Makes the policy anew.
    pub make: Box<dyn Fn() -> Box<dyn Policy> + Sync + 'a>,
}

/// The policies that take part, no two of the same name: everything after this tells them apart by it.
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

/// Plays all days with every contender; `played` is called after each day of each of them, from any thread.
///
/// # Errors
/// [`Error::Stuck`] if a policy cannot play a day to its end.
pub fn run(
    days: &[Arc<Scenario>],
    contenders: &Contenders<'_>,
    played: &(impl Fn() + Sync),
) -> Result<Vec<PolicyRecord>, Error> {
    contenders
        .0
        .iter()
        .enumerate()
        .map(|(position, contender)| play_days(position, contender, days, played))
        .collect()
}

fn play_days(
    position: usize,
    contender: &Contender<'_>,
    days: &[Arc<Scenario>],
    played: &(impl Fn() + Sync),
) -> Result<PolicyRecord, Error> {
    let results: Vec<(DayRecord, Vec<u64>)> = days
        .par_iter()
        .map_init(&contender.make, |policy, day| {
            let result = play_day(position, contender, policy.as_mut(), day);
            played();
            result
        })
        .collect::<Result<_, Error>>()?;
    let (records, nanoseconds): (Vec<DayRecord>, Vec<Vec<u64>>) = results.into_iter().unzip();
    Ok(PolicyRecord {
        name: contender.name.clone(),
        description: contender.description.clone(),
        days: records,
        decision_ns: latency(nanoseconds.concat()),
    })
}

fn play_day(
    position: usize,
    contender: &Contender<'_>,
    policy: &mut dyn Policy,
    day: &Arc<Scenario>,
) -> Result<(DayRecord, Vec<u64>), Error> {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut timed = Timed { policy, nanoseconds: Vec::new() };
    play(&mut simulation, &mut timed, |_| ()).map_err(|cause| Error::Stuck {
        policy: contender.name.clone(),
        day: day.name.clone(),
        cause,
    })?;
    let nanoseconds = timed.nanoseconds;
    Ok((record(position, day, &simulation.summary()), nanoseconds))
}

fn record(policy: usize, day: &Scenario, summary: &vertifleet_sim::Summary) -> DayRecord {
    DayRecord {
        policy,
        day: day.name.clone(),
        seed: day.seed,
        profit_usd: summary.profit,
        revenue_usd: summary.revenue,
        passenger_cost_usd: summary.passenger_cost,
        energy_cost_usd: summary.energy_cost,
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
    }
}

/// A policy whose every choice is timed, one by one as a dispatcher would ask.
struct Timed<'a> {
    policy: &'a mut dyn Policy,
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
    use vertifleet_policy::{Greedy, Random};

    use std::sync::Arc;

    use vertifleet_core::{DaySeed, Network};

    use super::{Contender, Contenders, LatencySummary, PolicyRecord, latency, run};
    use crate::summary::Summary;
    use crate::{DayRecord, NetworkOrigin, Study};

    fn greedy(name: &str) -> Contender<'static> {
        Contender {
            name: name.to_owned(),
            description: String::new(),
            make: Box::new(|| Box::new(Greedy)),
        }
    }

    fn contenders() -> Contenders<'static> {
        let random = Contender {
            name: "random".to_owned(),
            description: String::new(),
            make: Box::new(|| Box::new(Random::new(7))),
        };
        Contenders::new(vec![random, greedy("greedy")]).expect("different names")
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
        let days: Vec<_> = seeds.map(|seed| Arc::new(network.draw(seed))).collect();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| run(&days, &contenders(), &|| ())).expect("every day is played")
    }

    #[test]
    fn records_are_the_same_on_any_number_of_threads() {
        let records = |policies: Vec<PolicyRecord>| {
            policies.into_iter().map(|policy| policy.days).collect::<Vec<Vec<DayRecord>>>()
        };
        assert_eq!(records(played_on(1)), records(played_on(3)));
    }

    #[test]
    fn played_days_sum_up_to_a_comparison() {
        let study = Study {
            network: "paper".to_owned(),
            network_origin: NetworkOrigin::Shipped,
            seed: 11,
            days: 6,
            command: "vertifleet compare".to_owned(),
            policies: played_on(2),
            curves: Vec::new(),
        };
        let summary = Summary::of(&study).expect("records of one run");
        assert_eq!(summary.day_seeds, (11, 16));
        assert_eq!(summary.best().name, "greedy");
        assert!(summary.policies.iter().all(|policy| policy.decision_ns.p99 > 0));
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
