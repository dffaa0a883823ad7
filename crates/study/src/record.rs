//! The records of a comparison, one for every policy and day, before any statistics.
//!
//! They are plain numbers, so the code that uses them (statistics, figures, report) can be tested
//! without a simulation. Days are in the same order for every policy, which makes the tests paired.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use vertifleet_core::{Purpose, Scenario, VertiportIx};
use vertifleet_optimize::gap;
use vertifleet_sim::{DayNumber, DayTotals, Trace};

use crate::error::Error;
use crate::origin::NetworkOrigin;
use crate::sees::Sees;
use crate::statistics::Estimate;

/// One policy's result on one day.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DayRecord {
    /// The name of the day's scenario.
    pub day: String,
    /// The seed that the day was drawn from.
    pub seed: u64,
    /// The day's numbers.
    #[serde(flatten)]
    pub totals: DayTotals,
    /// The day's upper bound in dollars, if it was asked for.
    pub upper_bound_usd: Option<f64>,
    /// The vertiport that was chosen at each decision, in order; empty if choices were not to be
    /// kept.
    #[serde(skip)]
    pub choices: Vec<VertiportIx>,
}

impl DayRecord {
    /// Operating profit as a share of its upper bound, if the day has one: both before the costs of
    /// aircraft and sites, which no decision changes. The rest to 1 is the [`gap`]; where nothing
    /// can be earned, it is 1 without a loss and 0 with one.
    pub fn bound_share(&self) -> Option<f64> {
        self.upper_bound_usd.map(|bound_usd| bound_share(&self.totals, bound_usd))
    }
}

/// Operating profit as a share of its upper bound, as [`DayRecord::bound_share`] defines it.
/// `bound_usd` is that of the profit.
pub fn bound_share(totals: &DayTotals, bound_usd: f64) -> f64 {
    1.0 - gap(bound_usd + totals.fixed_cost_usd(), totals.operating_profit_usd())
}

/// Mean and interval of the profit of days, in dollars.
pub fn mean_profit_usd(days: &[DayRecord]) -> Estimate {
    Estimate::of(&days.iter().map(|day| day.totals.profit_usd).collect::<Vec<f64>>())
}

/// Time that one decision takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LatencySummary {
    /// Half of the decisions take at most this long, in nanoseconds.
    pub median_ns: u64,
    /// 99 % of the decisions take at most this long, in nanoseconds.
    pub p99_ns: u64,
}

/// The records of one policy on every day of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PolicyRecord {
    /// The name that the user gave it, for example `greedy`.
    pub name: String,
    /// Describes what the policy does, in one short sentence.
    pub description: String,
    /// What it looks at when it decides.
    #[serde(default)]
    pub sees: Sees,
    /// SHA-256 of its weight file; `None` for a policy without weights of ours.
    #[serde(default)]
    pub weights_sha256: Option<String>,
    /// The seed of the training run that made its weights, if they state it.
    #[serde(default)]
    pub training_seed: Option<u32>,
    /// One record for each day, in the study's order of days.
    pub days: Vec<DayRecord>,
    /// The time that one decision of this policy takes; `None` for a reference, which planned each
    /// day as a whole with the day known.
    pub decision_ns: Option<LatencySummary>,
}

/// The learning curve of a policy on its training days (Fig. 3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LearningCurve {
    /// The name of the policy that was trained.
    pub name: String,
    /// Decisions learned from and the mean reward at that point, in order of decisions.
    pub points: Vec<(u64, f64)>,
}

/// The learning curves of a policy on the validation days, one run for each seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValidationCurves {
    /// The name of the policy.
    pub name: String,
    /// The runs, beginning with the one whose weights play. Each point has the decisions learned
    /// from and the mean reward on the validation days at that point, in order of decisions. No run
    /// is empty.
    pub runs: Vec<Vec<(u64, f64)>>,
}

/// The records of many policies on the same days.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonRecords {
    /// The name of the network that the days were drawn from, or that the user's own days share; if
    /// they share none, where they came from.
    pub network: String,
    /// Whether that network is a shipped one.
    pub network_origin: NetworkOrigin,
    /// The seed or number of the first day as the user gave it; `None` for the user's own days.
    pub seed: Option<u64>,
    /// The purpose of days that were drawn.
    #[serde(default)]
    pub split: Purpose,
    /// Where the user's own days came from; `None` for days that were drawn from a seed.
    pub days_from: Option<String>,
    /// Number of days; each policy has that many records.
    pub days: usize,
    /// The length of the slices of the upper bounds in seconds, if bounds were asked for.
    pub bound_step_s: Option<u32>,
    /// The command line of the study.
    pub command: String,
    /// The record of every policy. No two have the same name, which
    /// [`Selection`](crate::competitor::Selection) ensures.
    pub policies: Vec<PolicyRecord>,
    /// The learning curves on the training days of the policies that have one; may be empty.
    pub curves: Vec<LearningCurve>,
    /// The learning curves on the validation days of the policies that were trained; may be empty.
    pub trainings: Vec<ValidationCurves>,
    /// The first days and what every policy did on them, for the report; they do not go into files
    /// and to other processes.
    #[serde(skip)]
    pub replayed: Vec<ReplayedDay>,
}

/// Checks that the records are those of policies on the same days, with finite results.
pub(crate) fn check_records(policies: &[PolicyRecord], days: usize) -> Result<(), Error> {
    let Some(first) = policies.first().filter(|_| days > 0) else {
        return Err(Error::Empty { policies: policies.len(), days });
    };
    for policy in policies {
        check_paired(days, first, policy)?;
        for day in &policy.days {
            check_finite(&policy.name, day)?;
        }
    }
    Ok(())
}

fn check_paired(days: usize, first: &PolicyRecord, policy: &PolicyRecord) -> Result<(), Error> {
    let label = |day: &DayRecord| format!("{} (seed {})", day.day, day.seed);
    for position in 0..days.max(policy.days.len()) {
        let found = policy.days.get(position).map_or("no day".to_owned(), label);
        let expected = match first.days.get(position) {
            Some(day) if position < days => label(day),
            None if position < days => "a day".to_owned(),
            _ => "no day".to_owned(),
        };
        if found != expected {
            return Err(Error::Unpaired {
                policy: policy.name.clone(),
                first_policy: first.name.clone(),
                position,
                found,
                expected,
            });
        }
    }
    Ok(())
}

fn check_finite(policy: &str, day: &DayRecord) -> Result<(), Error> {
    let amounts = day.totals.numbers().into_iter().filter_map(|(member, number)| match number {
        DayNumber::Amount(value) => Some((member, value)),
        DayNumber::Count(_) => None,
    });
    let bound = day.upper_bound_usd.map(|bound_usd| ("upper_bound_usd", bound_usd));
    match amounts.chain(bound).find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((member, value)) => {
            Err(Error::NotFinite { policy: policy.to_owned(), day: day.day.clone(), member, value })
        }
    }
}

/// A day, and what policies did on it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayedDay {
    /// The day.
    pub scenario: Arc<Scenario>,
    /// What each policy did.
    pub plays: Vec<Play>,
}

/// What a policy did on a day.
#[derive(Debug, Clone, PartialEq)]
pub struct Play {
    /// The name of the policy.
    pub policy: String,
    /// Every decision.
    pub trace: Trace,
    /// The profit of the day, dollars.
    pub profit_usd: f64,
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::DayRecord;

    #[test]
    fn a_share_is_of_operating_profit() {
        let share = |profit_usd: f64, upper_bound_usd: f64| {
            let record: DayRecord = serde_json::from_value(json!({
                "day": "a day", "seed": 1, "upper_bound_usd": upper_bound_usd, "profit_usd": profit_usd,
                "aircraft_cost_usd": 60.0, "site_cost_usd": 40.0, "revenue_usd": 0.0,
                "passenger_cost_usd": 0.0, "energy_cost_usd": 0.0, "energy_kwh": 0.0,
                "potential_usd": 0.0, "reward": 0.0, "flights": 0, "repositioning_flights": 0,
                "holds": 0, "decisions": 0, "passengers": 0, "spilled_passengers": 0,
                "load_factor": 0.0,
            }))
            .expect("a record");
            record.bound_share().expect("it has a bound")
        };
        // $80 of $100 are earned before fixed costs of $100.
        assert!((share(-20.0, 0.0) - 0.8).abs() < 1e-12);
        assert!((share(50.0, 100.0) - 0.75).abs() < 1e-12);
        // Nothing can be earned.
        assert_eq!([share(-100.0, -100.0), share(-101.0, -100.0)], [1.0, 0.0]);
    }
}
