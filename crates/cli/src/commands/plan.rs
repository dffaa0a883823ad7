//! `vertifleet plan`: finds the best schedule it can for a known day, while a proof of what is possible runs beside it.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use vertifleet_core::Scenario;
use vertifleet_optimize::{Bound, Budget, Error, Plan, Proof, Settings, plan};
use vertifleet_progress::SearchBar;

use crate::args::PlanArguments;
use crate::commands::read_scenario;
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;
use crate::worth;

/// How often somebody who waits for the bound looks up.
const GLANCE: Duration = Duration::from_millis(50);

pub(crate) fn run(arguments: &PlanArguments) -> Result<ExitCode, Failure> {
    let scenario = Arc::new(read_scenario(&arguments.scenario)?);
    let stop = stop_on_interrupt()?;
    let begun = Instant::now();
    let mut proof = Proof::begin(&scenario);
    let plan = search(arguments, &scenario, &stop, &mut proof)?;
    let seconds = begun.elapsed().as_secs_f64();
    // The schedule first: it is worth having whatever becomes of the bound.
    plan.trace.write(&scenario, &arguments.output)?;
    while !proof.wait(GLANCE) && !stop.load(Ordering::Relaxed) {}
    let bound = proof.outcome()?;
    if arguments.json {
        let numbers = numbers(&scenario, &plan, bound.as_ref(), seconds);
        print(&serde_json::to_string_pretty(&numbers).expect("numbers are plain data"))?;
    } else {
        print(&text(&scenario, &plan, bound.as_ref(), seconds))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Searches until the time is over, the gap is small enough or somebody presses Ctrl-C.
fn search(
    arguments: &PlanArguments,
    scenario: &Arc<Scenario>,
    stop: &AtomicBool,
    proof: &mut Proof,
) -> Result<Plan, Error> {
    let settings = Settings {
        budget: Budget::Time(arguments.time_limit),
        searches: rayon::current_num_threads(),
        seed: arguments.seed,
    };
    let mut bar = SearchBar::new("% of the time");
    plan(scenario, &settings, &mut |now| {
        proof.wait(Duration::ZERO);
        let bound = proof.bound();
        bar.show(now, bound);
        let gap = bound.map(|bound| bound.gap(now.profit_usd));
        let good_enough = arguments.gap.zip(gap).is_some_and(|(asked, gap)| gap <= asked);
        !good_enough && !stop.load(Ordering::Relaxed)
    })
}

fn numbers(scenario: &Scenario, plan: &Plan, bound: Option<&Bound>, seconds: f64) -> Value {
    json!({
        "profit": plan.profit_usd,
        "best_policy": plan.best_policy_usd,
        "upper_bound": bound.map(Bound::upper_bound_usd),
        "gap": bound.map(|bound| bound.gap(plan.profit_usd)),
        "step_s": bound.map(Bound::step_s),
        "seconds": seconds,
        "steps": plan.steps,
        "stand_worth": bound.map(|bound| worth::of_stands(scenario, bound)),
        "passenger_worth": bound.map(|bound| worth::of_passengers(scenario, bound)),
    })
}

fn text(scenario: &Scenario, plan: &Plan, bound: Option<&Bound>, seconds: f64) -> String {
    let mut lines = vec![
        format!("{} planned in {seconds:.1} s", scenario.name),
        format!("  profit          {:>12.2} $", plan.profit_usd),
        format!("  best policy     {:>12.2} $    where the search began", plan.best_policy_usd),
    ];
    let Some(bound) = bound else {
        lines.push("  upper bound     not known: stopped before it was proven".to_owned());
        return lines.join("\n");
    };
    let gap_percent = 100.0 * bound.gap(plan.profit_usd);
    let (bound_usd, step_min) = (bound.upper_bound_usd(), bound.step_s() / 60);
    lines.push(format!(
        "  upper bound     {bound_usd:>12.2} $    no schedule earns more (steps of {step_min} min)"
    ));
    lines.push(format!(
        "  gap             {gap_percent:>12.2} %    of the bound: the best schedule is at most so far ahead"
    ));
    lines.extend(worth::lines(scenario, bound));
    lines.join("\n")
}
