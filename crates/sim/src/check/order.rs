//! Order: events are totally ordered by time, then by aircraft (docs/src/design/world.md).

use vertifleet_core::Scenario;

use super::Rule;
use super::report::Findings;
use crate::Trace;

/// Checks that each row comes after the one before it, and that no aircraft decides twice at one
/// instant.
pub(super) fn check(scenario: &Scenario, trace: &Trace, findings: &mut Findings) {
    for (pair, number) in trace.rows.windows(2).zip(2..) {
        let (before, row) = (&pair[0], &pair[1]);
        if (before.time, before.aircraft) < (row.time, row.aircraft) {
            continue;
        }
        let aircraft = scenario.aircraft.get(row.aircraft.at()).map(|aircraft| &*aircraft.id);
        findings.add(Rule::Order, Some(number), row.time, aircraft, || {
            if (before.time, before.aircraft) == (row.time, row.aircraft) {
                "the aircraft decides twice at this instant".to_owned()
            } else {
                format!("belongs before the row above it, which is at {}", before.time)
            }
        });
    }
}
