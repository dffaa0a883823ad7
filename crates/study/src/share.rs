//! Shares of the upper bounds, policy by policy: what is measured where profits on different days
//! cannot be averaged.

use serde::Serialize;

use crate::record::{DayRecord, PolicyRecord};
use crate::sees::Sees;
use crate::statistics::{Estimate, PairedTest};

/// The results of one policy over all days.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PolicyShare {
    /// The name that the user gave it.
    pub name: String,
    /// Describes what the policy does.
    pub description: String,
    /// Whether the days were planned with the whole day known, which makes it a reference and not a
    /// policy.
    pub knows_the_day: bool,
    /// What it looks at when it decides.
    pub sees: Sees,
    /// Operating profit as a share of its upper bound.
    pub bound_share: Estimate,
    /// The share of the upper bound on the day where it is lowest.
    pub lowest_bound_share: f64,
    /// Paired t-test of the share, this policy minus the first; `None` for the first itself.
    pub minus_first: Option<PairedTest>,
}

impl PolicyShare {
    /// The results of policies that played the same days. Every day has its bound.
    pub(crate) fn of_all(policies: &[PolicyRecord]) -> Vec<Self> {
        let shares: Vec<Vec<f64>> =
            policies.iter().map(|policy| policy.days.iter().map(share).collect()).collect();
        let of = |(position, (policy, own)): (usize, (&PolicyRecord, &Vec<f64>))| Self {
            name: policy.name.clone(),
            description: policy.description.clone(),
            knows_the_day: policy.decision_ns.is_none(),
            sees: policy.sees,
            bound_share: Estimate::of(own),
            lowest_bound_share: own.iter().copied().fold(f64::INFINITY, f64::min),
            minus_first: (position > 0).then(|| PairedTest::of(own, &shares[0])),
        };
        policies.iter().zip(&shares).enumerate().map(of).collect()
    }
}

/// Operating profit as a share of its upper bound.
pub(crate) fn share(day: &DayRecord) -> f64 {
    day.bound_share().expect("every day has its bound")
}
