//! Schedules to start from: days that policies have played, as traces.

use std::sync::Arc;

use vertifleet_core::Scenario;
use vertifleet_policy::{Greedy, Lookahead, Policy, Priced, Random, play};
use vertifleet_sim::{Simulation, Trace};

use super::problem::Problem;
use super::schedule::{Flight, Schedule};
use crate::Rolling;

/// A day played by one policy.
pub(super) fn played(scenario: &Arc<Scenario>, policy: &mut dyn Policy) -> (Trace, f64) {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut trace = Trace::default();
    play(&mut simulation, policy, |row| trace.rows.push(*row))
        .expect("these policies always answer, and from the mask");
    (trace, simulation.ledger().profit_usd())
}

/// The best day of the policies that need no learning.
pub(super) fn best_policy(scenario: &Arc<Scenario>) -> (Trace, f64) {
    let policies: [&mut dyn Policy; 5] = [
        &mut Rolling::default(),
        &mut Priced::default(),
        &mut Lookahead,
        &mut Greedy,
        &mut Random::new(0),
    ];
    let days = policies.map(|policy| played(scenario, policy));
    days.into_iter().max_by(|one, other| one.1.total_cmp(&other.1)).expect("there are policies")
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
