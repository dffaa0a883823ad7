//! Who enters a comparison: policies by their names, and the planner as a reference that knows the days.

use vertifleet_core::Scenario;
use vertifleet_optimize::{Budget, SearchSettings, can_plan, plan, steps_of_equal_work};

use crate::error::Error;
use crate::numbers::grouped;
use crate::policies::{self, Given, Recipe, kind_of};
use crate::record::{LearningCurve, ValidationCurves};
use crate::run::{Contender, Contenders, Way};

/// Steps of the planner on a day of `paper`, where they take about a quarter of a minute on one core; on other days as many as
/// are as much work. There is no time limit, so that the plan is the same everywhere.
const PLAN_STEPS: u64 = 200_000;

/// A policy or the planner, with the name that it has in the comparison.
pub struct Entrant {
    /// Its name.
    pub name: String,
    kind: Kind,
}

/// How an entrant comes to its decisions.
enum Kind {
    Policy(Recipe),
    /// The planner, with the seed of its search.
    Plan(u64),
}

/// Who is asked for.
pub struct Asked<'a> {
    /// Names, in the order of the results.
    pub policies: &'a [String],
    /// Names with their weights.
    pub models: &'a [(String, Given)],
    /// Seed of the random policy and of the planner's search.
    pub seed: u64,
    /// Network whose shipped weights are taken where none are given.
    pub network: &'a str,
}

impl Asked<'_> {
    /// All who take part: given weights first, then rules, then the network's shipped weights.
    ///
    /// # Errors
    /// If there is no such policy, weights cannot be read, or names and weights do not go together.
    pub fn entrants(&self) -> Result<Vec<Entrant>, Error> {
        let models: Vec<&String> = self.models.iter().map(|(name, _)| name).collect();
        if let Some(twice) = first_repeated(&models) {
            return Err(Error::Asked {
                rule: format!("two models are given for {twice:?}"),
                hint: "give each name one path",
            });
        }
        let asked = |name: &str| {
            self.policies.iter().any(|policy| policy == name || kind_of(policy) == name)
        };
        if let Some(unused) = models.iter().find(|name| !asked(name)) {
            return Err(Error::Asked {
                rule: format!("a model is given for {unused:?}, which is not among the policies"),
                hint: "add the name to the policies",
            });
        }
        self.policies.iter().map(|name| self.entrant(name)).collect()
    }

    fn entrant(&self, name: &str) -> Result<Entrant, Error> {
        // Weights of gcaps-x are those of gcaps-x:rollouts=K too.
        let given = self.models.iter().find(|(given, _)| given == name || given == kind_of(name));
        let weights = given.map(|(_, given)| given);
        let rule = match name {
            "plan" => Some(Kind::Plan(self.seed)),
            _ => Recipe::rule(name, self.seed).map(Kind::Policy),
        };
        let kind = match (weights, rule) {
            (Some(_), Some(_)) => return Err(policies::takes_no_weights(name)),
            (Some(given), None) => Kind::Policy(Recipe::with_curves(name, given)?),
            (None, Some(rule)) => rule,
            (None, None) => Kind::Policy(Recipe::shipped(name, self.network)?),
        };
        Ok(Entrant { name: name.to_owned(), kind })
    }
}

impl Entrant {
    /// What it is made of, where it is a policy.
    pub fn recipe(&self) -> Option<&Recipe> {
        match &self.kind {
            Kind::Policy(recipe) => Some(recipe),
            Kind::Plan(_) => None,
        }
    }

    /// Whether it can take part on days like this one.
    ///
    /// # Errors
    /// If its weights are of another network, or the day has what the planner does not know.
    pub fn check_fits(&self, scenario: &Scenario) -> Result<(), Error> {
        match &self.kind {
            Kind::Policy(recipe) => recipe.check_fits(scenario),
            Kind::Plan(_) => Ok(can_plan(scenario)?),
        }
    }

    /// Whether it was trained on days of the network of this name.
    pub(crate) fn was_trained_on(&self, network: &str) -> bool {
        self.recipe().and_then(Recipe::trained_on) == Some(network)
    }

    /// Its learning curve on the training days, where it has one.
    pub(crate) fn curve(&self) -> Option<LearningCurve> {
        let points = self.recipe()?.curve();
        (!points.is_empty()).then(|| LearningCurve { name: self.name.clone(), points })
    }

    /// How it did on the validation days while it was trained, a run a seed.
    pub(crate) fn training(&self) -> Option<ValidationCurves> {
        let runs = self.recipe()?.validation_runs();
        (!runs.is_empty()).then(|| ValidationCurves { name: self.name.clone(), runs })
    }

    fn contender(&self) -> Contender<'_> {
        let (description, way) = match &self.kind {
            Kind::Policy(recipe) => (recipe.description(), Way::Online(Box::new(|| recipe.make()))),
            Kind::Plan(seed) => (
                format!(
                    "knows the day beforehand and searches for its best schedule, on `paper` in {} steps",
                    grouped(PLAN_STEPS as f64, 0)
                ),
                planned(*seed),
            ),
        };
        Contender { name: self.name.clone(), description, way }
    }
}

/// Days take turns on the threads, so each plan needs but one search.
fn planned(seed: u64) -> Way<'static> {
    Way::Offline(Box::new(move |day, stop| {
        let budget = Budget::Steps(steps_of_equal_work(day, PLAN_STEPS));
        let settings = SearchSettings { budget, searches: 1, seed };
        let mut learned = policies::shipped_for(day);
        let plan = plan(day, &settings, &mut learned, &mut |_| !stop.is_requested());
        plan.expect("the days were found to be fit for it").trace
    }))
}

/// All who take part, for the comparison.
///
/// # Errors
/// [`Error::DuplicatePolicy`] if two have one name.
pub fn contenders(entrants: &[Entrant]) -> Result<Contenders<'_>, Error> {
    Contenders::new(entrants.iter().map(Entrant::contender).collect())
}

fn first_repeated<'a>(names: &[&'a String]) -> Option<&'a String> {
    names.iter().enumerate().find(|(at, name)| names[..*at].contains(name)).map(|(_, name)| *name)
}
