//! `vertifleet check`: checks a schedule against the rules.

use std::process::ExitCode;

use vertifleet_sim::{Trace, check::check};

use crate::args::CheckArguments;
use crate::commands::read_scenario;
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &CheckArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let scenario = read_scenario(&arguments.scenario)?;
    let trace = Trace::read(&arguments.trace, &scenario)?;
    let report = check(&scenario, &trace);
    if arguments.json {
        print(&serde_json::to_string_pretty(&report).expect("a report is plain data"))?;
    } else {
        print(&report.to_string())?;
    }
    Ok(if report.is_valid() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
