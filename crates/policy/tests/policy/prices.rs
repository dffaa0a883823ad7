//! Properties of prices, and of the rule that decides by them.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, Closure, Route, Scenario, TypeIx, VertiportIx};
use vertifleet_policy::{BidPricePolicy, DayPrices, Greedy, Policy, play};
use vertifleet_sim::{Simulation, Trace, check::check};
use vertifleet_testkit::paper_day;

/// The day with another number of aircraft and of stands.
fn changed(seed: u64, aircraft: usize, stands: u16) -> Arc<Scenario> {
    let mut day = Scenario::clone(&paper_day(seed)).into_day();
    day.aircraft.truncate(aircraft);
    day.vertiports.iter_mut().for_each(|vertiport| vertiport.stands = stands);
    Arc::new(day.check("a changed day").expect("a day"))
}

fn played(day: &Arc<Scenario>, policy: &mut dyn Policy) -> (Trace, f64) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut trace = Trace::default();
    play(&mut simulation, policy, |row| trace.rows.push(*row)).expect("the policy plays the day");
    (trace, simulation.ledger().profit_usd())
}

fn prices_of(day: &Arc<Scenario>) -> DayPrices {
    DayPrices::of(Simulation::new(Arc::clone(day)).view(), day.operations.start)
}

/// The price of all stands of a day together.
fn all_rents_usd(day: &Scenario, prices: &DayPrices) -> f64 {
    let (start, end) = (day.operations.start, day.operations.end);
    let vertiports = VertiportIx::all(day.vertiports.len());
    vertiports.map(|vertiport| prices.rent_usd(vertiport, start, end)).sum()
}

/// A day of one aircraft that holds for 300 s, with every route from its vertiport closed for the
/// first `closed_s` seconds.
fn shut_in(seed: u64, closed_s: u32) -> Arc<Scenario> {
    let mut day = Scenario::clone(&changed(seed, 1, 1)).into_day();
    let (start, from) = (day.operations.start, day.aircraft[0].at);
    day.operations.hold_s = 300;
    let others = VertiportIx::all(day.vertiports.len()).filter(|&to| to != from);
    let routes = others.map(|to| Route { from, to, both_ways: false });
    day.disturbances.closures =
        routes.map(|route| Closure { route, start, end: start + closed_s, known: false }).collect();
    Arc::new(day.check("a day with closed routes").expect("a day"))
}

#[test]
fn no_policy_counts_on_a_route_that_is_closed() {
    let day = shut_in(1, 600);
    let mut simulation = Simulation::new(Arc::clone(&day));
    let decision = simulation.next_decision().expect("the day is young");
    let prices = DayPrices::of(simulation.view(), decision.time);
    let worth = |place, after_s| prices.worth_usd(TypeIx(0), place, decision.time + after_s);
    // All flights away are assumed impossible in the first two hours, so exactly these hours are
    // lost.
    assert_eq!(worth(decision.at, 0), worth(decision.at, 7_200 - 300));
    assert!(worth(decision.at, 0) > 500.0, "routes open again some time");
    let elsewhere = VertiportIx((decision.at.0 + 1) % 8);
    assert!(worth(elsewhere, 0) > worth(decision.at, 0) + 50.0);
}

#[test]
fn prices_are_recomputed_immediately_when_routes_open() {
    let mut simulation = Simulation::new(shut_in(1, 600));
    let decision = simulation.next_decision().expect("the day is young");
    let mut prices = DayPrices::of(simulation.view(), decision.time);
    let mut worths = Vec::new();
    for wait_s in [0, 300, 600] {
        let decision = simulation.next_decision().expect("the day is young");
        assert_eq!(decision.time.since(simulation.view().day_start()), wait_s);
        prices.refresh(simulation.view(), decision.time);
        worths.push(prices.worth_usd(TypeIx(0), decision.at, decision.time));
        simulation.apply(decision.at).expect("holding is always allowed");
    }
    assert_eq!(worths[0], worths[1], "nothing has changed by then");
    assert!(worths[2] > worths[1] + 50.0, "flights may leave again");
}

#[test]
fn what_is_not_scarce_is_free() {
    let roomy = changed(1, 8, 40);
    let prices = prices_of(&roomy);
    assert_eq!(all_rents_usd(&roomy, &prices), 0.0, "40 stands suffice for 8 aircraft");
    let crowded = paper_day(1);
    let prices = prices_of(&crowded);
    assert!(all_rents_usd(&crowded, &prices) > 100.0, "48 stands are few for 40 aircraft");
}

#[test]
fn prices_are_never_negative_and_worth_falls_to_nothing_at_the_end() {
    let day = paper_day(2);
    let prices = prices_of(&day);
    let (start, end) = (day.operations.start, day.operations.end);
    for vertiport in VertiportIx::all(day.vertiports.len()) {
        for minute in 0..720 {
            let from = start + 60 * minute;
            assert!(prices.rent_usd(vertiport, from, from + 60) >= 0.0);
        }
        let worth = |time| prices.worth_usd(TypeIx(0), vertiport, time);
        assert!(worth(start) > 500.0, "an aircraft earns a few hundred dollars a day");
        assert!(worth(end) > 0.0, "a last flight is allowed");
        assert_eq!(worth(end + 1), 0.0);
        for to in VertiportIx::all(day.vertiports.len()) {
            for period in 0..day.periods.len() {
                assert!(prices.passenger_usd(period, vertiport, to) >= 0.0);
            }
        }
    }
}

#[test]
fn an_aircraft_alone_and_with_room_earns_what_its_prices_predict() {
    for seed in 0..5 {
        let alone = changed(seed, 1, 1);
        let start = alone.operations.start;
        let predicted_usd =
            prices_of(&alone).worth_usd(TypeIx(0), alone.aircraft[AircraftIx(0).at()].at, start);
        let (_, profit_usd) = played(&alone, &mut BidPricePolicy::default());
        // Worth is linear within a slot of three minutes, and waiting is worth nothing here.
        let off = (profit_usd - predicted_usd).abs() / predicted_usd;
        assert!(off < 0.01, "day {seed}: {profit_usd} earned, {predicted_usd} predicted");
    }
}

#[test]
fn the_rule_keeps_every_rule_of_the_world_and_earns_more_than_greedy() {
    for seed in 3..6 {
        let day = paper_day(seed);
        let (trace, profit_usd) = played(&day, &mut BidPricePolicy::default());
        let report = check(&day, &trace);
        assert!(report.is_valid(), "{report}");
        let (_, greedy_usd) = played(&day, &mut Greedy);
        assert!(profit_usd > 1.02 * greedy_usd, "day {seed}: {profit_usd}, greedy {greedy_usd}");
    }
}

#[test]
fn a_day_has_one_outcome_after_any_other_day() {
    let (one, other) = (paper_day(7), paper_day(8));
    let mut policy = BidPricePolicy::default();
    let first = played(&one, &mut policy);
    played(&other, &mut policy);
    assert_eq!(played(&one, &mut policy), first);
    assert_eq!(played(&one, &mut policy), first, "the same day starts over");
}

#[test]
fn days_played_by_turns_are_not_mixed_up() {
    // Both days have the same seed, so that only the days themselves differ.
    let days = [changed(9, 40, 6), changed(9, 40, 7)];
    let mut simulations = days.clone().map(Simulation::new);
    let mut policy = BidPricePolicy::default();
    for _ in 0..30 {
        for simulation in &mut simulations {
            let decision = simulation.next_decision().expect("the day is young");
            let turn = policy.choose(&decision, &simulation.view());
            // The policy's memory of the other day must not matter.
            let fresh = BidPricePolicy::default().choose(&decision, &simulation.view());
            assert_eq!(turn, fresh);
            simulation.apply(turn.expect("an answer")).expect("a choice from the mask");
        }
    }
}

/// The day with a fiftieth of the passengers of each pair and period, rounded down.
fn thin(seed: u64) -> Arc<Scenario> {
    let mut day = Scenario::clone(&paper_day(seed)).into_day();
    for demand in day.demand.iter_mut().flat_map(vertifleet_core::Matrix::cells_mut) {
        *demand /= 50;
    }
    Arc::new(day.check("a thin day").expect("a day"))
}

#[test]
fn where_few_passengers_want_to_fly_prices_earn_as_much_as_greedy() {
    let (mut prices_usd, mut greedy_usd) = (0.0, 0.0);
    for seed in 0..6 {
        let day = thin(seed);
        prices_usd += played(&day, &mut BidPricePolicy::default()).1;
        greedy_usd += played(&day, &mut Greedy).1;
    }
    assert!(greedy_usd > 0.0, "the days have passengers");
    assert!(prices_usd >= greedy_usd, "{prices_usd} is less than {greedy_usd}");
}

#[test]
fn nothing_is_at_stake_without_demand() {
    let mut idle = Scenario::clone(&paper_day(1)).into_day();
    idle.demand.iter_mut().for_each(|table| table.cells_mut().fill(0));
    let idle = Arc::new(idle.check("a day without demand").expect("a day"));
    assert_eq!(prices_of(&idle).stake_usd(), 0.0);
    let (trace, _) = played(&idle, &mut BidPricePolicy::default());
    assert!(trace.rows.iter().all(|row| row.to == row.from), "every aircraft holds");
    assert!(
        prices_of(&paper_day(1)).stake_usd() > 50.0,
        "a decision of a busy day is worth a flight"
    );
}
