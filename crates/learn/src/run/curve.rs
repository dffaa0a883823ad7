//! Learning curves, with one row for an update of PPO, a round of imitation or a generation of
//! evolution. They are CSV files beside the weights of their run; curves of runs with other seeds
//! may stand there too.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::Error;
use crate::evolution::EvolutionRow;
use crate::imitation::ImitationRow;
use crate::ppo::PpoRow;

/// Longer files are not read. No learning curve of this program comes near this size, in bytes.
const LONGEST: u64 = 64 << 20;

/// The course of a run from its beginning.
#[derive(Debug, Clone, PartialEq)]
pub enum Curve {
    /// One row per update.
    Ppo(Vec<PpoRow>),
    /// One row per round.
    Imitation(Vec<ImitationRow>),
    /// One row per generation.
    Evolution(Vec<EvolutionRow>),
}

impl Curve {
    /// The path at which `train` writes the learning curve of these weights: `gcaps-curve.csv`
    /// beside `gcaps.safetensors`.
    pub fn beside(weights: &Path) -> PathBuf {
        weights.with_file_name(format!("{}-curve.csv", name(weights)))
    }

    /// The curve beside the weights, if there is one, followed by those of runs with other seeds,
    /// `gcaps-seed-2-curve.csv` and so on, in the order of the seeds.
    ///
    /// # Errors
    /// Returns an error if one of the files cannot be read or is not a curve.
    pub fn read_beside(weights: &Path) -> Result<Vec<Self>, Error> {
        let own = Self::beside(weights);
        if !own.exists() {
            return Ok(Vec::new());
        }
        let others = others(weights).into_iter().map(|(_, path)| path);
        std::iter::once(own).chain(others).map(|path| Self::read(&path)).collect()
    }

    /// Reads a learning curve.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or is not a curve.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = vertifleet_core::read_at_most(path, LONGEST)?;
        Self::from_csv(&String::from_utf8_lossy(&bytes), &path.display().to_string())
    }

    /// Parses the CSV text of a curve; `origin` names the file in errors.
    ///
    /// # Errors
    /// Returns [`Error::BadCurve`] for the first row that is not valid.
    pub(crate) fn from_csv(text: &str, origin: &str) -> Result<Self, Error> {
        if text.starts_with("round,") {
            return Ok(Self::Imitation(rows(text, origin)?));
        }
        if text.starts_with("generation,") {
            return Ok(Self::Evolution(rows(text, origin)?));
        }
        Ok(Self::Ppo(rows(text, origin)?))
    }

    /// The curve as CSV text, with one column for each member of its rows.
    pub fn to_csv(&self) -> String {
        match self {
            Self::Ppo(rows) => csv_of(rows),
            Self::Imitation(rows) => csv_of(rows),
            Self::Evolution(rows) => csv_of(rows),
        }
    }

    /// Number of decisions learned from by the last row; 0 before the first row.
    pub fn steps(&self) -> u64 {
        match self {
            Self::Ppo(rows) => rows.last().map_or(0, |row| row.steps),
            Self::Imitation(rows) => rows.last().map_or(0, |row| row.decisions),
            Self::Evolution(rows) => rows.last().map_or(0, |row| row.decisions),
        }
    }

    /// Whether the run has learned nothing yet.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Ppo(rows) => rows.is_empty(),
            Self::Imitation(rows) => rows.is_empty(),
            Self::Evolution(rows) => rows.is_empty(),
        }
    }

    /// Number of decisions learned from, and mean reward of the last training days; empty for
    /// imitation, which does not learn from rewards, and for evolution, whose training days are
    /// played with moved weights.
    pub fn training_rewards(&self) -> Vec<(u64, f64)> {
        match self {
            Self::Ppo(rows) => {
                rows.iter().filter_map(|row| Some((row.steps, row.mean_reward?))).collect()
            }
            Self::Imitation(_) | Self::Evolution(_) => Vec::new(),
        }
    }

    /// Number of decisions learned from, and mean reward on the validation days, for the rows that
    /// measured it.
    pub fn validation_rewards(&self) -> Vec<(u64, f64)> {
        match self {
            Self::Ppo(rows) => {
                rows.iter().filter_map(|row| Some((row.steps, row.validation_reward?))).collect()
            }
            Self::Imitation(rows) => {
                rows.iter().map(|row| (row.decisions, row.validation_reward)).collect()
            }
            Self::Evolution(rows) => rows
                .iter()
                .filter_map(|row| Some((row.decisions, row.validation_reward?)))
                .collect(),
        }
    }

    /// The rows for TensorBoard: number of decisions learned from, and what was measured by then.
    pub(crate) fn scalars(&self) -> Vec<Scalars> {
        match self {
            Self::Ppo(rows) => rows.iter().map(ppo_scalars).collect(),
            Self::Imitation(rows) => rows.iter().map(imitation_scalars).collect(),
            Self::Evolution(rows) => rows.iter().map(evolution_scalars).collect(),
        }
    }

    /// The last of the [`scalars`](Self::scalars).
    pub(crate) fn last_scalars(&self) -> Option<Scalars> {
        match self {
            Self::Ppo(rows) => rows.last().map(ppo_scalars),
            Self::Imitation(rows) => rows.last().map(imitation_scalars),
            Self::Evolution(rows) => rows.last().map(evolution_scalars),
        }
    }
}

/// Decisions learned from, and what was measured by then, by name.
pub(crate) type Scalars = (u64, Vec<(&'static str, f64)>);

fn ppo_scalars(row: &PpoRow) -> Scalars {
    (row.steps, row.scalars())
}

fn imitation_scalars(row: &ImitationRow) -> Scalars {
    (row.decisions, row.scalars())
}

fn evolution_scalars(row: &EvolutionRow) -> Scalars {
    (row.decisions, row.scalars())
}

fn csv_of(rows: &[impl Serialize]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("rows of numbers go into memory");
    }
    let bytes = writer.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("numbers are text")
}

fn rows<Row: DeserializeOwned>(text: &str, origin: &str) -> Result<Vec<Row>, Error> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader.deserialize().collect::<Result<_, csv::Error>>();
    rows.map_err(|error| Error::BadCurve {
        origin: origin.to_owned(),
        line: error.position().map_or(1, csv::Position::line),
        rule: error.to_string(),
    })
}

/// The curves of runs with other seeds, each with its seed, in the order of the seeds.
fn others(weights: &Path) -> Vec<(u32, PathBuf)> {
    let begin = format!("{}-seed-", name(weights));
    let seed = |path: &Path| -> Option<u32> {
        let name = path.file_name()?.to_str()?;
        name.strip_prefix(&begin)?.strip_suffix("-curve.csv")?.parse().ok()
    };
    let folder = weights.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = fs::read_dir(folder.unwrap_or(Path::new("."))).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let mut others: Vec<(u32, PathBuf)> =
        paths.filter_map(|path| Some((seed(&path)?, path))).collect();
    others.sort();
    others
}

/// The name of the policy: `gcaps` for `gcaps.safetensors`.
fn name(weights: &Path) -> String {
    weights.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;
    use vertifleet_core::Coded;

    use super::Curve;
    use crate::evolution::EvolutionRow;
    use crate::imitation::ImitationRow;
    use crate::ppo::PpoRow;

    #[test]
    fn curves_of_other_seeds_follow_that_of_the_weights_in_order() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, update| {
            let curve = Curve::Ppo(vec![PpoRow { update, ..PpoRow::default() }]);
            fs::write(folder.path().join(name), curve.to_csv()).expect("a file");
        };
        let weights = folder.path().join("mine.safetensors");
        let updates = || -> Vec<u64> {
            let rows = |curve| match curve {
                Curve::Ppo(rows) => rows,
                other => panic!("no such rows were written: {other:?}"),
            };
            let curves = Curve::read_beside(&weights).expect("curves").into_iter();
            curves.flat_map(rows).map(|row| row.update).collect()
        };
        write("mine-seed-10-curve.csv", 10);
        assert!(updates().is_empty(), "nothing to compare them with");
        for (name, update) in [
            ("mine-curve.csv", 1),
            ("mine-seed-2-curve.csv", 2),
            ("mine-seed-x-curve.csv", 3),
            ("yours-seed-4-curve.csv", 4),
        ] {
            write(name, update);
        }
        assert_eq!(updates(), [1, 2, 10]);
    }

    #[test]
    fn a_curve_reads_as_it_was_written() {
        let row = PpoRow { update: 3, mean_reward: Some(0.03125), ..PpoRow::default() };
        let round = ImitationRow { round: 1, gain: 0.5, ..ImitationRow::default() };
        let generation = EvolutionRow { generation: 1, gain: Some(0.5), ..EvolutionRow::default() };
        for curve in [
            Curve::Ppo(vec![PpoRow::default(), row]),
            Curve::Imitation(vec![ImitationRow::default(), round]),
            Curve::Evolution(vec![EvolutionRow::default(), generation]),
        ] {
            assert_eq!(Curve::from_csv(&curve.to_csv(), "curve").expect("a curve"), curve);
        }
        let error = Curve::from_csv("update,steps\n1,x\n", "curve").expect_err("no curve");
        assert_eq!(error.code().to_string(), "V308");
    }
}
