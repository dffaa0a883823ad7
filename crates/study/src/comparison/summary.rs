//! The statistics of a comparison: `summary.json` and `--json` contain them, and table, figures and
//! page show them.
//!
//! Records become statistics only here. All presentation reads a [`ComparisonReport`] and computes
//! nothing.

use serde::Serialize;
use vertifleet_core::Purpose;

use crate::error::Error;
use crate::origin::NetworkOrigin;
use crate::published::{self, PublishedResult};
use crate::record::{
    ComparisonRecords, DayRecord, LatencySummary, LearningCurve, PolicyRecord, ValidationCurves,
    check_records,
};
use crate::sees::Sees;
use crate::statistics::{BoxSummary, Estimate, PairedTest, mean};

/// Name and version of the format of `summary.json`.
pub const FORMAT: &str = "vertifleet-comparison/1";

/// The statistics of a comparison of policies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparisonReport {
    /// Always [`FORMAT`].
    pub format: &'static str,
    /// Version of the program, which all crates of the workspace share.
    pub program_version: &'static str,
    /// The command line of the study.
    pub command: String,
    /// The name of the network.
    pub network: String,
    /// Whether that network is a shipped one.
    pub network_origin: NetworkOrigin,
    /// The seed as the user gave it; `None` for the user's own days.
    pub seed: Option<u64>,
    /// The purpose of the days: only those of comparison are for results.
    pub split: Purpose,
    /// Where the user's own days came from; `None` for days that were drawn from a seed.
    pub days_from: Option<String>,
    /// Number of days.
    pub days: usize,
    /// The smallest and the largest seed that a day was drawn from; `None` for the user's own days.
    pub day_seeds: Option<(u64, u64)>,
    /// The days' upper bounds, if bounds were asked for.
    pub bound: Option<BoundSummary>,
    /// Every policy, the highest mean profit first.
    pub policies: Vec<PolicySummary>,
    /// Every pair of policies once, in the order of `policies`.
    pub comparisons: Vec<PairedDifference>,
    /// The published results to show next to these; empty except for days drawn from the network
    /// `paper` as it is shipped.
    pub published: &'static [PublishedResult],
    /// The results of the trainings of the learned policies.
    pub trainings: Vec<TrainingSummary>,
    /// Learning curves on the training days.
    #[serde(skip)]
    pub curves: Vec<LearningCurve>,
}

/// The training runs of a policy at their end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrainingSummary {
    /// The name of the policy.
    pub policy: String,
    /// Number of runs, each with a different seed.
    pub runs: usize,
    /// Decisions learned from, in the mean over the runs.
    pub decisions: f64,
    /// Mean reward at the last measurement on the validation days, over the runs.
    pub validation_reward: Estimate,
    /// The lowest and the highest of these rewards.
    pub range: (f64, f64),
    /// The learning curves of the runs.
    #[serde(skip)]
    pub curves: Vec<Vec<(u64, f64)>>,
}

impl TrainingSummary {
    fn of(training: &ValidationCurves) -> Option<Self> {
        let ends: Vec<(u64, f64)> =
            training.runs.iter().map(|run| run.last().copied()).collect::<Option<_>>()?;
        let rewards: Vec<f64> = ends.iter().map(|end| end.1).collect();
        let decisions: Vec<f64> = ends.iter().map(|end| end.0 as f64).collect();
        let lowest = rewards.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = rewards.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (!rewards.is_empty()).then(|| Self {
            policy: training.name.clone(),
            runs: rewards.len(),
            decisions: mean(&decisions),
            validation_reward: Estimate::of(&rewards),
            range: (lowest, highest),
            curves: training.runs.clone(),
        })
    }
}

/// The upper bounds of the days.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BoundSummary {
    /// The length of the bounds' slices, in seconds.
    pub step_s: u32,
    /// Upper bound of a day's profit, in dollars.
    pub upper_bound_usd: Estimate,
}

/// The results of one policy over all days. Counts and amounts are means per day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PolicySummary {
    /// The name that the user gave it.
    pub name: String,
    /// Describes what the policy does.
    pub description: String,
    /// What it looks at when it decides.
    pub sees: Sees,
    /// Daily profit, in dollars.
    pub profit_usd: Estimate,
    /// Daily profit before the costs of aircraft and sites, which no decision changes; dollars.
    pub operating_profit_usd: Estimate,
    /// Box plot of the daily profit (Fig. 5).
    pub profit_box_usd: BoxSummary,
    /// Daily operating profit as a share of its upper bound, where bounds were asked for.
    pub bound_share: Option<Estimate>,
    /// Box plot of the share of the upper bound.
    pub bound_share_box: Option<BoxSummary>,
    /// Reward.
    pub reward: Estimate,
    /// Box plot of the reward (Fig. 4).
    pub reward_box: BoxSummary,
    /// Fares paid, in dollars.
    pub revenue_usd: f64,
    /// Passenger cost, in dollars.
    pub passenger_cost_usd: f64,
    /// Energy cost, in dollars.
    pub energy_cost_usd: f64,
    /// Flight cost, in dollars.
    pub flight_cost_usd: f64,
    /// Aircraft cost, in dollars.
    pub aircraft_cost_usd: f64,
    /// Cost of stands and chargers, in dollars.
    pub site_cost_usd: f64,
    /// Energy charged, in kWh.
    pub energy_kwh: f64,
    /// The potential: what all passengers of the day would pay if all of them flew, in dollars.
    pub potential_usd: f64,
    /// Number of flights, with and without passengers.
    pub flights: f64,
    /// Number of repositions.
    pub repositioning_flights: f64,
    /// Number of decisions to hold.
    pub holds: f64,
    /// Number of decisions.
    pub decisions: f64,
    /// Number of passengers who were carried.
    pub passengers: f64,
    /// Number of passengers who were not carried.
    pub spilled_passengers: f64,
    /// Mean of the days' load factors, 0 to 1.
    pub load_factor: f64,
    /// Time of one decision; `None` for a reference, which knows the whole day.
    pub decision_ns: Option<Latency>,
    /// Profit of each day, in the study's order of days.
    #[serde(skip)]
    pub daily_profit_usd: Vec<f64>,
    /// Reward of each day, in the study's order of days.
    #[serde(skip)]
    pub daily_reward: Vec<f64>,
    /// Share of the upper bound of each day, in the study's order of days; empty if bounds were not
    /// asked for.
    #[serde(skip)]
    pub daily_bound_share: Vec<f64>,
}

/// The time of one decision, as it is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Latency {
    /// Median, in nanoseconds.
    pub median: u64,
    /// 99th percentile, in nanoseconds.
    pub p99: u64,
}

/// Two policies on the same days, first minus second.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairedDifference {
    /// Name of the first policy: the one with the higher mean profit.
    pub first: String,
    /// Name of the second policy.
    pub second: String,
    /// Positions of the two in [`ComparisonReport::policies`].
    #[serde(skip)]
    pub pair: (usize, usize),
    /// Paired t-test of the daily profit, in dollars.
    pub profit_usd: PairedTest,
    /// Paired t-test of the episode reward.
    pub reward: PairedTest,
}

impl ComparisonReport {
    /// Computes the statistics of a study.
    ///
    /// # Errors
    /// Returns [`Error::Empty`], [`Error::Unpaired`] or [`Error::NotFinite`] if the records are not
    /// those of policies on the same days.
    pub fn of(study: &ComparisonRecords) -> Result<Self, Error> {
        check_records(&study.policies, study.days)?;
        let empty = || Error::Empty { policies: study.policies.len(), days: study.days };
        let mut policies: Vec<PolicySummary> = study
            .policies
            .iter()
            .map(PolicySummary::of)
            .collect::<Option<_>>()
            .ok_or_else(empty)?;
        // The sort is stable, so equal policies keep the order in which they were named.
        policies.sort_by(|a, b| b.profit_usd.mean.total_cmp(&a.profit_usd.mean));
        let seeds = || study.policies.iter().flat_map(|policy| &policy.days).map(|day| day.seed);
        let bounds_usd: Option<Vec<f64>> =
            study.policies[0].days.iter().map(|day| day.upper_bound_usd).collect();
        let bound = |(step_s, bounds_usd): (u32, Vec<f64>)| BoundSummary {
            step_s,
            upper_bound_usd: Estimate::of(&bounds_usd),
        };
        let day_seeds = seeds().min().zip(seeds().max()).ok_or_else(empty)?;
        Ok(Self {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION"),
            command: study.command.clone(),
            network: study.network.clone(),
            network_origin: study.network_origin,
            seed: study.seed,
            split: study.split,
            days_from: study.days_from.clone(),
            days: study.days,
            day_seeds: study.days_from.is_none().then_some(day_seeds),
            bound: study.bound_step_s.zip(bounds_usd).map(bound),
            comparisons: compare_all(&policies),
            policies,
            published: match study.days_from {
                None => published::results_for(&study.network, study.network_origin),
                Some(_) => &[],
            },
            trainings: study.trainings.iter().filter_map(TrainingSummary::of).collect(),
            curves: study.curves.clone(),
        })
    }

    /// The statistics as indented JSON, the text of `summary.json` and `--json`.
    ///
    /// # Panics
    /// Never panics: numbers and texts can always be written.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers and texts can always be written")
    }

    /// Whether these days are like those of the paper, so that the figures correspond to the
    /// paper's.
    pub fn is_of_the_paper(&self) -> bool {
        !self.published.is_empty()
    }

    /// The policy with the highest mean profit. References are considered only when there are no
    /// other policies.
    ///
    /// # Panics
    /// Never panics: a summary has at least one policy.
    pub fn best(&self) -> &PolicySummary {
        self.policies.get(self.best_position()).expect("a summary has at least one policy")
    }

    /// The position of the best policy.
    pub fn best_position(&self) -> usize {
        self.policies.iter().position(|policy| !policy.knows_the_day()).unwrap_or(0)
    }

    /// The comparison that says most about the best policy: with `greedy`, or with the next best
    /// policy if `greedy` is the best or was not run. `None` if no policy earns less than the best.
    pub fn best_against_reference(&self) -> Option<&PairedDifference> {
        let best = self.best_position();
        let others =
            || (best + 1..self.policies.len()).filter(|&at| !self.policies[at].knows_the_day());
        let second =
            others().find(|&at| self.policies[at].name == "greedy").or_else(|| others().next())?;
        self.comparisons.iter().find(|comparison| comparison.pair == (best, second))
    }
}

impl PolicySummary {
    /// Whether the days were planned with the whole day known.
    pub fn knows_the_day(&self) -> bool {
        self.decision_ns.is_none()
    }

    fn of(policy: &PolicyRecord) -> Option<Self> {
        let column =
            |value: fn(&DayRecord) -> f64| policy.days.iter().map(value).collect::<Vec<f64>>();
        let average = |value: fn(&DayRecord) -> f64| mean(&column(value));
        let daily_profit_usd = column(|day| day.totals.profit_usd);
        let daily_reward = column(|day| day.totals.reward);
        let daily_bound_share: Vec<f64> = policy
            .days
            .iter()
            .map(DayRecord::bound_share)
            .collect::<Option<_>>()
            .unwrap_or_default();
        let bound_share_box = BoxSummary::of(&daily_bound_share);
        let latency =
            |LatencySummary { median_ns, p99_ns }| Latency { median: median_ns, p99: p99_ns };
        Some(Self {
            name: policy.name.clone(),
            description: policy.description.clone(),
            sees: policy.sees,
            profit_usd: Estimate::of(&daily_profit_usd),
            operating_profit_usd: Estimate::of(&column(|day| day.totals.operating_profit_usd())),
            profit_box_usd: BoxSummary::of(&daily_profit_usd)?,
            bound_share: bound_share_box.is_some().then(|| Estimate::of(&daily_bound_share)),
            bound_share_box,
            reward: Estimate::of(&daily_reward),
            reward_box: BoxSummary::of(&daily_reward)?,
            revenue_usd: average(|day| day.totals.revenue_usd),
            passenger_cost_usd: average(|day| day.totals.passenger_cost_usd),
            energy_cost_usd: average(|day| day.totals.energy_cost_usd),
            flight_cost_usd: average(|day| day.totals.flight_cost_usd),
            aircraft_cost_usd: average(|day| day.totals.aircraft_cost_usd),
            site_cost_usd: average(|day| day.totals.site_cost_usd),
            energy_kwh: average(|day| day.totals.energy_kwh),
            potential_usd: average(|day| day.totals.potential_usd),
            flights: average(|day| f64::from(day.totals.flights)),
            repositioning_flights: average(|day| f64::from(day.totals.repositioning_flights)),
            holds: average(|day| f64::from(day.totals.holds)),
            decisions: average(|day| f64::from(day.totals.decisions)),
            passengers: average(|day| day.totals.passengers as f64),
            spilled_passengers: average(|day| day.totals.spilled_passengers as f64),
            load_factor: average(|day| day.totals.load_factor),
            decision_ns: policy.decision_ns.map(latency),
            daily_profit_usd,
            daily_reward,
            daily_bound_share,
        })
    }
}

fn compare_all(policies: &[PolicySummary]) -> Vec<PairedDifference> {
    let pairs = (0..policies.len()).flat_map(|i| (i + 1..policies.len()).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| {
            let (first, second) = (&policies[i], &policies[j]);
            PairedDifference {
                first: first.name.clone(),
                second: second.name.clone(),
                pair: (i, j),
                profit_usd: PairedTest::of(&first.daily_profit_usd, &second.daily_profit_usd),
                reward: PairedTest::of(&first.daily_reward, &second.daily_reward),
            }
        })
        .collect()
}
