//! The result file of one policy on one suite: what is claimed, and every choice, from which it can
//! be verified.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use serde::{Deserialize, Serialize};
use vertifleet_core::{OutputKind, VertiportIx, read_at_most, write_atomically};

use super::EvaluationRecords;
use crate::error::Error;
use crate::record::{DayRecord, LatencySummary, PolicyRecord, mean_profit_usd};
use crate::sees::Sees;
use crate::share::{PolicyShare, share};
use crate::statistics::Estimate;

/// Name and version of the format of result files.
pub const RESULT_FORMAT: &str = "vertifleet-result/1";

/// Result files as a kind of output, to tell them from files that must not be replaced.
pub const RESULT: OutputKind =
    OutputKind { name: "result", skipped: 0, opening: "{\n  \"format\": \"vertifleet-result/" };

/// No file that this program writes is longer.
const LONGEST: u64 = 256 << 20;

/// The result of one policy on one suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResultFile {
    /// Always [`RESULT_FORMAT`].
    pub format: String,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// The command line of the evaluation.
    pub command: String,
    /// The name of the suite.
    pub suite: String,
    /// The policy.
    pub policy: ResultPolicy,
    /// The training run that made the policy; `None` for a policy that was not trained, and in
    /// files of programs that did not write it. This cannot be verified from choices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run: Option<TrainingRun>,
    /// What the authors say about it, which cannot be verified: days and seeds of training,
    /// training budget, code.
    pub about: BTreeMap<String, String>,
    /// Profit as a share of the day's upper bound.
    pub bound_share: Estimate,
    /// The share of the upper bound on the day where it is lowest.
    pub lowest_bound_share: f64,
    /// Profit of a day, in dollars.
    pub profit_usd: Estimate,
    /// Every day of the suite, in its order.
    pub days: Vec<ResultDay>,
}

/// The policy of a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResultPolicy {
    /// Its name.
    pub name: String,
    /// Describes what it does.
    pub description: String,
    /// What it looks at when it decides. This cannot be verified from choices.
    pub sees: Sees,
    /// SHA-256 of its weight file, by which a reader finds the weights that played; `None` for a
    /// policy that has no weights, or weights of another program. This cannot be verified from
    /// choices either.
    // With `deserialize_with`, serde rejects a result without this member, as the schema does.
    #[serde(deserialize_with = "Option::deserialize")]
    pub weights_sha256: Option<String>,
    /// The time that one decision took on the machine of the evaluation; `None` for a reference
    /// that plans whole days.
    #[serde(deserialize_with = "Option::deserialize")]
    pub decision_ns: Option<LatencySummary>,
}

/// One of the training runs of a method. Runs of one method differ in their seeds alone.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainingRun {
    /// The name of the method.
    pub method: String,
    /// The seed of the run; `None` if it is not known.
    #[serde(deserialize_with = "Option::deserialize")]
    pub training_seed: Option<u64>,
}

/// A day of a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResultDay {
    /// The name of the day.
    pub day: String,
    /// The hash of the day.
    pub hash: String,
    /// The upper bound of its profit, in dollars.
    pub upper_bound_usd: f64,
    /// The profit, in dollars.
    pub profit_usd: f64,
    /// The positions of the vertiports that were chosen, decision by decision, from 0, with blanks
    /// between them. A choice of the vertiport where the aircraft stands is a hold.
    pub choices: String,
}

impl EvaluationRecords {
    /// The result of every policy. `about` is what the authors say about them, and `runs` has the
    /// training runs that made them, by the name of the policy. The run of a policy that is not
    /// among them is of a method with the policy's name, if its weights have a seed.
    ///
    /// # Errors
    /// Returns [`Error::Asked`] if weights have another seed than the run.
    pub fn results(
        &self,
        about: &BTreeMap<String, String>,
        runs: &BTreeMap<String, TrainingRun>,
    ) -> Result<Vec<ResultFile>, Error> {
        let shares = PolicyShare::of_all(&self.policies);
        let runs: Vec<Option<TrainingRun>> =
            self.policies.iter().map(|policy| run_of(policy, runs)).collect::<Result<_, _>>()?;
        let result = |((policy, share), run): ((&PolicyRecord, PolicyShare), _)| ResultFile {
            format: RESULT_FORMAT.to_owned(),
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            command: self.command.clone(),
            suite: self.suite.name.to_string(),
            policy: ResultPolicy {
                name: policy.name.clone(),
                description: policy.description.clone(),
                sees: policy.sees,
                weights_sha256: policy.weights_sha256.clone(),
                decision_ns: policy.decision_ns,
            },
            run,
            about: about.clone(),
            bound_share: share.bound_share,
            lowest_bound_share: share.lowest_bound_share,
            profit_usd: mean_profit_usd(&policy.days),
            days: policy.days.iter().zip(&self.hashes).map(result_day).collect(),
        };
        Ok(self.policies.iter().zip(shares).zip(runs).map(result).collect())
    }
}

/// Checks that all runs are of policies with these names.
///
/// # Errors
/// Returns [`Error::Asked`] for the first run that is not.
pub fn check_runs(runs: &BTreeMap<String, TrainingRun>, policies: &[&str]) -> Result<(), Error> {
    match runs.keys().find(|name| !policies.contains(&name.as_str())) {
        None => Ok(()),
        Some(name) => Err(Error::Asked {
            rule: format!("a method is given for {name:?}, which is not among the policies"),
            hint: "add the name to the policies",
        }),
    }
}

/// The training run of a policy, with the seed that its weights state.
fn run_of(
    policy: &PolicyRecord,
    runs: &BTreeMap<String, TrainingRun>,
) -> Result<Option<TrainingRun>, Error> {
    let seed = policy.training_seed.map(u64::from);
    let Some(TrainingRun { method, training_seed }) = runs.get(&policy.name) else {
        let run = |seed| TrainingRun { method: policy.name.clone(), training_seed: Some(seed) };
        return Ok(seed.map(run));
    };
    match (seed, training_seed) {
        (Some(seed), Some(given)) if seed != *given => Err(Error::Asked {
            rule: format!("{:?} has weights of a run with seed {seed}, not {given}", policy.name),
            hint: "leave the seed out where weights state it",
        }),
        _ => {
            Ok(Some(TrainingRun { method: method.clone(), training_seed: seed.or(*training_seed) }))
        }
    }
}

fn result_day((day, hash): (&DayRecord, &String)) -> ResultDay {
    ResultDay {
        day: day.day.clone(),
        hash: hash.clone(),
        upper_bound_usd: day.upper_bound_usd.expect("every day of a suite has its bound"),
        profit_usd: day.totals.profit_usd,
        choices: choices_text(&day.choices),
    }
}

/// Mean and interval of the shares of the bounds, and the lowest one.
pub(super) fn shares(days: &[DayRecord]) -> (Estimate, f64) {
    let shares: Vec<f64> = days.iter().map(share).collect();
    (Estimate::of(&shares), shares.iter().copied().fold(f64::INFINITY, f64::min))
}

pub(super) fn choices_text(choices: &[VertiportIx]) -> String {
    let mut text = String::with_capacity(3 * choices.len());
    for (at, choice) in choices.iter().enumerate() {
        let blank = if at > 0 { " " } else { "" };
        write!(text, "{blank}{}", choice.0).expect("memory takes everything");
    }
    text
}

impl ResultFile {
    /// The name of its file, for example `paper-100-greedy.json`.
    pub fn file_name(suite: &str, policy: &str) -> String {
        let plain = |letter: char| {
            let is_plain = letter.is_ascii_alphanumeric() || "._-".contains(letter);
            if is_plain { letter } else { '-' }
        };
        format!("{suite}-{policy}").chars().map(plain).chain(".json".chars()).collect()
    }

    /// Writes the file.
    ///
    /// # Errors
    /// Returns [`Error::Core`] if it cannot be written. An earlier file then stays as it is.
    ///
    /// # Panics
    /// Never panics: numbers and texts can always be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let text = serde_json::to_string_pretty(self).expect("numbers and texts can be written");
        Ok(write_atomically(path, (text + "\n").as_bytes())?)
    }

    /// Reads a file. Its claims are not checked, [`verify`](super::verify) does that.
    ///
    /// # Errors
    /// Returns [`Error::Core`] if the file cannot be read or is longer than 256 MiB, and
    /// [`Error::NotAResult`] if it is not of this format.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::from_json(&read_at_most(path, LONGEST)?, &path.display().to_string())
    }

    /// Reads the bytes of a file; `origin` stands for the file in messages.
    ///
    /// # Errors
    /// Returns [`Error::NotAResult`] if they are not of this format, or have values that the
    /// format's schema refuses.
    pub fn from_json(bytes: &[u8], origin: &str) -> Result<Self, Error> {
        let not = |rule: String| Error::NotAResult { origin: origin.to_owned(), rule };
        let Format { format } =
            serde_json::from_slice(bytes).map_err(|error| not(error.to_string()))?;
        if format != RESULT_FORMAT {
            let found: String = format.chars().take(64).collect();
            return Err(not(format!("`format` must be {RESULT_FORMAT:?}, found {found:?}")));
        }
        let result: Self = serde_json::from_slice(bytes).map_err(|error| not(error.to_string()))?;
        result.check_form().map_err(not)?;
        Ok(result)
    }

    /// Checks what the schema says of texts, and that no number is one that cannot be.
    fn check_form(&self) -> Result<(), String> {
        let is_hash = |text: &str, digits| {
            text.len() == digits
                && text.bytes().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f'))
        };
        let ResultPolicy { weights_sha256, decision_ns, .. } = &self.policy;
        if let Some(text) = weights_sha256.as_ref().filter(|text| !is_hash(text, 64)) {
            let text: String = text.chars().take(64).collect();
            return Err(format!("`weights_sha256` must be 64 digits 0-9 and a-f, found {text:?}"));
        }
        if let Some(LatencySummary { median_ns, p99_ns }) =
            decision_ns.filter(|time| time.median_ns > time.p99_ns)
        {
            return Err(format!(
                "`decision_ns` cannot be: a median of {median_ns} is longer than the 99th percentile, {p99_ns}"
            ));
        }
        for ResultDay { day, hash, choices, .. } in &self.days {
            if !is_hash(hash, 32) {
                return Err(format!("the `hash` of {day:?} must be 32 digits 0-9 and a-f"));
            }
            if !choices.bytes().all(|byte| byte.is_ascii_digit() || byte == b' ') {
                return Err(format!(
                    "the `choices` of {day:?} must be whole numbers with a blank between them"
                ));
            }
        }
        for (member, estimate) in
            [("bound_share", &self.bound_share), ("profit_usd", &self.profit_usd)]
        {
            let widths = [estimate.standard_deviation, estimate.half_width_95];
            if widths.into_iter().flatten().any(|width| width < 0.0) {
                return Err(format!("`{member}` has a negative standard deviation or half width"));
            }
        }
        Ok(())
    }
}

/// The member that is read first, so that a file of another format is named as such.
#[derive(Deserialize)]
struct Format {
    format: String,
}
