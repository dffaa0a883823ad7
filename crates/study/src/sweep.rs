//! A sweep: the same days and policies under many settings of one network, to answer what a change
//! of the network is worth.
//!
//! Every cell of the design is the network with some members of its file changed. All cells meet
//! the same days: demand, delays, closures and start positions have the same random numbers
//! wherever the change allows it (common random numbers), so differences between cells are far less
//! noisy than the cells themselves. Finished cells are on the disk, and a sweep that is started
//! again goes on where it ended.

mod additive;
mod cell;
mod design;
mod effects;
mod record;
mod summary;

use std::collections::HashSet;
use std::path::Path;
use std::sync::OnceLock;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use serde_json::{Value, json};
use vertifleet_core::{Network, OutputKind, Scenario, Stop, write_atomically};
use vertifleet_optimize::Step;

use crate::comparison::{Comparison, DrawnDays};
use crate::competitor::{Competitor, Selection};
use crate::error::Error;
use crate::journal::{self, Head, Journal, fingerprint};
use crate::record::ComparisonRecords;
use crate::run::Kept;
use crate::study::{Study, Unwatched};

pub use cell::Cell;
pub use design::{Design, Factor, Levels, MOST_CELLS, format_value};
pub use effects::{Effect, LevelEffect};
pub use record::{CellRecord, Size};
pub use summary::{CellResult, CellSummary, FORMAT, SweepReport};

/// The name of the journal in the folder of a sweep.
pub const JOURNAL: &str = "cells.jsonl";
const JOURNAL_FORMAT: &str = "vertifleet-sweep-cells/1";

/// The beginning of every journal of a sweep, in any version of the format.
pub const JOURNAL_KIND: OutputKind =
    OutputKind { name: "sweep", skipped: 0, opening: "{\"format\":\"vertifleet-sweep-cells/" };

/// What a sweep is asked for.
pub struct SweepRequest<'a> {
    /// The network whose members are varied.
    pub network: &'a Network,
    /// What is varied.
    pub factors: Vec<Factor>,
    /// How values are combined.
    pub design: Design,
    /// The policies; cells are judged by the first.
    pub selection: &'a Selection<'a>,
    /// The days of every cell.
    pub drawn: DrawnDays,
    /// The step of the upper bounds, if days are to be bounded.
    pub bound_step: Option<Step>,
}

/// The cells of a design, the competitors that play their days, and the records of the cells that
/// are finished. Everything that can be checked beforehand has been checked.
pub struct Sweep {
    base: Network,
    factors: Vec<Factor>,
    cells: Vec<Cell>,
    competitors: Vec<Competitor>,
    drawn: DrawnDays,
    bound_step: Option<Step>,
    warnings: Vec<String>,
    head: Head,
    /// By cell.
    finished: Vec<OnceLock<CellRecord>>,
    journal: Option<Journal>,
}

impl Sweep {
    /// Makes the networks of all cells. A cell whose fleet has no aircraft, or no place, is left
    /// out; any other change that the format refuses is an error.
    ///
    /// # Errors
    /// Returns an error if a factor leads nowhere or has a value that the format refuses, if there
    /// are too many cells, if there is no such policy, or if a policy cannot play the days.
    pub fn new(request: SweepRequest<'_>, stop: &Stop) -> Result<Self, Error> {
        let SweepRequest { network, factors, design, selection, drawn, bound_step } = request;
        drawn.check()?;
        let competitors = selection.resolve(network.name())?;
        if competitors.is_empty() || drawn.days == 0 {
            let days = drawn.days as usize;
            return Err(Error::Empty { policies: competitors.len(), days });
        }
        let cells = Cell::all(network, &factors, design)?;
        let mut sweep = Self {
            base: network.clone(),
            factors,
            finished: cells.iter().map(|_| OnceLock::new()).collect(),
            cells,
            competitors,
            drawn,
            bound_step,
            warnings: Vec::new(),
            head: Head { format: JOURNAL_FORMAT.to_owned(), study: String::new() },
            journal: None,
        };
        sweep.head.study = sweep.fingerprint(selection.seed);
        sweep.warnings = sweep.check(stop)?;
        Ok(sweep)
    }

    /// Checks that the competitors can play a day of every cell, and returns the warnings about
    /// them, each once.
    fn check(&self, stop: &Stop) -> Result<Vec<String>, Error> {
        let first_day = DrawnDays { days: 1, ..self.drawn };
        let warnings = |network: &&Network| -> Result<Vec<String>, Error> {
            Ok(self.comparison_on(network, first_day, stop)?.warnings().collect())
        };
        let networks: Vec<&Network> = self.networks().collect();
        let all = networks.par_iter().map(warnings).collect::<Result<Vec<_>, Error>>()?.concat();
        let mut known = HashSet::new();
        Ok(all.into_iter().filter(|warning| known.insert(warning.clone())).collect())
    }

    /// Warnings about what is allowed but probably not intended, as those of a comparison.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The first day of the first cell that has a network, for warnings.
    ///
    /// # Errors
    /// Returns an error if there is no such day.
    pub fn first_day(&self) -> Result<Option<Scenario>, Error> {
        let seed = self.drawn.seed(0)?;
        Ok(self.networks().next().map(|network| network.draw(seed)))
    }

    /// The members of the network file that are varied.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.factors.iter().map(|factor| factor.path.as_str())
    }

    /// The cells, in the order of the design.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The networks of the cells that are not left out.
    fn networks(&self) -> impl Iterator<Item = &Network> {
        self.cells.iter().filter_map(|cell| cell.network.as_deref().ok())
    }

    /// Number of cells that are not left out.
    pub fn playable(&self) -> usize {
        self.networks().count()
    }

    /// The numbers of the cells that are still to be played.
    pub fn missing(&self) -> Vec<usize> {
        let is_missing =
            |&cell: &usize| self.cells[cell].network.is_ok() && self.finished[cell].get().is_none();
        (0..self.cells.len()).filter(is_missing).collect()
    }

    /// The records of the finished cells, in the order of the design.
    pub fn finished(&self) -> impl Iterator<Item = &CellRecord> {
        self.finished.iter().filter_map(OnceLock::get)
    }

    /// Whether the design has every combination of the values of its factors, each as often as any
    /// other.
    fn is_grid(&self) -> bool {
        let distinct =
            |texts: &mut dyn Iterator<Item = String>| texts.collect::<HashSet<_>>().len();
        let values = |factor: usize| {
            distinct(&mut self.cells.iter().map(|cell| cell.settings[factor].to_string()))
        };
        let combinations =
            (0..self.factors.len()).map(values).fold(1, |all: usize, one| all.saturating_mul(one));
        let settings = |cell: &Cell| Value::from(cell.settings.clone()).to_string();
        distinct(&mut self.cells.iter().map(settings)) == combinations
            && self.cells.len().is_multiple_of(combinations)
    }

    /// A number that changes when anything changes that the results depend on. `seed` is that of
    /// the policies.
    fn fingerprint(&self, seed: u64) -> String {
        let settings: Vec<&Vec<Value>> = self.cells.iter().map(|cell| &cell.settings).collect();
        let policy = |one: &Competitor| json!([one.name, one.identity(), one.weights_sha256()]);
        let mut text = json!({
            "program": env!("CARGO_PKG_VERSION"),
            "network": self.base.toml(),
            "factors": self.paths().collect::<Vec<_>>(),
            "cells": settings,
            "names": self.competitors.iter().map(|one| &one.name).collect::<Vec<_>>(),
            "policies": self.competitors.iter().map(policy).collect::<Vec<_>>(),
            "days": [self.drawn.purpose.name(), self.drawn.first, self.drawn.days],
            "bound_step_s": self.bound_step.map(Step::seconds),
        });
        // The program gives policies the seed of the first day, which is there already.
        if seed != self.drawn.first {
            text["policy_seed"] = json!(seed);
        }
        fingerprint(&text)
    }

    /// Keeps finished cells in the journal at this path from now on, and takes over those that it
    /// holds. Returns their number. With `force`, the journal of another sweep is replaced.
    ///
    /// # Errors
    /// Returns [`Error::OtherStudy`] if the journal belongs to another sweep, and [`Error::Core`]
    /// if it cannot be read or written.
    pub fn keep_in(&mut self, path: &Path, force: bool) -> Result<usize, Error> {
        let days = self.drawn.days as usize;
        let is_whole = |record: &CellRecord| {
            record.totals.len() == self.competitors.len()
                && record.totals.iter().all(|totals| totals.len() == days)
        };
        // What was damaged since is not believed, and neither is what follows it.
        let is_new = |record: &CellRecord| {
            let place = self.finished.get(record.cell);
            is_whole(record) && place.is_some_and(|place| place.set(record.clone()).is_ok())
        };
        let (journal, found) = Journal::open(path, &self.head, force, is_new)?;
        self.journal = Some(journal);
        Ok(found.len())
    }

    /// Plays all cells that are not finished, and keeps each as soon as it is. `played` is called
    /// after each of them, from any thread.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested, and an error if a day is too
    /// large for its bound, if a policy cannot play one to its end, or if the journal cannot be
    /// written. Cells that were finished are kept.
    pub fn run(&self, stop: &Stop, played: &(impl Fn() + Sync)) -> Result<(), Error> {
        self.missing().par_iter().try_for_each(|&cell| {
            let network = self.cells[cell].network.as_ref().expect("a missing cell has a network");
            let study = self.study(network, self.drawn, stop)?;
            self.add(CellRecord::of(cell, &study.play(Kept::Totals, stop, &Unwatched)?))?;
            played();
            Ok(())
        })
    }

    /// Adds a finished cell.
    ///
    /// # Errors
    /// Returns [`Error::Core`] if the journal cannot be written.
    pub fn add(&self, record: CellRecord) -> Result<(), Error> {
        if let Some(journal) = &self.journal {
            journal.add(&record)?;
        }
        // A cell that was added twice has the same record both times.
        let _ = self.finished[record.cell].set(record);
        Ok(())
    }

    fn study(&self, network: &Network, drawn: DrawnDays, stop: &Stop) -> Result<Study, Error> {
        let competitors = self.competitors.iter().map(|competitor| competitor.on(network));
        Study::new(
            competitors.collect::<Result<_, Error>>()?,
            drawn.draw(network, stop)?,
            self.bound_step,
        )
    }

    fn comparison_on(
        &self,
        network: &Network,
        drawn: DrawnDays,
        stop: &Stop,
    ) -> Result<Comparison, Error> {
        Ok(Comparison::of_drawn(drawn, network, self.study(network, drawn, stop)?))
    }

    /// A finished cell as the comparison on its network, with the warnings about it; `None` for a
    /// cell that is not finished. `command` is the command line that the comparison records.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested.
    pub fn comparison(
        &self,
        cell: usize,
        command: String,
        stop: &Stop,
    ) -> Result<Option<(ComparisonRecords, Vec<String>)>, Error> {
        let (Ok(network), Some(record)) = (&self.cells[cell].network, self.finished[cell].get())
        else {
            return Ok(None);
        };
        let comparison = self.comparison_on(network, self.drawn, stop)?;
        let warnings = comparison.warnings().collect();
        let policies = record.policies(&self.competitors, &comparison.days());
        Ok(Some((comparison.records(policies, command), warnings)))
    }

    /// Writes the finished cells as a journal into a folder, which is made if it is not there: in
    /// the order of the cells, whole or not at all. The same sweep gives the same bytes, however
    /// often it was interrupted.
    ///
    /// # Errors
    /// Returns [`Error::CannotMakeFolder`], or [`Error::Core`] (V102) if the file cannot be
    /// written.
    pub fn write_journal(&self, folder: &Path) -> Result<(), Error> {
        journal::make_folder(folder)?;
        let records: Vec<CellRecord> = self.finished().map(CellRecord::without_times).collect();
        let text = journal::text(&self.head, &records);
        Ok(write_atomically(&folder.join(JOURNAL), text.as_bytes())?)
    }
}
