//! The bound of the rest of a live day, against every way in which the day can continue.

use std::sync::Arc;

use rayon::prelude::*;
use vertifleet_core::{Scenario, Stop, Time};
use vertifleet_optimize::{Step, upper_bound, upper_bound_of_rest};
use vertifleet_policy::{BidPricePolicy, Greedy, Policy};
use vertifleet_sim::Imagined;
use vertifleet_sim::live::{LiveDay, Report, Reporter};
use vertifleet_testkit::{Size, any_energy_day, any_extended_day, paper_day};

fn bound_usd(day: &Scenario, ready: &[Time], minutes: u32) -> f64 {
    let step = Step::from_minutes(minutes).expect("a step");
    let bound = upper_bound_of_rest(&Stop::default(), day, ready, step).expect("a small day");
    bound.expect("it is not stopped").upper_bound_usd()
}

/// Reports to a live day its first decisions, which a policy takes.
fn begun(day: &Arc<Scenario>, policy: &mut dyn Policy, decisions: u32) -> LiveDay {
    let (mut live, mut reporter) = (LiveDay::new(Arc::clone(day)), Reporter::new(day));
    let mut room = None;
    for _ in 0..decisions {
        let Some(decision) = reporter.next_decision() else { break };
        while let Some((time, report)) = reporter.next_report(decision.time) {
            live.take(time, &report).expect("what the rules allow");
        }
        let view = live.view_at(&decision, &mut room);
        let to = policy.choose(&decision, &view).expect("these always answer");
        reporter.apply(to).expect("a feasible choice");
        let decided = Report::Decided { aircraft: decision.aircraft, to };
        live.take(decision.time, &decided).expect("a feasible choice");
    }
    live
}

/// The highest profit of any way to go on, by trying them all; `None` if there are more than
/// `most`.
fn best_of_rest(rest: &mut Imagined, most: &mut u32) -> Option<f64> {
    let Some(decision) = rest.next_decision() else {
        *most = most.checked_sub(1)?;
        return Some(rest.totals().profit_usd);
    };
    let mask = rest.view().feasible(&decision);
    let mut best = f64::NEG_INFINITY;
    for choice in mask.iter() {
        let mut after = rest.clone();
        after.apply(choice).expect("a choice from the mask");
        best = best.max(best_of_rest(&mut after, most)?);
    }
    Some(best)
}

#[test]
fn no_way_to_go_on_earns_more_than_the_bound_of_the_rest() {
    let excess_usd: Vec<f64> = (0..400_u32)
        .into_par_iter()
        .filter_map(|number| {
            let size = Size { vertiports: 3, fleet: 3, hours: 3 };
            let day = [any_extended_day, any_energy_day][number as usize % 2](number.into(), size);
            let mut live = begun(&day, &mut Greedy, 1 + number % 6);
            let so_far = live.totals().profit_usd;
            let best = best_of_rest(&mut live.rest(), &mut 3_000)? - so_far;
            let left = live.remaining_day().expect("a day within bounds")?;
            let bounds = [1, [5, 13, 60][number as usize % 3]];
            let bounds = bounds.map(|minutes| bound_usd(&left.day, &left.ready, minutes));
            for bound in bounds {
                assert!(bound >= best - 1e-6, "day {number}: bound {bound}, possible {best}");
            }
            (best > 0.0).then_some(bounds[0] - best)
        })
        .collect();
    let compared = excess_usd.len();
    assert!(compared >= 40, "{compared} days have few ways to go on");
    let exact = excess_usd.iter().filter(|&&excess_usd| excess_usd < 0.01).count();
    assert!(3 * exact >= compared, "{exact} of {compared} bounds are the optimum");
}

#[test]
fn before_the_first_event_the_rest_is_the_whole_day() {
    let day = paper_day(3);
    let left = LiveDay::new(Arc::clone(&day)).remaining_day().expect("a day").expect("all of it");
    let step = Step::from_minutes(60).expect("a step");
    let whole = upper_bound(&day, step).expect("a bound").upper_bound_usd();
    assert_eq!(bound_usd(&left.day, &left.ready, 60), whole);
}

#[test]
fn the_bound_of_the_day_is_tight_from_morning_to_evening() {
    let day = paper_day(3);
    for decisions in [50, 150, 300] {
        let mut live = begun(&day, &mut BidPricePolicy::default(), decisions);
        let so_far = live.totals().profit_usd;
        let left = live.remaining_day().expect("a day").expect("some of it");
        let bound = so_far + bound_usd(&left.day, &left.ready, 15);
        let mut rest = live.rest();
        let mut policy = BidPricePolicy::default();
        while let Some(decision) = rest.next_decision() {
            let to = policy.choose(&decision, &rest.view()).expect("it always answers");
            rest.apply(to).expect("a feasible choice");
        }
        let expected = rest.totals().profit_usd;
        let gap = (bound - expected) / bound;
        assert!((0.0..0.08).contains(&gap), "after {decisions}: {expected} of {bound}");
    }
}
