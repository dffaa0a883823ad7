//! The pairs that may be flown: corridors and closures (docs/src/concepts/model.md, beyond the
//! paper).

use vertifleet_core::Scenario;

use super::Rule;
use super::event::Event;
use super::report::Findings;

/// Judges whether one flight may be flown between its vertiports at its time.
pub(super) fn check(scenario: &Scenario, event: &Event<'_>, findings: &mut Findings) {
    let (from, to) = event.pair();
    let leads =
        |(a, b), both_ways: bool| (a, b) == (from, to) || (both_ways && (b, a) == (from, to));
    let ends = (&event.from.id, &event.to.id);
    if let Some(corridors) = &scenario.corridors
        && !corridors.iter().any(|route| leads((route.from, route.to), route.both_ways))
    {
        findings.add_event(Rule::Corridor, event, || {
            format!("no corridor leads from {} to {}", ends.0, ends.1)
        });
    }
    let time = event.row.time;
    let closure = scenario.disturbances.closures.iter().find(|closure| {
        closure.start <= time
            && time < closure.end
            && leads((closure.route.from, closure.route.to), closure.route.both_ways)
    });
    if let Some(closure) = closure {
        findings.add_event(Rule::Closure, event, || {
            let (start, end) = (closure.start, closure.end);
            format!("from {} to {} is closed from {start} to {end}", ends.0, ends.1)
        });
    }
}
