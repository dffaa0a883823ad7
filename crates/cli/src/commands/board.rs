//! `vertifleet board`: the methods behind result files, with their training runs as the unit.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{Outputs, Stop};
use vertifleet_report::folder;
use vertifleet_study::BoardReport;

use crate::args::BoardArguments;
use crate::commands::{claim_report, command};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &BoardArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let BoardArguments { results, presented } = arguments;
    let mut outputs = Outputs::new(presented.force);
    for path in results {
        outputs.reads(path);
    }
    claim_report(presented, &mut outputs)?;
    // Ctrl-C ends the program, so the verification needs no stop request.
    let summary = BoardReport::read(results, &Stop::default())?;
    let report = vertifleet_report::board(&summary, &command());
    print(&if presented.json { summary.to_json() } else { report.text() })?;
    if let Some(path) = &presented.report {
        let written = folder::write(&report, path, presented.force)?;
        if let Some(kept) = &written.kept {
            eprintln!("what was there before is now {}", kept.display());
        }
        eprintln!("report: {}", written.page.display());
    }
    Ok(ExitCode::SUCCESS)
}
