//! The request of a study, and the checks before it waits for its turn, so that errors are reported
//! at once.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use vertifleet_core::{Network, Purpose, Stop};
use vertifleet_optimize::Step;
use vertifleet_study::comparison::{Comparison, DrawnDays};
use vertifleet_study::competitor::Selection;
use vertifleet_study::{NetworkOrigin, PolicySource, PolicySpec};

use crate::access::Actor;
use crate::error::Error;
use crate::networks;
use crate::optional::or_default;
use crate::policies::Policies;
use crate::store::Store;
use crate::turns::Turns;

/// Largest number of policies of a study.
const MOST_POLICIES: usize = 10;
/// Largest number of days of a study.
const MOST_DAYS: u32 = 1_000;
/// Largest number of demand entries of all days together, which are in memory at once.
const MOST_ENTRIES: u64 = 20_000_000;

/// A study to make.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NewStudy {
    /// A network that the program ships, or that was uploaded.
    network: Option<String>,
    /// The text of a network file in place of a name. It is not stored.
    toml: Option<String>,
    /// The policies that play the days. The others are compared with the first. `plan` is the
    /// planner, which knows the days in advance: a reference, not a policy.
    #[schema(min_items = 1, max_items = 10)]
    policies: Vec<String>,
    /// The number of days.
    #[schema(format = Int64, minimum = 1, maximum = 1_000)]
    days: u32,
    /// The seed of the first day, which is that of `random` and `plan` too; with validation days,
    /// the number of the first. 1 if it is absent.
    #[schema(maximum = 1_099_511_627_775u64)]
    seed: Option<u64>,
    /// The purpose of the days.
    #[serde(default, deserialize_with = "or_default")]
    #[schema(nullable)]
    split: Split,
    /// Whether to prove an upper bound for every day, which takes long on large networks.
    #[serde(default, deserialize_with = "or_default")]
    #[schema(nullable)]
    bounds: bool,
}

/// The purpose of days. No day has both.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Split {
    /// Those for results.
    #[default]
    Comparison,
    /// Those on which settings are chosen.
    Validation,
}

impl From<Split> for Purpose {
    fn from(split: Split) -> Self {
        match split {
            Split::Comparison => Self::Comparison,
            Split::Validation => Self::Validation,
        }
    }
}

/// A study that can be played.
#[derive(Debug)]
pub(crate) struct Asked {
    pub(super) network: Network,
    pub(super) origin: NetworkOrigin,
    pub(super) policies: Vec<String>,
    /// The weights of policies that were uploaded.
    models: Vec<(String, PolicySource)>,
    pub(super) drawn: DrawnDays,
    pub(super) split: Split,
    pub(super) bound_step: Option<Step>,
    pub(super) warnings: Vec<String>,
}

impl NewStudy {
    /// Checks everything that can be checked before days are played.
    ///
    /// # Errors
    /// Returns [`Error::BadRequest`], [`Error::TooMuch`], [`Error::NotFound`], or the error in the
    /// network or the policies.
    pub(crate) async fn check(
        self,
        store: &Store,
        uploaded: &Policies,
        (turns, actor): (&Turns, &Actor),
    ) -> Result<Asked, Error> {
        let Self { network, toml, policies, days, seed, split, bounds } = self;
        let most = |what, most| Err(Error::TooMuch { what, most });
        if policies.len() > MOST_POLICIES {
            return most("policies in a study", MOST_POLICIES as u64);
        }
        if days > MOST_DAYS {
            return most("days in a study", u64::from(MOST_DAYS));
        }
        let network = match (network, toml) {
            (Some(name), None) => networks::find(store, &name).await?.0,
            (None, Some(toml)) => networks::read(&toml)?,
            _ => {
                let rule = "a study needs either network or toml".to_owned();
                return Err(Error::BadRequest { rule });
            }
        };
        let entries = network.vertiports().len().pow(2) * network.periods();
        if u64::from(days).saturating_mul(entries as u64) > MOST_ENTRIES {
            return most("entries of demand in a study (days x periods x pairs)", MOST_ENTRIES);
        }
        let mut models = Vec::new();
        for name in &policies {
            if PolicySpec::parse(name)?.is_own() {
                models.push((name.clone(), uploaded.source(name).await?));
            }
        }
        let drawn = DrawnDays { purpose: split.into(), first: seed.unwrap_or(1), days };
        let bound_step = bounds.then(Step::default);
        let (origin, warnings) = (NetworkOrigin::Own, Vec::new());
        let asked = Asked { network, origin, policies, models, drawn, split, bound_step, warnings };
        turns.work(actor, None, move |_| asked.tried()).await
    }
}

impl Asked {
    /// Checks the study on one of its days, and returns the warnings.
    fn tried(mut self) -> Result<Self, Error> {
        self.drawn.check()?;
        let days = DrawnDays { days: self.drawn.days.min(1), ..self.drawn };
        let comparison = self.comparison_of(days, &Stop::default())?;
        self.origin = NetworkOrigin::of(self.network.name(), comparison.days());
        let of_network = self.network.warnings().into_iter().map(|one| one.to_string());
        self.warnings = of_network.chain(comparison.warnings()).collect();
        Ok(self)
    }

    /// The comparison, with all days drawn.
    ///
    /// # Errors
    /// Returns the errors of [`Comparison::new`].
    pub(super) fn comparison(&self, stop: &Stop) -> Result<Comparison, vertifleet_study::Error> {
        self.comparison_of(self.drawn, stop)
    }

    fn comparison_of(
        &self,
        days: DrawnDays,
        stop: &Stop,
    ) -> Result<Comparison, vertifleet_study::Error> {
        let (policies, models, seed) = (&self.policies, &self.models, self.drawn.first);
        let selection = Selection { policies, models, seed };
        Comparison::new(&self.network, &selection, days, self.bound_step, stop)
    }

    /// The command that runs the same study. Networks and weights of the user have the names of
    /// their downloads.
    pub(super) fn command(&self) -> String {
        let DrawnDays { first, days, .. } = self.drawn;
        let (name, policies) = (self.network.name(), self.policies.join(","));
        let file = if self.origin == NetworkOrigin::Shipped { "" } else { ".toml" };
        let begin = format!("vertifleet compare --network {name}{file} --policies {policies}");
        let models = self.models.iter().map(|(one, _)| format!("--model {one}={one}.safetensors"));
        let mut words = vec![begin];
        words.extend(models);
        words.push(format!("--days {days} --seed {first}"));
        if self.split == Split::Validation {
            words.push("--split validation".to_owned());
        }
        if self.bound_step.is_some() {
            words.push("--bound".to_owned());
        }
        words.join(" ")
    }
}
