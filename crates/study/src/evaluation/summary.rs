//! The statistics of an evaluation, suite by suite.

use serde::Serialize;

use super::{EvaluationRecords, LeftOut};
use crate::error::Error;
use crate::record::{LatencySummary, PolicyRecord, check_records, mean_profit_usd};
use crate::share::PolicyShare;
use crate::statistics::{Estimate, holm};

/// Name and version of the format of `vertifleet evaluate --json`.
pub const FORMAT: &str = "vertifleet-evaluation/1";

/// The statistics of an evaluation on one or more suites.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EvaluationReport {
    /// Always [`FORMAT`].
    pub format: &'static str,
    /// Version of the program.
    pub program_version: &'static str,
    /// The suites, in the order in which they were named.
    pub suites: Vec<SuiteReport>,
}

/// The statistics of the policies on one suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuiteReport {
    /// The name of the suite.
    pub suite: String,
    /// Describes its days.
    pub description: String,
    /// Number of its days.
    pub days: usize,
    /// Whether all days are drawn from one network, so that profits can be averaged.
    pub one_network: bool,
    /// The length of the slices of its bounds, in seconds.
    pub bound_step_s: u32,
    /// Every policy, in the order in which they were named.
    pub policies: Vec<EvaluatedPolicy>,
    /// The policies that cannot play these days.
    pub left_out: Vec<LeftOut>,
}

/// The results of one policy on a suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EvaluatedPolicy {
    /// Its shares of the bounds.
    #[serde(flatten)]
    pub share: PolicyShare,
    /// The p-value of [`PolicyShare::minus_first`], corrected for the number of policies that are
    /// measured against the first (Holm).
    pub p_value_holm: Option<f64>,
    /// Profit of a day, in dollars.
    pub profit_usd: Estimate,
    /// The time that one decision takes; `None` for a reference that plans whole days.
    pub decision_ns: Option<LatencySummary>,
}

impl EvaluationReport {
    /// Computes the statistics of the records of some suites.
    ///
    /// # Errors
    /// Returns [`Error::Empty`], [`Error::Unpaired`] or [`Error::NotFinite`] if the records of a
    /// suite are not those of policies on the same days.
    pub fn of(suites: &[EvaluationRecords]) -> Result<Self, Error> {
        Ok(Self {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION"),
            suites: suites.iter().map(SuiteReport::of).collect::<Result<_, _>>()?,
        })
    }

    /// The statistics as indented JSON.
    ///
    /// # Panics
    /// Never panics: numbers and texts can always be written.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers and texts can always be written")
    }
}

impl SuiteReport {
    fn of(records: &EvaluationRecords) -> Result<Self, Error> {
        let EvaluationRecords { suite, policies, left_out, .. } = records;
        check_records(policies, suite.days)?;
        let shares = PolicyShare::of_all(policies);
        let p_values: Vec<Option<f64>> =
            shares.iter().map(|share| share.minus_first.as_ref()?.p_value).collect();
        let evaluated = |((share, policy), p_value_holm): ((_, &PolicyRecord), _)| {
            let (profit_usd, decision_ns) = (mean_profit_usd(&policy.days), policy.decision_ns);
            EvaluatedPolicy { share, p_value_holm, profit_usd, decision_ns }
        };
        Ok(Self {
            suite: suite.name.to_string(),
            description: suite.description.to_string(),
            days: suite.days,
            one_network: suite.network().is_some(),
            bound_step_s: 60 * suite.step_minutes,
            policies: shares
                .into_iter()
                .zip(policies)
                .zip(holm(&p_values))
                .map(evaluated)
                .collect(),
            left_out: left_out.clone(),
        })
    }
}
