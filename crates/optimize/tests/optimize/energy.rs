//! The bound and the planner on days with reserves, charge curves, start charges and aircraft that
//! leave before they are full.

use std::sync::Arc;

use rayon::prelude::*;
use vertifleet_core::{Coded, Scenario};
use vertifleet_optimize::{Budget, Plan, Rolling, SearchSettings, Step, plan, upper_bound};
use vertifleet_policy::{BidPricePolicy, Greedy, Policy, Random, play};
use vertifleet_sim::Simulation;
use vertifleet_sim::check::check;
use vertifleet_testkit::{Size, any_energy_day, any_extreme_energy_day};

use crate::exhaustive::best_of_all;

const TINY: Size = Size { vertiports: 3, fleet: 3, hours: 2 };

fn bound_usd(day: &Scenario, minutes: u32) -> f64 {
    let step = Step::from_minutes(minutes).expect("a step");
    upper_bound(day, step).expect("a small day").upper_bound_usd()
}

fn planned(day: &Arc<Scenario>, steps: u64) -> Plan {
    let settings = SearchSettings { budget: Budget::Steps(steps), searches: 2, seed: 5 };
    plan(day, &settings, Vec::new(), &mut |_| true)
}

/// The profit of the best of all sequences of decisions, if there are at most `most`.
fn best_usd(day: &Arc<Scenario>, mut most: u32) -> Option<f64> {
    best_of_all(&mut Simulation::new(Arc::clone(day)), &mut most)
}

#[test]
fn no_sequence_of_decisions_of_a_tiny_day_earns_more_than_its_bound() {
    let compared = (0..300_u32).into_par_iter().filter(|&number| {
        let day = any_energy_day(number.into(), TINY);
        let Some(best) = best_usd(&day, 3_000) else { return false };
        let bound = bound_usd(&day, [1, 5, 13, 60][number as usize % 4]);
        assert!(bound >= best - 1e-6, "day {number}: bound {bound}, possible {best}");
        true
    });
    assert!(compared.count() >= 60, "enough days have few sequences");
}

/// Curves with neighbouring numbers for charges, the least and the greatest batteries and powers.
#[test]
fn extreme_curves_are_played_planned_and_bounded() {
    (0..60_u32).into_par_iter().for_each(|number| {
        let day = any_extreme_energy_day(number.into(), Size { vertiports: 4, fleet: 5, hours: 4 });
        let bound = bound_usd(&day, 30);
        let found = planned(&day, 40);
        assert!(check(&day, &found.trace).is_valid(), "day {number}");
        assert!(bound >= found.profit_usd - 1e-6, "day {number}: bound {bound}, {found:?}");
        for policy in [&mut BidPricePolicy::default() as &mut dyn Policy, &mut Rolling::default()] {
            let mut simulation = Simulation::new(Arc::clone(&day));
            play(&mut simulation, policy, |_| ()).expect("these policies always answer");
            assert!(bound >= simulation.ledger().profit_usd() - 1e-6, "day {number}");
        }
    });
}

#[test]
fn no_policy_earns_more_than_the_bound() {
    (1_000..1_150_u32).into_par_iter().for_each(|number| {
        let day = any_energy_day(number.into(), Size { vertiports: 6, fleet: 12, hours: 5 });
        let bound = bound_usd(&day, [5, 7, 15, 30, 60][number as usize % 5]);
        let policies: [&mut dyn Policy; 4] = [
            &mut Random::new(1),
            &mut Greedy,
            &mut BidPricePolicy::default(),
            &mut Rolling::default(),
        ];
        for policy in policies {
            let mut simulation = Simulation::new(Arc::clone(&day));
            play(&mut simulation, policy, |_| ()).expect("these policies always answer");
            let earned = simulation.ledger().profit_usd();
            assert!(bound >= earned, "day {number}: bound {bound}, earned {earned}");
        }
    });
}

#[test]
fn shorter_slices_and_more_levels_of_charge_never_give_a_looser_bound() {
    let lower = (2_000..2_020_u32).into_par_iter().filter(|&number| {
        let day = any_energy_day(number.into(), Size { vertiports: 5, fleet: 8, hours: 5 });
        let [long, short] = [15, 5].map(|minutes| {
            [4, 16, 64].map(|levels| {
                let step = Step::from_minutes(minutes).and_then(|step| step.with_levels(levels));
                let bound = upper_bound(&day, step.expect("a step")).expect("a small day");
                bound.upper_bound_usd()
            })
        });
        for bounds in [long, short] {
            assert!(bounds.is_sorted_by(|fewer, more| fewer >= more), "day {number}: {bounds:?}");
        }
        for (long, short) in long.iter().zip(&short) {
            assert!(long >= short, "day {number}: {long}, {short}");
        }
        short[2] < short[1] - 0.01 && short[1] < short[0] - 0.01
    });
    let lower = lower.count();
    assert!(lower >= 5, "{lower} bounds are lower with more levels");
    let step = Step::from_minutes(15).expect("a step");
    for levels in [0, 3, 65] {
        let refused = step.with_levels(levels).expect_err("out of range");
        assert_eq!(refused.code().to_string(), "V505", "{refused}");
    }
}

#[test]
fn a_plan_keeps_every_rule_and_earns_no_less_than_any_policy() {
    let better = (500..580_u64).into_par_iter().filter(|&number| {
        let day = any_energy_day(number, Size { vertiports: 6, fleet: 9, hours: 6 });
        let plan = planned(&day, 60);
        let report = check(&day, &plan.trace);
        assert!(report.is_valid(), "day {number}: {report}");
        assert!((report.totals.profit_usd - plan.profit_usd).abs() < 1e-6, "day {number}");
        assert!(plan.profit_usd >= plan.best_policy_usd, "day {number}");
        plan.profit_usd > plan.best_policy_usd
    });
    let better = better.count();
    assert!(better > 30, "{better}");
}

#[test]
fn a_tiny_day_is_planned_as_well_as_any_sequence_of_decisions_allows() {
    let compared = (0..150_u64).into_par_iter().filter(|&number| {
        let day = any_energy_day(number, TINY);
        let Some(best) = best_usd(&day, 3_000).filter(|&best| best > 0.0) else { return false };
        let found = planned(&day, 400).profit_usd;
        assert!((found - best).abs() < 1e-6, "day {number}: planned {found}, possible {best}");
        true
    });
    let compared = compared.count();
    assert!(compared >= 25, "{compared} days have few enough sequences");
}

/// Takes minutes, and so is run by hand:
/// `cargo t -p vertifleet-optimize --test optimize of_1000 -- --ignored --nocapture`.
#[test]
#[ignore = "searches 1,000 days exhaustively"]
fn of_1000_tiny_days_no_bound_is_broken_and_few_are_planned_below_their_optimum() {
    let sizes = [(3, 3, 2), (3, 2, 3), (2, 3, 2), (4, 2, 2)];
    let days = (10_000..14_000_u32).into_par_iter().filter_map(|number| {
        let (vertiports, fleet, hours) = sizes[number as usize % 4];
        let day = any_energy_day(number.into(), Size { vertiports, fleet, hours });
        let best = best_usd(&day, 200_000).filter(|&best| best > 0.0)?;
        let bound = bound_usd(&day, [1, 5, 15][number as usize % 3]);
        let found = planned(&day, 2_000);
        Some((number, best, bound, found.profit_usd, check(&day, &found.trace).is_valid()))
    });
    let mut days: Vec<_> = days.collect();
    days.truncate(1_000);
    let broken = days.iter().filter(|&&(_, best, bound, ..)| bound < best - 1e-6).count();
    let missed = days.iter().filter(|&&(_, best, _, found, _)| found < best - 1e-6).count();
    let refused = days.iter().filter(|&&(.., is_valid)| !is_valid).count();
    println!(
        "{} days: {broken} bounds broken, {missed} optima missed, {refused} plans refused",
        days.len()
    );
    assert_eq!((days.len(), broken, refused), (1_000, 0, 0));
    assert!(missed <= 10, "{missed} optima are missed");
}
