//! Policies do not see the future: the view of a decision does not change when later events are
//! changed.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use proptest::prelude::{ProptestConfig, any, prop, prop_assert, prop_assert_eq, proptest};
use vertifleet_core::{AircraftIx, Closure, Outage, Route, Scenario, Time, VertiportIx};
use vertifleet_sim::Simulation;

use crate::shown::shown;
use vertifleet_testkit::energy_day;

#[test]
fn no_method_of_the_view_is_forgotten_here() {
    let (view, test) = (include_str!("../../src/view.rs"), include_str!("shown.rs"));
    for line in view.lines().filter_map(|line| line.trim().strip_prefix("pub fn ")) {
        let name = line.split(['(', '<']).next().expect("a name");
        assert!(test.contains(&format!("view.{name}(")), "{name} is not asked for");
    }
}

/// The slot of take-off delays that contains a time, and 0 on a day without delays.
fn slot(day: &Scenario, time: Time) -> usize {
    let delays = day.disturbances.takeoff_delays.as_ref();
    delays.map_or(0, |delays| time.since(day.operations.start) / delays.slot_s) as usize
}

/// The day with everything changed that cannot be known at `now`, when flights have left the
/// vertiports `left` in the current slot of take-off delays.
fn with_another_future(
    day: &Scenario,
    now: Time,
    left: &BTreeSet<VertiportIx>,
    change: u32,
) -> Arc<Scenario> {
    let current = slot(day, now);
    let mut day = day.clone().into_day();
    let forecast = day.disturbances.forecast.get_or_insert_with(|| day.demand.clone());
    assert_eq!(forecast.len(), day.periods.len());
    for (start, table) in day.periods.iter().zip(&mut day.demand) {
        if *start > now {
            for from in VertiportIx::all(table.size()) {
                for to in VertiportIx::all(table.size()).filter(|&to| to != from) {
                    table[(from, to)] = (table[(from, to)] + change) % 13;
                }
            }
        }
    }
    if let Some(delays) = &mut day.disturbances.takeoff_delays {
        for (slot, delays_s) in delays.delay_s.iter_mut().enumerate().skip(current) {
            for (at, delay_s) in delays_s.iter_mut().enumerate() {
                if slot > current || !left.contains(&VertiportIx::new(at)) {
                    *delay_s = (*delay_s + change) % 1300;
                }
            }
        }
    }
    let later = now + 1 + change % 600;
    let closures = &mut day.disturbances.closures;
    closures.retain(|closure| closure.known || closure.start <= now || change.is_multiple_of(2));
    for closure in closures.iter_mut().filter(|closure| !closure.known) {
        if (closure.start..closure.end).contains(&now) {
            closure.end = later;
        }
    }
    if day.vertiports.len() > 1 {
        let route = Route { from: VertiportIx(0), to: VertiportIx(1), both_ways: true };
        closures.push(Closure { route, start: later, end: later + 1200, known: false });
    }
    let outages = &mut day.disturbances.outages;
    outages.retain(|outage| outage.start <= now || change.is_multiple_of(3));
    for aircraft in AircraftIx::all(day.aircraft.len()) {
        outages.push(Outage { aircraft, start: later, end: later + 7200 });
    }
    Arc::new(day.check("another future").expect("a day within the rules"))
}

/// The views at the first `count` decisions of a day, at most, the time of the last of them, and
/// the vertiports that flights have left by then in its slot of take-off delays.
fn course(
    day: &Arc<Scenario>,
    draws: &[u32],
    count: usize,
) -> (Vec<Vec<String>>, Time, BTreeSet<VertiportIx>) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let (mut course, mut now, mut left) = (Vec::new(), day.operations.start, BTreeSet::new());
    while let Some(decision) = simulation.next_decision() {
        course.push(shown(simulation.view(), &decision));
        if slot(day, decision.time) > slot(day, now) {
            left.clear();
        }
        now = decision.time;
        if course.len() == count {
            break;
        }
        let mask = simulation.view().feasible(&decision);
        let rank = draws[course.len() % draws.len()] % mask.len();
        let row = simulation.apply(mask.nth(rank).expect("a rank within the mask"));
        let row = row.expect("feasible");
        if row.to != row.from {
            left.insert(row.from);
        }
    }
    (course, now, left)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn a_view_does_not_change_when_the_future_does(
        day in energy_day(), draws in prop::collection::vec(any::<u32>(), 1..20),
        count in 1_usize..40, change in 1_u32..100_000
    ) {
        let mut known = Scenario::clone(&day).into_day();
        known.disturbances.forecast.get_or_insert_with(|| day.demand.clone());
        let known = Arc::new(known.check("known").expect("a day within the rules"));
        let (shown, now, left) = course(&known, &draws, count);
        // Only as many decisions are compared, because whether there is another one depends on the
        // future.
        let other = with_another_future(&known, now, &left, change);
        let (again, ..) = course(&other, &draws, shown.len());
        prop_assert!(shown == again);
    }

    #[test]
    fn an_imagined_flight_is_as_late_as_the_latest_that_left_in_its_quarter_of_an_hour(
        day in energy_day(), draws in prop::collection::vec(any::<u32>(), 1..20)
    ) {
        let mut simulation = Simulation::new(Arc::clone(&day));
        let mut left = BTreeMap::new();
        let mut room = None;
        while let Some(decision) = simulation.next_decision() {
            let view = simulation.view();
            let mask = view.feasible(&decision);
            let rank = draws[decision.index as usize % draws.len()] % mask.len();
            let choice = mask.nth(rank).expect("a rank within the mask");
            let flight_s = view.leg(view.kind(decision.aircraft), decision.at, choice).flight_s;
            let imagined = view.imagined_in(&mut room).apply(choice).expect("feasible");
            let row = simulation.apply(choice).expect("feasible");
            if row.to != row.from {
                let on_time = row.takeoff + flight_s;
                let quarter = row.time.seconds() / 900;
                let known = left.insert(row.from, (quarter, row.arrival.since(on_time)));
                let expected_s = match known {
                    Some((same, late_s)) if same == quarter && late_s <= 3_600 => late_s,
                    _ => 0,
                };
                prop_assert_eq!(imagined.arrival, on_time + expected_s);
            }
        }
    }

    #[test]
    fn a_day_goes_as_it_is_imagined_if_all_that_happens_is_known(
        day in energy_day(), draws in prop::collection::vec(any::<u32>(), 1..20)
    ) {
        let mut day = Scenario::clone(&day).into_day();
        let mut closures = std::mem::take(&mut day.disturbances).closures;
        for closure in &mut closures {
            closure.known = true;
        }
        day.disturbances.closures = closures;
        let day = Arc::new(day.check("no surprises").expect("a day within the rules"));
        let mut simulation = Simulation::new(Arc::clone(&day));
        // Changes that come before the first decision are seen at it.
        simulation.next_decision();
        let mut imagined = simulation.view().imagined();
        while let Some(decision) = simulation.next_decision() {
            prop_assert_eq!(imagined.next_decision(), Some(decision));
            let mask = simulation.view().feasible(&decision);
            let rank = draws[decision.index as usize % draws.len()] % mask.len();
            let choice = mask.nth(rank).expect("a rank within the mask");
            prop_assert_eq!(imagined.apply(choice), simulation.apply(choice));
        }
        prop_assert_eq!(imagined.next_decision(), None);
    }
}
