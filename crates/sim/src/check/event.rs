//! The schedule's rows in the order in which they happen, with the aircraft and vertiports that
//! they name.

use vertifleet_core::{Aircraft, AircraftType, Scenario, Time, Vertiport, VertiportIx};

use super::Rule;
use super::report::Findings;
use crate::{Trace, TraceRow};

/// A row whose aircraft and vertiports exist.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event<'a> {
    /// The row's number in the trace, from 1 below the header.
    pub(super) number: usize,
    pub(super) row: &'a TraceRow,
    pub(super) aircraft: &'a Aircraft,
    pub(super) kind: &'a AircraftType,
    pub(super) from: &'a Vertiport,
    pub(super) to: &'a Vertiport,
}

impl Event<'_> {
    pub(super) fn is_hold(&self) -> bool {
        self.row.from == self.row.to
    }

    /// The origin and destination, as tables are indexed.
    pub(super) fn pair(&self) -> (VertiportIx, VertiportIx) {
        (self.row.from, self.row.to)
    }
}

/// The rows whose aircraft and vertiports the scenario has, by time and aircraft. A trace in
/// another order is judged in this one, so that only its order is found wrong.
pub(super) fn in_order<'a>(
    scenario: &'a Scenario,
    trace: &'a Trace,
    findings: &mut Findings,
) -> Vec<Event<'a>> {
    let mut events = Vec::with_capacity(trace.rows.len());
    for (row, number) in trace.rows.iter().zip(1..) {
        match event(scenario, row, number) {
            Some(event) => events.push(event),
            None => findings.add_unknown(scenario, row, number),
        }
    }
    events.sort_by_key(|event| (event.row.time, event.row.aircraft));
    events
}

fn event<'a>(scenario: &'a Scenario, row: &'a TraceRow, number: usize) -> Option<Event<'a>> {
    let aircraft = scenario.aircraft.get(row.aircraft.at())?;
    Some(Event {
        number,
        row,
        aircraft,
        kind: &scenario.aircraft_types[aircraft.kind.at()],
        from: scenario.vertiports.get(row.from.at())?,
        to: scenario.vertiports.get(row.to.at())?,
    })
}

impl Findings {
    fn add_unknown(&mut self, scenario: &Scenario, row: &TraceRow, number: usize) {
        let aircraft = scenario.aircraft.get(row.aircraft.at()).map(|aircraft| &*aircraft.id);
        self.add(Rule::KnownIds, Some(number), row.time, aircraft, || {
            format!(
                "aircraft {} from vertiport {} to {}, but the scenario has {} aircraft and {} vertiports",
                row.aircraft.0,
                row.from.0,
                row.to.0,
                scenario.aircraft.len(),
                scenario.vertiports.len()
            )
        });
    }
}

/// A number of seconds since midnight as a time, for messages.
pub(super) fn clock(seconds: u64) -> Time {
    Time::from_seconds(u32::try_from(seconds).unwrap_or(u32::MAX))
}

/// The demand period that contains an instant: the last one that has started.
pub(super) fn period_of(scenario: &Scenario, seconds: u64) -> usize {
    let started = scenario.periods.partition_point(|start| u64::from(start.seconds()) <= seconds);
    started.saturating_sub(1)
}
