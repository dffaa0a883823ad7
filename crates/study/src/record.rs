//! What a comparison leaves behind: every policy's every day, before any statistics.
//!
//! These are plain numbers, so that everything after them (statistics, figures, report) can be tested without a
//! simulation. Days stand in the same order for every policy: that is what makes the tests paired.

use serde::{Deserialize, Serialize};
use vertifleet_sim::DayTotals;

use crate::origin::NetworkOrigin;

/// One policy's result on one day.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DayRecord {
    /// Name of the day's scenario.
    pub day: String,
    /// Seed that the day was drawn from.
    pub seed: u64,
    /// The day's numbers.
    #[serde(flatten)]
    pub totals: DayTotals,
    /// What no schedule of the day earns more than, in dollars, where that was asked for.
    pub upper_bound_usd: Option<f64>,
}

impl DayRecord {
    /// Profit as a share of the day's upper bound, where there is one. Where nothing can be earned, or only a loss be kept
    /// small, it is the least possible loss as a share of the loss: 1 where there is no other, 0 where there need be none.
    pub fn bound_share(&self) -> Option<f64> {
        self.upper_bound_usd.map(|bound_usd| {
            if bound_usd > 0.0 {
                self.totals.profit_usd / bound_usd
            } else if self.totals.profit_usd < 0.0 {
                // Not -0 where the bound is 0.
                (0.0 - bound_usd) / -self.totals.profit_usd
            } else {
                1.0
            }
        })
    }
}

/// Time that one decision takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LatencySummary {
    /// Half of the decisions take at most this long, in nanoseconds.
    pub median_ns: u64,
    /// 99 % of the decisions take at most this long, in nanoseconds.
    pub p99_ns: u64,
}

/// One policy on every day of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PolicyRecord {
    /// Name as the user gave it, for example `greedy`.
    pub name: String,
    /// What the policy does, in one short sentence.
    pub description: String,
    /// One record a day, in the study's order of days.
    pub days: Vec<DayRecord>,
    /// Time that one decision of this policy takes; `None` for an offline reference, whose days were planned as a whole
    /// with the day known.
    pub decision_ns: Option<LatencySummary>,
}

/// How a policy's training went (Fig. 3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LearningCurve {
    /// Name of the policy that was trained.
    pub name: String,
    /// Steps of experience and the mean episode reward at that point, in order of steps.
    pub points: Vec<(u64, f64)>,
}

/// How a policy does on the validation days while it learns, one run a seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValidationCurves {
    /// Name of the policy.
    pub name: String,
    /// The runs, the one whose weights play first. Decisions learned from and the mean reward on the validation days then, in
    /// order of decisions; no run is empty.
    pub runs: Vec<Vec<(u64, f64)>>,
}

/// Many policies on the same days.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonRecords {
    /// Name of the network that the days were drawn from, or that the user's own days have in common; where they have none, where they
    /// came from.
    pub network: String,
    /// Whether that is a shipped network.
    pub network_origin: NetworkOrigin,
    /// Seed of the first day, as the user gave it; none where the days are not drawn but the user's own.
    pub seed: Option<u64>,
    /// Where the user's own days came from; none where they were drawn from a seed.
    pub days_from: Option<String>,
    /// Number of days; each policy has as many records.
    pub days: usize,
    /// Length of the steps of the days' upper bounds, in seconds, where those were asked for.
    pub bound_step_s: Option<u32>,
    /// Command that made the study, as it would be typed.
    pub command: String,
    /// Every policy's record, no two of the same name: [`Selection`](crate::competitor::Selection) sees to that.
    pub policies: Vec<PolicyRecord>,
    /// Learning curves on the training days of those policies that have one; may be empty.
    pub curves: Vec<LearningCurve>,
    /// Learning curves on the validation days of those policies that were trained; may be empty.
    pub trainings: Vec<ValidationCurves>,
}
