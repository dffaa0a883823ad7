//! A comparison: from the request, which names competitors, days and a bound, to the records.

mod days_csv;
mod headline;
mod join;
mod page;
mod summary;
mod table;

use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::{DaySeed, Network, Scenario, Stop};
use vertifleet_optimize::Step;

use crate::competitor::{Competitor, Selection};
use crate::error::Error;
use crate::figure;
use crate::origin::NetworkOrigin;
use crate::own_days::OwnDays;
use crate::record::ComparisonRecords;
use crate::report::{File, Records, pictures};
use crate::study::{Bounds, Study, Watch};

pub use summary::{
    BoundSummary, ComparisonReport, FORMAT, PairedDifference, PolicySummary, TrainingSummary,
};

/// Some days of a network and the competitors that will play them. Everything that can be checked beforehand has been
/// checked.
pub struct Comparison {
    network: String,
    origin: NetworkOrigin,
    study: Study,
    first_seed: Option<u64>,
    days_from: Option<String>,
}

impl Comparison {
    /// Draws `days` days of a network from `first_seed` on; with a `step`, each of them gets an upper bound.
    ///
    /// # Errors
    /// Returns an error if there is no such policy or day, if two policies have the same name, or if a policy cannot
    /// play these days; [`Error::Stopped`] soon after `stop` is requested.
    pub fn new(
        network: &Network,
        selection: &Selection<'_>,
        first_seed: u64,
        days: u32,
        bound_step: Option<Step>,
        stop: &Stop,
    ) -> Result<Self, Error> {
        let competitors = selection.resolve(network.name())?;
        let scenarios = draw(network, first_seed, days, stop)?;
        let study = Study::new(competitors, scenarios, bound_step)?;
        Ok(Self {
            network: network.name().to_owned(),
            origin: NetworkOrigin::of_all(network.name(), &study.scenarios),
            study,
            first_seed: Some(first_seed),
            days_from: None,
        })
    }

    /// Takes the user's own days; with a `step`, each of them gets an upper bound.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, if two policies have the same name, or if a policy cannot play one
    /// of these days.
    pub fn of_own(
        days: OwnDays,
        selection: &Selection<'_>,
        bound_step: Option<Step>,
    ) -> Result<Self, Error> {
        let competitors = selection.resolve(days.network())?;
        let (network, origin) = (days.network().to_owned(), days.origin());
        let study = Study::new(competitors, days.scenarios, bound_step)?;
        Ok(Self { network, origin, study, first_seed: None, days_from: Some(days.from) })
    }

    /// The days that will be played.
    pub fn days(&self) -> impl Iterator<Item = &Scenario> {
        self.study.days()
    }

    /// Warnings about what is allowed but probably not intended, such as shipped weights on a changed copy of their
    /// network (V310).
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.study.competitors.iter().filter_map(|competitor| {
            competitor.policy()?.warning(&competitor.name, &self.network, || self.origin)
        })
    }

    /// Plays all days with every policy; `command` is the command line that the study records.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested, and an error if a day is too large for its bound or
    /// a policy cannot play one to its end.
    pub fn run(
        self,
        command: String,
        stop: &Stop,
        watch: &impl Watch,
    ) -> Result<ComparisonRecords, Error> {
        let Self { network, origin, study, first_seed, days_from } = self;
        let policies = study.play(stop, watch)?;
        // The learning curve of a policy trained on another network says nothing about these days, and no policy was
        // trained on the user's own days.
        let is_at_home =
            |competitor: &&Competitor| days_from.is_none() && competitor.was_trained_on(&network);
        let at_home = || study.competitors.iter().filter(is_at_home);
        Ok(ComparisonRecords {
            curves: at_home().filter_map(Competitor::learning_curve).collect(),
            trainings: at_home().filter_map(Competitor::validation_curves).collect(),
            network,
            network_origin: origin,
            seed: first_seed,
            days_from,
            days: study.scenarios.len(),
            bound_step_s: match study.bounds {
                Bounds::Prove(slices) => Some(slices.seconds()),
                Bounds::None | Bounds::Known(_) => None,
            },
            command,
            policies,
        })
    }
}

impl Records for ComparisonRecords {
    fn text(&self) -> Result<String, Error> {
        Ok(table::text(&ComparisonReport::of(self)?))
    }

    fn json(&self) -> Result<String, Error> {
        Ok(ComparisonReport::of(self)?.to_json())
    }

    fn files(&self) -> Result<Vec<File>, Error> {
        let summary = ComparisonReport::of(self)?;
        let figures = figure::all(&summary);
        let mut files = pictures(&figures);
        files.extend([
            ("days.csv".to_owned(), days_csv::text(self).into_bytes()),
            ("summary.json".to_owned(), (summary.to_json() + "\n").into_bytes()),
            ("report.html".to_owned(), page::text(&summary, &figures).into_bytes()),
        ]);
        Ok(files)
    }
}

fn draw(
    network: &Network,
    first: u64,
    days: u32,
    stop: &Stop,
) -> Result<Vec<Arc<Scenario>>, Error> {
    let seed = |day: u32| DaySeed::comparison(first.saturating_add(u64::from(day)));
    // The last seed is checked first, so that no day is drawn if one of them cannot be.
    seed(days.saturating_sub(1))?;
    let draw = |day: u32| {
        if stop.is_requested() {
            return Err(Error::Stopped);
        }
        Ok(Arc::new(network.draw(seed(day)?)))
    };
    (0..days).into_par_iter().map(draw).collect()
}
