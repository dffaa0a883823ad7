//! Schedules to start from: days that policies have played, as traces.

use std::sync::Arc;

use vertifleet_core::Scenario;
use vertifleet_policy::{Greedy, Lookahead, Policy, Priced, Random};
use vertifleet_sim::{Simulation, Trace};

use super::problem::Problem;
use super::schedule::{Flight, Schedule};
use crate::Rolling;

/// A day played by one policy; nothing if `go_on`, asked before each decision, says no.
pub(super) fn played(
    scenario: &Arc<Scenario>,
    policy: &mut dyn Policy,
    go_on: &mut dyn FnMut() -> bool,
) -> Option<(Trace, f64)> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut trace = Trace::default();
    while let Some(decision) = simulation.next_decision() {
        if !go_on() {
            return None;
        }
        let choice = policy.choose(&decision, &simulation.view());
        let choice = choice.expect("these policies always answer");
        trace.rows.push(simulation.apply(choice).expect("and from the mask"));
    }
    Some((trace, simulation.ledger().profit_usd()))
}

/// The best day of the rules that decide at once.
pub(super) fn best_rule(scenario: &Arc<Scenario>) -> (Trace, f64) {
    let policies: [&mut dyn Policy; 4] =
        [&mut Priced::default(), &mut Lookahead, &mut Greedy, &mut Random::new(0)];
    let days = policies.map(|policy| played(scenario, policy, &mut || true));
    let days = days.into_iter().flatten();
    days.max_by(|one, other| one.1.total_cmp(&other.1)).expect("there are policies")
}

/// The rolling horizon's day, which mostly is the better one, and takes a while on large networks.
pub(super) fn rolling(
    scenario: &Arc<Scenario>,
    go_on: &mut dyn FnMut() -> bool,
) -> Option<(Trace, f64)> {
    played(scenario, &mut Rolling::default(), go_on)
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
