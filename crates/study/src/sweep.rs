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
mod played;
mod record;
mod summary;

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use serde_json::{Value, json};
use vertifleet_core::{Network, OutputKind, Scenario, Stop, write_atomically};
use vertifleet_optimize::Step;

use crate::comparison::DrawnDays;
use crate::competitor::{Competitor, Selection};
use crate::error::Error;
use crate::journal::{self, Head, Journal, fingerprint};
use crate::kept_bounds::KeptBounds;
use crate::run::{BoundedDay, Kept, play_all};

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

/// The cells of a design, and the competitors that will play their days. Everything that can be
/// checked beforehand has been checked.
pub struct Sweep {
    base: Network,
    factors: Vec<Factor>,
    cells: Vec<Cell>,
    /// The names of the policies.
    policies: Vec<String>,
    /// The policies, where this program plays their days.
    competitors: Vec<Competitor>,
    drawn: DrawnDays,
    bound_step: Option<Step>,
    fingerprint: String,
}

impl Sweep {
    /// Makes the networks of all cells. A cell whose fleet has no place is left out; any other
    /// change that the format refuses is an error.
    ///
    /// # Errors
    /// Returns an error if a factor leads nowhere or has a value that the format refuses, if there
    /// are too many cells, if there is no such policy, or if a policy cannot play the days.
    pub fn new(request: SweepRequest<'_>) -> Result<Self, Error> {
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
            cells,
            policies: competitors.iter().map(|one| one.name.clone()).collect(),
            competitors,
            drawn,
            bound_step,
            fingerprint: String::new(),
        };
        sweep.fingerprint = sweep.fingerprint();
        if let Some(day) = sweep.first_day()? {
            sweep.competitors.iter().try_for_each(|competitor| competitor.check_fits(&day))?;
        }
        Ok(sweep)
    }

    /// The first day of the first cell that has a network, for warnings.
    ///
    /// # Errors
    /// Returns an error if there is no such day.
    pub fn first_day(&self) -> Result<Option<Scenario>, Error> {
        let network = self.cells.iter().find_map(|cell| cell.network.as_ref().ok());
        let seed = self.drawn.seed(0)?;
        Ok(network.map(|network| network.draw(seed)))
    }

    /// Number of cells that will be played.
    pub fn cells(&self) -> usize {
        self.cells.iter().filter(|cell| cell.network.is_ok()).count()
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

    /// A number that changes when anything changes that the results depend on.
    fn fingerprint(&self) -> String {
        let settings: Vec<&Vec<Value>> = self.cells.iter().map(|cell| &cell.settings).collect();
        let policies: Vec<Value> = self
            .competitors
            .iter()
            .map(|one| json!([one.name, one.description(), one.weights_sha256()]))
            .collect();
        let text = json!({
            "program": env!("CARGO_PKG_VERSION"),
            "network": self.base.toml(),
            "factors": self.factors.iter().map(|factor| &factor.path).collect::<Vec<_>>(),
            "cells": settings,
            "names": self.policies,
            "policies": policies,
            "days": [self.drawn.purpose.name(), self.drawn.first, self.drawn.days],
            "bound_step_s": self.bound_step.map(Step::seconds),
        });
        fingerprint(&text)
    }

    /// The head of the sweep's journal.
    fn head(&self) -> Head {
        Head { format: JOURNAL_FORMAT.to_owned(), study: self.fingerprint.clone() }
    }

    /// Plays the days of a cell; `None` if the cell has no network.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested, and an error if a day is too
    /// large for its bound or a policy cannot play one to its end.
    pub fn play(&self, cell: usize, stop: &Stop) -> Result<Option<CellRecord>, Error> {
        let Ok(network) = &self.cells[cell].network else { return Ok(None) };
        let days = self.drawn.draw(network, stop)?;
        let days: Vec<BoundedDay> = match self.bound_step {
            Some(slices) => KeptBounds::of_this_user().days(days, slices, stop, &|| ())?,
            None => days.into_iter().map(BoundedDay::unbounded).collect(),
        };
        let totals = |competitor: &Competitor| {
            let policy = play_all(competitor, &days, Kept::Totals, stop, &|| ())?;
            Ok(policy.days.iter().map(|day| day.totals).collect())
        };
        Ok(Some(CellRecord {
            cell,
            upper_bounds_usd: days.iter().filter_map(|day| day.upper_bound_usd).collect(),
            totals: self.competitors.iter().map(totals).collect::<Result<_, Error>>()?,
        }))
    }

    /// Plays all cells that the folder, which is made if it is not there, does not hold yet, and
    /// keeps each as soon as it is finished. `begin` is called with the number of cells that were
    /// there and of all cells; the function that it returns is called after each further one, from
    /// any thread. With `force`, another sweep in the folder is replaced.
    ///
    /// # Errors
    /// Returns [`Error::CannotMakeFolder`], [`Error::OtherStudy`] if the folder holds another
    /// sweep, [`Error::Stopped`] soon after `stop` is requested, and the errors of
    /// [`play`](Self::play). Cells that were finished are kept.
    pub fn run<Played: Fn() + Sync>(
        &self,
        folder: &Path,
        command: String,
        force: bool,
        stop: &Stop,
        begin: impl FnOnce(usize, usize) -> Played,
    ) -> Result<SweepRecords<'_>, Error> {
        fs::create_dir_all(folder)
            .map_err(|cause| Error::CannotMakeFolder { path: folder.to_owned(), cause })?;
        let mut known = vec![false; self.cells.len()];
        let is_new = |record: &CellRecord| {
            known.get_mut(record.cell).is_some_and(|known| !std::mem::replace(known, true))
        };
        let (journal, found) = Journal::open(&folder.join(JOURNAL), &self.head(), force, is_new)?;
        let mut records: Vec<Option<CellRecord>> = vec![None; self.cells.len()];
        let played = begin(found.len(), self.cells());
        for record in found {
            let cell = record.cell;
            records[cell] = Some(record);
        }
        let missing: Vec<usize> =
            (0..records.len()).filter(|&cell| records[cell].is_none()).collect();
        let play = |&cell: &usize| {
            let record = self.play(cell, stop)?;
            if let Some(record) = &record {
                journal.add(record)?;
                played();
            }
            Ok(record)
        };
        let fresh = missing.par_iter().map(play).collect::<Result<Vec<_>, Error>>()?;
        for record in fresh.into_iter().flatten() {
            let cell = record.cell;
            records[cell] = Some(record);
        }
        Ok(self.records(records, command))
    }

    /// The records of the whole sweep, made from those of its cells in the order of the design.
    pub fn records(&self, records: Vec<Option<CellRecord>>, command: String) -> SweepRecords<'_> {
        SweepRecords { sweep: self, records, command }
    }
}

/// A sweep with the records of its cells.
pub struct SweepRecords<'a> {
    sweep: &'a Sweep,
    /// By cell; `None` for a cell without a network.
    records: Vec<Option<CellRecord>>,
    command: String,
}

impl SweepRecords<'_> {
    /// The records of the cells that were played, in the order of the design.
    pub fn played(&self) -> impl Iterator<Item = &CellRecord> {
        self.records.iter().flatten()
    }

    /// Writes the journal in the order of the cells, whole or not at all: the same sweep gives the
    /// same bytes, however often it was interrupted.
    ///
    /// # Errors
    /// Returns [`Error::Core`] (V102) if the file cannot be written.
    pub fn write_journal(&self, folder: &Path) -> Result<(), Error> {
        let records: Vec<CellRecord> = self.played().cloned().collect();
        let text = journal::text(&self.sweep.head(), &records);
        Ok(write_atomically(&folder.join(JOURNAL), text.as_bytes())?)
    }
}
