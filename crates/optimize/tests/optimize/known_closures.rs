//! Closures at given times: bound and planner know all closures of a day, the rolling horizon only
//! those that are known in advance.

use std::sync::Arc;

use vertifleet_core::{Closure, DaySeed, Network, Route, Scenario, Time, VertiportIx};
use vertifleet_optimize::{Budget, Rolling, SearchSettings, Step, plan, upper_bound};
use vertifleet_policy::play;
use vertifleet_sim::{Simulation, Trace, check::check};

/// A day of `paper` with 8 aircraft. Unless `known` is `None`, the first two vertiports are closed
/// from 14:00 on.
fn day(seed: u64, known: Option<bool>) -> Arc<Scenario> {
    let network = Network::shipped("paper").expect("a shipped network");
    let mut day = network.draw(DaySeed::validation(seed).expect("a seed")).into_day();
    day.aircraft.truncate(8);
    let (start, end) = (Time::from_seconds(14 * 3600), Time::from_seconds(19 * 3600));
    for from in [0, 1].map(VertiportIx) {
        for to in VertiportIx::all(8).filter(|&to| to != from) {
            let route = Route { from, to, both_ways: true };
            day.disturbances.closures.extend(known.map(|known| Closure {
                route,
                start,
                end,
                known,
            }));
        }
    }
    Arc::new(day.check("a day with a curfew").expect("a day"))
}

fn bound_usd(day: &Scenario) -> f64 {
    let step = Step::from_minutes(15).expect("a step");
    upper_bound(day, step).expect("a small day").upper_bound_usd()
}

#[test]
fn the_bound_is_the_same_whether_others_know_of_a_closure_and_lower_than_without() {
    let [open, surprise, announced] =
        [None, Some(false), Some(true)].map(|known| bound_usd(&day(1, known)));
    assert_eq!(surprise, announced);
    assert!(announced < open - 100.0, "{announced} with a curfew, {open} without");
}

#[test]
fn a_plan_keeps_out_of_closures_of_both_kinds_and_within_the_bound() {
    for known in [false, true] {
        let day = day(2, Some(known));
        let settings = SearchSettings { budget: Budget::Steps(300), searches: 2, seed: 5 };
        let plan = plan(&day, &settings, Vec::new(), &mut |_| true);
        let report = check(&day, &plan.trace);
        assert!(report.is_valid(), "{report}");
        let bound_usd = bound_usd(&day);
        assert!(plan.profit_usd <= bound_usd, "{} planned, bound {bound_usd}", plan.profit_usd);
        assert!(
            plan.profit_usd > 0.8 * bound_usd,
            "{} planned, bound {bound_usd}",
            plan.profit_usd
        );
    }
}

#[test]
fn the_rolling_horizon_earns_more_if_it_knows_of_a_curfew() {
    let earned_usd = |seed, known| {
        let day = day(seed, Some(known));
        let (mut simulation, mut trace) = (Simulation::new(Arc::clone(&day)), Trace::default());
        play(&mut simulation, &mut Rolling::default(), |row| trace.rows.push(*row))
            .expect("every choice is feasible");
        let report = check(&day, &trace);
        assert!(report.is_valid(), "{report}");
        simulation.ledger().profit_usd()
    };
    let gains_usd = [3, 4, 5].map(|seed| earned_usd(seed, true) - earned_usd(seed, false));
    let mean_usd = gains_usd.iter().sum::<f64>() / 3.0;
    assert!(mean_usd > 100.0, "{gains_usd:?}");
}
