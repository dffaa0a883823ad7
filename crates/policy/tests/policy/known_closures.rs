//! Policies take closures that are known in advance into account.

use std::sync::Arc;

use vertifleet_core::{
    AircraftIx, ClosedTimes, Closure, Day, DaySeed, Network, Route, Scenario, Time, TypeIx,
    VertiportIx,
};
use vertifleet_policy::{BidPricePolicy, DayPrices, play};
use vertifleet_sim::{Simulation, Trace, check::check};

/// A day of `paper` with a given number of aircraft and ample stands.
fn day(seed: u64, aircraft: usize) -> Day {
    let network = Network::shipped("paper").expect("a shipped network");
    let mut day = network.draw(DaySeed::validation(seed).expect("a seed")).into_day();
    day.aircraft.truncate(aircraft);
    day
}

/// Closes every route from and to a vertiport.
fn close(day: &mut Day, closed: VertiportIx, start: Time, end: Time, known: bool) {
    for to in VertiportIx::all(day.vertiports.len()).filter(|&to| to != closed) {
        let route = Route { from: closed, to, both_ways: true };
        day.disturbances.closures.push(Closure { route, start, end, known });
    }
}

fn checked(day: Day) -> Arc<Scenario> {
    Arc::new(day.check("a day with closures").expect("a day"))
}

/// The profit of `prices`, and the vertiports where its aircraft end the day.
fn played(day: &Arc<Scenario>) -> (f64, Vec<VertiportIx>) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut trace = Trace::default();
    play(&mut simulation, &mut BidPricePolicy::default(), |row| trace.rows.push(*row))
        .expect("the policy plays the day");
    let report = check(day, &trace);
    assert!(report.is_valid(), "{report}");
    (simulation.ledger().profit_usd(), simulation.view().places().to_vec())
}

#[test]
fn alone_and_with_room_an_aircraft_earns_what_its_prices_say_of_a_day_with_known_closures() {
    for seed in 0..6 {
        let mut day = day(seed, 1);
        let start = day.operations.start;
        // Odd times, so that closures begin and end within slots.
        close(&mut day, VertiportIx(0), start + 5_000, start + 12_345, true);
        close(&mut day, VertiportIx(4), start + 20_000, start + 31_111, true);
        for at in [1, 2, 3] {
            close(&mut day, VertiportIx(at), start + 36_001, start + 50_000, true);
        }
        let day = checked(day);
        let mut simulation = Simulation::new(Arc::clone(&day));
        simulation.next_decision().expect("the day is young");
        let prices = DayPrices::of(simulation.view(), start);
        let predicted_usd = prices.worth_usd(TypeIx(0), day.aircraft[AircraftIx(0).at()].at, start);
        let (profit_usd, _) = played(&day);
        // Worth is linear within a slot of three minutes, even if a closure begins or ends in it.
        let off = (profit_usd - predicted_usd).abs() / predicted_usd;
        assert!(off < 0.03, "day {seed}: {profit_usd} earned, {predicted_usd} predicted");
    }
}

#[test]
fn to_know_a_curfew_earns_more_than_to_be_surprised_by_it_and_strands_no_aircraft() {
    const DAYS: u64 = 8;
    let curfew = Time::from_seconds(14 * 3600);
    let (mut gains_usd, mut stranded) = (Vec::new(), [0, 0]);
    for seed in 0..DAYS {
        let outcomes = [false, true].map(|known| {
            let mut day = day(seed, 12);
            let end = day.operations.end + 3600;
            for at in [0, 1] {
                close(&mut day, VertiportIx(at), curfew, end, known);
            }
            played(&checked(day))
        });
        for (stranded, (_, places)) in stranded.iter_mut().zip(&outcomes) {
            *stranded += places.iter().filter(|place| place.0 < 2).count();
        }
        gains_usd.push(outcomes[1].0 - outcomes[0].0);
    }
    let mean_usd = gains_usd.iter().sum::<f64>() / DAYS as f64;
    assert!(mean_usd > 100.0, "{gains_usd:?}");
    assert!(gains_usd.iter().all(|&usd| usd > 0.0), "{gains_usd:?}");
    assert!(stranded[1] == 0 && stranded[0] >= 8, "{stranded:?} of {} aircraft", 12 * DAYS);
}

#[test]
fn nothing_is_worth_less_before_an_unknown_closure_begins() {
    let worths = |known: Option<bool>| {
        let mut day = day(1, 12);
        let start = day.operations.start;
        if let Some(known) = known {
            close(&mut day, VertiportIx(0), start + 3_600, start + 14_400, known);
        }
        let day = checked(day);
        let mut simulation = Simulation::new(Arc::clone(&day));
        simulation.next_decision().expect("the day is young");
        let prices = DayPrices::of(simulation.view(), start);
        let at = |minute: u32| prices.worth_usd(TypeIx(0), VertiportIx(0), start + 60 * minute);
        (0..720).map(at).collect::<Vec<f64>>()
    };
    let (open, surprise, announced) = (worths(None), worths(Some(false)), worths(Some(true)));
    assert_eq!(open, surprise);
    assert!(announced[60] < open[60] - 50.0, "{} and {}", announced[60], open[60]);
}

#[test]
fn no_flight_counts_on_a_route_in_the_slots_in_which_it_is_known_to_be_closed() {
    // An aircraft that can only hold until the curfew is over loses nothing by waiting until then.
    let mut day = day(3, 1);
    let (start, at) = (day.operations.start, day.aircraft[0].at);
    let opens = start + 3_600 + 47 * 60;
    close(&mut day, at, start, opens, true);
    let day = checked(day);
    let known = ClosedTimes::of(&day.disturbances.closures, day.vertiports.len());
    assert!(VertiportIx::all(8).all(|to| to == at || known.is_closed(at, to, start)));
    let mut simulation = Simulation::new(Arc::clone(&day));
    simulation.next_decision().expect("the day is young");
    let prices = DayPrices::of(simulation.view(), start);
    let worth = |minute: u32| prices.worth_usd(TypeIx(0), at, start + 60 * minute);
    // Holds last 15 minutes, so an aircraft that is ready at 0 or at 90 minutes decides again at
    // 1:45 and at 2:00.
    assert_eq!(worth(0), worth(90));
    assert_eq!(worth(90), worth(105));
    assert!(worth(105) <= worth(108), "an aircraft that is ready when routes open flies at once");
    assert!(worth(0) > 500.0, "most of the day is left");
}
