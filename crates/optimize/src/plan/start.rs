//! Schedules to start from: days that policies have played, as traces.

use std::sync::Arc;

use vertifleet_core::{Scenario, Stop};
use vertifleet_policy::{
    BidPricePolicy, Greedy, PlayError, Policy, PolicyError, Random, Stoppable, play,
};
use vertifleet_sim::{Simulation, Trace};

use super::problem::Problem;
use super::schedule::{Flight, Schedule};
use super::{BestPlan, Plan};
use crate::Rolling;

/// A policy whose day a plan may start from.
pub struct StartingPolicy {
    name: String,
    policy: Box<dyn Policy>,
}

impl StartingPolicy {
    /// A policy with its name in plans ([`Plan::best_policy`](crate::Plan::best_policy)).
    pub fn new(name: &str, policy: Box<dyn Policy>) -> Self {
        Self { name: name.to_owned(), policy }
    }
}

/// A day that a policy has played.
pub(super) struct PlayedDay {
    pub(super) policy: String,
    pub(super) trace: Trace,
    pub(super) profit_usd: f64,
}

/// A day that one policy plays until its end, or until `go_on`, called after each decision with the
/// number of decisions so far, returns `false`.
struct Begun {
    simulation: Simulation,
    trace: Trace,
    /// Whether the policy has reached the end of the day.
    is_over: bool,
}

impl Begun {
    fn by(
        policy: &mut dyn Policy,
        scenario: &Arc<Scenario>,
        go_on: &mut dyn FnMut(usize) -> bool,
    ) -> Self {
        let mut simulation = Simulation::new(Arc::clone(scenario));
        let mut trace = Trace::default();
        let stop = Stop::default();
        let outcome = play(&mut simulation, &mut Stoppable { policy, stop: &stop }, |row| {
            trace.rows.push(*row);
            if !go_on(trace.rows.len()) {
                stop.request();
            }
        });
        let is_over = match outcome {
            Ok(()) => true,
            Err(PlayError::NoAnswer(PolicyError::Stopped)) => false,
            Err(error) => panic!("{ANSWERS}: {error}"),
        };
        Self { simulation, trace, is_over }
    }

    /// The day, if the policy has reached its end.
    fn whole(self, policy: &str) -> Option<PlayedDay> {
        let profit_usd = self.simulation.ledger().profit_usd();
        self.is_over.then(|| PlayedDay { policy: policy.to_owned(), trace: self.trace, profit_usd })
    }

    /// The day, with the rest of it decided by greedy.
    fn finished(mut self, policy: &str) -> PlayedDay {
        play(&mut self.simulation, &mut Greedy, |row| self.trace.rows.push(*row)).expect(ANSWERS);
        let profit_usd = self.simulation.ledger().profit_usd();
        PlayedDay { policy: policy.to_owned(), trace: self.trace, profit_usd }
    }
}

const ANSWERS: &str = "these policies always answer, and from the mask";

/// The best day of several policies: greedy, the prices, `more`, the other rules that need no
/// learning, and the rolling horizon.
///
/// `go_on` is called with the best profit so far in dollars, and while a day is being played, with
/// the share of it that is over, in decisions of greedy's day. If it returns `false`, that day is
/// left out; before a day begins, all following ones are too. Greedy's day is always played. The
/// prices decide until the time is over, and greedy for the rest of their day: on a large network
/// with a short limit, no other policy gets this far.
pub(super) fn best_policy(
    scenario: &Arc<Scenario>,
    more: Vec<StartingPolicy>,
    known: &BestPlan,
    go_on: &mut dyn FnMut(f64, Option<f64>) -> bool,
) -> Plan {
    let mut best = Plan::from(Begun::by(&mut Greedy, scenario, &mut |_| true).finished("greedy"));
    known.record(&best);
    if !go_on(best.profit_usd, None) {
        return best;
    }
    let decisions = best.trace.rows.len().max(1) as f64;
    // Each decision is reported as the last one, so that the day continues until there is no time
    // at all.
    let priced = Begun::by(&mut BidPricePolicy::default(), scenario, &mut |_| {
        go_on(best.profit_usd, Some(1.0))
    });
    best = better(best, priced.finished("prices"), known);
    let others = [
        StartingPolicy::new("random", Box::new(Random::new(0))),
        StartingPolicy::new("rolling", Box::<Rolling>::default()),
    ];
    for StartingPolicy { name, mut policy } in more.into_iter().chain(others) {
        if !go_on(best.profit_usd, None) {
            break;
        }
        let day = Begun::by(policy.as_mut(), scenario, &mut |taken| {
            go_on(best.profit_usd, Some((taken as f64 / decisions).min(1.0)))
        });
        if let Some(day) = day.whole(&name) {
            best = better(best, day, known);
        }
    }
    best
}

/// A day of the rolling horizon with more roll-outs, or `None` if `go_on`, called after each
/// decision with the number of decisions so far, returns `false`.
pub(super) fn rolled_thoroughly(
    scenario: &Arc<Scenario>,
    go_on: &mut dyn FnMut(usize) -> bool,
) -> Option<PlayedDay> {
    Begun::by(&mut Rolling::thorough(), scenario, go_on).whole("rolling")
}

/// The day that earns more; of equals, the first. A better day is recorded.
fn better(one: Plan, other: PlayedDay, known: &BestPlan) -> Plan {
    if other.profit_usd <= one.profit_usd {
        return one;
    }
    let better = Plan::from(other);
    known.record(&better);
    better
}

/// The flights of a whole day's trace.
pub(super) fn schedule_of(problem: &Problem, trace: &Trace) -> Schedule {
    let mut flights = vec![Vec::new(); problem.day.fleet().len()];
    for row in trace.rows.iter().filter(|row| row.from != row.to) {
        let (day, take_off_s) = (&problem.day, row.time.seconds());
        let own: &mut Vec<Flight> = &mut flights[row.aircraft.at()];
        let before = own.last().map_or_else(|| day.start(row.aircraft), |flight| flight.landing);
        let hop = day.hop(day.kind(row.aircraft), row.from, row.to);
        let standing = day.standing(row.aircraft, row.from, take_off_s, before.arrival);
        let landing = day.landing(row.aircraft, row.from, hop, standing);
        let landing = landing.expect("the simulator has flown it");
        own.push(Flight { take_off_s, from: row.from, to: row.to, landing });
    }
    Schedule::of(problem, &flights)
}

/// Flies a schedule in the simulator. Returns its trace and its profit in dollars.
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
