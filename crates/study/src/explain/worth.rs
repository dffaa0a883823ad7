//! What one thing more or less would be worth: the days to solve again.

use std::sync::Arc;

use serde::Serialize;
use vertifleet_core::{Aircraft, Day, Scenario, VertiportIx};
use vertifleet_optimize::Bound;

/// With more vertiports, only those with the highest shadow prices get a further stand.
const MOST_STANDS: usize = 8;

/// What a change of the day is worth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worth {
    /// The change in words.
    pub change: String,
    /// By how much the policy earns more on the changed day, dollars; `None` for a replay.
    pub policy_usd: Option<f64>,
    /// By how much the upper bound is higher on the changed day, dollars.
    pub bound_usd: f64,
}

/// The changed days, each with its change in words. What the change costs is not counted, except for the fixed costs that
/// the day states for it.
pub(super) fn changes(day: &Scenario, bound: &Bound) -> Vec<(String, Arc<Scenario>)> {
    let mut days: Vec<(String, Day)> = Vec::new();
    let mut vertiports: Vec<VertiportIx> = VertiportIx::all(day.vertiports.len()).collect();
    vertiports.sort_by(|&one, &other| {
        bound.stand_shadow_price_usd(other).total_cmp(&bound.stand_shadow_price_usd(one))
    });
    for at in vertiports.into_iter().take(MOST_STANDS) {
        let mut changed = day.clone().into_day();
        let vertiport = &mut changed.vertiports[at.at()];
        match &mut vertiport.chargers {
            Some(chargers) => *chargers += 1,
            None => vertiport.stands += 1,
        }
        let what = if vertiport.chargers.is_some() { "charger" } else { "stand" };
        days.push((format!("one more {what} at {}", vertiport.id), changed));
    }
    for kind in 0..day.aircraft_types.len() {
        if let Some(changed) = with_aircraft(day, kind) {
            days.push((format!("one more {}", day.aircraft_types[kind].id), changed));
        }
        let mut changed = day.clone().into_day();
        changed.aircraft_types[kind].seats += 1;
        days.push((format!("one more seat in every {}", day.aircraft_types[kind].id), changed));
    }
    let windows_s = day.operations.takeoff_s + day.operations.landing_s;
    if day.operations.takeoff_s >= 60 && windows_s >= 120 {
        let mut changed = day.clone().into_day();
        changed.operations.takeoff_s -= 60;
        days.push(("a minute less for every take-off".to_owned(), changed));
    }
    let checked = |(change, day): (String, Day)| {
        // A change that the format does not allow, such as a stand beyond the most, is left out.
        day.check("a changed day").ok().map(|day| (change, Arc::new(day)))
    };
    days.into_iter().filter_map(checked).collect()
}

/// The day with one more aircraft, which starts where most stands are free; `None` if none is.
fn with_aircraft(day: &Scenario, kind: usize) -> Option<Day> {
    let free = |at: VertiportIx| {
        let there = day.aircraft.iter().filter(|aircraft| aircraft.at == at).count();
        usize::from(day.vertiports[at.at()].stands) - there
    };
    // The first of those with the most free stands.
    let most = VertiportIx::all(day.vertiports.len()).map(free).max()?;
    let at = VertiportIx::all(day.vertiports.len()).find(|&at| free(at) == most)?;
    let id = (1..).map(|number| format!("A+{number}"));
    let is_new = |id: &String| day.aircraft.iter().all(|aircraft| aircraft.id != *id);
    let id = id.into_iter().find(is_new).expect("one of endlessly many ids is free");
    (free(at) > 0).then(|| {
        let mut changed = day.clone().into_day();
        changed.aircraft.push(Aircraft { id, kind: vertifleet_core::TypeIx::new(kind), at });
        changed
    })
}
