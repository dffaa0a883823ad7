//! The competitors of a study: policies by name, and the planner as a reference that knows the
//! days.

use std::collections::BTreeSet;
use std::sync::Arc;

use vertifleet_core::{Network, Scenario, Stop};
use vertifleet_optimize::{Budget, SearchSettings, plan, steps_of_equal_work};
use vertifleet_picture::numbers::grouped;
use vertifleet_sim::Trace;

use crate::error::Error;
use crate::policy_spec::{PolicySource, PolicySpec, ResolveFor};
use crate::record::{DayRecord, LatencySummary, LearningCurve, PolicyRecord, ValidationCurves};
use crate::resolved_policy::ResolvedPolicy;
use crate::sees::Sees;
use crate::starting_policies::starting_policies;

/// Number of steps of the planner on a day of `paper`, where a plan takes about half a minute on
/// one core; other days get as many steps as are the same amount of work. There is no time limit,
/// so the plan is the same on every machine.
const PLAN_STEPS: u64 = 200_000;

/// A policy or the planner, with its name in the study.
#[derive(Clone)]
pub struct Competitor {
    /// Its name, which is unique in the study.
    pub name: String,
    pub(crate) kind: Kind,
}

/// How a competitor decides.
#[derive(Clone)]
pub(crate) enum Kind {
    /// It decides while the day is played.
    Policy(ResolvedPolicy),
    /// It knows the whole day: a reference for policies.
    Planner(Planner),
}

/// The planner, with its number of steps on a day of `paper` and the seed of its search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Planner {
    pub(crate) paper_steps: u64,
    pub(crate) seed: u64,
}

impl Planner {
    /// Plans a known day; if `stop` is requested, it returns the best schedule so far soon. The
    /// days of a study already fill the threads, so each plan uses only one search.
    pub(crate) fn plan(&self, day: &Arc<Scenario>, stop: &Stop) -> Trace {
        let budget = Budget::Steps(steps_of_equal_work(day, self.paper_steps));
        let settings = SearchSettings { budget, searches: 1, seed: self.seed };
        let starts = starting_policies(day);
        plan(day, &settings, starts, &mut |_| !stop.is_requested()).trace
    }
}

/// A name, and the competitor that it stands for.
pub(crate) type Named = (String, Result<Competitor, Error>);

/// The competitors of a study as the user names them.
pub struct Selection<'a> {
    /// The names, in the order of the results.
    pub policies: &'a [String],
    /// What names refer to, for those names that come with weights or a policy.
    pub models: &'a [(String, PolicySource)],
    /// The seed of the random policy and of the planner's search.
    pub seed: u64,
}

impl Selection<'_> {
    /// Finds all competitors, for days of the network with this name.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, if weights cannot be read, if names and weights
    /// do not go together, or if two competitors have the same name.
    pub fn resolve(&self, network: &str) -> Result<Vec<Competitor>, Error> {
        self.resolve_each(network)?.into_iter().map(|(_, competitor)| competitor).collect()
    }

    /// Like [`resolve`](Self::resolve), with a separate result for each name.
    ///
    /// # Errors
    /// Returns an error if names and weights do not go together, or if two competitors have the
    /// same name.
    pub(crate) fn resolve_each(&self, network: &str) -> Result<Vec<Named>, Error> {
        let parse = |name: &String| PolicySpec::parse(name);
        let specs: Vec<PolicySpec> = self.policies.iter().map(parse).collect::<Result<_, _>>()?;
        self.check_models(&specs)?;
        if let Some(name) = first_repeated(self.policies.iter()) {
            return Err(Error::DuplicatePolicy { name: name.clone() });
        }
        let named = |spec: &PolicySpec| (spec.name().to_owned(), self.competitor(spec, network));
        Ok(specs.iter().map(named).collect())
    }

    fn check_models(&self, specs: &[PolicySpec]) -> Result<(), Error> {
        let names = || self.models.iter().map(|(name, _)| name);
        if let Some(twice) = first_repeated(names()) {
            return Err(Error::Asked {
                rule: format!("two models are given for {twice:?}"),
                hint: "give each name one path",
            });
        }
        let is_used = |name: &str| specs.iter().any(|spec| spec.takes(name));
        match names().find(|name| !is_used(name)) {
            None => Ok(()),
            Some(unused) => Err(Error::Asked {
                rule: format!("a model is given for {unused:?}, which is not among the policies"),
                hint: "add the name to the policies",
            }),
        }
    }

    fn competitor(&self, spec: &PolicySpec, network: &str) -> Result<Competitor, Error> {
        let source =
            self.models.iter().find(|(name, _)| spec.takes(name)).map(|(_, source)| source);
        let kind = if spec.is_planner() && source.is_none() {
            Kind::Planner(Planner { paper_steps: PLAN_STEPS, seed: self.seed })
        } else {
            Kind::Policy(spec.resolve(source, ResolveFor::DaysOf(network), self.seed)?)
        };
        Ok(Competitor { name: spec.name().to_owned(), kind })
    }
}

impl Competitor {
    /// Checks that it can play days like this one.
    ///
    /// # Errors
    /// Returns an error if its weights belong to another network.
    pub fn check_fits(&self, scenario: &Scenario) -> Result<(), Error> {
        match &self.kind {
            Kind::Policy(policy) => policy.check_fits(scenario),
            Kind::Planner(_) => Ok(()),
        }
    }

    /// The same competitor for days of this network, which a policy of the user's own may look at.
    ///
    /// # Errors
    /// Returns the error of a policy of the user's own that cannot play days of this network.
    pub(crate) fn on(&self, network: &Network) -> Result<Self, Error> {
        let mut competitor = self.clone();
        if let Kind::Policy(ResolvedPolicy::Own(factory)) = &mut competitor.kind {
            *factory = (factory.on)(network)?;
        }
        Ok(competitor)
    }

    /// Its record of days that it has played.
    pub(crate) fn record(
        &self,
        days: Vec<DayRecord>,
        decision_ns: Option<LatencySummary>,
    ) -> PolicyRecord {
        PolicyRecord {
            name: self.name.clone(),
            description: self.description(),
            sees: self.sees(),
            weights_sha256: self.weights_sha256(),
            training_seed: self.policy().and_then(ResolvedPolicy::training_seed),
            days,
            decision_ns,
        }
    }

    pub(crate) fn policy(&self) -> Option<&ResolvedPolicy> {
        match &self.kind {
            Kind::Policy(policy) => Some(policy),
            Kind::Planner(_) => None,
        }
    }

    /// What it looks at.
    pub(crate) fn sees(&self) -> Sees {
        self.policy().map_or(Sees::WholeDay, ResolvedPolicy::sees)
    }

    /// Describes what it does, in one short sentence.
    pub(crate) fn description(&self) -> String {
        match &self.kind {
            Kind::Policy(policy) => policy.description(),
            Kind::Planner(Planner { paper_steps, .. }) => format!(
                "knows the day beforehand and searches for its best schedule, on `paper` in {} steps",
                grouped(*paper_steps as f64, 0)
            ),
        }
    }

    /// What tells it from other competitors of its name, besides its weights.
    pub(crate) fn identity(&self) -> String {
        match &self.kind {
            Kind::Policy(ResolvedPolicy::Own(factory)) => factory.identity.clone(),
            Kind::Policy(_) | Kind::Planner(_) => self.description(),
        }
    }

    /// SHA-256 of its weight file, if it has one.
    pub(crate) fn weights_sha256(&self) -> Option<String> {
        self.policy().and_then(ResolvedPolicy::weights_sha256)
    }

    /// Whether it was trained on days of the network with this name.
    pub(crate) fn was_trained_on(&self, network: &str) -> bool {
        self.policy().and_then(ResolvedPolicy::trained_on) == Some(network)
    }

    /// Its learning curve on the training days, if it has one.
    pub(crate) fn learning_curve(&self) -> Option<LearningCurve> {
        let points = self.policy()?.training_rewards();
        (!points.is_empty()).then(|| LearningCurve { name: self.name.clone(), points })
    }

    /// Its rewards on the validation days during training, one curve per run.
    pub(crate) fn validation_curves(&self) -> Option<ValidationCurves> {
        let runs = self.policy()?.validation_rewards();
        (!runs.is_empty()).then(|| ValidationCurves { name: self.name.clone(), runs })
    }
}

fn first_repeated<'a>(mut names: impl Iterator<Item = &'a String>) -> Option<&'a String> {
    let mut known = BTreeSet::new();
    names.find(|name| !known.insert(*name))
}

#[cfg(test)]
mod tests {
    use vertifleet_core::Coded;

    use super::Selection;

    #[test]
    fn a_name_that_comes_twice_is_refused() {
        let policies = ["greedy", "random", "greedy"].map(str::to_owned);
        let selection = Selection { policies: &policies, models: &[], seed: 0 };
        let error = selection.resolve("paper").err().expect("a name that comes twice");
        assert_eq!(error.code().to_string(), "V404");
        assert!(error.to_string().contains("\"greedy\""), "{error}");
    }
}
