//! Comments of the network file on the source of its demand, line by line.

use std::path::Path;

use crate::file_name;
use crate::hourly_demand::HourlyDemand;
use crate::trips::{TripAccount, Trips};

/// The most files that are named individually.
const MOST_FILES: usize = 12;

/// Describes demand from a table.
pub(crate) fn of_table(path: &Path, demand: &HourlyDemand) -> Vec<String> {
    let mut lines = vec![format!(
        "Mean passengers from {}; assumption: they decide independently.",
        file_name(path)
    )];
    let none_first =
        || demand.pairs.values().all(|means| means.first().is_none_or(|&mean| mean == 0.0));
    if let [_, second, ..] = demand.periods.as_slice()
        && none_first()
    {
        lines.push(format!("There are none before {second}."));
    }
    lines
}

/// Describes demand from trip records, and what became of the records.
pub(crate) fn of_trips(trips: &Trips<'_>, account: &TripAccount) -> Vec<String> {
    let mut files: Vec<&str> = account.files.iter().map(String::as_str).collect();
    let more = files.len().saturating_sub(MOST_FILES);
    files.truncate(MOST_FILES);
    let more = if more > 0 { format!(" and {more} more files") } else { String::new() };
    let mut lines = vec![
        format!("Demand from the trip records of {}{more}.", files.join(", ")),
        format!(
            "assumption: a share of {} of the passengers fly whose trips begin and end within {} mi of two vertiports",
            trips.mode_share, trips.radius_mi
        ),
    ];
    lines.push(match trips.decay_mi {
        Some(decay_mi) => {
            format!(
                "(times exp(-d / {decay_mi} mi), where d is the way to and from these vertiports)."
            )
        }
        None => "(as many near a vertiport as at this distance).".to_owned(),
    });
    if let Some(zones) = trips.zones {
        lines.push(format!("A zone of {} is taken for its middle.", file_name(zones)));
    }
    if let (Some(first), Some(last)) = (account.first_date, account.last_date) {
        lines.push(format!(
            "Mean of {} days ({}) from {first} to {last}: {} passengers a day. assumption: they decide independently.",
            account.days, trips.weekdays, account.passengers_a_day
        ));
    }
    lines.push(format!("Of {} rows, {} were kept.", account.rows, account.kept));
    let dropped = account.dropped().into_iter().filter(|(_, rows)| *rows > 0);
    lines.extend(dropped.map(|(reason, rows)| format!("- dropped for {reason}: {rows}")));
    lines
}
