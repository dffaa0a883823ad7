//! The features of charge, which `gcaps-x` and `gcaps-full` observe in addition if their weights
//! have learned from days that charge as needed. Weights that have not do not read them.
//!
//! Times are in hours, and charges are shares of the battery. On days that charge to full, no
//! flight waits and every battery is full at its decision.

use vertifleet_core::{VertiportIx, whole_mwh};
use vertifleet_sim::{Decision, View};

use crate::column::{self, Column, flag, hours};

/// A choice of the deciding aircraft.
pub(crate) struct Choice {
    wait_h: f64,
    needed: f64,
    after: f64,
}

/// The deciding aircraft.
pub(crate) struct Battery {
    charge: f64,
    to_full_h: f64,
    as_needed: bool,
}

/// The columns of a vertiport.
pub(crate) const NODES: [Column<Choice>; 3] = [
    Column("wait_h", |choice| choice.wait_h.min(2.0)),
    Column("charge_needed", |choice| choice.needed.min(1.0)),
    Column("charge_after", |choice| choice.after),
];

/// The columns of the deciding aircraft.
pub(crate) const AIRCRAFT: [Column<Battery>; 3] = [
    Column("charge", |battery| battery.charge),
    Column("to_full_h", |battery| battery.to_full_h.min(2.0)),
    Column("as_needed", |battery| flag(battery.as_needed)),
];

/// Writes the columns of the vertiports into the last columns of their rows, which have `stride`
/// columns each.
pub(crate) fn write_nodes(view: View<'_>, decision: &Decision, stride: usize, to: &mut [f32]) {
    let rows = to.chunks_exact_mut(stride);
    for (at, row) in VertiportIx::all(view.vertiports()).zip(rows) {
        column::write(&NODES, &Choice::of(view, decision, at), &mut row[stride - NODES.len()..]);
    }
}

/// Writes the columns of the deciding aircraft into the last columns of a row.
pub(crate) fn write_aircraft(view: View<'_>, decision: &Decision, to: &mut [f32]) {
    let first = to.len() - AIRCRAFT.len();
    column::write(&AIRCRAFT, &Battery::of(view, decision), &mut to[first..]);
}

impl Choice {
    fn of(view: View<'_>, decision: &Decision, to: VertiportIx) -> Self {
        let Decision { time, at: from, aircraft, .. } = *decision;
        let kind = view.kind(aircraft);
        let is_flight = view.within_range(kind, from).contains(to);
        if !is_flight && to != from {
            return Self { wait_h: 0.0, needed: 0.0, after: 0.0 };
        }
        let full_mwh = whole_mwh(view.aircraft_type(kind).battery_kwh) as f64;
        let needed_mwh = if is_flight {
            view.aircraft_type(kind).needed_mwh(view.leg(kind, from, to).energy_kwh)
        } else {
            0
        };
        let outcome = view.outcome(decision, to);
        let as_needed = view.charges_as_needed();
        Self {
            wait_h: if as_needed && is_flight { hours(outcome.takeoff.since(time)) } else { 0.0 },
            needed: needed_mwh as f64 / full_mwh,
            after: if as_needed { outcome.charge_mwh as f64 / full_mwh } else { 1.0 },
        }
    }
}

impl Battery {
    fn of(view: View<'_>, decision: &Decision) -> Self {
        let Decision { time, aircraft, .. } = *decision;
        if !view.charges_as_needed() {
            return Self { charge: 1.0, to_full_h: 0.0, as_needed: false };
        }
        let full_mwh = whole_mwh(view.aircraft_type(view.kind(aircraft)).battery_kwh) as f64;
        Self {
            charge: view.charge_mwh_at(decision) as f64 / full_mwh,
            to_full_h: view.to_full_s(aircraft, time) / 3_600.0,
            as_needed: true,
        }
    }
}
