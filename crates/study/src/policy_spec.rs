//! The names of policies: [`PolicySpec::parse`] reads a name, and [`PolicySpec::resolve`] finds the
//! weights or the trace that it refers to.
//!
//! All commands and the Python package name policies in this way.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use vertifleet_core::{Scenario, nearest};
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::{Curve, GcapsX, Model, Shipped, shipped};
use vertifleet_sim::Trace;

use crate::error::Error;
use crate::origin::network_of;
use crate::resolved_policy::{PolicyFactory, ResolvedPolicy};

/// The policy whose weights fit networks of any size.
const ANY_SIZE: &str = "gcaps-x";

/// The names that need no further information.
const NAMES: [&str; 10] = [
    "random",
    "greedy",
    "prices",
    "rolling",
    ANY_SIZE,
    "gcaps",
    "mlp",
    "gcaps-full",
    "mlp-full",
    "plan",
];

/// A policy as its name describes it, before any file is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PolicySpec {
    name: String,
    kind: Kind,
}

/// The meaning of a name.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Kind {
    Random,
    Greedy,
    BidPrices,
    Rolling,
    /// The planner, which is not a policy because it knows the day.
    Planner,
    /// The trace in this file.
    Replay(PathBuf),
    Learned {
        architecture: &'static str,
        most_rolled_out: usize,
    },
    /// A name that the user chose for weights or a function.
    Own,
}

/// What a name refers to, if the user says so.
#[derive(Debug, Clone)]
pub enum PolicySource {
    /// Weights in a file, with the learning curves that may stand next to it.
    File(PathBuf),
    /// Weights that have been read.
    Model(Arc<Model>),
    /// A policy of the user's own.
    Own(PolicyFactory),
}

/// The days that a policy is resolved for.
#[derive(Debug, Clone, Copy)]
pub enum ResolveFor<'a> {
    /// One day, which a trace may belong to.
    Day(&'a Scenario),
    /// Days of the network with this name.
    DaysOf(&'a str),
}

impl PolicySpec {
    /// Reads a name such as `greedy`, `gcaps-x:rollouts=3` or `replay:day.csv`. A name that is not
    /// known may be one of the user's own, for the source that is given to
    /// [`resolve`](Self::resolve).
    ///
    /// # Errors
    /// Returns [`Error::Asked`] if the name has a control character, or if the text after
    /// `gcaps-x:` is not valid.
    pub fn parse(name: &str) -> Result<Self, Error> {
        if name.contains(char::is_control) {
            return Err(Error::Asked {
                rule: format!("the name {name:?} of a policy has a control character"),
                hint: "names stand in tables and files; use letters, digits and marks",
            });
        }
        let kind = match name {
            "random" => Kind::Random,
            "greedy" => Kind::Greedy,
            "prices" => Kind::BidPrices,
            "rolling" => Kind::Rolling,
            "plan" => Kind::Planner,
            _ => match (Architecture::named(name), name.split_once(':')) {
                (Some(architecture), _) => {
                    Kind::Learned { architecture: architecture.name(), most_rolled_out: 1 }
                }
                (None, Some((ANY_SIZE, options))) => Kind::Learned {
                    architecture: ANY_SIZE,
                    most_rolled_out: parse_rollouts(name, options)?,
                },
                (None, Some(("replay", path))) => Kind::Replay(path.into()),
                _ => Kind::Own,
            },
        };
        Ok(Self { name: name.to_owned(), kind })
    }

    /// The name as it was given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether this is the planner, which knows the day and is not a policy.
    pub fn is_planner(&self) -> bool {
        self.kind == Kind::Planner
    }

    /// Whether a source that is given under `name` belongs to this policy. `gcaps-x` also belongs
    /// to `gcaps-x:rollouts=3`.
    pub fn takes(&self, name: &str) -> bool {
        let is_architecture = |kind: &Kind| matches!(kind, Kind::Learned { architecture, .. } if *architecture == name);
        self.name == name || is_architecture(&self.kind)
    }

    /// Whether this is a name that the user chose for weights or a function.
    pub fn is_own(&self) -> bool {
        self.kind == Kind::Own
    }

    /// The trace that is replayed, if this is a replay.
    pub fn replayed(&self) -> Option<&Path> {
        match &self.kind {
            Kind::Replay(path) => Some(path),
            _ => None,
        }
    }

    /// Finds the policy: from the given source, or else a rule, a trace, or weights that the
    /// program ships. `seed` is for the random policy.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, if weights or trace cannot be read, or if name
    /// and weights do not go together. The planner is not a policy.
    pub fn resolve(
        &self,
        source: Option<&PolicySource>,
        days: ResolveFor<'_>,
        seed: u64,
    ) -> Result<ResolvedPolicy, Error> {
        let takes_a_source = matches!(self.kind, Kind::Learned { .. } | Kind::Own);
        match (source, &self.kind) {
            (Some(source), _) if takes_a_source => self.given(source, days),
            (Some(_), _) => Err(Error::Asked {
                rule: format!(
                    "policy {:?} takes no weights, but a model is given for it",
                    self.name
                ),
                hint: "leave the model out, or name a learned policy (gcaps, mlp, gcaps-x, gcaps-full, mlp-full)",
            }),
            (None, Kind::Random) => Ok(ResolvedPolicy::Random(seed)),
            (None, Kind::Greedy) => Ok(ResolvedPolicy::Greedy),
            (None, Kind::BidPrices) => Ok(ResolvedPolicy::BidPrices),
            (None, Kind::Rolling) => Ok(ResolvedPolicy::Rolling),
            (None, Kind::Replay(path)) => match days {
                ResolveFor::Day(day) => {
                    Ok(ResolvedPolicy::Replay(Arc::new(Trace::read(path, day)?)))
                }
                ResolveFor::DaysOf(_) => Err(self.is_unknown()),
            },
            (None, Kind::Learned { architecture, most_rolled_out }) => {
                let Shipped { model, curves } = shipped(architecture, days.network())?;
                Ok(ResolvedPolicy::Learned {
                    model: Arc::new(model),
                    most_rolled_out: *most_rolled_out,
                    curves,
                    is_shipped: true,
                })
            }
            (None, Kind::Own | Kind::Planner) => Err(self.is_unknown()),
        }
    }

    /// The policy of the given source. If the name is that of an architecture, the weights must be
    /// of that architecture.
    fn given(&self, source: &PolicySource, days: ResolveFor<'_>) -> Result<ResolvedPolicy, Error> {
        let (model, origin) = match source {
            PolicySource::File(path) => (Arc::new(Model::read(path)?), path.display().to_string()),
            PolicySource::Model(model) => (Arc::clone(model), "the model".to_owned()),
            PolicySource::Own(factory) => return Ok(ResolvedPolicy::Own(factory.clone())),
        };
        let (found, mut most) = (model.kind(), 1);
        if let Kind::Learned { architecture, most_rolled_out } = self.kind {
            if architecture != found {
                return Err(Error::Asked {
                    rule: format!(
                        "{origin} has weights of {found:?}, but {architecture:?} is asked for"
                    ),
                    hint: "name the policy as its weights do",
                });
            }
            most = most_rolled_out;
        }
        // Learning curves are shown with results of many days only. For one day, a curve that
        // cannot be read must not cause an error.
        let curves = match (source, days) {
            (PolicySource::File(path), ResolveFor::DaysOf(_)) => Curve::read_beside(path)?,
            _ => Vec::new(),
        };
        Ok(ResolvedPolicy::Learned { model, most_rolled_out: most, curves, is_shipped: false })
    }

    fn is_unknown(&self) -> Error {
        let meant = match nearest(&self.name, NAMES) {
            Some("plan") => Some("`vertifleet plan` plans a day that is known in full".to_owned()),
            meant => meant.map(|name| format!("did you mean {name}?")),
        };
        let known = NAMES.join(", ");
        Error::UnknownPolicy {
            name: self.name.clone(),
            known: format!(
                "{known} (in compare), {ANY_SIZE}:rollouts=K and replay:TRACE (in simulate)"
            ),
            meant,
        }
    }
}

/// Parses the number of choices that `gcaps-x` rolls out from the text after its colon.
fn parse_rollouts(name: &str, options: &str) -> Result<usize, Error> {
    let most = options.strip_prefix("rollouts=").and_then(|most| most.parse().ok());
    most.filter(|most| (2..=GcapsX::MOST_ROLLED_OUT).contains(most)).ok_or_else(|| Error::Asked {
        rule: format!("policy {name:?} is not understood"),
        hint: "gcaps-x:rollouts=3 rolls the 3 best choices out; from 2 to 5 can be",
    })
}

impl ResolveFor<'_> {
    fn network(&self) -> &str {
        match self {
            Self::Day(day) => network_of(day),
            Self::DaysOf(network) => network,
        }
    }
}
