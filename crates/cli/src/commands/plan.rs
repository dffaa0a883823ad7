//! `vertifleet plan`: searches for the best schedule of a known day, while the proof of an upper
//! bound runs in parallel.

use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;
use serde_json::{Map, Value};
use vertifleet_core::{Outputs, Scenario};
use vertifleet_optimize::{Bound, Budget, Plan, ProvenPlan, SearchSettings, plan_in_time};
use vertifleet_progress::SearchBar;
use vertifleet_sim::Trace;
use vertifleet_study::starting_policies;

use crate::args::PlanArguments;
use crate::commands::read_scenario;
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;
use crate::shadow_prices::{self, PassengerShadowPrice};

pub(crate) fn run(arguments: &PlanArguments) -> Result<ExitCode, Failure> {
    let scenario = Arc::new(read_scenario(&arguments.scenario)?);
    let mut outputs = Outputs::new(arguments.force);
    outputs.reads(&arguments.scenario);
    outputs.prints();
    outputs.writes(&arguments.output, &Trace::FILE)?;
    let stop = stop_on_interrupt()?;
    let begun = Instant::now();
    let settings = SearchSettings {
        budget: Budget::Time(arguments.time_limit),
        searches: rayon::current_num_threads(),
        seed: arguments.seed,
    };
    let mut bar = SearchBar::new("% of the time", Some(arguments.time_limit));
    let starts = starting_policies(&scenario);
    let ProvenPlan { plan, bound } =
        plan_in_time(&scenario, &settings, starts, arguments.gap, &stop, &mut |now, bound| {
            bar.show(now, bound);
        })?;
    drop(bar);
    let (bound, seconds) = (bound.as_ref(), begun.elapsed().as_secs_f64());
    plan.trace.write(&scenario, &arguments.output)?;
    if arguments.json {
        let numbers = Numbers::of(&scenario, &plan, bound, seconds);
        print(&serde_json::to_string_pretty(&numbers).expect("numbers are plain data"))?;
    } else {
        print(&text(&scenario, &plan, bound, seconds))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The output of `--json`.
#[derive(Serialize)]
struct Numbers<'a> {
    profit_usd: f64,
    operating_profit_usd: f64,
    best_policy: &'a str,
    best_policy_usd: f64,
    upper_bound_usd: Option<f64>,
    gap: Option<f64>,
    step_s: Option<u32>,
    bound_is_final: Option<bool>,
    seconds: f64,
    steps: u64,
    stand_shadow_price_usd: Option<Map<String, Value>>,
    passenger_shadow_price_usd: Option<Vec<PassengerShadowPrice<'a>>>,
}

impl<'a> Numbers<'a> {
    fn of(scenario: &'a Scenario, plan: &'a Plan, bound: Option<&Bound>, seconds: f64) -> Self {
        Self {
            profit_usd: plan.profit_usd,
            operating_profit_usd: plan.profit_usd + scenario.fixed_cost_usd(),
            best_policy: &plan.best_policy,
            best_policy_usd: plan.best_policy_usd,
            upper_bound_usd: bound.map(Bound::upper_bound_usd),
            gap: bound.map(|bound| bound.gap(plan.profit_usd)),
            step_s: bound.map(Bound::step_s),
            bound_is_final: bound.map(Bound::is_final),
            seconds,
            steps: plan.steps,
            stand_shadow_price_usd: bound.map(|bound| shadow_prices::of_stands(scenario, bound)),
            passenger_shadow_price_usd: bound
                .map(|bound| shadow_prices::of_passengers(scenario, bound)),
        }
    }
}

fn text(scenario: &Scenario, plan: &Plan, bound: Option<&Bound>, seconds: f64) -> String {
    let mut lines = vec![
        format!("{} planned in {seconds:.1} s", scenario.name),
        format!("  profit          {:>12.2} $", plan.profit_usd),
        format!(
            "  best policy     {:>12.2} $    {}, of those whose day was played in time",
            plan.best_policy_usd, plan.best_policy
        ),
    ];
    let Some(bound) = bound else {
        lines.push(
            "  upper bound     none: the day is too large for one, or the time was too short"
                .to_owned(),
        );
        return lines.join("\n");
    };
    let gap_percent = 100.0 * bound.gap(plan.profit_usd);
    let (bound_usd, step_min) = (bound.upper_bound_usd(), bound.step_s() / 60);
    let fixed_usd = scenario.fixed_cost_usd();
    let share = match (bound_usd + fixed_usd > 0.0, fixed_usd > 0.0) {
        (true, false) => "of the bound",
        (true, true) => "of the bound before the costs of aircraft and sites",
        (false, _) => "of the loss",
    };
    let longer = if bound.is_final() { "" } else { "; a longer search may lower it" };
    lines.push(format!(
        "  upper bound     {bound_usd:>12.2} $    no schedule earns more (slices of {step_min} min{longer})"
    ));
    lines.push(format!(
        "  gap             {gap_percent:>12.2} %    {share}: no schedule is further ahead of this one"
    ));
    lines.extend(shadow_prices::lines(scenario, bound));
    lines.join("\n")
}
