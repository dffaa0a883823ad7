//! Properties of the rolling horizon as a policy, on small days of every kind.

use std::sync::Arc;

use rayon::prelude::*;
use vertifleet_core::{DaySeed, Matrix, Network, Scenario};
use vertifleet_optimize::Rolling;
use vertifleet_policy::{BidPricePolicy, Greedy, Policy, play};
use vertifleet_sim::{Simulation, Trace, check::check};
use vertifleet_testkit::{Size, any_day, any_extended_day};

const SMALL: Size = Size { vertiports: 5, fleet: 8, hours: 5 };

/// A day played from its first decision to its last.
fn played(day: &Arc<Scenario>, policy: &mut dyn Policy) -> (Trace, f64) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let trace = finished(&mut simulation, policy);
    (trace, simulation.ledger().profit_usd())
}

/// Plays the rest of a day.
fn finished(simulation: &mut Simulation, policy: &mut dyn Policy) -> Trace {
    let mut trace = Trace::default();
    play(simulation, policy, |row| trace.rows.push(*row)).expect("every choice is feasible");
    trace
}

#[test]
fn days_keep_every_rule_and_earn_more_than_greedys() {
    let (mut rolling_usd, mut greedy_usd) = (0.0, 0.0);
    let mut rolling = Rolling::default();
    for number in 300..310 {
        let day = any_day(number, SMALL);
        let (trace, profit_usd) = played(&day, &mut rolling);
        let report = check(&day, &trace);
        assert!(report.is_valid(), "day {number}: {report}");
        rolling_usd += profit_usd;
        greedy_usd += played(&day, &mut Greedy).1;
    }
    assert!(rolling_usd > greedy_usd, "{rolling_usd} is not more than {greedy_usd}");
}

#[test]
fn disturbed_days_keep_every_rule() {
    let mut rolling = Rolling::default();
    for number in 400..412 {
        let day = any_extended_day(number, SMALL);
        let (trace, _) = played(&day, &mut rolling);
        let report = check(&day, &trace);
        assert!(report.is_valid(), "day {number}: {report}");
    }
}

#[test]
fn a_day_has_one_outcome_whatever_was_played_before_and_on_how_many_threads() {
    let days: Vec<_> = (320..326).map(|number| any_day(number, SMALL)).collect();
    let in_order = |days: &mut dyn Iterator<Item = &Arc<Scenario>>| {
        let mut policy = Rolling::default();
        days.map(|day| played(day, &mut policy)).collect::<Vec<_>>()
    };
    let forwards = in_order(&mut days.iter());
    let mut backwards = in_order(&mut days.iter().rev());
    backwards.reverse();
    assert_eq!(forwards, backwards);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
    let on_two: Vec<_> = pool.install(|| {
        days.par_iter().map_init(Rolling::default, |policy, day| played(day, policy)).collect()
    });
    assert_eq!(forwards, on_two);
}

#[test]
fn a_day_can_be_taken_up_in_its_middle_whatever_is_remembered() {
    for number in 340..350 {
        let day = any_day(number, SMALL);
        // Another day of the same seed, so that only the day itself differs.
        let mut other = Scenario::clone(&any_day(number + 50, SMALL)).into_day();
        other.seed = day.seed;
        let other = Arc::new(other.check("another day").expect("a seed is a number"));
        let mut simulation = Simulation::new(Arc::clone(&day));
        let mut elsewhere = Simulation::new(other);
        let mut remembers_another = Rolling::default();
        for _ in 0..number % 20 {
            let (Some(decision), Some(there)) =
                (simulation.next_decision(), elsewhere.next_decision())
            else {
                break;
            };
            let choice = Greedy.choose(&decision, &simulation.view()).expect("an answer");
            simulation.apply(choice).expect("a choice from the mask");
            let choice = remembers_another.choose(&there, &elsewhere.view()).expect("an answer");
            elsewhere.apply(choice).expect("a choice from the mask");
        }
        finished(&mut simulation.clone(), &mut remembers_another);
        let once = finished(&mut simulation.clone(), &mut Rolling::default());
        assert_eq!(once, finished(&mut simulation, &mut Rolling::default()), "day {number}");
    }
}

#[test]
fn days_can_be_played_by_turns() {
    let days = [360, 361].map(|number| any_day(number, Size { hours: 2, ..SMALL }));
    let mut simulations = days.map(Simulation::new);
    let mut policy = Rolling::default();
    loop {
        let mut over = true;
        for simulation in &mut simulations {
            let Some(decision) = simulation.next_decision() else { continue };
            let choice = policy.choose(&decision, &simulation.view()).expect("an answer");
            simulation.apply(choice).expect("a choice from the mask");
            over = false;
        }
        if over {
            break;
        }
    }
}

/// A day with so little demand that most flights would be empty.
fn thin_day(number: u64) -> Arc<Scenario> {
    let network = Network::shipped("new-york").expect("a shipped network");
    let day = network.draw(DaySeed::validation(number).expect("a seed"));
    let mut day = Scenario::clone(&day).into_day();
    let forecast = day.disturbances.forecast.iter_mut().flatten();
    for passengers in day.demand.iter_mut().chain(forecast).flat_map(Matrix::cells_mut) {
        *passengers /= 12;
    }
    day.disturbances.takeoff_delays = None;
    day.disturbances.outages.clear();
    day.operations.end = day.operations.start + 3 * 3600;
    day.aircraft.truncate(12);
    Arc::new(day.check("a thin day").expect("a day"))
}

#[test]
fn where_demand_is_thin_it_earns_as_much_as_the_rule_that_it_looks_ahead_with() {
    let (mut rolling_usd, mut prices_usd, mut greedy_usd) = (0.0, 0.0, 0.0);
    for number in 0..6 {
        let day = thin_day(number);
        rolling_usd += played(&day, &mut Rolling::default()).1;
        prices_usd += played(&day, &mut BidPricePolicy::default()).1;
        greedy_usd += played(&day, &mut Greedy).1;
    }
    assert!(greedy_usd > 0.0, "some want to fly");
    assert!(rolling_usd >= prices_usd, "{rolling_usd} is less than the {prices_usd} of prices");
    assert!(rolling_usd >= greedy_usd, "{rolling_usd} is less than the {greedy_usd} of greedy");
}

#[test]
fn without_demand_there_are_no_flights() {
    let mut idle = Scenario::clone(&thin_day(1)).into_day();
    for table in idle.demand.iter_mut().chain(idle.disturbances.forecast.iter_mut().flatten()) {
        table.cells_mut().fill(0);
    }
    let idle = Arc::new(idle.check("a day without demand").expect("a day"));
    let (trace, _) = played(&idle, &mut Rolling::default());
    assert!(trace.rows.iter().all(|row| row.to == row.from), "every aircraft holds");
}
