//! The tables of a sweep, by cell and by day, as CSV and as Parquet.
//!
//! In Parquet, a setting has the narrowest type that fits all of its values in the design: whole
//! numbers, numbers, true or false, or else texts. So the schema does not depend on the results. In
//! CSV, settings are written as they were given.

use serde_json::Value;
use vertifleet_export::{Cells, TypedColumn};
use vertifleet_sim::{DayNumber, DayTotals};

use vertifleet_study::sweep::{CellResult, CellSummary, Sweep, SweepReport, format_value};

/// How the settings of a table are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Settings {
    /// As they were given.
    AsGiven,
    /// With the narrowest type that fits.
    Typed,
}

/// A row of the cells: a cell with the results of one policy, or a cell that was left out.
type CellRow<'a> = (&'a CellSummary, Option<&'a CellResult>);

/// One row for every cell and policy. A cell that was not played has one row, without results.
pub(crate) fn cells(report: &SweepReport, settings: Settings) -> Vec<TypedColumn> {
    let mut rows: Vec<CellRow<'_>> = Vec::new();
    for cell in &report.cells {
        rows.extend(cell.results.iter().map(|result| (cell, Some(result))));
        rows.extend(cell.left_out.as_ref().map(|_| (cell, None)));
    }
    let mut columns = vec![TypedColumn::new("cell", whole(rows.iter().map(|row| row.0.cell)))];
    for (at, factor) in report.factors.iter().enumerate() {
        let design: Vec<&Value> = report.cells.iter().map(|cell| &cell.settings[at]).collect();
        let values = rows.iter().map(|(cell, _)| &cell.settings[at]);
        columns.push(TypedColumn::new(factor, Kind::of(&design, settings).cells(values)));
    }
    columns.extend(sizes(&rows));
    columns.extend(results(&rows));
    columns
}

/// The sizes of the networks of cells.
fn sizes(rows: &[CellRow<'_>]) -> Vec<TypedColumn> {
    let sizes = || rows.iter().map(|(cell, _)| cell.size);
    let aircraft = sizes().map(|size| size.map(|size| count(size.aircraft as u64)));
    let stands = sizes().map(|size| size.map(|size| size.stands.into()));
    let chargers = sizes().map(|size| size.map(|size| size.chargers.into()));
    let cost_usd = sizes().map(|size| size.map(|size| size.fixed_cost_usd));
    vec![
        TypedColumn::new("aircraft", Cells::OptionalWhole(aircraft.collect())),
        TypedColumn::new("stands", Cells::OptionalWhole(stands.collect())),
        TypedColumn::new("chargers", Cells::OptionalWhole(chargers.collect())),
        TypedColumn::new("fixed_cost_usd", Cells::OptionalNumber(cost_usd.collect())),
    ]
}

/// The results of policies on the days of cells.
fn results(rows: &[CellRow<'_>]) -> Vec<TypedColumn> {
    let policy = rows.iter().map(|(_, result)| result.map(|result| result.policy.clone()));
    let reason = rows.iter().map(|(cell, result)| match result {
        Some(_) => None,
        None => cell.left_out.clone(),
    });
    let number = |name: &str, number: fn(&CellResult) -> Option<f64>| {
        let numbers = rows.iter().map(|(_, result)| result.and_then(number));
        TypedColumn::new(name, Cells::OptionalNumber(numbers.collect()))
    };
    vec![
        TypedColumn::new("policy", Cells::OptionalText(policy.collect())),
        number("profit_usd", |one| Some(one.profit_usd.mean)),
        number("profit_half_width_95_usd", |one| one.profit_usd.half_width_95),
        number("minus_best_usd", |one| Some(one.minus_best_usd.as_ref()?.mean)),
        number("minus_best_half_width_95_usd", |one| one.minus_best_usd.as_ref()?.half_width_95),
        number("bound_share", |one| Some(one.bound_share.as_ref()?.mean)),
        number("revenue_usd", |one| Some(one.revenue_usd)),
        number("flights", |one| Some(one.flights)),
        number("repositioning_flights", |one| Some(one.repositioning_flights)),
        number("passengers", |one| Some(one.passengers)),
        number("spilled_passengers", |one| Some(one.spilled_passengers)),
        number("served_share", |one| Some(one.served_share)),
        number("load_factor", |one| Some(one.load_factor)),
        TypedColumn::new("left_out", Cells::OptionalText(reason.collect())),
    ]
}

/// A row of the days: cell, policy, position of the day, its numbers and its bound.
struct DayRow<'a> {
    cell: usize,
    policy: &'a str,
    day: usize,
    totals: &'a DayTotals,
    upper_bound_usd: Option<f64>,
}

/// One row for every cell, policy and day.
pub(crate) fn days(report: &SweepReport, sweep: &Sweep, settings: Settings) -> Vec<TypedColumn> {
    let mut rows: Vec<DayRow<'_>> = Vec::new();
    for record in sweep.finished() {
        for (policy, days) in report.policies.iter().zip(&record.totals) {
            rows.extend(days.iter().enumerate().map(|(day, totals)| {
                let upper_bound_usd = record.upper_bounds_usd.get(day).copied();
                DayRow { cell: record.cell, policy, day, totals, upper_bound_usd }
            }));
        }
    }
    let mut columns = vec![TypedColumn::new("cell", whole(rows.iter().map(|row| row.cell)))];
    for (at, factor) in report.factors.iter().enumerate() {
        let design: Vec<&Value> = report.cells.iter().map(|cell| &cell.settings[at]).collect();
        let values = rows.iter().map(|row| &report.cells[row.cell].settings[at]);
        columns.push(TypedColumn::new(factor, Kind::of(&design, settings).cells(values)));
    }
    let policies = rows.iter().map(|row| row.policy.to_owned()).collect();
    let day = rows.iter().map(|row| count(report.first_day + row.day as u64)).collect();
    columns.push(TypedColumn::new("policy", Cells::Text(policies)));
    columns.push(TypedColumn::new("day", Cells::Whole(day)));
    columns.extend(numbers(&rows));
    let bounds = rows.iter().map(|row| row.upper_bound_usd).collect();
    columns.push(TypedColumn::new("upper_bound_usd", Cells::OptionalNumber(bounds)));
    columns
}

/// The numbers of the days.
fn numbers(rows: &[DayRow<'_>]) -> Vec<TypedColumn> {
    let all: Vec<_> = rows.iter().map(|row| row.totals.numbers()).collect();
    let of_number = |(at, (name, kind)): (usize, (&str, DayNumber))| {
        let column = all.iter().map(|numbers| numbers[at].1);
        let cells = match kind {
            DayNumber::Amount(_) => Cells::Number(column.map(amount).collect()),
            DayNumber::Count(_) => Cells::Whole(column.map(counted).collect()),
        };
        TypedColumn::new(name, cells)
    };
    DayTotals::default().numbers().into_iter().enumerate().map(of_number).collect()
}

fn amount(number: DayNumber) -> f64 {
    match number {
        DayNumber::Amount(amount) => amount,
        DayNumber::Count(count) => count as f64,
    }
}

fn counted(number: DayNumber) -> i64 {
    match number {
        DayNumber::Count(number) => count(number),
        DayNumber::Amount(_) => unreachable!("a number of a day is always of one kind"),
    }
}

fn count(number: u64) -> i64 {
    i64::try_from(number).expect("counts and numbers of days are far below 2^63")
}

fn whole(numbers: impl Iterator<Item = usize>) -> Cells {
    Cells::Whole(numbers.map(|number| count(number as u64)).collect())
}

/// The type of a setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Whole,
    Number,
    Flag,
    Text,
}

impl Kind {
    /// The narrowest type that fits all values of a design.
    fn of(design: &[&Value], settings: Settings) -> Self {
        let all = |fits: fn(&Value) -> bool| design.iter().all(|value| fits(value));
        if settings == Settings::AsGiven {
            Self::Text
        } else if all(Value::is_i64) {
            Self::Whole
        } else if all(Value::is_number) {
            Self::Number
        } else if all(Value::is_boolean) {
            Self::Flag
        } else {
            Self::Text
        }
    }

    fn cells<'a>(self, settings: impl Iterator<Item = &'a Value>) -> Cells {
        const FITS: &str = "all values of the design have this type";
        match self {
            Self::Whole => Cells::Whole(settings.map(|one| one.as_i64().expect(FITS)).collect()),
            Self::Number => Cells::Number(settings.map(|one| one.as_f64().expect(FITS)).collect()),
            Self::Flag => Cells::Flag(settings.map(|one| one.as_bool().expect(FITS)).collect()),
            Self::Text => Cells::Text(settings.map(format_value).collect()),
        }
    }
}
