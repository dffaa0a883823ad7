//! Properties of the rules, on days of the `paper` network.

use std::sync::Arc;

use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_policy::{Greedy, PlayError, Policy, PolicyError, Random, Replay, play};
use vertifleet_sim::{Decision, Simulation, Trace, View, check::check};
use vertifleet_testkit::paper_day;

fn trace_of(day: &Arc<Scenario>, policy: &mut dyn Policy) -> (Trace, f64) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut trace = Trace::default();
    play(&mut simulation, policy, |row| trace.rows.push(*row)).expect("the policy plays the day");
    (trace, simulation.totals().profit_usd)
}

fn rules() -> [(&'static str, Box<dyn Policy>); 2] {
    [("random", Box::new(Random::new(1))), ("greedy", Box::new(Greedy))]
}

#[test]
fn every_rule_leaves_a_schedule_that_passes_the_check() {
    for (name, mut policy) in rules() {
        for seed in 0..5 {
            let day = paper_day(seed);
            let (trace, profit) = trace_of(&day, policy.as_mut());
            let report = check(&day, &trace);
            assert!(report.is_valid(), "{name}: {report}");
            assert!((report.totals.profit_usd - profit).abs() < 1e-6, "{name}");
        }
    }
}

#[test]
fn a_replay_repeats_the_day_to_the_bit() {
    let day = paper_day(3);
    let (trace, profit) = trace_of(&day, &mut Random::new(8));
    let (again, profit_again) = trace_of(&day, &mut Replay::new(Arc::new(trace.clone())));
    assert_eq!((again, profit_again), (trace, profit));
}

#[test]
fn a_replay_of_another_day_gets_stuck_and_reports_where() {
    let (trace, _) = trace_of(&paper_day(3), &mut Greedy);
    let stuck = |day: Arc<Scenario>, trace: Trace| {
        let mut replay = Replay::new(Arc::new(trace));
        let error = play(&mut Simulation::new(day), &mut replay, |_| ());
        error.expect_err("another day's trace").to_string()
    };
    let refused = stuck(paper_day(4), trace.clone());
    assert!(refused.contains("aircraft \"A") && refused.contains("vertiport \"V"), "{refused}");
    let later = Trace { rows: trace.rows[1..].to_vec() };
    assert_eq!(
        stuck(paper_day(3), later),
        "row 1 of the trace is aircraft \"A02\" at 06:00:00, but aircraft \"A01\" decides at 06:00:00"
    );

    let short = Trace { rows: trace.rows[..10].to_vec() };
    let mut simulation = Simulation::new(paper_day(3));
    let error = play(&mut simulation, &mut Replay::new(Arc::new(short)), |_| ());
    let expected = PolicyError::TraceTooShort {
        rows: 10,
        time: simulation.next_decision().expect("the day goes on").time,
    };
    assert_eq!(error, Err(PlayError::NoAnswer(expected)));
}

/// Calls `ask` at every decision of a day that is played by greedy.
fn on_every_decision(day: &Arc<Scenario>, mut ask: impl FnMut(&Decision, &View<'_>)) {
    let mut simulation = Simulation::new(Arc::clone(day));
    while let Some(decision) = simulation.next_decision() {
        ask(&decision, &simulation.view());
        let choice = Greedy.choose(&decision, &simulation.view()).expect("greedy always answers");
        simulation.apply(choice).expect("a choice from the mask");
    }
}

#[test]
fn greedy_takes_the_highest_profit_per_hour() {
    let day = paper_day(11);
    on_every_decision(&day, |decision, view| {
        let rate = |to: VertiportIx| {
            if to == decision.at {
                return 0.0;
            }
            let pair = (decision.at, to);
            let miles = day.distance_mi[pair];
            let waiting = view.demand_left(view.period_at(decision.time), decision.at, to);
            let margin = day.fare_usd.in_period(0)[pair] - day.passenger_cost_usd[pair];
            let profit = f64::from(waiting.min(4)) * margin - 0.2 * 2.2 * miles;
            let hours = 0.5 + miles / 74.5 + 2.2 * miles / 150.0;
            profit / hours
        };
        let choice = Greedy.choose(decision, view).expect("greedy always answers");
        let best = view.feasible(decision).iter().map(rate).fold(f64::NEG_INFINITY, f64::max);
        // Rounding to whole seconds changes a rate by a few parts in ten thousand.
        assert!(rate(choice) >= best - 1e-3 * best.abs(), "{} is below {best}", rate(choice));
    });
}

#[test]
fn random_draws_evenly_from_the_mask() {
    let day = paper_day(5);
    let mut simulation = Simulation::new(day);
    let decision = simulation.next_decision().expect("a day begins");
    let view = simulation.view();
    let mask = view.feasible(&decision);
    let draws = 20_000;
    let mut counts = vec![0_u32; view.vertiports()];
    for seed in 0..draws {
        counts[Random::new(seed).choose(&decision, &view).expect("random always answers").at()] +=
            1;
    }
    let expected = draws as f64 / f64::from(mask.len());
    for vertiport in VertiportIx::all(view.vertiports()) {
        let count = f64::from(counts[vertiport.at()]);
        if mask.contains(vertiport) {
            // Five standard deviations of a binomial draw.
            assert!(
                (count - expected).abs() < 5.0 * expected.sqrt(),
                "{count} is not about {expected}"
            );
        } else {
            assert_eq!(count, 0.0);
        }
    }
}

#[test]
fn another_seed_or_another_day_draws_otherwise() {
    let profit =
        |policy_seed, day_seed| trace_of(&paper_day(day_seed), &mut Random::new(policy_seed)).1;
    assert_ne!(profit(1, 0), profit(2, 0));
    assert_ne!(profit(1, 0), profit(1, 1));
    assert_eq!(profit(1, 0), profit(1, 0));
}
