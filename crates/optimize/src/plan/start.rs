//! Schedules to start from: days that policies have played, as traces.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use vertifleet_core::Scenario;
use vertifleet_policy::{
    Greedy, Lookahead, PlayError, Policy, PolicyError, Priced, Random, Stoppable, play,
};
use vertifleet_sim::{Simulation, Trace};

use super::problem::Problem;
use super::schedule::{Flight, Schedule};
use crate::Rolling;

/// A day played by one policy; nothing if `go_on`, asked after each decision, says no.
fn played(
    scenario: &Arc<Scenario>,
    policy: &mut dyn Policy,
    go_on: &mut dyn FnMut() -> bool,
) -> Option<(Trace, f64)> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut trace = Trace::default();
    let stop = AtomicBool::new(false);
    let outcome = play(&mut simulation, &mut Stoppable { policy, stop: &stop }, |row| {
        trace.rows.push(*row);
        stop.store(!go_on(), Ordering::Relaxed);
    });
    match outcome {
        Ok(()) => Some((trace, simulation.ledger().profit_usd())),
        Err(PlayError::NoAnswer(PolicyError::Stopped)) => None,
        Err(error) => panic!("these policies always answer, and from the mask: {error}"),
    }
}

/// The best day of the policies that need no learning. That of the rolling horizon, which is mostly the best and takes a while on
/// large networks, is left out if `go_on`, told the profit of the others in dollars, says no while it is being played.
pub(super) fn best_policy(
    scenario: &Arc<Scenario>,
    mut go_on: impl FnMut(f64) -> bool,
) -> (Trace, f64) {
    let rules: [&mut dyn Policy; 4] =
        [&mut Priced::default(), &mut Lookahead, &mut Greedy, &mut Random::new(0)];
    let days = rules.map(|rule| played(scenario, rule, &mut || true));
    let best = days.into_iter().flatten().max_by(|one, other| one.1.total_cmp(&other.1));
    let best = best.expect("there are rules");
    match played(scenario, &mut Rolling::default(), &mut || go_on(best.1)) {
        Some(rolling) if rolling.1 > best.1 => rolling,
        _ => best,
    }
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
