//! `days.csv`: one row for every policy and day, for use in other programs.

use crate::record::{ComparisonRecords, DayRecord};

/// The days of the study as CSV with a header row; policies in the order in which they were named.
///
/// # Panics
/// Never panics: writing rows of numbers and text to memory cannot fail, and a study has at least
/// one day.
pub(crate) fn text(study: &ComparisonRecords) -> String {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    let days = || {
        study.policies.iter().flat_map(|policy| policy.days.iter().map(move |day| (policy, day)))
    };
    let (_, first) = days().next().expect("a study has a day");
    let names = first.totals.numbers().map(|(name, _)| name);
    let names = ["policy", "day", "seed"].into_iter().chain(names);
    writer.write_record(names.chain(["upper_bound_usd", "bound_share"])).expect(TO_MEMORY);
    for (policy, day) in days() {
        let DayRecord { day: name, seed, totals, upper_bound_usd, .. } = day;
        let row = (&policy.name, name, seed, totals, upper_bound_usd, day.bound_share());
        writer.serialize(row).expect(TO_MEMORY);
    }
    String::from_utf8(writer.into_inner().expect(TO_MEMORY)).expect("text and numbers are UTF-8")
}

const TO_MEMORY: &str = "memory takes every row";
