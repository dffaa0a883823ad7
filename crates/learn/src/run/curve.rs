//! Learning curves of all ways to learn, with one row for each step. They are CSV files in the
//! folder of their run's weights; curves of runs with other seeds may be there too.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::Error;

/// Largest learning curve, bytes. No learning curve of this program comes near this size.
const LONGEST: u64 = 64 << 20;
/// The columns that every curve has first: the number of the step, under its own name, and the
/// number of decisions learned from by then.
const DECISIONS: usize = 1;

/// The course of a run from its beginning: columns of numbers, the first two of which count steps
/// and decisions learned from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    columns: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

/// A number in a row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// A whole number.
    Count(u64),
    /// Any number.
    Number(f64),
    /// A value that was not measured after this step.
    Unmeasured,
}

impl Curve {
    /// The path at which `train` writes the learning curve of these weights: `gcaps-curve.csv` in
    /// the folder of `gcaps.safetensors`.
    pub fn next_to(weights: &Path) -> PathBuf {
        weights.with_file_name(format!("{}-curve.csv", name(weights)))
    }

    /// The curve in the folder of the weights, if there is one, followed by those of runs with
    /// other seeds, `gcaps-seed-2-curve.csv` and so on, in the order of the seeds.
    ///
    /// # Errors
    /// Returns an error if one of the files cannot be read or is not a curve.
    pub fn read_beside(weights: &Path) -> Result<Vec<Self>, Error> {
        let own = Self::next_to(weights);
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
        let bad = |line, rule| Error::BadCurve { origin: origin.to_owned(), line, rule };
        let of_csv = |error: csv::Error| {
            bad(error.position().map_or(1, csv::Position::line), error.to_string())
        };
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let columns: Vec<String> =
            reader.headers().map_err(of_csv)?.iter().map(str::to_owned).collect();
        if !columns.is_empty() && !columns.iter().any(|column| column == "validation_reward") {
            return Err(bad(1, "it has no column \"validation_reward\"".to_owned()));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(of_csv)?;
            let line = record.position().map_or(1, csv::Position::line);
            let mut cells = Vec::with_capacity(columns.len());
            for (at, (text, column)) in record.iter().zip(&columns).enumerate() {
                let cell = Cell::parse(text);
                let counts = |cell: &Cell| at > DECISIONS || matches!(cell, Cell::Count(_));
                let rule = || format!("{column} must be a number, found {text:?}");
                cells.push(cell.filter(counts).ok_or_else(|| bad(line, rule()))?);
            }
            rows.push(cells);
        }
        Ok(Self { columns, rows })
    }

    /// The curve of a run with these rows.
    pub(crate) fn of(rows: &[impl Serialize]) -> Self {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in rows {
            writer.serialize(row).expect("rows of numbers go into memory");
        }
        Self::from_csv(&text(writer), "the run").expect("rows are numbers")
    }

    /// The curve as CSV text.
    pub fn to_csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        if !self.columns.is_empty() {
            writer.write_record(&self.columns).expect("memory takes everything");
        }
        for row in &self.rows {
            writer.serialize(row).expect("rows of numbers go into memory");
        }
        text(writer)
    }

    /// The names of the columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The rows, each with a number in every column.
    pub fn rows(&self) -> &[Vec<Cell>] {
        &self.rows
    }

    /// Number of decisions learned from by the last row; 0 before the first row.
    pub fn steps(&self) -> u64 {
        self.rows.last().map_or(0, |row| decisions(row))
    }

    /// Whether the run has learned nothing yet.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of decisions learned from, and the number in a column, for the rows that measured it;
    /// empty if there is no such column.
    pub fn measured(&self, column: &str) -> Vec<(u64, f64)> {
        let Some(at) = self.columns.iter().position(|name| name == column) else {
            return Vec::new();
        };
        self.rows.iter().filter_map(|row| Some((decisions(row), row[at].number()?))).collect()
    }

    /// Number of decisions learned from, and mean reward of the last training days; empty for ways
    /// to learn that do not use the rewards of training days.
    pub fn training_rewards(&self) -> Vec<(u64, f64)> {
        self.measured("mean_reward")
    }

    /// Number of decisions learned from, and mean reward on the validation days, for the rows that
    /// measured it.
    pub fn validation_rewards(&self) -> Vec<(u64, f64)> {
        self.measured("validation_reward")
    }

    /// A row for TensorBoard: number of decisions learned from, and the values measured by then, by
    /// their tags.
    pub(crate) fn scalars(&self, row: usize) -> (u64, Vec<(String, f64)>) {
        let row = &self.rows[row];
        let measured = self.columns.iter().zip(row).filter_map(|(column, cell)| match cell {
            Cell::Number(number) => Some((tag(column), *number)),
            Cell::Count(_) | Cell::Unmeasured => None,
        });
        (decisions(row), measured.collect())
    }
}

impl Cell {
    fn parse(text: &str) -> Option<Self> {
        if text.is_empty() {
            return Some(Self::Unmeasured);
        }
        let count = text.parse().ok().map(Self::Count);
        count.or_else(|| text.parse().ok().map(Self::Number))
    }

    /// The number, if it was measured.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Count(count) => Some(count as f64),
            Self::Number(number) => Some(number),
            Self::Unmeasured => None,
        }
    }
}

fn decisions(row: &[Cell]) -> u64 {
    match row.get(DECISIONS) {
        Some(&Cell::Count(decisions)) => decisions,
        _ => 0,
    }
}

/// The name of a column in TensorBoard, which is that of stable-baselines3 where it has one.
fn tag(column: &str) -> String {
    match column {
        "mean_reward" => "rollout/ep_rew_mean".to_owned(),
        "validation_reward" => "eval/mean_reward".to_owned(),
        "policy_loss" => "train/policy_gradient_loss".to_owned(),
        "gain" | "random_gain" => format!("eval/{column}"),
        _ => format!("train/{column}"),
    }
}

fn text(writer: csv::Writer<Vec<u8>>) -> String {
    let bytes = writer.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("numbers are text")
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

    use super::{Cell, Curve};
    use crate::evolution::EvolutionRow;
    use crate::imitation::ImitationRow;
    use crate::ppo::PpoRow;

    #[test]
    fn curves_of_other_seeds_follow_that_of_the_weights_in_order() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, update| {
            let curve = Curve::of(&[PpoRow { update, ..PpoRow::default() }]);
            fs::write(folder.path().join(name), curve.to_csv()).expect("a file");
        };
        let weights = folder.path().join("mine.safetensors");
        let updates = || -> Vec<Cell> {
            let curves = Curve::read_beside(&weights).expect("curves");
            curves.iter().flat_map(Curve::rows).map(|row| row[0]).collect()
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
        assert_eq!(updates(), [1, 2, 10].map(Cell::Count));
    }

    #[test]
    fn a_curve_reads_as_it_was_written() {
        let row = PpoRow { update: 3, mean_reward: Some(0.03125), ..PpoRow::default() };
        let round = ImitationRow { round: 1, gain: 0.5, ..ImitationRow::default() };
        let generation = EvolutionRow { generation: 1, gain: Some(0.5), ..EvolutionRow::default() };
        for (curve, column) in [
            (Curve::of(&[PpoRow::default(), row]), "mean_reward"),
            (Curve::of(&[ImitationRow::default(), round]), "gain"),
            (Curve::of(&[EvolutionRow::default(), generation]), "gain"),
        ] {
            assert_eq!(Curve::from_csv(&curve.to_csv(), "curve").expect("a curve"), curve);
            let (_, last) = *curve.measured(column).last().expect("it was measured");
            assert!(last == 0.5 || last == 0.03125, "{last}");
        }
    }

    #[test]
    fn an_invalid_curve_is_refused_with_the_line() {
        for (text, line) in [
            ("update,steps\n1,2\n", "line 1"),
            ("update,steps,validation_reward\n1,2,\n2,x,0.5\n", "line 3"),
            ("update,steps,validation_reward\n1,,0.5\n", "line 2"),
            ("update,steps,validation_reward\n1\n", "line 2"),
        ] {
            let error = Curve::from_csv(text, "curve").expect_err(text);
            assert_eq!(error.code().to_string(), "V308");
            assert!(error.to_string().contains(line), "{error}");
        }
    }
}
