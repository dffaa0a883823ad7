//! `vertifleet evaluate`: plays suites and random networks, measures shares of their certified
//! bounds, and verifies results.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{Outputs, Stop, create_folder};
use vertifleet_progress::Bars;
use vertifleet_study::competitor::Selection;
use vertifleet_study::evaluation::{
    Evaluation, EvaluationRecords, EvaluationReport, RESULT, ResultFile, TrainingRun, check_runs,
    verify,
};
use vertifleet_study::{SUITES, Suite};

use crate::args::EvaluateArguments;
use crate::commands::{command, reads_models};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;

/// The name that stands for all suites.
const ALL: &str = "all";
/// The seed of the random policy and of the planner's search, the same for everyone.
const SEED: u64 = 1;

pub(crate) fn run(arguments: &EvaluateArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    if !arguments.verify.is_empty() {
        return verify_all(arguments);
    }
    // Ctrl-C ends the program, so the evaluation needs no stop request.
    let never = Stop::default();
    let suites = suites(&arguments.suite)?;
    let (policies, models) = (&arguments.policies, &arguments.models);
    let selection = Selection { policies, models, seed: SEED };
    let runs = runs(&arguments.methods);
    check_runs(&runs, &policies.iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut outputs = Outputs::new(arguments.force);
    reads_models(models.iter().map(|(_, model)| model), &mut outputs);
    // Everything is checked before the first day is played.
    let evaluations = suites
        .iter()
        .map(|suite| Evaluation::new(suite.clone(), &selection, &never))
        .collect::<Result<Vec<_>, _>>()?;
    if let Some(folder) = &arguments.results {
        create_folder(folder)?;
        for (suite, policy) in pairs(&suites, policies) {
            outputs.writes(&folder.join(ResultFile::file_name(&suite.name, policy)), &RESULT)?;
        }
    }
    let mut records = Vec::new();
    for (suite, evaluation) in suites.iter().zip(evaluations) {
        eprintln!("{}: {}", suite.name, suite.description);
        let played = evaluation.run(command(), &never, &Bars)?;
        if let Some(folder) = &arguments.results {
            write_results(&played, folder, &arguments.about, &runs)?;
        }
        records.push(played);
    }
    let report = EvaluationReport::of(&records)?;
    print(&if arguments.json {
        report.to_json()
    } else {
        vertifleet_report::evaluation(&report).text()
    })?;
    Ok(ExitCode::SUCCESS)
}

fn suites(names: &[String]) -> Result<Vec<Suite>, Failure> {
    if names.iter().any(|name| name == ALL) {
        return Ok(SUITES.to_vec());
    }
    let mut suites: Vec<Suite> = Vec::new();
    for name in names {
        let suite = Suite::find(name)?;
        // A suite that is named twice is played once.
        if !suites.contains(&suite) {
            suites.push(suite);
        }
    }
    Ok(suites)
}

fn pairs<'a>(
    suites: &'a [Suite],
    policies: &'a [String],
) -> impl Iterator<Item = (&'a Suite, &'a String)> {
    suites.iter().flat_map(move |suite| policies.iter().map(move |policy| (suite, policy)))
}

fn write_results(
    records: &EvaluationRecords,
    folder: &Path,
    about: &[(String, String)],
    runs: &BTreeMap<String, TrainingRun>,
) -> Result<(), Failure> {
    let about: BTreeMap<String, String> = about.iter().cloned().collect();
    for result in records.results(&about, runs)? {
        let path = folder.join(ResultFile::file_name(&result.suite, &result.policy.name));
        result.write(&path)?;
        eprintln!("result: {}", path.display());
    }
    Ok(())
}

/// The training runs of policies with methods; their seeds are those of the weights.
fn runs(methods: &[(String, String)]) -> BTreeMap<String, TrainingRun> {
    let run = |method: &String| TrainingRun { method: method.clone(), training_seed: None };
    methods.iter().map(|(policy, method)| (policy.clone(), run(method))).collect()
}

/// Verifies every file; the exit code is 1 if a claim does not hold.
fn verify_all(arguments: &EvaluateArguments) -> Result<ExitCode, Failure> {
    let (mut verified, mut unreadable) = (Vec::new(), None);
    for path in &arguments.verify {
        let verdict = ResultFile::read(path).and_then(|result| verify(&result, &Stop::default()));
        match verdict {
            Ok(verification) => {
                if !arguments.json {
                    print(&verification.to_string())?;
                }
                verified.push(verification);
            }
            // The other files are still verified.
            Err(error) => unreadable = Some(Failure::from(error).report()),
        }
    }
    if arguments.json {
        print(&serde_json::to_string_pretty(&verified).expect("a verification is plain data"))?;
    }
    let valid = verified.iter().all(|verification| verification.valid);
    let verdict = if valid { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    Ok(unreadable.unwrap_or(verdict))
}
