//! A policy with everything that it needs to decide; each thread that needs the policy builds its
//! own.

use std::fmt;
use std::sync::Arc;

use vertifleet_core::{Network, Scenario, Stop};
use vertifleet_learn::{Curve, Model, Observation};
use vertifleet_optimize::Rolling;
use vertifleet_picture::numbers::grouped;
use vertifleet_policy::{BidPricePolicy, Greedy, Policy, Random, Replay, Stoppable, play};
use vertifleet_sim::{DayTotals, Simulation, Trace};

use crate::error::Error;
use crate::origin::{NetworkOrigin, network_of};
use crate::sees::Sees;

/// A policy that can be built.
#[derive(Debug, Clone)]
pub enum ResolvedPolicy {
    /// [`Random`] with this seed.
    Random(u64),
    /// [`Greedy`].
    Greedy,
    /// [`BidPricePolicy`].
    BidPrices,
    /// [`Rolling`].
    Rolling,
    /// A policy of the user's own.
    Own(PolicyFactory),
    /// [`Replay`] of a trace.
    Replay(Arc<Trace>),
    /// A learned policy.
    Learned {
        /// Its weights.
        model: Arc<Model>,
        /// How many choices `gcaps-x` rolls out; with 1 it decides at once, as the others always
        /// do.
        most_rolled_out: usize,
        /// The learning curve of the run of these weights, followed by those of runs with other
        /// seeds.
        curves: Vec<Curve>,
        /// Whether the program ships the weights.
        is_shipped: bool,
    },
}

/// Makes the factory of policies for days of a network.
pub type OnNetwork = dyn Fn(&Network) -> Result<PolicyFactory, Error> + Send + Sync;

/// Makes policies, one for each thread that needs one.
#[derive(Clone)]
pub struct PolicyFactory {
    /// What tells them from other policies of the user's own, in the journal of a sweep.
    pub identity: String,
    /// Makes one.
    pub make: Arc<dyn Fn() -> Box<dyn Policy> + Send + Sync>,
    /// Makes the factory of the same policies for days of another network.
    pub on: Arc<OnNetwork>,
    /// What the policies look at.
    pub sees: Sees,
    /// Whether they are asked about many days at once, by [`Policy::choose_batch`].
    pub in_batches: bool,
}

impl fmt::Debug for PolicyFactory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("PolicyFactory")
    }
}

impl ResolvedPolicy {
    /// Builds a policy of this kind.
    pub fn build(&self) -> Box<dyn Policy> {
        match self {
            Self::Random(seed) => Box::new(Random::new(*seed)),
            Self::Greedy => Box::new(Greedy),
            Self::BidPrices => Box::new(BidPricePolicy::default()),
            Self::Rolling => Box::new(Rolling::default()),
            Self::Own(factory) => (factory.make)(),
            Self::Replay(trace) => Box::new(Replay::new(Arc::clone(trace))),
            Self::Learned { model, most_rolled_out, .. } => model.policy(*most_rolled_out),
        }
    }

    /// Whether it is asked about many days at once.
    pub(crate) fn plays_in_batches(&self) -> bool {
        matches!(self, Self::Own(PolicyFactory { in_batches: true, .. }))
    }

    /// Plays a day to its end; `name` is the policy's name in an error.
    ///
    /// # Errors
    /// Returns [`Error::Stuck`] if the policy cannot play the day; [`Error::Stopped`] soon after
    /// `stop` is requested.
    pub fn play(
        &self,
        name: &str,
        day: &Arc<Scenario>,
        stop: &Stop,
    ) -> Result<(Trace, DayTotals), Error> {
        let mut simulation = Simulation::new(Arc::clone(day));
        let mut trace = Trace::default();
        let mut policy = self.build();
        let mut policy = Stoppable { policy: policy.as_mut(), stop };
        play(&mut simulation, &mut policy, |row| trace.rows.push(*row))
            .map_err(|cause| Error::of_play(name, &day.name, cause))?;
        Ok((trace, simulation.totals()))
    }

    /// Checks that the policy can play this day.
    ///
    /// # Errors
    /// Returns [`Error::Learn`] if its weights belong to another network.
    pub fn check_fits(&self, scenario: &Scenario) -> Result<(), Error> {
        match self {
            Self::Learned { model, .. } => Ok(model.check_fits(scenario)?),
            _ => Ok(()),
        }
    }

    /// The warning V310 for one day: shipped weights are to decide on a changed copy of their
    /// network.
    pub fn warning_for(&self, name: &str, day: &Scenario) -> Option<String> {
        let network = network_of(day);
        self.warning(name, network, || NetworkOrigin::of(network, [day]))
    }

    /// V310 shipped weights on a changed network (warning). `gcaps` or `mlp` uses the weights that
    /// are shipped for a network, but the days are not days of that network: its file or the
    /// scenario was copied and changed, and kept its name. This is a warning: the weights decide
    /// all the same, and often well, but they were not trained with the change. The report then
    /// does not show the published figures.
    ///
    /// Fix: none is needed if this is what you want. Otherwise train weights on your network and
    /// give them with `--model`, or give your network another name.
    pub(crate) fn warning(
        &self,
        name: &str,
        network: &str,
        origin: impl FnOnce() -> NetworkOrigin,
    ) -> Option<String> {
        let Self::Learned { is_shipped: true, model, .. } = self else { return None };
        let is_for_another =
            model.header().shape.vertiports.is_some() && origin() == NetworkOrigin::Changed;
        is_for_another.then(|| {
            format!(
                "policy {name:?} was trained on network {network:?} as it is shipped, but this is a changed copy of it; `vertifleet train` makes weights for the copy"
            )
        })
    }

    /// What the policy looks at. A trace may come from a planner, who knew the day.
    pub fn sees(&self) -> Sees {
        match self {
            Self::Own(factory) => factory.sees,
            Self::Replay(_) => Sees::WholeDay,
            Self::Random(_) | Self::Greedy => Sees::Present,
            Self::Learned { model, .. }
                if model.header().policy.observation() == Observation::Paper =>
            {
                Sees::Present
            }
            Self::BidPrices | Self::Rolling | Self::Learned { .. } => Sees::Forecast,
        }
    }

    /// Describes what the policy does, in one short sentence.
    pub(crate) fn description(&self) -> String {
        match self {
            Self::Random(_) => "draws evenly among the feasible vertiports (Feas-RND)".to_owned(),
            Self::Greedy => "takes the flight with the highest profit per hour".to_owned(),
            Self::BidPrices => "takes what is worth most at the day's prices".to_owned(),
            Self::Rolling => "rolls out what is worth nearly most at the day's prices".to_owned(),
            Self::Own(_) => "decides in its own way".to_owned(),
            Self::Replay(_) => "repeats the decisions of a trace".to_owned(),
            Self::Learned { model, most_rolled_out, .. } => {
                let header = model.header();
                let decisions = grouped(header.steps as f64, 0);
                match (header.policy.observation(), most_rolled_out) {
                    (Observation::Paper | Observation::Full { .. }, _) => {
                        format!("learned on {} from {decisions} decisions", header.network)
                    }
                    (Observation::Priced { .. }, 1) => {
                        format!("learned what prices miss from {decisions} decisions")
                    }
                    (Observation::Priced { .. }, most) => format!(
                        "learned what prices miss from {decisions} decisions; rolls its {most} best choices out"
                    ),
                }
            }
        }
    }

    /// SHA-256 of its weight file, if it has one.
    pub fn weights_sha256(&self) -> Option<String> {
        match self {
            Self::Learned { model, .. } => Some(model.sha256()),
            _ => None,
        }
    }

    /// The seed of the training run that made its weights, if they state it.
    pub(crate) fn training_seed(&self) -> Option<u32> {
        match self {
            Self::Learned { model, .. } => model.header().seed,
            _ => None,
        }
    }

    /// The name of the network whose days it was trained on, if it was trained.
    pub(crate) fn trained_on(&self) -> Option<&str> {
        match self {
            Self::Learned { model, .. } => Some(&model.header().network),
            _ => None,
        }
    }

    /// Decisions learned from and mean reward on the training days; empty for a policy that does
    /// not learn from rewards.
    pub(crate) fn training_rewards(&self) -> Vec<(u64, f64)> {
        match self {
            Self::Learned { curves, .. } => {
                curves.first().map(Curve::training_rewards).unwrap_or_default()
            }
            _ => Vec::new(),
        }
    }

    /// Decisions learned from and mean reward on the validation days, run by run; empty for a
    /// policy that was not trained, or not validated during its training.
    pub(crate) fn validation_rewards(&self) -> Vec<Vec<(u64, f64)>> {
        let mut runs: Vec<Vec<(u64, f64)>> = match self {
            // With roll-outs the policy decides in another way than it did in training, so the
            // curves do not apply.
            Self::Learned { curves, most_rolled_out: 1, .. } => {
                curves.iter().map(Curve::validation_rewards).collect()
            }
            _ => Vec::new(),
        };
        runs.retain(|run| !run.is_empty());
        runs
    }
}
