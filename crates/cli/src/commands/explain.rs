//! `vertifleet explain`: breaks a day's profit down, and prices one more stand, aircraft or seat.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::OnceLock;

use anstream::eprintln;
use vertifleet_core::{Code, Outputs, Stop, write_atomically};
use vertifleet_optimize::Step;
use vertifleet_progress::Bar;
use vertifleet_report::EXPLANATION_PAGE;
use vertifleet_study::explain::explain;
use vertifleet_study::{PolicySpec, ResolveFor};

use crate::args::ExplainArguments;
use crate::commands::{read_scenario, reads_policy};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};

pub(crate) fn run(arguments: &ExplainArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let scenario = Arc::new(read_scenario(&arguments.scenario)?);
    let spec = PolicySpec::parse(&arguments.policy)?;
    let days = ResolveFor::Day(&scenario);
    let policy = spec.resolve(arguments.model.as_ref(), days, arguments.seed)?;
    policy.check_fits(&scenario)?;
    let mut outputs = Outputs::new(arguments.force);
    outputs.reads(&arguments.scenario);
    reads_policy(&spec, arguments.model.as_ref(), &mut outputs);
    outputs.prints();
    if let Some(page) = &arguments.report {
        outputs.writes(page, &EXPLANATION_PAGE)?;
    }
    if let Some(warning) = policy.warning_for(spec.name(), &scenario) {
        warn(Code(310), &warning);
    }
    let step = Step::from_minutes(arguments.step)?;
    let bar = OnceLock::new();
    // Ctrl-C ends the program, so the work needs no stop request.
    let explanation =
        explain(&scenario, spec.name(), &policy, step, &Stop::default(), &|changes| {
            let bar: &Bar = bar.get_or_init(|| Bar::new(changes as u64, "changes"));
            if changes == 0 {
                bar.advance(1);
            }
        })?;
    drop(bar);
    let replayed = [explanation.account.replayed()];
    let report = vertifleet_report::explanation(&explanation, &replayed);
    if let Some(page) = &arguments.report {
        write_atomically(page, report.page().as_bytes())?;
        eprintln!("report: {}", page.display());
    }
    print(&if arguments.json { explanation.to_json() } else { report.text() })?;
    Ok(ExitCode::SUCCESS)
}
