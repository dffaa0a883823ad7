//! What a sweep finds out about each cell, before any statistics.

use serde::{Deserialize, Serialize};
use vertifleet_core::{Network, Scenario};
use vertifleet_sim::DayTotals;

use crate::competitor::Competitor;
use crate::record::{DayRecord, LatencySummary, PolicyRecord};

/// The results of one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CellRecord {
    /// The number of the cell in the design, from 0.
    pub cell: usize,
    /// The upper bound of each day in dollars; empty if none was asked for.
    pub upper_bounds_usd: Vec<f64>,
    /// The numbers of each day by policy: `[policy][day]`.
    pub totals: Vec<Vec<DayTotals>>,
    /// The time that one decision takes, by policy. It differs from run to run, so it is kept only
    /// while the sweep runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub decision_ns: Vec<Option<LatencySummary>>,
}

impl CellRecord {
    /// The results of a cell whose days these policies have played.
    pub fn of(cell: usize, policies: &[PolicyRecord]) -> Self {
        let days = policies.first().into_iter().flat_map(|policy| &policy.days);
        let totals = |policy: &PolicyRecord| policy.days.iter().map(|day| day.totals).collect();
        Self {
            cell,
            upper_bounds_usd: days.filter_map(|day| day.upper_bound_usd).collect(),
            totals: policies.iter().map(totals).collect(),
            decision_ns: policies.iter().map(|policy| policy.decision_ns).collect(),
        }
    }

    /// The same results, without what differs from run to run.
    pub(super) fn without_times(&self) -> Self {
        Self { decision_ns: Vec::new(), ..self.clone() }
    }

    /// The records of the policies that have played these days.
    pub(super) fn policies<'a>(
        &self,
        competitors: &[Competitor],
        days: &(impl Iterator<Item = &'a Scenario> + Clone),
    ) -> Vec<PolicyRecord> {
        let record = |(at, competitor): (usize, &Competitor)| {
            let day = |(day, (scenario, &totals)): (usize, (&Scenario, &DayTotals))| DayRecord {
                day: scenario.name.clone(),
                seed: scenario.seed,
                totals,
                upper_bound_usd: self.upper_bounds_usd.get(day).copied(),
                choices: Vec::new(),
            };
            let days = days.clone().zip(&self.totals[at]).enumerate().map(day).collect();
            competitor.record(days, self.decision_ns.get(at).copied().flatten())
        };
        competitors.iter().enumerate().map(record).collect()
    }
}

/// What a cell's network has, and what that costs whatever is flown.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Size {
    /// Aircraft of all types.
    pub aircraft: usize,
    /// Stands of all vertiports.
    pub stands: u32,
    /// Chargers that are counted apart from stands.
    pub chargers: u32,
    /// What fleet, stands and chargers cost, dollars a day.
    pub fixed_cost_usd: f64,
}

impl Size {
    /// The size of a network.
    pub fn of(network: &Network) -> Self {
        let vertiports = network.vertiports().iter();
        Self {
            aircraft: network.fleet_size(),
            stands: vertiports.clone().map(|one| u32::from(one.stands)).sum(),
            chargers: vertiports.map(|one| u32::from(one.chargers.unwrap_or(0))).sum(),
            fixed_cost_usd: network.fixed_cost_usd(),
        }
    }
}
