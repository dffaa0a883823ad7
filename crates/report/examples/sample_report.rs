//! Writes a report of made-up results, to show the page and the figures without a simulation.
//!
//! `cargo run -p vertifleet-report --example sample_report -- FOLDER`

use std::path::Path;
use std::process::ExitCode;
use vertifleet_core::Coded;
use vertifleet_study::ComparisonReport;

#[path = "../tests/report/made_up.rs"]
mod made_up;

fn main() -> ExitCode {
    let Some(folder) = std::env::args().nth(1) else {
        eprintln!("usage: sample_report FOLDER");
        return ExitCode::from(2);
    };
    let study = made_up::study(100);
    let summary = ComparisonReport::of(&study).expect("made-up results are sound");
    let report = vertifleet_report::comparison_folder(&summary, &study);
    match vertifleet_report::folder::write(&report, Path::new(&folder), false) {
        Ok(paths) => {
            println!("{}", paths.page.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error[{}]: {error}", error.code());
            ExitCode::FAILURE
        }
    }
}
