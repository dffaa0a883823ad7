//! How profit follows each factor: the mean over all cells that have a value of the factor in common.

use serde::Serialize;
use serde_json::Value;

use super::Sweep;
use super::record::CellRecord;
use super::summary::shown;
use crate::statistics::Estimate;

/// A factor with more values than this is shown in groups of neighbouring values.
const MOST_LEVELS: usize = 12;
/// Number of such groups.
const GROUPS: usize = 6;

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
    /// Mean profit a day over these cells by policy, with its interval over the days; dollars.
    pub profit_usd: Vec<Estimate>,
}

impl Effect {
    /// The effects of all factors.
    pub(super) fn of_all(sweep: &Sweep, records: &[Option<CellRecord>]) -> Vec<Self> {
        let records: Vec<&CellRecord> = records.iter().flatten().collect();
        (0..sweep.factors.len()).map(|factor| Self::of(sweep, factor, &records)).collect()
    }

    fn of(sweep: &Sweep, factor: usize, records: &[&CellRecord]) -> Self {
        let value = |record: &CellRecord| &sweep.cells[record.cell].settings[factor];
        let levels: Vec<LevelEffect> =
            groups(records, value).iter().map(|group| level(sweep, group, value)).collect();
        let means = levels.iter().map(|level| level.profit_usd[0].mean);
        let (low, high) = means.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), mean| {
            (low.min(mean), high.max(mean))
        });
        Self { factor: sweep.factors[factor].path.clone(), levels, span_usd: high - low }
    }
}

/// The records by their value of a factor, neighbouring values together where there are many.
fn groups<'a>(
    records: &[&'a CellRecord],
    value: impl Fn(&CellRecord) -> &'a Value,
) -> Vec<Vec<&'a CellRecord>> {
    let number = |record: &CellRecord| value(record).as_f64();
    let mut sorted = records.to_vec();
    let are_numbers = records.iter().all(|record| number(record).is_some());
    if are_numbers {
        let number = |record: &CellRecord| number(record).unwrap_or_default();
        sorted.sort_by(|one, other| number(one).total_cmp(&number(other)));
    }
    let mut groups: Vec<Vec<&CellRecord>> = Vec::new();
    for record in sorted {
        match groups.iter_mut().find(|group| value(group[0]) == value(record)) {
            Some(group) => group.push(record),
            None => groups.push(vec![record]),
        }
    }
    if !are_numbers || groups.len() <= MOST_LEVELS {
        return groups;
    }
    let all = groups.len();
    let bounds = (0..GROUPS).map(|at| at * all / GROUPS..(at + 1) * all / GROUPS);
    bounds.map(|bounds| groups[bounds].concat()).collect()
}

fn level<'a>(
    sweep: &Sweep,
    group: &[&CellRecord],
    value: impl Fn(&CellRecord) -> &'a Value,
) -> LevelEffect {
    let (first, last) = (value(group[0]), value(group[group.len() - 1]));
    let numbers: Option<Vec<f64>> = group.iter().map(|record| value(record).as_f64()).collect();
    let of_policy = |policy: usize| {
        let of_day = |day: usize| {
            let sum: f64 = group.iter().map(|record| record.totals[policy][day].profit_usd).sum();
            sum / group.len() as f64
        };
        Estimate::of(&(0..group[0].totals[policy].len()).map(of_day).collect::<Vec<f64>>())
    };
    LevelEffect {
        label: if first == last {
            shown(first)
        } else {
            format!("{} to {}", shown(first), shown(last))
        },
        value: numbers.map(|all| all.iter().sum::<f64>() / all.len() as f64),
        cells: group.len(),
        profit_usd: (0..sweep.policies.len()).map(of_policy).collect(),
    }
}
