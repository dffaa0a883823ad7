//! A played day in numbers: who was carried and who was not, how full the vertiports were, what
//! every aircraft did, and where the money went.

mod losses;
mod usage;

use std::sync::Arc;

use serde::Serialize;
use vertifleet_core::Scenario;
use vertifleet_optimize::Bound;
use vertifleet_sim::{DayTotals, Trace};

use crate::record::{Play, ReplayedDay};

pub use losses::{CellLoss, Loss, PairLoss, PeriodLoss};
pub use usage::{AircraftUse, StandWorth, VertiportUse};

/// A played day in numbers.
#[derive(Debug, Clone, Serialize)]
pub struct Account {
    /// The name of the day.
    pub day: String,
    /// The policy that played it.
    pub policy: String,
    /// The numbers of the day.
    pub totals: DayTotals,
    /// Demand served and spilled by period.
    pub periods: Vec<PeriodLoss>,
    /// Demand served and spilled by pair. Pairs that some aircraft can fly come first, and among
    /// them the pair with the most money spilled.
    pub pairs: Vec<PairLoss>,
    /// Demand of all pairs that no aircraft of the day can fly, because they have no corridor or
    /// are beyond the range.
    pub cannot_be_flown: Loss,
    /// Demand spilled by pair and period, in the same order; only where some is spilled.
    pub spilled: Vec<CellLoss>,
    /// How full the vertiports were, and what their stands are worth if that is known.
    pub vertiports: Vec<VertiportUse>,
    /// What every aircraft did.
    pub aircraft: Vec<AircraftUse>,
    #[serde(skip)]
    trace: Trace,
    #[serde(skip)]
    scenario: Arc<Scenario>,
}

impl Account {
    /// The account of a day as a policy played it.
    pub fn of(scenario: &Arc<Scenario>, policy: &str, trace: Trace, totals: DayTotals) -> Self {
        let pairs = losses::by_pair(scenario, &trace.rows);
        let mut cannot_be_flown = Loss::default();
        for pair in pairs.iter().filter(|pair| !pair.can_be_flown) {
            cannot_be_flown.add(pair.demand);
        }
        Self {
            day: scenario.name.clone(),
            policy: policy.to_owned(),
            totals,
            periods: losses::by_period(scenario, &trace.rows),
            pairs,
            cannot_be_flown,
            spilled: losses::by_cell(scenario, &trace.rows),
            vertiports: usage::of_vertiports(scenario, &trace.rows),
            aircraft: usage::of_aircraft(scenario, &trace.rows),
            trace,
            scenario: Arc::clone(scenario),
        }
    }

    /// The same account with what stands are worth by a bound of the day.
    pub(crate) fn with_worth_of_stands(mut self, bound: &Bound) -> Self {
        for (at, one) in self.vertiports.iter_mut().enumerate() {
            one.stand_worth = Some(StandWorth::of(bound, at, self.scenario.periods.len()));
        }
        self
    }

    /// What passengers who were not carried would have paid less what carrying them costs, dollars.
    pub fn spilled_margin_usd(&self) -> f64 {
        self.periods.iter().map(|one| one.demand.spilled_margin_usd).sum()
    }

    /// The day that was played.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Every decision of the day.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// The day for a replay.
    pub fn replayed(&self) -> ReplayedDay {
        let play = Play {
            policy: self.policy.clone(),
            trace: self.trace.clone(),
            profit_usd: self.totals.profit_usd,
        };
        ReplayedDay { scenario: Arc::clone(&self.scenario), plays: vec![play] }
    }
}
