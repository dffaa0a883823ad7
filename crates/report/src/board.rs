//! The report of a board: a table and a figure for each suite.

use vertifleet_picture::numbers::{counted, grouped, minutes};
use vertifleet_study::BoardReport;
use vertifleet_study::board::{Interval, MethodSummary, PROFILE_SAMPLES, SAMPLES, SuiteBoard};

use crate::comparison::{NONE, SEES};
use crate::figure;
use crate::report::{DataFile, Files, Place, Report, Section, Table};

/// The report of a board, as a folder; `command` is the command line that made it.
pub fn board<'a>(report: &'a BoardReport, command: &str) -> Report<'a> {
    let mut sections: Vec<Section> = report.suites.iter().map(of_suite).collect();
    sections.push(Section { place: Place::Page, ..files(report) });
    if let Some(last) = sections.iter_mut().rfind(|section| section.place == Place::Everywhere) {
        last.notes.extend(how_to_read());
    }
    let json = || (report.to_json() + "\n").into_bytes();
    let methods = report.suites.iter().flat_map(|suite| &suite.methods);
    let runs: usize = methods.map(|method| method.runs.len()).sum();
    Report {
        title: "Vertifleet board".to_owned(),
        subject: "methods on frozen suites",
        heading: "Board".to_owned(),
        headline: format!(
            "{} on {}, all verified: the choices in each file were played again and judged by the checker.",
            counted(runs, "result", "results"),
            counted(report.suites.len(), "suite", "suites"),
        ),
        command: command.to_owned(),
        sections,
        closing: vec![
            "A verified result does not prove which policy decided and what it saw. For these, and for the seeds of training, the \
             reader has the word of the authors."
                .to_owned(),
        ],
        files: Files::Beside(vec![
            DataFile::new("board.md", "this page in Markdown", || {
                board(report, "").markdown().into_bytes()
            }),
            DataFile::new("summary.json", "all numbers of this page", json),
        ]),
        ..Report::default()
    }
}

fn how_to_read() -> Vec<String> {
    vec![
        format!(
            "in brackets: 95 % intervals over training runs and days ({} bootstrap samples; runs and days are drawn with \
             replacement, the same days for all runs, within each network); with one run they are over days only",
            grouped(f64::from(SAMPLES), 0)
        ),
        "of bound: mean share of the certified bound; 100 % less this is the optimality gap"
            .to_owned(),
        "IQM: interquartile mean, the mean of the middle half of all runs and days".to_owned(),
        "runs from, to: the lowest and the highest mean of a training run".to_owned(),
        SEES.to_owned(),
    ]
}

fn of_suite(board: &SuiteBoard) -> Section {
    let columns =
        ["method", "sees", "runs", "of bound, %", "IQM, %", "runs from, to, %", "lowest day, %"];
    let table = Table::new(columns).with_rows(board.methods.iter().map(row));
    let title = format!(
        "{}: {}, bounds with slices of {}",
        board.suite,
        board.description,
        minutes(board.bound_step_s)
    );
    Section { figures: vec![figure::of_board(board)], ..Section::of_table(title, table) }
}

fn row(method: &MethodSummary) -> Vec<String> {
    let (lowest, highest) = method.range_of_runs();
    let range = format!("{} to {}", percent(lowest), percent(highest));
    vec![
        method.method.clone(),
        method.sees.to_string(),
        method.runs.len().to_string(),
        interval(&method.bound_share),
        interval(&method.interquartile_mean),
        if method.runs.len() > 1 { range } else { NONE.to_owned() },
        percent(method.lowest_bound_share),
    ]
}

/// A row for each file.
fn files(report: &BoardReport) -> Section {
    let rows = report.suites.iter().flat_map(|suite| {
        suite.methods.iter().flat_map(|method| {
            method.runs.iter().map(|run| {
                let seed = run.training_seed.map_or(NONE.to_owned(), |seed| seed.to_string());
                let weights = run.weights_sha256.as_ref().map_or(NONE, |hash| &hash[..12]);
                vec![
                    run.file.clone(),
                    method.method.clone(),
                    seed,
                    percent(run.bound_share),
                    weights.to_owned(),
                    run.program_version.clone(),
                ]
            })
        })
    });
    let columns = ["file", "method", "training seed", "of bound, %", "weights", "version"];
    let profiles = grouped(f64::from(PROFILE_SAMPLES), 0);
    Section::of_table("Result files", Table::new(columns).with_rows(rows))
        .with_note("weights: the first digits of the SHA-256 of the weight file")
        .with_note(format!("the bands of the figures are of {profiles} bootstrap samples"))
}

fn interval(interval: &Interval) -> String {
    let (low, high) = interval.interval_95;
    format!("{} ({} to {})", percent(interval.estimate), percent(low), percent(high))
}

fn percent(share: f64) -> String {
    grouped(100.0 * share, 2)
}
