//! `vertifleet bound`: proves how much a known day can earn at most.

use std::process::ExitCode;
use std::time::Instant;

use serde_json::json;
use vertifleet_optimize::{Step, upper_bound};

use crate::args::BoundArguments;
use crate::commands::read_scenario;
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;
use crate::worth;

pub(crate) fn run(arguments: &BoundArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let step = Step::from_minutes(arguments.step)?;
    let scenario = read_scenario(&arguments.scenario)?;
    let begun = Instant::now();
    let bound = upper_bound(&scenario, step)?;
    let seconds = begun.elapsed().as_secs_f64();
    if arguments.json {
        let numbers = json!({
            "upper_bound": bound.upper_bound_usd(),
            "step_s": bound.step_s(),
            "seconds": seconds,
            "stand_worth": worth::of_stands(&scenario, &bound),
            "passenger_worth": worth::of_passengers(&scenario, &bound),
        });
        print(&serde_json::to_string_pretty(&numbers).expect("numbers are plain data"))?;
    } else {
        let mut lines = vec![
            format!("{} bounded in {seconds:.1} s", scenario.name),
            format!(
                "  upper bound     {:>12.2} $    no schedule earns more (steps of {} min)",
                bound.upper_bound_usd(),
                arguments.step
            ),
        ];
        lines.extend(worth::lines(&scenario, &bound));
        print(&lines.join("\n"))?;
    }
    Ok(ExitCode::SUCCESS)
}
