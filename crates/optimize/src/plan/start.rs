//! Schedules to start from: days that rules have played, as traces.

use std::sync::Arc;

use vertifleet_core::Scenario;
use vertifleet_policy::{Greedy, Lookahead, Policy, Random, play};
use vertifleet_sim::{Simulation, Trace};

use super::problem::Problem;
use super::route_search::{Bias, RouteSearch};
use super::schedule::{Flight, Schedule};

/// A day played by one rule.
pub(super) fn played(scenario: &Arc<Scenario>, policy: &mut dyn Policy) -> (Trace, f64) {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut trace = Trace::default();
    play(&mut simulation, policy, |row| trace.rows.push(*row))
        .expect("rules always answer, and from the mask");
    (trace, simulation.ledger().profit_usd())
}

/// The best day of the rules that need no learning.
pub(super) fn best_rule(scenario: &Arc<Scenario>) -> (Trace, f64) {
    let rules: [&mut dyn Policy; 3] = [&mut Lookahead, &mut Greedy, &mut Random::new(0)];
    let days = rules.map(|rule| played(scenario, rule));
    days.into_iter().max_by(|one, other| one.1.total_cmp(&other.1)).expect("there are three rules")
}

/// The flights of a whole day's trace.
pub(super) fn schedule_of(problem: &Problem, trace: &Trace) -> Schedule {
    let mut schedule = Schedule::unplanned(problem);
    let mut flights = vec![Vec::new(); problem.day.fleet().len()];
    for row in trace.rows.iter().filter(|row| row.from != row.to) {
        let flight = Flight { take_off_s: row.time.seconds(), from: row.from, to: row.to };
        flights[row.aircraft.at()].push(flight);
    }
    for (aircraft, flights) in problem.day.fleet().zip(&flights) {
        schedule.complete(problem, aircraft, flights);
    }
    schedule
}

/// A schedule to start from where nothing is known: aircraft after aircraft, earliest first, takes its best way. If they
/// leave no stand for one of them, all stay where they are, which is always possible.
pub(super) fn one_by_one(problem: &Problem) -> Schedule {
    let mut schedule = Schedule::unplanned(problem);
    let mut order: Vec<_> =
        problem.day.fleet().filter(|&aircraft| !schedule.is_whole(aircraft)).collect();
    order.sort_by_key(|aircraft| problem.state.aircraft[aircraft.at()].ready_at);
    let mut routes = RouteSearch::default();
    let mut way_on = Vec::new();
    let bias = Bias { shift_s: 0, rent_share: 1.0 };
    for &aircraft in &order {
        if !routes.complete(problem, &schedule, aircraft, bias, &mut way_on) {
            schedule = Schedule::unplanned(problem);
            for &aircraft in &order {
                schedule.complete(problem, aircraft, &[]);
            }
            return schedule;
        }
        schedule.complete(problem, aircraft, &way_on);
    }
    schedule
}

/// Flies a schedule in the simulator: the trace that it leaves, and its profit in dollars.
pub(super) fn flown(scenario: &Arc<Scenario>, schedule: &Schedule) -> (Trace, f64) {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut trace = Trace::default();
    let mut done = vec![0; scenario.aircraft.len()];
    while let Some(decision) = simulation.next_decision() {
        let done = &mut done[decision.aircraft.at()];
        let choice = match schedule.flights(decision.aircraft).get(*done) {
            Some(next) if next.take_off_s == decision.time.seconds() => {
                *done += 1;
                next.to
            }
            _ => decision.at,
        };
        trace.rows.push(simulation.apply(choice).expect("a schedule keeps every rule"));
    }
    (trace, simulation.ledger().profit_usd())
}
