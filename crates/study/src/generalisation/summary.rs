//! The statistics of a study of many networks: every policy's share of the upper bounds.

use serde::Serialize;

use super::{GeneralisationRecords, NetworkRecord};
use crate::error::Error;
use crate::record::{DayRecord, PolicyRecord, check_records};
use crate::share::{PolicyShare, share};

/// Name and version of the format of `summary.json`.
pub const FORMAT: &str = "vertifleet-generalisation/1";

/// The statistics of a study: `summary.json` and `--json` contain them, and table, figure and page show them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GeneralisationReport {
    /// Always [`FORMAT`].
    pub format: &'static str,
    /// Version of the program.
    pub program_version: &'static str,
    /// The command line of the study.
    pub command: String,
    /// The length of the bounds' slices, in seconds.
    pub bound_step_s: u32,
    /// Every policy, in the order in which they were named.
    pub policies: Vec<PolicyShare>,
    /// Every network.
    pub networks: Vec<NetworkShare>,
}

/// One network with every policy's result on its day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NetworkShare {
    /// The name by which commands find it.
    pub network: String,
    /// The seed of its day.
    pub seed: u64,
    /// Number of vertiports.
    pub vertiports: usize,
    /// Number of aircraft of all types together.
    pub aircraft: usize,
    /// The day's upper bound, in dollars.
    pub upper_bound_usd: f64,
    /// The result of every policy, in the order of the policies.
    pub results: Vec<Outcome>,
}

/// The result of a policy on the day of a network.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// The name of the policy.
    pub policy: String,
    /// Profit, in dollars.
    pub profit_usd: f64,
    /// Profit as a share of the day's upper bound.
    pub bound_share: f64,
}

impl GeneralisationReport {
    /// Computes the statistics of a study.
    ///
    /// # Errors
    /// Returns [`Error::Empty`], [`Error::Unpaired`] or [`Error::NotFinite`] if the records are not those of policies
    /// on the same days.
    ///
    /// # Panics
    /// Panics if a day has no upper bound.
    pub fn of(study: &GeneralisationRecords) -> Result<Self, Error> {
        check_records(&study.policies, study.networks.len())?;
        let network = |(position, record): (usize, &NetworkRecord)| {
            let day = &study.policies[0].days[position];
            let outcome = |policy: &PolicyRecord| Outcome {
                policy: policy.name.clone(),
                profit_usd: policy.days[position].totals.profit_usd,
                bound_share: share(&policy.days[position]),
            };
            NetworkShare {
                network: record.name.clone(),
                seed: day.seed,
                vertiports: record.vertiports,
                aircraft: record.aircraft,
                upper_bound_usd: bound_usd(day),
                results: study.policies.iter().map(outcome).collect(),
            }
        };
        Ok(Self {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION"),
            command: study.command.clone(),
            bound_step_s: study.bound_step_s,
            policies: PolicyShare::of_all(&study.policies),
            networks: study.networks.iter().enumerate().map(network).collect(),
        })
    }

    /// The statistics as indented JSON, the text of `summary.json` and `--json`.
    ///
    /// # Panics
    /// Never panics: numbers and texts can always be written.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers and texts can always be written")
    }

    /// The policy that the others are measured against.
    pub(crate) fn first(&self) -> &PolicyShare {
        self.policies.first().expect("a summary has at least one policy")
    }

    /// The position of the policy with the highest mean share. The planner counts only if there is nothing else.
    pub(crate) fn best_position(&self) -> usize {
        let rank =
            |at: usize| (!self.policies[at].knows_the_day, self.policies[at].bound_share.mean);
        (1..self.policies.len()).fold(0, |best, at| if rank(at) > rank(best) { at } else { best })
    }

    /// The smallest and the largest value of a size of the networks.
    pub(crate) fn range(&self, size: fn(&NetworkShare) -> usize) -> (usize, usize) {
        let sizes = || self.networks.iter().map(size);
        (sizes().min().unwrap_or(0), sizes().max().unwrap_or(0))
    }
}

fn bound_usd(day: &DayRecord) -> f64 {
    day.upper_bound_usd.expect("every day of many networks has its bound")
}
