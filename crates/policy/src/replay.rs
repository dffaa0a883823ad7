//! `replay`: repeats the decisions of a trace.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, VertiportIx};
use vertifleet_sim::{Decision, Trace, View};

use crate::{Policy, PolicyError};

/// Answers each decision with the trace's row for it.
#[derive(Debug, Clone)]
pub struct Replay {
    trace: Arc<Trace>,
}

impl Replay {
    /// Replays `trace`, which must be of the day that is played.
    pub fn new(trace: Arc<Trace>) -> Self {
        Self { trace }
    }
}

impl Policy for Replay {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let at = decision.index as usize;
        let rows = &self.trace.rows;
        let row = rows
            .get(at)
            .ok_or(PolicyError::TraceTooShort { rows: rows.len(), time: decision.time })?;
        if (row.aircraft, row.time) != (decision.aircraft, decision.time) {
            return Err(PolicyError::TraceOfAnotherDay {
                row: at + 1,
                found: (aircraft_id(row.aircraft, *view), row.time),
                asked: (aircraft_id(decision.aircraft, *view), decision.time),
            });
        }
        Ok(row.to)
    }
}

/// The aircraft's id, or its position if another day's trace has more aircraft than this day.
fn aircraft_id(aircraft: AircraftIx, view: View<'_>) -> String {
    view.aircraft_id(aircraft).map_or_else(|| format!("#{}", aircraft.0), str::to_owned)
}
