//! The `vertifleet` program: arguments and glue, without logic.
//!
//! Numbers go to stdout, messages for people to stderr. Exit code 0: done; 1: failed, or `check`
//! found a broken rule; 2: wrong usage or bad input.

mod args;
mod commands;
mod failure;
mod file_limit;
mod interrupt;
mod mean_shadow_prices;
mod output;
mod shadow_prices;
mod typed;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = file_limit::survive()
        .and_then(|()| limit_threads(arguments.threads))
        .and_then(|()| run(arguments.command));
    match outcome {
        Ok(code) => code,
        Err(failure) => failure.report(),
    }
}

fn run(command: Command) -> Result<ExitCode, failure::Failure> {
    match command {
        Command::Network(action) => commands::network::run(&action),
        Command::Scenario(arguments) => commands::scenario::run(&arguments),
        Command::Simulate(arguments) => commands::simulate::run(&arguments),
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Bound(arguments) => commands::bound::run(&arguments),
        Command::Plan(arguments) => commands::plan::run(&arguments),
        Command::Train(arguments) => commands::train::run(&arguments),
        Command::Compare(arguments) => commands::compare::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
        Command::Export(arguments) => commands::export::run(&arguments),
        Command::Sweep(arguments) => commands::sweep::run(&arguments),
        Command::Size(arguments) => commands::size::run(&arguments),
        Command::Evaluate(arguments) => commands::evaluate::run(&arguments),
        Command::Board(arguments) => commands::board::run(&arguments),
        #[cfg(feature = "service")]
        Command::Serve(arguments) => commands::serve::run(&arguments),
        #[cfg(feature = "service")]
        Command::Operate(arguments) => commands::operate::run(&arguments),
        #[cfg(not(feature = "service"))]
        Command::Serve { .. } => Err(failure::Failure::usage(
            "this build has no dispatch service".to_owned(),
            "`make program` builds all of the program",
        )),
    }
}

/// Limits the number of threads of all later work. Without `--threads`, it is `RAYON_NUM_THREADS`
/// or the number of cores.
fn limit_threads(threads: Option<usize>) -> Result<(), failure::Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| failure::Failure::internal(&error))
}
