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

/// A day that was played, and its profit in dollars.
pub(super) type Played = (Trace, f64);

/// A day played by one policy; `None` if `go_on`, asked after each decision with how many there were, says no.
fn played(
    scenario: &Arc<Scenario>,
    policy: &mut dyn Policy,
    go_on: &mut dyn FnMut(usize) -> bool,
) -> Option<Played> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut trace = Trace::default();
    let stop = AtomicBool::new(false);
    let outcome = play(&mut simulation, &mut Stoppable { policy, stop: &stop }, |row| {
        trace.rows.push(*row);
        stop.store(!go_on(trace.rows.len()), Ordering::Relaxed);
    });
    match outcome {
        Ok(()) => Some((trace, simulation.ledger().profit_usd())),
        Err(PlayError::NoAnswer(PolicyError::Stopped)) => None,
        Err(error) => panic!("these policies always answer, and from the mask: {error}"),
    }
}

/// The best day of several policies: the rules that need no learning, `more`, and the rolling horizon, the quickest first.
///
/// `go_on` is told the best profit so far in dollars, and of a day that is being played how much of it is over, as a share
/// of greedy's decisions. When it says no, that day is left out, and before a day begins also all that follow. Greedy's is
/// always played.
pub(super) fn best_policy(
    scenario: &Arc<Scenario>,
    more: &mut [Box<dyn Policy>],
    go_on: &mut dyn FnMut(f64, Option<f64>) -> bool,
) -> Played {
    let mut best = played(scenario, &mut Greedy, &mut |_| true).expect("it is not stopped");
    let decisions = best.0.rows.len().max(1) as f64;
    let mut rules: [Box<dyn Policy>; 3] =
        [Box::new(Lookahead), Box::new(Random::new(0)), Box::<Priced>::default()];
    let mut rolling: [Box<dyn Policy>; 1] = [Box::<Rolling>::default()];
    for policy in rules.iter_mut().chain(more).chain(&mut rolling) {
        if !go_on(best.1, None) {
            break;
        }
        let day = played(scenario, policy.as_mut(), &mut |taken| {
            go_on(best.1, Some((taken as f64 / decisions).min(1.0)))
        });
        if let Some(day) = day.filter(|day| day.1 > best.1) {
            best = day;
        }
    }
    best
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
