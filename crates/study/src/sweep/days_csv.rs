//! `days.csv` of a sweep: one row for every cell, policy and day.

use vertifleet_sim::{DayNumber, DayTotals};

use super::SweepRecords;
use super::design::format_value;

const TO_MEMORY: &str = "memory takes every row";

/// The days as CSV with a header row.
pub(super) fn text(records: &SweepRecords<'_>) -> String {
    let sweep = records.sweep;
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    let names = DayTotals::default().numbers().map(|(name, _)| name);
    let factors = sweep.factors.iter().map(|factor| factor.path.as_str());
    let head = ["cell"].into_iter().chain(factors).chain(["policy", "day"]).chain(names);
    writer.write_record(head.chain(["upper_bound_usd"])).expect(TO_MEMORY);
    for record in records.records.iter().flatten() {
        let settings = &sweep.cells[record.cell].settings;
        for (policy, days) in sweep.policies.iter().zip(&record.totals) {
            for (at, day) in days.iter().enumerate() {
                let mut row = vec![record.cell.to_string()];
                row.extend(settings.iter().map(format_value));
                row.extend([policy.clone(), (sweep.drawn.first + at as u64).to_string()]);
                row.extend(day.numbers().map(|(_, number)| match number {
                    DayNumber::Amount(amount) => amount.to_string(),
                    DayNumber::Count(count) => count.to_string(),
                }));
                let bound = record.upper_bounds_usd.get(at);
                row.push(bound.map_or_else(String::new, f64::to_string));
                writer.write_record(row).expect(TO_MEMORY);
            }
        }
    }
    String::from_utf8(writer.into_inner().expect(TO_MEMORY)).expect("text and numbers are UTF-8")
}
