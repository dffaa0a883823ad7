//! Closures that are known in advance are seen before they begin, and carried out on imagined days.

use std::sync::Arc;

use vertifleet_core::{Closure, DaySeed, Network, Route, Time, VertiportIx};
use vertifleet_sim::{Refusal, Simulation, View};

/// A day of one aircraft, which has eight decisions if it only holds, with closures of one route.
/// Each closure is given by the seconds from the start of the day until it begins, its duration in
/// seconds, and whether it is known.
fn day_with(closures: &[(u32, u32, bool)]) -> Simulation {
    let network = Network::shipped("paper").expect("a shipped network");
    let mut day = network.draw(DaySeed::validation(1).expect("a seed")).into_day();
    day.aircraft.truncate(1);
    day.aircraft[0].at = VertiportIx(0);
    let start = day.operations.start;
    day.operations.end = start + 7 * 900;
    let route = Route { from: VertiportIx(0), to: VertiportIx(1), both_ways: false };
    let closure = |&(after_s, lasts_s, known)| {
        let start = start + after_s;
        Closure { route, start, end: start + lasts_s, known }
    };
    day.disturbances.closures = closures.iter().map(closure).collect();
    Simulation::new(Arc::new(day.check("a day with closures").expect("a day within the rules")))
}

/// For each decision, whether the route is closed.
fn closed_so_far(mut next: impl FnMut() -> Option<bool>) -> String {
    let mut seen = String::new();
    while let Some(closed) = next() {
        seen.push(if closed { 'x' } else { '.' });
    }
    seen
}

#[test]
fn imagined_days_carry_out_known_closures_and_leave_unknown_ones_as_they_are() {
    let closed = |view: View<'_>| view.closed(VertiportIx(0)).contains(VertiportIx(1));
    for (closures, happens, imagined) in [
        (vec![(1800, 1800, true)], "..xx....", "..xx...."),
        (vec![(1800, 1800, false)], "..xx....", "........"),
        (vec![(0, 1800, true)], "xx......", "xx......"),
        (vec![(0, 1800, false)], "xx......", "xxxxxxxx"),
        // An unknown closure that is in force lasts on imagined days, even next to a known one that
        // ends.
        (vec![(0, 1800, false), (0, 3600, true)], "xxxx....", "xxxxxxxx"),
        (vec![(0, 900, true), (900, 900, true), (1000, 900, false)], "xxx.....", "xx......"),
    ] {
        let mut day = day_with(&closures);
        day.next_decision().expect("the day is young");
        let mut course = day.view().imagined();
        let seen = closed_so_far(|| {
            let decision = day.next_decision()?;
            let closed = closed(day.view());
            day.apply(decision.at).expect("holding is always allowed");
            Some(closed)
        });
        assert_eq!(seen, happens, "{closures:?}");
        let seen = closed_so_far(|| {
            let decision = course.next_decision()?;
            let closed = closed(course.view());
            course.apply(decision.at).expect("holding is always allowed");
            Some(closed)
        });
        assert_eq!(seen, imagined, "{closures:?}");
    }
}

#[test]
fn a_known_closure_forbids_what_an_unknown_one_does() {
    for known in [false, true] {
        let mut day = day_with(&[(900, 900, known)]);
        let aircraft = day.scenario().aircraft[0].id.clone();
        for closed in [false, true, false] {
            let decision = day.next_decision().expect("the day is young");
            let open = day.view().feasible(&decision).contains(VertiportIx(1));
            assert_eq!(open, !closed);
            if closed {
                let to = day.scenario().vertiports[1].id.clone();
                let refusal = Refusal::Closed { aircraft: aircraft.clone(), to };
                assert_eq!(day.apply(VertiportIx(1)), Err(refusal));
            }
            day.apply(decision.at).expect("holding is always allowed");
        }
    }
}

#[test]
fn only_known_closures_are_announced() {
    let mut day = day_with(&[(900, 900, true), (1800, 900, false)]);
    let start = day.scenario().operations.start;
    day.next_decision().expect("the day is young");
    let (view, pair) = (day.view(), (VertiportIx(0), VertiportIx(1)));
    let spans = view.known_closures().spans(pair.0, pair.1);
    assert_eq!(
        spans.iter().map(|span| (span.start, span.end)).collect::<Vec<_>>(),
        [(start + 900, start + 1800)]
    );
    let at = |after_s: u32| -> Time { start + after_s };
    assert!(view.known_closures().is_closed(pair.0, pair.1, at(900)));
    assert!(!view.known_closures().is_closed(pair.0, pair.1, at(1800)));
    assert!(!view.known_closures().is_closed(pair.1, pair.0, at(900)));
}

#[test]
fn what_was_announced_is_no_change_when_it_comes() {
    let mut day = day_with(&[(900, 900, true), (2700, 900, false)]);
    let mut changes = Vec::new();
    while let Some(decision) = day.next_decision() {
        changes.push(day.view().route_changes());
        day.apply(decision.at).expect("holding is always allowed");
    }
    assert_eq!(changes, [0, 0, 0, 1, 2, 2, 2, 2]);
}
