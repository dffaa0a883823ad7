//! The table of a suite: the name, the hash and the upper bound of every day.

use std::fmt::Write as _;
use std::hash::Hasher as _;

use siphasher::sip128::{Hasher128 as _, SipHasher24};
use vertifleet_core::Scenario;

const HEADER: &str = "day,hash,upper_bound_usd";

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FrozenDay {
    pub(super) name: &'static str,
    pub(super) hash: &'static str,
    pub(super) upper_bound_usd: f64,
}

/// Reads a table that is compiled into the program. Rows that are none are left out, so that a
/// damaged table has too few days.
pub(super) fn parse(table: &'static str) -> Vec<FrozenDay> {
    let row = |line: &'static str| {
        let mut cells = line.split(',');
        let (name, hash) = (cells.next()?, cells.next()?);
        Some(FrozenDay { name, hash, upper_bound_usd: cells.next()?.parse().ok()? })
    };
    table.lines().skip(1).filter_map(row).collect()
}

/// Writes a table.
pub(super) fn text<'a>(days: impl Iterator<Item = (&'a Scenario, f64)>) -> String {
    let mut text = format!("{HEADER}\n");
    for (day, upper_bound_usd) in days {
        // Rounded up to a hundredth of a cent, so that it stays an upper bound.
        let rounded_usd = (upper_bound_usd * 1e4).ceil() / 1e4;
        writeln!(text, "{},{},{rounded_usd}", day.name, hash(day))
            .expect("memory takes everything");
    }
    text
}

/// The hash of everything that a day consists of: `SipHash` 2-4 with 128 bits and a key of zeros,
/// of the text of its scenario file.
pub(super) fn hash(day: &Scenario) -> String {
    let mut hasher = SipHasher24::new();
    hasher.write(day.to_json().as_bytes());
    let hash = hasher.finish128();
    format!("{:016x}{:016x}", hash.h1, hash.h2)
}
