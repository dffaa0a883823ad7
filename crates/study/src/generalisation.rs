//! One day each of many networks: how policies do where they were not tuned, and whether size matters.
//!
//! What a policy earns on one network cannot be averaged with what it earns on another, so the measure is the share of the
//! day's certified bound. Every network counts once.

mod headline;
mod networks_csv;
mod page;
mod summary;
mod table;

use std::sync::Arc;

use vertifleet_core::{DaySeed, Network, Purpose, Scenario, Stop, random_network};
use vertifleet_optimize::Step;

use crate::competitor::Selection;
use crate::error::Error;
use crate::figure;
use crate::record::PolicyRecord;
use crate::report::{File, Records, pictures};
use crate::study::{Study, Watch};

pub use summary::{FORMAT, GeneralisationReport, NetworkShare, Outcome, PolicyShare};

/// Random networks with a day of each, and the competitors that will play them; everything that can be found wrong beforehand has
/// been looked for.
pub struct Generalisation {
    study: Study,
    step: Step,
}

impl Generalisation {
    /// The first so many random networks, each with the day that has its number.
    ///
    /// # Errors
    /// If there is no such policy, two policies have one name, or a policy cannot play networks of any size.
    pub fn new(selection: &Selection<'_>, networks: u32, step: Step) -> Result<Self, Error> {
        let competitors = selection.resolve("random")?;
        let draw = |number| {
            let network = random_network(Purpose::Comparison, number);
            Ok(Arc::new(network.draw(DaySeed::comparison(number)?)))
        };
        let scenarios = (0..u64::from(networks)).map(draw).collect::<Result<_, Error>>()?;
        Ok(Self { study: Study::new(competitors, scenarios, Some(step))?, step })
    }

    /// The days that will be played.
    pub fn days(&self) -> impl Iterator<Item = &Scenario> {
        self.study.days()
    }

    /// Bounds all days and plays them with every policy; `command` is what the study says it was made with.
    ///
    /// # Errors
    /// [`Error::Stopped`] soon after `stop` is raised; else if a day is too large for its bound, or a policy cannot play
    /// one to its end.
    pub fn run(
        self,
        command: String,
        stop: &Stop,
        watch: &impl Watch,
    ) -> Result<GeneralisationRecords, Error> {
        let policies = self.study.play(stop, watch)?;
        let network = |day: &Scenario| NetworkRecord {
            name: Network::random_name(day.seed),
            vertiports: day.vertiports.len(),
            aircraft: day.aircraft.len(),
        };
        let networks = self.study.days().map(network).collect();
        Ok(GeneralisationRecords { bound_step_s: self.step.seconds(), command, networks, policies })
    }
}

/// What playing a day each of many networks leaves behind.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneralisationRecords {
    /// Length of the steps of the days' upper bounds, in seconds.
    pub bound_step_s: u32,
    /// Command that made the study, as it would be typed.
    pub command: String,
    /// The networks, as many as there are days.
    pub networks: Vec<NetworkRecord>,
    /// Every policy's day of each network, in the networks' order, each with its upper bound. The others are measured against
    /// the first.
    pub policies: Vec<PolicyRecord>,
}

/// A network that a day was drawn from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NetworkRecord {
    /// Name by which every command finds it.
    pub name: String,
    /// Number of vertiports.
    pub vertiports: usize,
    /// Aircraft of all types together.
    pub aircraft: usize,
}

impl Records for GeneralisationRecords {
    fn text(&self) -> Result<String, Error> {
        Ok(table::text(&GeneralisationReport::of(self)?))
    }

    fn json(&self) -> Result<String, Error> {
        Ok(GeneralisationReport::of(self)?.to_json())
    }

    fn files(&self) -> Result<Vec<File>, Error> {
        let summary = GeneralisationReport::of(self)?;
        let figures = [figure::share_by_size(&summary)];
        let mut files = pictures(&figures);
        files.extend([
            ("networks.csv".to_owned(), networks_csv::text(&summary).into_bytes()),
            ("summary.json".to_owned(), (summary.to_json() + "\n").into_bytes()),
            ("report.html".to_owned(), page::text(&summary, &figures).into_bytes()),
        ]);
        Ok(files)
    }
}
