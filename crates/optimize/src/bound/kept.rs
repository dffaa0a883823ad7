//! Prices of bounds kept in files, so that a day's bound is searched for only once.
//!
//! A file holds prices and not a bound; the bound that they prove is recomputed. A file that is
//! damaged, of another day or made up can therefore never give a wrong bound, at worst a loose one.
//! The name is a hash of everything that the prices depend on.

use std::fmt::Write;
use std::hash::Hasher;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use siphasher::sip128::{Hasher128, SipHasher24};
use vertifleet_core::{Charging, Scenario, Stop, create_folder, read_at_most, write_atomically};

use super::certificate::Certificate;
use super::descent::Found;
use super::prices::Prices;
use super::step::LEVELS;
use super::time_expanded_day::TimeExpandedDay;
use super::{Bound, Step, upper_bound_unless};
use crate::Error;

/// To be raised whenever the search would find other prices.
const VERSION: u64 = 5;
/// No file that this program wrote is longer.
const LONGEST: u64 = 256 << 20;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    /// Length of the slices of these prices, minutes.
    minutes: u32,
    stand: Vec<i64>,
    flight: Vec<i64>,
    /// Of a second of charging.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    charging: Vec<i64>,
    /// Number of levels of charge, on days that charge as needed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    levels: Option<u16>,
}

/// Does the same as [`upper_bound_unless`], but takes the prices from a file in `folder` if it
/// exists, and otherwise writes them there.
///
/// # Errors
/// The errors of [`upper_bound_unless`], and [`Error::Core`] if the folder or the file cannot be
/// written.
pub fn kept_upper_bound(
    stopped: &Stop,
    scenario: &Scenario,
    step: Step,
    folder: &Path,
) -> Result<Option<Bound>, Error> {
    let path = path(scenario, step, folder);
    if let Some(bound) = kept(scenario, stopped, &path) {
        return Ok(Some(bound));
    }
    let Some(bound) = upper_bound_unless(stopped, scenario, step)? else { return Ok(None) };
    let (minutes, Prices { stand, flight, charging }) = (bound.step.minutes, bound.prices);
    let levels = (!charging.is_empty()).then_some(bound.levels);
    let kept = Kept { minutes, stand, flight, charging, levels };
    create_folder(folder)?;
    write_atomically(&path, &serde_json::to_vec(&kept).expect("whole numbers are plain data"))?;
    let Kept { stand, flight, charging, .. } = kept;
    Ok(Some(Bound { prices: Prices { stand, flight, charging }, ..bound }))
}

/// The bound of the prices in a file. Returns `None` if there is no such file, if it has no prices
/// for this day, or if `stopped` is requested meanwhile.
fn kept(scenario: &Scenario, stopped: &Stop, path: &Path) -> Option<Bound> {
    let text = read_at_most(path, LONGEST).ok()?;
    let kept: Kept = serde_json::from_slice(&text).ok()?;
    let step = Step::from_minutes(kept.minutes).ok()?;
    if kept.levels.is_some_and(|levels| levels != 1 && !LEVELS.contains(&levels)) {
        return None;
    }
    let Kept { stand, flight, charging, levels, .. } = kept;
    let bound =
        proven(scenario, stopped, (step, levels.unwrap_or(1)), Prices { stand, flight, charging })?;
    // Only prices of a search that came to its end are kept.
    Some(Bound { is_final: true, ..bound })
}

/// The bound of a day that prices prove in slices of a length, with a number of levels of charge.
fn proven(
    scenario: &Scenario,
    stopped: &Stop,
    (step, levels): (Step, u16),
    prices: Prices,
) -> Option<Bound> {
    let day = TimeExpandedDay::of(scenario, &[], step.seconds(), levels).ok()?;
    let prices = prices.checked(&day)?;
    let micro_usd = Certificate::new(&day).evaluate(&day, &prices, stopped)?;
    Some(Bound::of(step, &day, &Found { prices, micro_usd }))
}

impl Bound {
    /// What the prices of this bound prove of another day, which differs in what aircraft and
    /// chargers can do; dollars. `None` if the days have other prices, the other one is too large,
    /// or `stopped` is requested meanwhile.
    pub fn of_other_usd(&self, scenario: &Scenario, stopped: &Stop) -> Option<f64> {
        let bound = proven(scenario, stopped, (self.step, self.levels), self.prices.clone())?;
        Some(bound.upper_bound_usd())
    }
}

fn path(scenario: &Scenario, step: Step, folder: &Path) -> PathBuf {
    let mut hasher = SipHasher24::new();
    hasher.write_u64(VERSION);
    hasher.write_u32(step.seconds());
    if scenario.operations.charging == Charging::AsNeeded {
        hasher.write_u16(step.levels);
    }
    hasher.write(scenario.to_json().as_bytes());
    let mut name = String::from("bound-");
    for byte in hasher.finish128().as_bytes() {
        write!(name, "{byte:02x}").expect("a String takes any text");
    }
    folder.join(name + ".json")
}
