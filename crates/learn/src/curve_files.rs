//! Where learning curves stand: beside the weights of their run, with those of runs with other seeds.

use std::fs;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use crate::curve::from_csv;
use crate::error::Error;

/// No learning curve of ours comes near; longer files are not read.
const LONGEST_CURVE: u64 = 64 << 20;

/// Where `train` leaves the learning curve of these weights: `gcaps-curve.csv` beside `gcaps.safetensors`.
pub fn curve_beside(weights: &Path) -> PathBuf {
    weights.with_file_name(format!("{}-curve.csv", name(weights)))
}

/// The curve beside weights, if there is one, and then those of runs with other seeds, `gcaps-seed-2-curve.csv` and so on, in the
/// order of the seeds.
///
/// # Errors
/// If one of them cannot be read or is no curve with these rows.
pub fn read_curves<Row: DeserializeOwned>(weights: &Path) -> Result<Vec<Vec<Row>>, Error> {
    let own = curve_beside(weights);
    if !own.exists() {
        return Ok(Vec::new());
    }
    let others = others(weights).into_iter().map(|(_, path)| path);
    std::iter::once(own).chain(others).map(|path| read_curve(&path)).collect()
}

fn read_curve<Row: DeserializeOwned>(path: &Path) -> Result<Vec<Row>, Error> {
    let bytes = vertifleet_core::read_at_most(path, LONGEST_CURVE)?;
    from_csv(&String::from_utf8_lossy(&bytes), &path.display().to_string())
}

/// Curves of runs with other seeds, each with its seed, in their order.
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

/// `gcaps` of `gcaps.safetensors`.
fn name(weights: &Path) -> String {
    weights.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::read_curves;
    use crate::curve::{CurveRow, to_csv};

    #[test]
    fn curves_of_other_seeds_follow_that_of_the_weights_in_order() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, update| {
            let rows = [CurveRow { update, ..CurveRow::default() }];
            fs::write(folder.path().join(name), to_csv(&rows)).expect("a file");
        };
        let weights = folder.path().join("mine.safetensors");
        let updates = || -> Vec<u64> {
            let curves: Vec<Vec<CurveRow>> = read_curves(&weights).expect("curves");
            curves.iter().flatten().map(|row| row.update).collect()
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
}
