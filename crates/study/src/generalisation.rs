//! One day of each of many networks, to show how policies do on networks that they were not tuned for, and whether
//! size matters.
//!
//! Profits on different networks cannot be averaged, so the measure is the share of the day's upper bound. Every
//! network counts once.

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

pub use summary::{FORMAT, GeneralisationReport, NetworkShare, Outcome};

/// Random networks with a day of each, and the competitors that will play them. Everything that can be checked
/// beforehand has been checked.
pub struct Generalisation {
    study: Study,
    step: Step,
}

impl Generalisation {
    /// Takes the first `networks` random networks, and of each the day that has the network's number.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, if two policies have the same name, or if a policy cannot play
    /// networks of any size.
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

    /// Bounds all days and plays them with every policy; `command` is the command line that the study records.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested, and an error if a day is too large for its bound or
    /// a policy cannot play one to its end.
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

/// The records of playing one day of each of many networks.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneralisationRecords {
    /// The length of the slices of the upper bounds, in seconds.
    pub bound_step_s: u32,
    /// The command line of the study.
    pub command: String,
    /// The networks, one for each day.
    pub networks: Vec<NetworkRecord>,
    /// The records of every policy, with one day for each network, in the order of the networks, and with the upper
    /// bounds. The other policies are measured against the first.
    pub policies: Vec<PolicyRecord>,
}

/// The network that a day was drawn from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NetworkRecord {
    /// The name by which commands find it.
    pub name: String,
    /// Number of vertiports.
    pub vertiports: usize,
    /// Number of aircraft of all types together.
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
