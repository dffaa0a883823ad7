//! The statistics of a sweep: what every cell earns, how far it is from the best one, and which
//! design is the cheapest of those that earn nearly as much.

use serde::Serialize;
use serde_json::Value;
use vertifleet_optimize::Step;
use vertifleet_sim::DayTotals;

use super::Sweep;
use super::cell::Cell;
use super::design::format_value;
use super::effects::{Effect, Effects};
use super::record::{CellRecord, Size};
use crate::error::Error;
use crate::record::bound_share;
use crate::statistics::{Estimate, mean};

/// The format of `summary.json`.
pub const FORMAT: &str = "vertifleet-sweep/1";

/// By how much a design may earn less than the best and still count as good, as a share.
const NEARLY: f64 = 0.01;

/// The statistics of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepReport {
    /// [`FORMAT`].
    pub format: &'static str,
    /// The version of the program.
    pub program_version: &'static str,
    /// The command that gave these results.
    pub command: String,
    /// The name of the network.
    pub network: String,
    /// The seed or number of the first day.
    pub first_day: u64,
    /// The purpose of the days.
    pub split: &'static str,
    /// Days of each cell.
    pub days: u32,
    /// The length of the slices of the upper bounds in seconds, if bounds were asked for.
    pub bound_step_s: Option<u32>,
    /// The members of the network file that were varied.
    pub factors: Vec<String>,
    /// The policies; cells are judged by the first.
    pub policies: Vec<String>,
    /// The number of the cell in which the first policy earns most.
    pub best: usize,
    /// The number of the cheapest cell in which it earns at most 1 % less: the one with the lowest
    /// fixed cost, and among equals with the fewest aircraft and then stands, and then the one in
    /// which it earns most.
    pub cheapest: usize,
    /// How the profit follows each factor.
    pub effects: Vec<Effect>,
    /// Whether these are the effects of a sum that fits best, because some combinations of values
    /// were not played.
    pub effects_fitted: bool,
    /// Whether the design has every combination of values; if not, it is a Latin hypercube.
    pub is_grid: bool,
    /// The cells in the order of the design.
    pub cells: Vec<CellSummary>,
}

/// A cell of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CellSummary {
    /// Its number, from 0.
    pub cell: usize,
    /// The values of the factors.
    pub settings: Vec<Value>,
    /// Why the cell was not played.
    pub left_out: Option<String>,
    /// What its network has.
    pub size: Option<Size>,
    /// The results by policy; empty if the cell was not played.
    pub results: Vec<CellResult>,
}

/// The results of one policy in one cell: means a day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CellResult {
    /// The policy.
    pub policy: String,
    /// Profit, dollars.
    pub profit_usd: Estimate,
    /// Profit less that of the same policy in the best cell on the same day, dollars; `None` in the
    /// best cell.
    pub minus_best_usd: Option<Estimate>,
    /// Profit as a share of the day's upper bound, where bounds were asked for.
    pub bound_share: Option<Estimate>,
    /// Fares paid, dollars.
    pub revenue_usd: f64,
    /// Flights, repositioning flights included.
    pub flights: f64,
    /// Flights without passengers.
    pub repositioning_flights: f64,
    /// Passengers carried.
    pub passengers: f64,
    /// Passengers who wanted to fly and were not carried.
    pub spilled_passengers: f64,
    /// Passengers carried as a share of those who wanted to fly; 1 if none did.
    pub served_share: f64,
    /// Passenger-miles over seat-miles.
    pub load_factor: f64,
}

impl SweepReport {
    /// Computes the statistics of the finished cells; `command` is the command line that the report
    /// shows.
    ///
    /// # Errors
    /// Returns [`Error::Empty`] if no cell is finished.
    pub fn of(sweep: &Sweep, command: String) -> Result<Self, Error> {
        let days = sweep.drawn.days;
        let profits = |policy: usize, record: &CellRecord| -> Vec<f64> {
            record.totals[policy].iter().map(|day| day.profit_usd).collect()
        };
        let played: Vec<(&CellRecord, Size, f64)> = sweep
            .finished()
            .filter_map(|record| {
                let network = sweep.cells[record.cell].network.as_ref().ok()?;
                Some((record, Size::of(network), mean(&profits(0, record))))
            })
            .collect();
        let best = played
            .iter()
            .max_by(|one, other| one.2.total_cmp(&other.2).then(other.0.cell.cmp(&one.0.cell)));
        let Some(&(best, _, best_usd)) = best else {
            return Err(Error::Empty { policies: sweep.competitors.len(), days: 0 });
        };
        let enough_usd = best_usd - NEARLY * best_usd.abs();
        let good = played.iter().filter(|(_, _, profit_usd)| *profit_usd >= enough_usd);
        let cheapest = good.min_by(|(one, a, earns), (other, b, less)| {
            let cost = a.fixed_cost_usd.total_cmp(&b.fixed_cost_usd);
            let size = |size: &Size| (size.aircraft, size.stands, size.chargers);
            let profit = less.total_cmp(earns);
            cost.then(size(a).cmp(&size(b))).then(profit).then(one.cell.cmp(&other.cell))
        });
        let cheapest = cheapest.expect("the best cell is good").0.cell;
        let cell = |(number, cell): (usize, &Cell)| {
            let results = sweep.finished[number].get().into_iter().flat_map(|record| {
                (0..sweep.competitors.len()).map(move |policy| result(sweep, policy, record, best))
            });
            CellSummary {
                cell: number,
                settings: cell.settings.clone(),
                left_out: cell.network.as_ref().err().cloned(),
                size: cell.network.as_ref().ok().map(|network| Size::of(network)),
                results: results.collect(),
            }
        };
        let effects = Effects::of(sweep);
        Ok(Self {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION"),
            command,
            network: sweep.base.name().to_owned(),
            first_day: sweep.drawn.first,
            split: sweep.drawn.purpose.name(),
            days,
            bound_step_s: sweep.bound_step.map(Step::seconds),
            factors: sweep.paths().map(str::to_owned).collect(),
            policies: sweep.competitors.iter().map(|one| one.name.clone()).collect(),
            best: best.cell,
            cheapest,
            effects: effects.all,
            effects_fitted: effects.fitted,
            is_grid: effects.is_grid,
            cells: sweep.cells.iter().enumerate().map(cell).collect(),
        })
    }

    /// The cell of this number.
    pub fn cell(&self, number: usize) -> &CellSummary {
        &self.cells[number]
    }

    /// The cells that were played, by the mean profit of the first policy, best first.
    pub fn ranked(&self) -> Vec<&CellSummary> {
        let mut cells: Vec<&CellSummary> =
            self.cells.iter().filter(|cell| !cell.results.is_empty()).collect();
        cells.sort_by(|one, other| {
            other.results[0].profit_usd.mean.total_cmp(&one.results[0].profit_usd.mean)
        });
        cells
    }

    /// How profit follows those factors that have more than one value.
    pub fn varied(&self) -> impl Iterator<Item = &Effect> + Clone {
        self.effects.iter().filter(|effect| effect.levels.len() > 1)
    }

    /// A sentence about how effects were found, for captions, with a blank before it; nothing where
    /// they are plain means.
    pub fn how_effects_were_found(&self) -> &'static str {
        if self.effects_fitted {
            " Not every combination of settings was played, so that means are those of the sum of one effect for each setting that \
             fits best: like is compared with like."
        } else {
            ""
        }
    }

    /// The settings of a cell in words: `fleet.0.count = 40, tariffs.fare_level = 1.1`. A setting
    /// that is the same in all cells is left out.
    pub fn settings(&self, cell: &CellSummary) -> String {
        let pairs = self.effects.iter().zip(&cell.settings);
        let varied = pairs.filter(|(effect, _)| effect.levels.len() > 1);
        let pairs: Vec<String> = varied
            .map(|(effect, value)| format!("{} = {}", effect.factor, format_value(value)))
            .collect();
        if pairs.is_empty() { "the only design".to_owned() } else { pairs.join(", ") }
    }

    /// The statistics as JSON.
    ///
    /// # Panics
    /// Never panics: numbers and texts can always be written.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain data")
    }
}

fn result(sweep: &Sweep, policy: usize, record: &CellRecord, best: &CellRecord) -> CellResult {
    let days = &record.totals[policy];
    let average =
        |number: fn(&DayTotals) -> f64| mean(&days.iter().map(number).collect::<Vec<f64>>());
    let profits: Vec<f64> = days.iter().map(|day| day.profit_usd).collect();
    let differences = || {
        let pairs = profits.iter().zip(&best.totals[policy]);
        pairs.map(|(profit_usd, best)| profit_usd - best.profit_usd).collect::<Vec<f64>>()
    };
    let shares: Vec<f64> = days
        .iter()
        .zip(&record.upper_bounds_usd)
        .map(|(totals, &bound_usd)| bound_share(totals, bound_usd))
        .collect();
    let (carried, spilled) =
        (average(|day| day.passengers as f64), average(|day| day.spilled_passengers as f64));
    CellResult {
        policy: sweep.competitors[policy].name.clone(),
        profit_usd: Estimate::of(&profits),
        minus_best_usd: (record.cell != best.cell).then(|| Estimate::of(&differences())),
        bound_share: (!shares.is_empty()).then(|| Estimate::of(&shares)),
        revenue_usd: average(|day| day.revenue_usd),
        flights: average(|day| day.flights.into()),
        repositioning_flights: average(|day| day.repositioning_flights.into()),
        passengers: carried,
        spilled_passengers: spilled,
        served_share: if carried + spilled > 0.0 { carried / (carried + spilled) } else { 1.0 },
        load_factor: average(|day| day.load_factor),
    }
}
