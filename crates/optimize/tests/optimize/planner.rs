//! Properties of the planner, on small days of every kind and on days of the `paper` network.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::exhaustive::best_of_all;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{Matrix, Scenario, Stop, VertiportIx};
use vertifleet_optimize::{Budget, Plan, SearchSettings, StartingPolicy, plan, plan_in_time};
use vertifleet_policy::{BidPricePolicy, Greedy, Policy, PolicyError, Random, Replay, play};
use vertifleet_sim::{Decision, Simulation, View, check::check};
use vertifleet_testkit::{Size, any_day, any_extended_day, paper_day};

fn planned(day: &Arc<Scenario>, steps: u64) -> Plan {
    let settings = SearchSettings { budget: Budget::Steps(steps), searches: 2, seed: 5 };
    plan(day, &settings, Vec::new(), &mut |_| true)
}

#[test]
fn a_tiny_day_is_planned_as_well_as_any_sequence_of_decisions_allows() {
    let tiny = Size { vertiports: 3, fleet: 3, hours: 2 };
    let mut compared = 0;
    for number in 0..100 {
        let day = any_day(number, tiny);
        let best = best_of_all(&mut Simulation::new(Arc::clone(&day)), &mut 3_000);
        let Some(best) = best.filter(|&best| best > 0.0) else { continue };
        let found = planned(&day, 200).profit_usd;
        assert!((found - best).abs() < 1e-6, "day {number}: planned {found}, possible {best}");
        compared += 1;
    }
    assert!(compared >= 20, "{compared} days have few enough sequences");
}

#[test]
fn a_plan_keeps_every_rule_and_earns_no_less_than_any_simple_one() {
    let small = Size { vertiports: 6, fleet: 9, hours: 6 };
    for number in 100..160 {
        let day = any_day(number, small);
        let plan = planned(&day, 60);
        let report = check(&day, &plan.trace);
        assert!(report.is_valid(), "day {number}: {report}");
        assert!((report.totals.profit_usd - plan.profit_usd).abs() < 1e-6, "day {number}");
        let rules: [&mut dyn Policy; 3] =
            [&mut Random::new(0), &mut Greedy, &mut BidPricePolicy::default()];
        for rule in rules {
            let mut simulation = Simulation::new(Arc::clone(&day));
            play(&mut simulation, rule, |_| ()).expect("rules always answer");
            let earned = simulation.ledger().profit_usd();
            assert!(plan.profit_usd >= earned, "day {number}: {} < {earned}", plan.profit_usd);
        }
    }
}

#[test]
fn a_disturbed_day_is_planned_as_known() {
    let small = Size { vertiports: 6, fleet: 9, hours: 6 };
    let mut better = 0;
    for number in 500..560 {
        let day = any_extended_day(number, small);
        let plan = planned(&day, 60);
        let report = check(&day, &plan.trace);
        assert!(report.is_valid(), "day {number}: {report}");
        assert!((report.totals.profit_usd - plan.profit_usd).abs() < 1e-6, "day {number}");
        assert!(plan.profit_usd >= plan.best_policy_usd, "day {number}");
        better += usize::from(plan.profit_usd > plan.best_policy_usd);
    }
    assert!(better > 20, "{better}");
}

#[test]
fn a_tiny_disturbed_day_is_planned_as_well_as_any_sequence_of_decisions_allows() {
    let tiny = Size { vertiports: 3, fleet: 3, hours: 2 };
    let mut compared = 0;
    for number in 600..700_u64 {
        let day = any_extended_day(number, tiny);
        let best = best_of_all(&mut Simulation::new(Arc::clone(&day)), &mut 3_000);
        let Some(best) = best.filter(|&best| best > 0.0) else { continue };
        let found = planned(&day, 200).profit_usd;
        assert!((found - best).abs() < 1e-6, "day {number}: planned {found}, possible {best}");
        compared += 1;
    }
    assert!(compared >= 10, "{compared} days have few enough sequences");
}

/// Days on which one aircraft has to earn less than it could so that another can earn more. A
/// search in which every move is the best for one aircraft stays below the optimum of each of these
/// days for any running time.
#[test]
fn a_tiny_day_is_planned_to_its_optimum_where_no_aircraft_may_take_what_is_best_for_itself() {
    let days =
        [(3, 3, 2, 5021), (3, 3, 2, 5046), (3, 2, 3, 5249), (2, 3, 2, 5314), (4, 3, 2, 5194)];
    for (vertiports, fleet, hours, number) in days {
        let day = any_day(number, Size { vertiports, fleet, hours });
        let best = best_of_all(&mut Simulation::new(Arc::clone(&day)), &mut 200_000);
        let best = best.expect("few enough sequences");
        let found = planned(&day, 2_000).profit_usd;
        assert!((found - best).abs() < 1e-6, "day {number}: planned {found}, possible {best}");
    }
}

/// Takes a minute in a debug build, and so is run by hand:
/// `cargo t --workspace --test optimize planner -- --ignored --nocapture`.
#[test]
#[ignore = "plans 3,074 days"]
fn of_thousands_of_tiny_days_a_handful_are_planned_below_their_optimum() {
    let sizes = [(3, 3, 2), (3, 2, 3), (2, 3, 2), (4, 3, 2)];
    let size = |(vertiports, fleet, hours)| Size { vertiports, fleet, hours };
    let days = |number| [any_day, any_extended_day].map(|kind| move |size| kind(number, size));
    let days: Vec<Arc<Scenario>> = sizes
        .into_iter()
        .flat_map(|one| (5_000..5_400).flat_map(days).map(move |day| day(size(one))))
        .collect();
    let missed_usd = |day: &Arc<Scenario>| {
        let best = best_of_all(&mut Simulation::new(Arc::clone(day)), &mut 200_000)?;
        let settings = SearchSettings { budget: Budget::Steps(2_000), searches: 2, seed: 5 };
        Some(best - plan(day, &settings, Vec::new(), &mut |_| true).profit_usd)
    };
    let missed_usd: Vec<f64> = days.par_iter().filter_map(missed_usd).collect();
    let missed = missed_usd.iter().filter(|&&missed_usd| missed_usd > 1e-6).count();
    println!("{missed} of {} optima are missed", missed_usd.len());
    assert!(missed_usd.len() > 2_000 && missed < 10, "{missed} of {}", missed_usd.len());
}

#[test]
fn a_plan_of_paper_gets_better_with_more_steps_and_keeps_every_rule() {
    let day = paper_day(1);
    let (none, few, more) = (planned(&day, 0), planned(&day, 500), planned(&day, 3_000));
    assert_eq!(none.profit_usd, none.best_policy_usd, "the search begins at the best policy's day");
    assert!(none.profit_usd <= few.profit_usd && few.profit_usd < more.profit_usd);
    assert!(check(&day, &more.trace).is_valid());
}

#[test]
fn the_plan_of_a_day_without_demand_is_done_without_a_search() {
    let mut day = paper_day(1).as_ref().clone().into_day();
    day.demand.iter_mut().flat_map(Matrix::cells_mut).for_each(|cell| *cell = 0);
    let day = Arc::new(day.check("a day without passengers").expect("a day within the rules"));
    let plan = planned(&day, 1_000_000_000);
    assert_eq!((plan.steps, plan.profit_usd), (0, 0.0));
}

#[test]
fn the_same_settings_give_the_same_plan_on_any_number_of_threads() {
    let day = paper_day(2);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| planned(&day, 300))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    let other_seed = SearchSettings { budget: Budget::Steps(300), searches: 2, seed: 6 };
    let other = plan(&day, &other_seed, Vec::new(), &mut |_| true);
    assert_ne!(one, other, "chance follows the seed");
}

/// A dive takes the time of many steps, so it is a part of long searches only.
#[test]
fn a_plan_with_a_dive_is_the_same_on_any_number_of_threads_and_keeps_every_rule() {
    let day = any_extended_day(3, Size { vertiports: 4, fleet: 6, hours: 3 });
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| planned(&day, 25_000))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert!(check(&day, &one.trace).is_valid());
}

#[test]
fn a_plan_can_be_stopped_at_any_time_and_is_whole_then() {
    let day = paper_day(3);
    let settings =
        SearchSettings { budget: Budget::Time(Duration::from_mins(10)), searches: 1, seed: 1 };
    let mut looks = 0;
    let stopped = plan(&day, &settings, Vec::new(), &mut |progress| {
        looks += 1;
        assert!((0.0..=1.0).contains(&progress.share));
        looks < 4
    });
    assert!(check(&day, &stopped.trace).is_valid());
    let at_once = SearchSettings { budget: Budget::Time(Duration::ZERO), ..settings };
    let policy = plan(&day, &at_once, Vec::new(), &mut |_| true);
    assert_eq!((policy.steps, policy.profit_usd), (0, policy.best_policy_usd));
}

/// A policy that panics when it is asked to decide.
struct NotInTime;

impl Policy for NotInTime {
    fn choose(&mut self, _: &Decision, _: &View<'_>) -> Result<VertiportIx, PolicyError> {
        panic!("there is no time for it")
    }
}

/// A policy that never answers.
struct NeverAnswers;

impl Policy for NeverAnswers {
    fn choose(&mut self, _: &Decision, _: &View<'_>) -> Result<VertiportIx, PolicyError> {
        loop {
            std::thread::sleep(Duration::from_mins(1));
        }
    }
}

#[test]
fn a_plan_is_there_at_its_limit_and_at_a_stop_though_a_policy_never_answers() {
    let day = paper_day(6);
    let begin = |limit_s: u64, stop: &Stop| {
        let budget = Budget::Time(Duration::from_secs(limit_s));
        let settings = SearchSettings { budget, searches: 1, seed: 1 };
        let starts = vec![StartingPolicy::new("never", Box::new(NeverAnswers))];
        let begun = Instant::now();
        let found = plan_in_time(&day, &settings, starts, None, stop, &mut |_, _| {});
        (found.expect("greedy has played").plan, begun.elapsed())
    };
    let (plan, took) = begin(1, &Stop::default());
    assert!(took < Duration::from_secs(5), "{took:?}");
    assert!(check(&day, &plan.trace).is_valid());
    let mut simulation = Simulation::new(Arc::clone(&day));
    play(&mut simulation, &mut Greedy, |_| ()).expect("greedy always answers");
    assert!(plan.profit_usd >= simulation.ledger().profit_usd());

    let stop = Stop::default();
    let raised = stop.clone();
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_secs(2));
        raised.request();
    });
    let (stopped, took) = begin(600, &stop);
    assert!(took < Duration::from_secs(10), "{took:?}");
    assert!(check(&day, &stopped.trace).is_valid());
}

#[test]
fn without_time_the_plan_is_greedys_day() {
    let day = paper_day(6);
    let settings = SearchSettings { budget: Budget::Time(Duration::ZERO), searches: 1, seed: 1 };
    let plan =
        plan(&day, &settings, vec![StartingPolicy::new("late", Box::new(NotInTime))], &mut |_| {
            true
        });
    let mut simulation = Simulation::new(Arc::clone(&day));
    play(&mut simulation, &mut Greedy, |_| ()).expect("greedy always answers");
    assert_eq!((plan.profit_usd, plan.steps), (simulation.ledger().profit_usd(), 0));
    assert_eq!(plan.best_policy, "greedy");
}

#[test]
fn a_plan_is_never_below_a_policy_that_it_is_given() {
    let day = paper_day(5);
    let better = planned(&day, 1_000);
    let settings = SearchSettings { budget: Budget::Steps(0), searches: 1, seed: 1 };
    let replay = Replay::new(Arc::new(better.trace.clone()));
    let replay = StartingPolicy::new("replay", Box::new(replay));
    let given = plan(&day, &settings, vec![replay], &mut |_| true);
    assert_eq!((given.best_policy.as_str(), given.profit_usd), ("replay", better.profit_usd));
    assert!(given.profit_usd > planned(&day, 0).profit_usd, "it is better than any rule's day");
}

#[test]
fn there_are_no_flights_where_nothing_can_be_earned() {
    let mut idle = Scenario::clone(&paper_day(4)).into_day();
    idle.demand.iter_mut().for_each(|table| table.cells_mut().fill(0));
    let idle = Arc::new(idle.check("no demand").expect("a day without demand is a day"));
    let plan = planned(&idle, 20);
    assert_eq!(plan.profit_usd, 0.0);
    assert!(plan.trace.rows.iter().all(|row| row.from == row.to));

    let mut stuck = Scenario::clone(&paper_day(4)).into_day();
    let size = stuck.vertiports.len();
    stuck.distance_mi = Matrix::from_fn(size, |from, to| if from == to { 0.0 } else { 900.0 });
    let stuck = Arc::new(stuck.check("out of range").expect("no aircraft has to be able to fly"));
    assert_eq!(planned(&stuck, 20).profit_usd, 0.0);
}
