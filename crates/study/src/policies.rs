//! Policies by their names, as commands and the Python package take them.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use vertifleet_core::{Scenario, nearest};
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::{Curve, GcapsX, Model, Shipped, shipped};
use vertifleet_optimize::Rolling;
use vertifleet_policy::{BidPricePolicy, Greedy, Lookahead, Policy, Random, Replay};
use vertifleet_sim::Trace;

use crate::error::Error;
use crate::numbers::grouped;
use crate::origin::NetworkOrigin;

/// The policy whose weights fit networks of any size.
const ANY_SIZE: &str = "gcaps-x";

/// What a name stands for, where the caller says so: weights, mostly.
#[derive(Debug, Clone)]
pub enum Given {
    /// In a weight file, with the learning curves that may lie beside it.
    File(PathBuf),
    /// Read already.
    Model(Arc<Model>),
    /// No weights: a policy of the caller's own.
    Policy(Maker),
}

/// Makes a policy, as often as there are threads that need one.
#[derive(Clone)]
pub struct Maker(pub Arc<dyn Fn() -> Box<dyn Policy> + Send + Sync>);

impl fmt::Debug for Maker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Maker")
    }
}

/// A policy as the command line names it.
#[derive(Debug, Clone, Copy)]
pub struct Choice<'a> {
    /// Its name.
    pub name: &'a str,
    /// Seed of the random policy.
    pub seed: u64,
    /// Weights in place of the shipped ones.
    pub model: Option<&'a Given>,
}

/// A policy that may be made as often as there are threads that need one.
#[derive(Debug, Clone)]
pub enum Recipe {
    /// [`Random`] with this seed.
    Random(u64),
    /// [`Greedy`].
    Greedy,
    /// [`Lookahead`].
    Lookahead,
    /// [`BidPricePolicy`].
    BidPricePolicy,
    /// [`Rolling`].
    Rolling,
    /// Made by the caller.
    Own(Maker),
    /// [`Replay`] of a trace.
    Replay(Arc<Trace>),
    /// A policy that has learned.
    Learned {
        /// Its weights.
        model: Arc<Model>,
        /// How many choices `gcaps-x` rolls out; 1 decides at once, as the others do.
        most_rolled_out: usize,
        /// Of the run that these weights are of, then of runs with other seeds.
        curves: Vec<Curve>,
        /// Whether the program ships them.
        shipped: bool,
    },
}

impl Recipe {
    /// A policy of this recipe.
    pub fn make(&self) -> Box<dyn Policy> {
        match self {
            Self::Random(seed) => Box::new(Random::new(*seed)),
            Self::Greedy => Box::new(Greedy),
            Self::Lookahead => Box::new(Lookahead),
            Self::BidPricePolicy => Box::new(BidPricePolicy::default()),
            Self::Rolling => Box::new(Rolling::default()),
            Self::Own(Maker(make)) => make(),
            Self::Replay(trace) => Box::new(Replay::new(Arc::clone(trace))),
            Self::Learned { model, most_rolled_out, .. } => model.policy(*most_rolled_out),
        }
    }

    /// What the policy does, in one short sentence.
    pub(crate) fn description(&self) -> String {
        match self {
            Self::Random(_) => "draws evenly among the feasible vertiports (Feas-RND)".to_owned(),
            Self::Greedy => "takes the flight with the highest profit per hour".to_owned(),
            Self::Lookahead => "takes the first of the best two flights in a row".to_owned(),
            Self::BidPricePolicy => "takes what is worth most at the day's prices".to_owned(),
            Self::Rolling => "tries out what is worth most at the day's prices".to_owned(),
            Self::Own(_) => "decides in a way of its own".to_owned(),
            Self::Replay(_) => "repeats the decisions of a trace".to_owned(),
            Self::Learned { model, most_rolled_out, .. } => {
                let header = model.header();
                let decisions = grouped(header.steps as f64, 0);
                match (header.shape.vertiports, most_rolled_out) {
                    (Some(_), _) => {
                        format!("learned on {} from {decisions} decisions", header.network)
                    }
                    (None, 1) => format!("learned what prices miss from {decisions} decisions"),
                    (None, most) => format!(
                        "learned what prices miss from {decisions} decisions; rolls its {most} best choices out"
                    ),
                }
            }
        }
    }

    /// A rule that needs no file, by its name.
    pub(crate) fn rule(name: &str, seed: u64) -> Option<Self> {
        match name {
            "random" => Some(Self::Random(seed)),
            "greedy" => Some(Self::Greedy),
            "lookahead" => Some(Self::Lookahead),
            "prices" => Some(Self::BidPricePolicy),
            "rolling" => Some(Self::Rolling),
            _ => None,
        }
    }

    /// The policy of given weights. Where `name` is that of a kind of policy, the weights must be of that kind.
    fn of(name: &str, given: &Given) -> Result<Self, Error> {
        let (model, origin) = match given {
            Given::File(path) => (Arc::new(Model::read(path)?), path.display().to_string()),
            Given::Model(model) => (Arc::clone(model), "the model".to_owned()),
            Given::Policy(maker) => return Ok(Self::Own(maker.clone())),
        };
        let (kind, asked) = (model.kind(), kind_of(name));
        if Architecture::named(asked).is_some() && asked != kind {
            return Err(Error::Asked {
                rule: format!("{origin} has weights of {kind:?}, but {asked:?} is asked for"),
                hint: "name the policy as its weights do",
            });
        }
        let most_rolled_out = rolled_out_by(name)?.unwrap_or(1);
        Ok(Self::Learned { model, most_rolled_out, curves: Vec::new(), shipped: false })
    }

    /// The policy of given weights, with the learning curve that `train` left beside a file, and those of runs with other seeds
    /// that were put there.
    pub(crate) fn with_curves(name: &str, given: &Given) -> Result<Self, Error> {
        let mut recipe = Self::of(name, given)?;
        if let (Given::File(path), Self::Learned { curves, .. }) = (given, &mut recipe) {
            *curves = Curve::read_beside(path)?;
        }
        Ok(recipe)
    }

    /// The shipped policy of a network, or for all of them.
    pub(crate) fn shipped(name: &str, network: &str) -> Result<Self, Error> {
        let most_rolled_out = rolled_out_by(name)?.unwrap_or(1);
        if Architecture::named(kind_of(name)).is_none() {
            return Err(unknown(name));
        }
        let Shipped { model, curves } = shipped(kind_of(name), network)?;
        Ok(Self::Learned { model: Arc::new(model), most_rolled_out, curves, shipped: true })
    }

    /// Name of the network whose days it was trained on, if it was.
    pub(crate) fn trained_on(&self) -> Option<&str> {
        match self {
            Self::Learned { model, .. } => Some(&model.header().network),
            _ => None,
        }
    }

    /// Whether the policy can play this day.
    pub(crate) fn check_fits(&self, scenario: &Scenario) -> Result<(), Error> {
        match self {
            Self::Learned { model, .. } => Ok(model.check_fits(scenario)?),
            _ => Ok(()),
        }
    }

    /// V310: what to say where shipped weights decide on a network that only bears the name of theirs. Cause: the network
    /// was copied and changed, or the scenario was. Fix: train weights on it, or take it that these know the other one.
    pub fn warning(&self, name: &str, network: &str, origin: NetworkOrigin) -> Option<String> {
        let for_another = match self {
            Self::Learned { shipped: true, model, .. } => {
                origin == NetworkOrigin::Changed && model.header().shape.vertiports.is_some()
            }
            _ => false,
        };
        for_another.then(|| {
            format!(
                "policy {name:?} was trained on network {network:?} as it is shipped, but this is a changed copy of it; `vertifleet train` makes weights for the copy"
            )
        })
    }

    /// Steps and mean episode reward on the training days; nothing for who does not learn from rewards.
    pub(crate) fn curve(&self) -> Vec<(u64, f64)> {
        match self {
            Self::Learned { curves, .. } => {
                curves.first().map(Curve::training_rewards).unwrap_or_default()
            }
            _ => Vec::new(),
        }
    }

    /// Decisions learned from and mean reward on the validation days, run by run; nothing for who was not trained, or not asked
    /// while it was.
    pub(crate) fn validation_runs(&self) -> Vec<Vec<(u64, f64)>> {
        let mut runs: Vec<Vec<(u64, f64)>> = match self {
            // With roll-outs it decides in another way than in its training.
            Self::Learned { curves, most_rolled_out: 1, .. } => {
                curves.iter().map(Curve::validation_rewards).collect()
            }
            _ => Vec::new(),
        };
        runs.retain(|run| !run.is_empty());
        runs
    }
}

/// Names of policies that commands take as they are.
const NAMES: [&str; 9] =
    ["random", "greedy", "lookahead", "prices", "rolling", ANY_SIZE, "gcaps", "mlp", "plan"];

/// That no policy has this name.
fn unknown(name: &str) -> Error {
    let meant = match nearest(name, NAMES) {
        Some("plan") => Some("`vertifleet plan` plans a day that is known in full".to_owned()),
        meant => meant.map(|name| format!("did you mean {name}?")),
    };
    let known = NAMES.join(", ");
    Error::UnknownPolicy {
        name: name.to_owned(),
        known: format!(
            "{known} (in compare), {ANY_SIZE}:rollouts=K and replay:TRACE (in simulate)"
        ),
        meant,
    }
}

/// The kind of policy that a name asks for: `gcaps-x` of `gcaps-x:rollouts=3`.
pub(crate) fn kind_of(name: &str) -> &str {
    name.strip_prefix(ANY_SIZE).filter(|rest| rest.starts_with(':')).map_or(name, |_| ANY_SIZE)
}

/// How many choices a name of `gcaps-x` asks to be rolled out, 1 for none; nothing for other names.
fn rolled_out_by(name: &str) -> Result<Option<usize>, Error> {
    match name.strip_prefix(ANY_SIZE) {
        Some("") => Ok(Some(1)),
        Some(rest) if rest.starts_with(':') => {
            let most = rest.strip_prefix(":rollouts=").and_then(|most| most.parse().ok());
            match most {
                Some(most @ 2..=GcapsX::MOST_ROLLED_OUT) => Ok(Some(most)),
                _ => Err(Error::Asked {
                    rule: format!("policy {name:?} is not understood"),
                    hint: "gcaps-x:rollouts=3 rolls the 3 best choices out; from 2 to 5 can be",
                }),
            }
        }
        _ => Ok(None),
    }
}

/// The policy that is asked for on one day, and what is to be said of it, if anything ([`Recipe::warning`]).
///
/// # Errors
/// If there is no such policy, its weights cannot be read, or it cannot play this day.
pub fn for_scenario(
    choice: &Choice<'_>,
    scenario: &Scenario,
) -> Result<(Recipe, Option<String>), Error> {
    let replayed = choice.name.strip_prefix("replay:");
    let recipe = match (choice.model, Recipe::rule(choice.name, choice.seed), replayed) {
        (Some(given), None, None) if Architecture::named(kind_of(choice.name)).is_some() => {
            Recipe::of(choice.name, given)?
        }
        (Some(_), ..) => return Err(takes_no_weights(choice.name)),
        (None, Some(rule), _) => rule,
        (None, None, Some(path)) => {
            Recipe::Replay(Arc::new(Trace::read(Path::new(path), scenario)?))
        }
        (None, None, None) => Recipe::shipped(choice.name, network_of(scenario))?,
    };
    recipe.check_fits(scenario)?;
    let network = network_of(scenario);
    let warning = recipe.warning(choice.name, network, NetworkOrigin::of(network, [scenario]));
    Ok((recipe, warning))
}

/// Weights given for a policy that has none.
pub(crate) fn takes_no_weights(policy: &str) -> Error {
    Error::Asked {
        rule: format!("policy {policy:?} takes no weights, but a model is given for it"),
        hint: "leave the model out, or name a learned policy (gcaps, mlp, gcaps-x)",
    }
}

/// The network a day was drawn from, by its name: `paper` of `paper-7`.
pub(crate) fn network_of(scenario: &Scenario) -> &str {
    scenario.name.strip_suffix(&format!("-{}", scenario.seed)).unwrap_or(&scenario.name)
}

/// The learned policies that the program ships for a day's network, and those for every network: with the rules, all from
/// whose days a plan can set out.
pub fn shipped_for(scenario: &Scenario) -> Vec<Box<dyn Policy>> {
    let recipes = [ANY_SIZE, "gcaps", "mlp"].into_iter().filter_map(|name| {
        let recipe = Recipe::shipped(name, network_of(scenario)).ok()?;
        recipe.check_fits(scenario).is_ok().then_some(recipe)
    });
    recipes.map(|recipe| recipe.make()).collect()
}
