//! How profit follows each factor: the mean over all cells that have a value of the factor in
//! common, like compared with like.

use serde::Serialize;
use serde_json::Value;

use super::Sweep;
use super::additive::{level_means, plain_means};
use super::design::format_value;
use super::record::CellRecord;
use crate::statistics::Estimate;

/// A factor with more values than this is shown in groups of neighbouring values.
const MOST_LEVELS: usize = 12;
/// Number of such groups.
const GROUPS: usize = 6;
/// Cells of a group at least, where a design has few cells with the same value.
const CELLS_OF_A_GROUP: usize = 4;

/// How profit follows a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    /// The member of the network file.
    pub factor: String,
    /// Its values, or groups of them, in ascending order if they are numbers.
    pub levels: Vec<LevelEffect>,
    /// How far apart the highest and the lowest mean profit of the first policy are, dollars.
    pub span_usd: f64,
}

/// The cells with one value of a factor, or with neighbouring ones.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LevelEffect {
    /// The value, or the lowest and the highest value.
    pub label: String,
    /// The mean value, if values are numbers.
    pub value: Option<f64>,
    /// Number of cells.
    pub cells: usize,
    /// Mean profit a day over these cells by policy, with its interval over the days; dollars. In a
    /// design without some combinations of values, cells with one value differ from others in other
    /// settings too; then it is the mean that the best sum of one effect for each setting gives
    /// (`additive.rs`).
    pub profit_usd: Vec<Estimate>,
}

/// The effects of all factors.
pub(super) struct Effects {
    pub(super) all: Vec<Effect>,
    /// Whether means are those of a sum of effects, because combinations of values are missing.
    pub(super) fitted: bool,
    /// Whether the design has every combination of values.
    pub(super) is_grid: bool,
}

impl Effects {
    pub(super) fn of(sweep: &Sweep) -> Self {
        let played: Vec<&CellRecord> = sweep.finished().collect();
        let is_grid = sweep.is_grid();
        let factors: Vec<Vec<Vec<usize>>> = (0..sweep.factors.len())
            .map(|factor| groups(sweep, factor, &played, is_grid))
            .collect();
        let unknown = 1 + factors.iter().map(|levels| levels.len() - 1).sum::<usize>();
        let fitted = !(is_grid && played.len() == sweep.cells.len()) && 2 * unknown <= played.len();
        let days = played[0].totals[0].len();
        let by_policy: Vec<Vec<Vec<Vec<f64>>>> = (0..sweep.competitors.len())
            .map(|policy| {
                let of_day = |day: usize| {
                    let profits = played.iter().map(|record| record.totals[policy][day].profit_usd);
                    let profits: Vec<f64> = profits.collect();
                    if fitted {
                        level_means(&factors, &profits)
                    } else {
                        plain_means(&factors, &profits)
                    }
                };
                (0..days).map(of_day).collect()
            })
            .collect();
        let effect = |(factor, levels): (usize, &Vec<Vec<usize>>)| {
            let level = |(at, cells): (usize, &Vec<usize>)| {
                let estimate = |days: &Vec<Vec<Vec<f64>>>| {
                    Estimate::of(&days.iter().map(|day| day[factor][at]).collect::<Vec<f64>>())
                };
                let values = cells.iter().map(|&cell| value(sweep, factor, played[cell]));
                LevelEffect::of(
                    &values.collect::<Vec<&Value>>(),
                    by_policy.iter().map(estimate).collect(),
                )
            };
            Effect::of(&sweep.factors[factor].path, levels.iter().enumerate().map(level).collect())
        };
        Self { all: factors.iter().enumerate().map(effect).collect(), fitted, is_grid }
    }
}

impl Effect {
    fn of(factor: &str, levels: Vec<LevelEffect>) -> Self {
        let means = levels.iter().map(|level| level.profit_usd[0].mean);
        let (low, high) = means.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), mean| {
            (low.min(mean), high.max(mean))
        });
        Self { factor: factor.to_owned(), levels, span_usd: high - low }
    }
}

impl LevelEffect {
    fn of(values: &[&Value], profit_usd: Vec<Estimate>) -> Self {
        let (first, last) = (values[0], values[values.len() - 1]);
        let numbers: Option<Vec<f64>> = values.iter().map(|value| value.as_f64()).collect();
        let number = |all: Vec<f64>| {
            let same = all.iter().all(|one| one == &all[0]);
            if same { all[0] } else { all.iter().sum::<f64>() / all.len() as f64 }
        };
        Self {
            label: if first == last {
                format_value(first)
            } else {
                format!("{} to {}", format_value(first), format_value(last))
            },
            value: numbers.map(number),
            cells: values.len(),
            profit_usd,
        }
    }
}

fn value<'a>(sweep: &'a Sweep, factor: usize, record: &CellRecord) -> &'a Value {
    &sweep.cells[record.cell].settings[factor]
}

/// The positions of the records by their value of a factor, neighbouring values together where
/// there are many, or where few cells have one value.
fn groups(sweep: &Sweep, factor: usize, records: &[&CellRecord], grid: bool) -> Vec<Vec<usize>> {
    let value = |at: usize| value(sweep, factor, records[at]);
    let mut sorted: Vec<usize> = (0..records.len()).collect();
    let are_numbers = sorted.iter().all(|&at| value(at).is_number());
    if are_numbers {
        let number = |at: usize| value(at).as_f64().unwrap_or_default();
        sorted.sort_by(|&one, &other| number(one).total_cmp(&number(other)));
    }
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for at in sorted {
        match groups.iter_mut().find(|group| value(group[0]) == value(at)) {
            Some(group) => group.push(at),
            None => groups.push(vec![at]),
        }
    }
    let most = (records.len() / CELLS_OF_A_GROUP).clamp(2, GROUPS);
    let joined = match (grid, groups.len()) {
        (true, all) if all > MOST_LEVELS => GROUPS,
        (false, all) if all > most => most,
        _ => return groups,
    };
    if !are_numbers {
        return groups;
    }
    let all = groups.len();
    let bounds = (0..joined).map(|at| at * all / joined..(at + 1) * all / joined);
    bounds.map(|bounds| groups[bounds].concat()).collect()
}
