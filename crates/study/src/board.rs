//! A board: the methods behind result files, with their training runs as the unit, suite by suite.
//!
//! Each file is one run of a method on a suite. All files are verified first, and the statistics
//! are of the shares that verification finds. The measures are those of R. Agarwal and others,
//! *Deep Reinforcement Learning at the Edge of the Statistical Precipice*, NeurIPS 2021, and of
//! their library rliable, with a run as a run and a day as a task.

mod bootstrap;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::PathBuf;

use serde::Serialize;
use vertifleet_core::Stop;

use crate::error::Error;
use crate::evaluation::{ResultFile, can_be_drawn, verify_on};
use crate::own_days::files;
use crate::sees::Sees;
use crate::statistics::mean;
use crate::suite::{SUITES, Suite, SuiteDay};
use bootstrap::Shares;

pub use bootstrap::{Interval, PROFILE_SAMPLES, SAMPLES};

/// Name and version of the format of `vertifleet board --json`.
pub const FORMAT: &str = "vertifleet-board/1";

/// Number of thresholds of a performance profile between two whole shares, 0 and 1.
const THRESHOLDS: u32 = 200;

/// The board of some result files.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BoardReport {
    /// Always [`FORMAT`].
    pub format: &'static str,
    /// Version of the program.
    pub program_version: &'static str,
    /// The suites, in the order of the program's.
    pub suites: Vec<SuiteBoard>,
}

/// The methods on one suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuiteBoard {
    /// The name of the suite.
    pub suite: String,
    /// Describes its days.
    pub description: String,
    /// Number of its days.
    pub days: usize,
    /// The length of the slices of its bounds, in seconds.
    pub bound_step_s: u32,
    /// The shares of the bound at which performance profiles are measured.
    pub thresholds: Vec<f64>,
    /// The methods, by information class and then by share, highest first.
    pub methods: Vec<MethodSummary>,
}

/// A method: all of its training runs, or a policy that was not trained.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodSummary {
    /// Its name.
    pub method: String,
    /// What it looks at when it decides.
    pub sees: Sees,
    /// Its runs, by seed.
    pub runs: Vec<RunSummary>,
    /// The mean share of the bound over runs and days.
    pub bound_share: Interval,
    /// The mean of the middle half of the shares of all runs and days.
    pub interquartile_mean: Interval,
    /// The interval of the interquartile mean as rliable computes it: the runs of each day are
    /// drawn separately, and the days are fixed. `None` with one run.
    pub interquartile_mean_by_day_95: Option<(f64, f64)>,
    /// 1 - `bound_share`.
    pub optimality_gap: Interval,
    /// The lowest share of all runs and days.
    pub lowest_bound_share: f64,
    /// The performance profile: the share of runs and days that lie above each threshold.
    pub profile: Vec<Interval>,
}

/// One training run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunSummary {
    /// The path of its result file.
    pub file: String,
    /// The name of the policy in the file.
    pub policy: String,
    /// The seed of the run, if it is known.
    pub training_seed: Option<u64>,
    /// SHA-256 of its weight file, if it has one.
    pub weights_sha256: Option<String>,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// The mean share of the bound over the days.
    pub bound_share: f64,
}

/// A verified result, with the share of each day.
struct Verified {
    method: String,
    sees: Sees,
    run: RunSummary,
    shares: Vec<f64>,
}

impl BoardReport {
    /// Reads and verifies result files. A folder stands for all of its files whose names end in
    /// `.json`.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read or is not a result, [`Error::NotVerified`] if a
    /// claim does not hold, [`Error::ResultsDiffer`] if the results do not go together, and
    /// [`Error::Stopped`] soon after `stop` is requested.
    pub fn read(paths: &[PathBuf], stop: &Stop) -> Result<Self, Error> {
        let read = |path: &PathBuf| Ok((path.display().to_string(), ResultFile::read(path)?));
        Self::of(files(paths)?.iter().map(read).collect::<Result<_, Error>>()?, stop)
    }

    /// Verifies results, each with the name of its file.
    ///
    /// # Errors
    /// The same as those of [`read`](Self::read).
    pub fn of(results: Vec<(String, ResultFile)>, stop: &Stop) -> Result<Self, Error> {
        if results.is_empty() {
            return Err(Error::ResultsDiffer { rule: "there is none".to_owned() });
        }
        let mut days: HashMap<String, Vec<SuiteDay>> = HashMap::new();
        let mut suites: BTreeMap<(usize, String), (Suite, Vec<Verified>)> = BTreeMap::new();
        for (origin, result) in results {
            let suite = Suite::find(&result.suite)?;
            if can_be_drawn(&result, &suite) && !days.contains_key(&result.suite) {
                days.insert(result.suite.clone(), suite.draw_with_bounds(stop)?);
            }
            let drawn = days.get(&result.suite).map_or(&[][..], Vec::as_slice);
            let (verification, shares) = verify_on(&result, &suite, drawn);
            if let Some(finding) = verification.findings.first() {
                let verdict = format!("this result is not verified: {finding}");
                return Err(Error::NotVerified { origin, verdict });
            }
            let position = SUITES.iter().position(|known| *known == suite);
            let key = (position.unwrap_or(SUITES.len()), result.suite.clone());
            let entry = suites.entry(key).or_insert_with(|| (suite, Vec::new()));
            entry.1.push(verified(origin, result, shares));
        }
        let suites = suites.into_values().map(|(suite, results)| SuiteBoard::of(&suite, results));
        Ok(Self {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION"),
            suites: suites.collect::<Result<_, _>>()?,
        })
    }

    /// The board as indented JSON.
    ///
    /// # Panics
    /// Never panics: numbers and texts can always be written.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers and texts can always be written")
    }
}

/// A file without a run is of a method with the name of its policy.
fn verified(file: String, result: ResultFile, shares: Vec<f64>) -> Verified {
    let policy = result.policy;
    let (method, training_seed) = match result.run {
        Some(run) => (run.method, run.training_seed),
        None => (policy.name.clone(), None),
    };
    let run = RunSummary {
        file,
        policy: policy.name,
        training_seed,
        weights_sha256: policy.weights_sha256,
        program_version: result.program_version,
        bound_share: mean(&shares),
    };
    Verified { method, sees: policy.sees, run, shares }
}

impl SuiteBoard {
    fn of(suite: &Suite, results: Vec<Verified>) -> Result<Self, Error> {
        let lowest = results.iter().flat_map(|result| &result.shares).copied().fold(1.0, f64::min);
        let thresholds = thresholds(lowest);
        let mut methods: BTreeMap<String, Vec<Verified>> = BTreeMap::new();
        for result in results {
            methods.entry(result.method.clone()).or_default().push(result);
        }
        let summary = |(method, runs)| MethodSummary::of(method, runs, suite, &thresholds);
        let mut methods: Vec<MethodSummary> =
            methods.into_iter().map(summary).collect::<Result<_, _>>()?;
        methods.sort_by(|a, b| {
            let share = |method: &MethodSummary| method.bound_share.estimate;
            a.sees.cmp(&b.sees).then_with(|| share(b).total_cmp(&share(a)))
        });
        Ok(Self {
            suite: suite.name.to_string(),
            description: suite.description.to_string(),
            days: suite.days,
            bound_step_s: 60 * suite.step_minutes,
            thresholds,
            methods,
        })
    }
}

/// Thresholds from the whole percent below the lowest share, but at least 0, up to 1.
fn thresholds(lowest: f64) -> Vec<f64> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 <= lowest <= 1")]
    let first = (lowest.clamp(0.0, 1.0) * 100.0).floor() as u32 * (THRESHOLDS / 100);
    (first..=THRESHOLDS).map(|step| f64::from(step) / f64::from(THRESHOLDS)).collect()
}

impl MethodSummary {
    fn of(
        method: String,
        mut runs: Vec<Verified>,
        suite: &Suite,
        thresholds: &[f64],
    ) -> Result<Self, Error> {
        runs.sort_by(|a, b| {
            (a.run.training_seed, &a.run.file).cmp(&(b.run.training_seed, &b.run.file))
        });
        check_runs_differ(&method, &suite.name, &runs)?;
        let sees = runs[0].sees;
        let (runs, shares) = runs.into_iter().map(|one| (one.run, one.shares)).unzip();
        let shares = Shares { runs: shares, strata: suite.strata() };
        let statistics = shares.statistics(thresholds);
        let bound_share = statistics.mean;
        let (low, high) = bound_share.interval_95;
        Ok(Self {
            method,
            sees,
            runs,
            bound_share,
            interquartile_mean: statistics.interquartile_mean,
            interquartile_mean_by_day_95: statistics.interquartile_mean_by_day_95,
            optimality_gap: Interval {
                estimate: 1.0 - bound_share.estimate,
                interval_95: (1.0 - high, 1.0 - low),
            },
            lowest_bound_share: statistics.lowest,
            profile: statistics.profile,
        })
    }

    /// The lowest and the highest mean share of a run.
    pub fn range_of_runs(&self) -> (f64, f64) {
        let means = self.runs.iter().map(|run| run.bound_share);
        means.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), share| {
            (low.min(share), high.max(share))
        })
    }
}

/// Checks that runs of a method have different seeds and weights, and see the same.
fn check_runs_differ(method: &str, suite: &str, runs: &[Verified]) -> Result<(), Error> {
    let (mut seeds, mut weights) = (BTreeSet::new(), BTreeSet::new());
    for Verified { sees, run, .. } in runs {
        let is_new = seeds.insert(run.training_seed)
            && run.weights_sha256.as_ref().is_none_or(|hash| weights.insert(hash));
        let file = &run.file;
        if !is_new {
            let rule = format!(
                "{file}: another result on {suite} is of the same training run of {method:?}"
            );
            return Err(Error::ResultsDiffer { rule });
        }
        if *sees != runs[0].sees {
            let (first, first_sees) = (&runs[0].run.file, runs[0].sees);
            let rule = format!(
                "{file}: this run of {method:?} sees the {sees}, that of {first} sees the {first_sees}"
            );
            return Err(Error::ResultsDiffer { rule });
        }
    }
    Ok(())
}
