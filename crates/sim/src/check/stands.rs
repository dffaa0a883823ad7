//! Stands (Eq. 16): U_i, the number of aircraft standing at i or in the air towards it, is between
//! 0 and U_max at every instant. The same holds for chargers, where a vertiport also has stands
//! without chargers.
//!
//! U_i only changes at a take-off, from the vertiport that an aircraft leaves to the one that it
//! flies to, so checking each take-off checks every instant. At one instant the aircraft listed
//! first moves first, and the stand that it leaves is free for the next. With chargers, a hold
//! moves an aircraft from its charger to a stand, if one is free.

use vertifleet_core::Scenario;

use super::Rule;
use super::event::Event;
use super::report::Findings;

/// The kind of place that an aircraft occupies while it waits.
#[derive(Clone, Copy, PartialEq)]
enum Pool {
    /// On a stand, as all aircraft are at vertiports without chargers.
    Stand,
    /// On a charger, or in the air towards one.
    Charger,
}

/// Counts the aircraft of every vertiport through the day.
pub(super) fn check(scenario: &Scenario, events: &[Event<'_>], findings: &mut Findings) {
    let mut on_stands = vec![0_i64; scenario.vertiports.len()];
    let mut on_chargers = on_stands.clone();
    let mut pools = vec![Pool::Stand; scenario.aircraft.len()];
    for aircraft in &scenario.aircraft {
        on_stands[aircraft.at.at()] += 1;
    }
    for event in events {
        let (from, to) = (event.row.from.at(), event.row.to.at());
        let pool = &mut pools[event.row.aircraft.at()];
        if event.is_hold() {
            if *pool == Pool::Charger && on_stands[from] < i64::from(event.from.stands) {
                *pool = Pool::Stand;
                on_chargers[from] -= 1;
                on_stands[from] += 1;
            }
            continue;
        }
        let (left, rule) = match pool {
            Pool::Stand => (&mut on_stands[from], Rule::StandBound),
            Pool::Charger => (&mut on_chargers[from], Rule::ChargerBound),
        };
        *left -= 1;
        if *left < 0 {
            let left = *left;
            findings
                .add_event(rule, event, || format!("leaves {left} aircraft at {}", event.from.id));
        }
        let (there, limit, places, rule) = match event.to.chargers {
            None => (&mut on_stands[to], event.to.stands, "stands", Rule::StandBound),
            Some(chargers) => (&mut on_chargers[to], chargers, "chargers", Rule::ChargerBound),
        };
        *pool = if event.to.chargers.is_none() { Pool::Stand } else { Pool::Charger };
        *there += 1;
        if *there > i64::from(limit) {
            let there = *there;
            findings.add_event(rule, event, || {
                format!(
                    "makes {there} aircraft at {} or on their way there, but its {places} are {limit}",
                    event.to.id
                )
            });
        }
    }
}
