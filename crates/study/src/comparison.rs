//! A comparison: from the request, which names competitors, days and a bound, to the records.

mod join;
mod summary;

use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::{DaySeed, Network, Purpose, Scenario, Stop};
use vertifleet_optimize::Step;

use crate::competitor::{Competitor, Selection};
use crate::error::Error;
use crate::origin::NetworkOrigin;
use crate::own_days::OwnDays;
use crate::record::{ComparisonRecords, PolicyRecord};
use crate::replay;
use crate::run::Kept;
use crate::study::{Study, Watch};

pub use summary::{
    BoundSummary, ComparisonReport, FORMAT, PairedDifference, PolicySummary, TrainingSummary,
};

/// What the report replays.
const KEPT: Kept = Kept::ChoicesOfFirst(replay::MOST_DAYS);

/// Some days of a network and the competitors that will play them. Everything that can be checked
/// beforehand has been checked.
pub struct Comparison {
    network: String,
    origin: NetworkOrigin,
    study: Study,
    drawn: Option<DrawnDays>,
    days_from: Option<String>,
}

/// Some days of a network: those of a purpose with consecutive numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DrawnDays {
    /// The purpose, whose days are never days of another purpose.
    pub purpose: Purpose,
    /// The number of the first day; for comparison days it is the seed.
    pub first: u64,
    /// How many days.
    pub days: u32,
}

impl DrawnDays {
    /// Days of comparison from the day with this seed on.
    pub fn of_comparison(first: u64, days: u32) -> Self {
        Self { purpose: Purpose::Comparison, first, days }
    }

    /// Checks that the purpose has all of these days.
    ///
    /// # Errors
    /// Returns the error V118 of `vertifleet-core` if it has not.
    pub fn check(&self) -> Result<(), Error> {
        self.seed(self.days.saturating_sub(1))?;
        Ok(())
    }

    /// The seed of a day, counted from 0.
    ///
    /// # Errors
    /// Returns the error V118 of `vertifleet-core` if the purpose has no such day.
    pub(crate) fn seed(&self, day: u32) -> Result<DaySeed, Error> {
        Ok(DaySeed::of_purpose(self.purpose, self.first.saturating_add(u64::from(day)))?)
    }

    /// Draws the days of a network.
    pub(crate) fn draw(&self, network: &Network, stop: &Stop) -> Result<Vec<Arc<Scenario>>, Error> {
        // The last seed is checked first, so that no day is drawn if one of them cannot be.
        self.check()?;
        let draw = |day: u32| {
            if stop.is_requested() {
                return Err(Error::Stopped);
            }
            Ok(Arc::new(network.draw(self.seed(day)?)))
        };
        (0..self.days).into_par_iter().map(draw).collect()
    }
}

impl Comparison {
    /// Draws days of a network; with a `step`, each of them gets an upper bound.
    ///
    /// # Errors
    /// Returns an error if there is no such policy or day, if two policies have the same name, or
    /// if a policy cannot play these days; [`Error::Stopped`] soon after `stop` is requested.
    pub fn new(
        network: &Network,
        selection: &Selection<'_>,
        drawn: DrawnDays,
        bound_step: Option<Step>,
        stop: &Stop,
    ) -> Result<Self, Error> {
        let competitors = selection.resolve(network.name())?;
        let study = Study::new(competitors, drawn.draw(network, stop)?, bound_step)?;
        Ok(Self::of_drawn(drawn, network, study))
    }

    /// The comparison of a study of these days of a network.
    pub(crate) fn of_drawn(drawn: DrawnDays, network: &Network, study: Study) -> Self {
        Self {
            network: network.name().to_owned(),
            origin: NetworkOrigin::of_all(network.name(), &study.scenarios()),
            study,
            drawn: Some(drawn),
            days_from: None,
        }
    }

    /// Takes the user's own days; with a `step`, each of them gets an upper bound.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, if two policies have the same name, or if a
    /// policy cannot play one of these days.
    pub fn of_own(
        days: OwnDays,
        selection: &Selection<'_>,
        bound_step: Option<Step>,
    ) -> Result<Self, Error> {
        let competitors = selection.resolve(days.network())?;
        let (network, origin) = (days.network().to_owned(), days.origin());
        let study = Study::new(competitors, days.scenarios, bound_step)?;
        Ok(Self { network, origin, study, drawn: None, days_from: Some(days.from) })
    }

    /// The days that will be played.
    pub fn days(&self) -> impl Iterator<Item = &Scenario> + Clone {
        self.study.days()
    }

    /// Warnings about what is allowed but probably not intended, such as shipped weights on a
    /// changed copy of their network (V310).
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.study.competitors.iter().filter_map(|competitor| {
            competitor.policy()?.warning(&competitor.name, &self.network, || self.origin)
        })
    }

    /// Plays all days with every policy; `command` is the command line that the study records.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested, and an error if a day is too
    /// large for its bound or a policy cannot play one to its end.
    pub fn run(
        self,
        command: String,
        stop: &Stop,
        watch: &impl Watch,
    ) -> Result<ComparisonRecords, Error> {
        let mut policies = self.study.play(KEPT, stop, watch)?;
        let replayed = replay::replayed(&self.study.scenarios(), &mut policies);
        Ok(ComparisonRecords { replayed, ..self.records(policies, command) })
    }

    /// The records of policies that have played all days.
    pub(crate) fn records(self, policies: Vec<PolicyRecord>, command: String) -> ComparisonRecords {
        let Self { network, origin, study, drawn, days_from } = self;
        // The learning curve of a policy trained on another network says nothing about these days,
        // and no policy was trained on the user's own days.
        let is_at_home =
            |competitor: &&Competitor| days_from.is_none() && competitor.was_trained_on(&network);
        let at_home = || study.competitors.iter().filter(is_at_home);
        ComparisonRecords {
            curves: at_home().filter_map(Competitor::learning_curve).collect(),
            trainings: at_home().filter_map(Competitor::validation_curves).collect(),
            network,
            network_origin: origin,
            seed: drawn.map(|drawn| drawn.first),
            split: drawn.map_or(Purpose::Comparison, |drawn| drawn.purpose),
            days_from,
            days: study.days().count(),
            bound_step_s: study.bound_step.map(Step::seconds),
            command,
            policies,
            replayed: Vec::new(),
        }
    }
}
