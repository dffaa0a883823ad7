//! What one thing more or less would be worth: the days to solve again.

use std::sync::Arc;

use serde::Serialize;
use vertifleet_core::{
    Aircraft, ChargeCurve, Charging, CurvePoint, Day, Scenario, TypeIx, VertiportIx,
};
use vertifleet_optimize::Bound;

/// With more vertiports, only those with the highest shadow prices get a further stand.
const MOST_STANDS: usize = 8;
/// The energy that is added to a battery, and the power that is added to a charger.
const MORE_KWH: f64 = 10.0;
const MORE_KW: f64 = 1.0;

/// What a change of the day is worth, after what it costs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worth {
    /// The change in words.
    pub change: String,
    /// What the change costs, dollars: the fixed costs that the day states for it.
    pub cost_usd: f64,
    /// By how much the policy earns more on the changed day, after this cost, dollars; `None` for a
    /// replay.
    pub policy_usd: Option<f64>,
    /// By how much the upper bound is higher on the changed day, after this cost, dollars.
    pub bound_usd: f64,
    /// Whether `bound_usd` is within the error of the bound, so that the change may be worth
    /// nothing.
    pub is_within_error: bool,
}

/// What a change adds to the day.
#[derive(Debug, Clone, Copy)]
pub(super) enum Effect {
    /// A stand, or a charger where these are counted apart.
    Stand(VertiportIx),
    /// An aircraft that starts there.
    Aircraft(TypeIx, VertiportIx),
    /// A seat in every aircraft of a type.
    Seat,
    /// A shorter take-off.
    TakeOff,
    /// More energy in every battery of a type.
    Battery,
    /// More power at every charger.
    Power,
}

/// A day that differs in one thing.
pub(super) struct Change {
    /// The change in words.
    pub(super) words: String,
    pub(super) effect: Effect,
    /// By how much the changed day has higher fixed costs, dollars.
    pub(super) cost_usd: f64,
    pub(super) day: Arc<Scenario>,
}

/// The changed days.
pub(super) fn changes(day: &Scenario, bound: &Bound) -> Vec<Change> {
    let mut days: Vec<(String, Effect, Day)> = Vec::new();
    let mut vertiports: Vec<VertiportIx> = VertiportIx::all(day.vertiports.len()).collect();
    vertiports.sort_by(|&one, &other| {
        bound.stand_shadow_price_usd(other).total_cmp(&bound.stand_shadow_price_usd(one))
    });
    days.extend(vertiports.into_iter().take(MOST_STANDS).map(|at| with_stand(day, at)));
    for kind in (0..day.aircraft_types.len()).map(TypeIx::new) {
        days.extend(with_aircraft(day, kind));
        let mut changed = day.clone().into_day();
        changed.aircraft_types[kind.at()].seats += 1;
        let words = format!("one more seat in every {}", day.aircraft_types[kind.at()].id);
        days.push((words, Effect::Seat, changed));
    }
    let windows_s = day.operations.takeoff_s + day.operations.landing_s;
    if day.operations.takeoff_s >= 60 && windows_s >= 120 {
        let mut changed = day.clone().into_day();
        changed.operations.takeoff_s -= 60;
        days.push(("a minute less for every take-off".to_owned(), Effect::TakeOff, changed));
    }
    if day.operations.charging == Charging::AsNeeded {
        days.extend(with_batteries(day));
        days.push(with_power(day));
    }
    let checked = |(words, effect, changed): (String, Effect, Day)| {
        // A change that the format does not allow, such as a stand beyond the most, is left out.
        let changed = changed.check("a changed day").ok()?;
        let cost_usd = cost_usd(day, effect);
        Some(Change { words, effect, cost_usd, day: Arc::new(changed) })
    };
    days.into_iter().filter_map(checked).collect()
}

/// What a change costs.
fn cost_usd(day: &Scenario, effect: Effect) -> f64 {
    match effect {
        Effect::Stand(at) => {
            let vertiport = &day.vertiports[at.at()];
            vertiport.chargers.map_or(vertiport.stand_cost_usd, |_| vertiport.charger_cost_usd)
        }
        Effect::Aircraft(..) => day.aircraft_cost_usd,
        Effect::Seat | Effect::TakeOff | Effect::Battery | Effect::Power => 0.0,
    }
}

/// The days with more energy in every battery of a type.
fn with_batteries(day: &Scenario) -> impl Iterator<Item = (String, Effect, Day)> {
    let kinds = 0..day.aircraft_types.len();
    kinds.map(|kind| {
        let mut changed = day.clone().into_day();
        changed.aircraft_types[kind].battery_kwh += MORE_KWH;
        let words = format!("{MORE_KWH} kWh more in every {}", day.aircraft_types[kind].id);
        (words, Effect::Battery, changed)
    })
}

/// The day on which every charger delivers more power, and every type takes it.
fn with_power(day: &Scenario) -> (String, Effect, Day) {
    let mut changed = day.clone().into_day();
    for kind in &mut changed.aircraft_types {
        kind.charge_kw += MORE_KW;
        kind.charge_curve = kind.charge_curve.take().map(|curve| {
            let more = |point: &CurvePoint| CurvePoint { kw: point.kw + MORE_KW, ..*point };
            ChargeCurve::through(curve.points().iter().map(more).collect())
        });
    }
    for vertiport in &mut changed.vertiports {
        vertiport.charger_kw = vertiport.charger_kw.map(|kw| kw + MORE_KW);
    }
    (format!("{MORE_KW} kW more at every charger"), Effect::Power, changed)
}

/// The day with one more stand, or with one more charger where these are counted apart.
fn with_stand(day: &Scenario, at: VertiportIx) -> (String, Effect, Day) {
    let mut changed = day.clone().into_day();
    let vertiport = &mut changed.vertiports[at.at()];
    match &mut vertiport.chargers {
        Some(chargers) => *chargers += 1,
        None => vertiport.stands += 1,
    }
    let what = if vertiport.chargers.is_some() { "charger" } else { "stand" };
    (format!("one more {what} at {}", vertiport.id), Effect::Stand(at), changed)
}

/// The day with one more aircraft, which starts where most stands are free; `None` if none is.
fn with_aircraft(day: &Scenario, kind: TypeIx) -> Option<(String, Effect, Day)> {
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
        changed.aircraft.push(Aircraft { id, kind, at, start_charge_kwh: None });
        let words = format!("one more {}", day.aircraft_types[kind.at()].id);
        (words, Effect::Aircraft(kind, at), changed)
    })
}
