//! A played day in numbers and on a page: who was carried and who was not, how full the vertiports
//! were, what every aircraft did, and where the money went.
//!
//! The page is what `simulate --report` writes. An [explanation](crate::explain) is the same
//! account with what things are worth, and its page is this page with these sections beside it.

mod losses;
pub(crate) mod page;
pub(crate) mod table;
mod usage;

use std::sync::Arc;

use serde::Serialize;
use vertifleet_core::{OutputKind, Scenario};
use vertifleet_optimize::Bound;
use vertifleet_picture::numbers::grouped;
use vertifleet_sim::{DayTotals, Trace};

pub use losses::{CellLoss, Loss, PairLoss, PeriodLoss};
pub use usage::{AircraftUse, StandWorth, VertiportUse};

/// The beginning of every page of a played day.
pub const PAGE: OutputKind = OutputKind {
    name: "page of a day",
    skipped: 0,
    opening: "<!DOCTYPE html>\n<!-- vertifleet-day/",
};

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
    pub(crate) fn spilled_margin_usd(&self) -> f64 {
        self.periods.iter().map(|one| one.demand.spilled_margin_usd).sum()
    }

    /// How much of the money that is spilled no aircraft can earn, as the end of a sentence; empty
    /// if no passenger is spilled there.
    pub(crate) fn spilled_out_of_reach(&self, dollars: impl Fn(f64) -> String) -> String {
        let Loss { spilled, spilled_margin_usd, .. } = self.cannot_be_flown;
        if spilled == 0 {
            return String::new();
        }
        format!(
            "; {} of it and {} of these passengers are on pairs that no aircraft can fly, for want of a corridor or of range",
            dollars(spilled_margin_usd),
            grouped(spilled as f64, 0),
        )
    }

    /// The account as a page: ledger, map, aircraft, stands, demand, all tables, and the replay of
    /// the day.
    pub fn page(&self) -> String {
        page::text(self, &page::PageExtras::default())
    }
}
