//! The validation days of a run: the profit of a policy compared with that of `prices`.

use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{DaySeed, Network, Purpose, Scenario, World, random_city};
use vertifleet_policy::{BidPricePolicy, Policy, play};
use vertifleet_sim::{DayTotals, Simulation};

use crate::error::Error;
use crate::model::Model;

/// The days, each with the profit of `prices`.
pub(crate) struct ValidationDays {
    own: Vec<(Arc<Scenario>, f64)>,
    /// Of random networks, if the weights fit networks of any size.
    random: Vec<(Arc<Scenario>, f64)>,
}

/// Means over validation days.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Validated {
    /// Mean reward on the network's days.
    pub(crate) reward: f64,
    /// Profit above that of `prices`, as a share of the profit of `prices`.
    pub(crate) gain: f64,
    /// The same on days of random networks.
    pub(crate) random_gain: Option<f64>,
}

impl ValidationDays {
    /// This number of days of a world, and, if `of_any_size` is set, as many of random networks and
    /// [`random_city`], in turns.
    pub(crate) fn of(world: &World, count: u32, of_any_size: bool) -> Result<Self, Error> {
        let random = if of_any_size { count } else { 0 };
        let of_world = |day| world.network(Purpose::Validation, day);
        let at_random = |day| match day % 2 {
            0 => World::Random.network(Purpose::Validation, day),
            _ => Arc::new(random_city(Purpose::Validation, day)),
        };
        Ok(Self { own: drawn(of_world, count)?, random: drawn(at_random, random)? })
    }

    /// Plays the days with a model.
    pub(crate) fn measure(&self, model: &Model) -> Validated {
        let [own, random] = [&self.own, &self.random].map(|days| means(model, days));
        Validated {
            reward: own.0,
            gain: own.1,
            random_gain: (!self.random.is_empty()).then_some(random.1),
        }
    }
}

fn drawn(
    network: impl Fn(u64) -> Arc<Network>,
    count: u32,
) -> Result<Vec<(Arc<Scenario>, f64)>, Error> {
    let days = (0..u64::from(count))
        .map(|day| Ok(network(day).draw(DaySeed::validation(day)?)))
        .collect::<Result<Vec<Scenario>, Error>>()?;
    let days: Vec<Arc<Scenario>> = days.into_iter().map(Arc::new).collect();
    let priced = |day: &Arc<Scenario>| played(&mut BidPricePolicy::default(), day).profit_usd;
    Ok(days.par_iter().map(|day| (Arc::clone(day), priced(day))).collect())
}

/// The mean reward and the mean gain over some days; 0 without days.
fn means(model: &Model, days: &[(Arc<Scenario>, f64)]) -> (f64, f64) {
    let outcomes: Vec<(f64, f64)> = days
        .par_iter()
        .map(|(day, priced_usd)| {
            let played = played(model.policy(1).as_mut(), day);
            (played.reward, played.profit_usd / priced_usd - 1.0)
        })
        .collect();
    let mean = |of: fn(&(f64, f64)) -> f64| {
        outcomes.iter().map(of).sum::<f64>() / outcomes.len().max(1) as f64
    };
    (mean(|outcome| outcome.0), mean(|outcome| outcome.1))
}

/// Plays a day to its end.
pub(crate) fn played(policy: &mut dyn Policy, day: &Arc<Scenario>) -> DayTotals {
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, policy, |_| ()).expect("the policy has an answer for every decision");
    simulation.totals()
}
