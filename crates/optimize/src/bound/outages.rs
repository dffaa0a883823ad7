//! Which aircraft have an outage that may happen to them. The bound lets these wait for any time,
//! which loosens it, so outages that cannot happen are left out (docs/src/concepts/bound.md, "Days
//! beyond the paper").

use vertifleet_core::{Scenario, Time, TypeIx, VertiportIx};
use vertifleet_sim::Legs;

/// Whether each aircraft has an outage that may keep it on the ground. Its first decision is when
/// it is `ready`. An outage has no effect if no landing falls into it, if the time on the ground
/// after any landing lasts as long, or if operations are over by then.
pub(super) fn may_happen(scenario: &Scenario, ready: impl Fn(usize) -> Time) -> Vec<bool> {
    let mut has_outage = vec![false; scenario.aircraft.len()];
    if scenario.disturbances.outages.is_empty() {
        return has_outage;
    }
    let shortest = shortest_stays(scenario);
    for outage in &scenario.disturbances.outages {
        let position = outage.aircraft.at();
        let kind = scenario.aircraft[position].kind;
        let Some((flight_s, ground_s)) = shortest[kind.at()] else { continue };
        let again = outage.start.max(ready(position) + flight_s) + ground_s;
        has_outage[position] |= again < outage.end && again <= scenario.operations.end;
    }
    has_outage
}

/// By type: the shortest flight within range, and the shortest time on the ground after one; `None`
/// if it has no flight.
fn shortest_stays(scenario: &Scenario) -> Vec<Option<(u32, u32)>> {
    let legs = Legs::of(scenario);
    let size = scenario.vertiports.len();
    let of_kind = |kind| {
        let pairs = VertiportIx::all(size)
            .flat_map(|from| legs.within_range(kind, from).iter().map(move |to| (from, to)));
        let stays = pairs.map(|(from, to)| legs.leg(kind, from, to));
        let stays = stays.map(|leg| (leg.flight_s, leg.ground_s));
        stays.reduce(|one, other| (one.0.min(other.0), one.1.min(other.1)))
    };
    TypeIx::all(scenario.aircraft_types.len()).map(of_kind).collect()
}
