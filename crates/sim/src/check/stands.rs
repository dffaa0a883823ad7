//! Stands (Eq. 16): U_i, the aircraft standing at i or in the air towards it, is 0 to U_max at every instant.
//!
//! U_i only changes at take-off, from where an aircraft was to where it flies, so looking at each take-off is looking
//! at every instant. At one instant the aircraft listed first moves first, and the stand it leaves is free for the next.

use vertifleet_core::Scenario;

use super::Rule;
use super::event::Event;
use super::report::Findings;

/// Counts the aircraft of every vertiport through the day.
pub(super) fn check(scenario: &Scenario, events: &[Event<'_>], findings: &mut Findings) {
    let mut aircraft_at = vec![0_i64; scenario.vertiports.len()];
    for aircraft in &scenario.aircraft {
        aircraft_at[aircraft.at.at()] += 1;
    }
    for event in events.iter().filter(|event| !event.is_hold()) {
        let left = &mut aircraft_at[event.row.from.at()];
        *left -= 1;
        if *left < 0 {
            let left = *left;
            findings.add_event(Rule::StandBound, event, || {
                format!("leaves {left} aircraft at {}", event.from.id)
            });
        }
        let there = &mut aircraft_at[event.row.to.at()];
        *there += 1;
        if *there > i64::from(event.to.stands) {
            let there = *there;
            findings.add_event(Rule::StandBound, event, || {
                format!(
                    "makes {there} aircraft at {} or on their way there, but its stands are {}",
                    event.to.id, event.to.stands
                )
            });
        }
    }
}
