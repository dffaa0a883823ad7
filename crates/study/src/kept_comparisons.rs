//! Comparisons that are finished, kept in a file, so that a study of many of them goes on where it
//! ended.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::comparison::ComparisonReport;
use crate::error::Error;
use crate::journal::{Head, Journal, fingerprint};
use crate::record::ComparisonRecords;

const FORMAT: &str = "vertifleet-comparisons/1";

/// A comparison that is part of a study.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeptComparison {
    /// The number of the network within the study that the days were drawn from.
    pub point: usize,
    /// The warnings about the comparison.
    pub warnings: Vec<String>,
    /// The comparison.
    pub records: ComparisonRecords,
}

/// The file that finished comparisons are kept in.
pub struct KeptComparisons(Journal);

impl KeptComparisons {
    /// Opens the file at `path`, or begins it, and returns what it holds. `depends_on` names
    /// everything that the results of the study depend on, except the version of the program.
    ///
    /// # Errors
    /// Returns [`Error::OtherStudy`] if the file belongs to another study, and [`Error::Core`] if
    /// it cannot be read or written.
    pub fn open(path: &Path, depends_on: &Value) -> Result<(Self, Vec<KeptComparison>), Error> {
        let study = fingerprint(&serde_json::json!([env!("CARGO_PKG_VERSION"), depends_on]));
        let head = Head { format: FORMAT.to_owned(), study };
        // What was damaged since is not believed, and neither is what follows it.
        let is_sound = |kept: &KeptComparison| ComparisonReport::of(&kept.records).is_ok();
        let (journal, kept) = Journal::open(path, &head, false, is_sound)?;
        Ok((Self(journal), kept))
    }

    /// Adds a comparison. It is on the disk when this returns.
    ///
    /// # Errors
    /// Returns [`Error::Core`] (V102) if the file cannot be written.
    pub fn add(&self, finished: &KeptComparison) -> Result<(), Error> {
        self.0.add(finished)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use vertifleet_core::{Coded, Network, Stop};

    use super::{KeptComparison, KeptComparisons};
    use crate::Unwatched;
    use crate::comparison::{Comparison, DrawnDays};
    use crate::competitor::Selection;

    fn finished(point: usize) -> KeptComparison {
        let network = Network::shipped("paper").expect("shipped");
        let selection = Selection { policies: &["greedy".to_owned()], models: &[], seed: 1 };
        let (days, stop) = (DrawnDays::of_comparison(1, 2), Stop::default());
        let comparison = Comparison::new(&network, &selection, days, None, &stop).expect("fits");
        let records = comparison.run("a test".to_owned(), &stop, &Unwatched).expect("plays");
        KeptComparison { point, warnings: vec!["a warning".to_owned()], records }
    }

    #[test]
    fn what_was_added_is_there_and_other_studies_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("study.jsonl");
        let (kept, found) = KeptComparisons::open(&path, &json!({"days": 2})).expect("begun");
        assert!(found.is_empty());
        kept.add(&finished(3)).expect("room");
        let (_, found) = KeptComparisons::open(&path, &json!({"days": 2})).expect("goes on");
        let [found] = &found[..] else { panic!("one part, found {}", found.len()) };
        let expected = finished(3);
        assert_eq!((found.point, &found.warnings), (3, &expected.warnings));
        let totals = |kept: &KeptComparison| {
            kept.records.policies[0].days.iter().map(|day| day.totals).collect::<Vec<_>>()
        };
        assert_eq!(totals(found), totals(&expected));
        let other = KeptComparisons::open(&path, &json!({"days": 3})).err().expect("another study");
        assert_eq!(other.code().to_string(), "V414");
    }

    #[test]
    fn a_damaged_comparison_is_not_believed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("study.jsonl");
        let (kept, _) = KeptComparisons::open(&path, &json!({})).expect("begun");
        let mut damaged = finished(0);
        damaged.records.policies[0].days.pop();
        kept.add(&damaged).expect("room");
        let (_, found) = KeptComparisons::open(&path, &json!({})).expect("goes on");
        assert!(found.is_empty());
    }
}
