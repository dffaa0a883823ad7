//! A sweep of comparisons that were played elsewhere, such as on the nodes of a cluster: the same
//! tables, figures and page.

use serde_json::Value;
use vertifleet_core::Network;
use vertifleet_optimize::Step;

use super::design::{Factor, Levels};
use super::record::CellRecord;
use super::{Cell, Sweep};
use crate::comparison::DrawnDays;
use crate::error::Error;
use crate::record::ComparisonRecords;

impl Sweep {
    /// The sweep whose cells have these settings, by path, and the comparisons on their networks,
    /// where they have one; with the records of the cells, from which [`records`](Self::records)
    /// makes the report.
    ///
    /// # Errors
    /// Returns [`Error::Empty`] without a comparison, [`Error::PartsDiffer`] if the comparisons
    /// have not the same policies on the same drawn days or one is missing, and the errors of
    /// [`Network::changed`].
    pub fn of_comparisons(
        network: &Network,
        paths: &[String],
        cells: Vec<(Vec<Value>, Option<&ComparisonRecords>)>,
    ) -> Result<(Self, Vec<Option<CellRecord>>), Error> {
        let comparisons = || cells.iter().filter_map(|&(_, records)| records);
        let Some(first) = comparisons().next() else {
            return Err(Error::Empty { policies: 0, days: 0 });
        };
        let names = |records: &ComparisonRecords| -> Vec<String> {
            records.policies.iter().map(|policy| policy.name.clone()).collect()
        };
        let alike = |records: &ComparisonRecords| {
            let days = (records.seed, records.split, records.days, records.bound_step_s);
            (days, names(records))
        };
        let differ = |rule: &str| Error::PartsDiffer { rule: rule.to_owned() };
        let (Some(seed), true) = (first.seed, comparisons().all(|one| alike(one) == alike(first)))
        else {
            let rule = "a sweep has the same policies on the same drawn days in all of its cells";
            return Err(differ(rule));
        };
        let values = |at: usize| cells.iter().map(|(settings, _)| settings[at].clone()).collect();
        let factors: Vec<Factor> = (0..paths.len())
            .map(|at| Factor { path: paths[at].clone(), levels: Levels::List(values(at)) })
            .collect();
        let record = |(cell, (_, records)): (usize, &(Vec<Value>, Option<&ComparisonRecords>))| {
            let records = (*records)?;
            let bounds = records.policies.iter().take(1).flat_map(|policy| &policy.days);
            Some(CellRecord {
                cell,
                upper_bounds_usd: bounds.filter_map(|day| day.upper_bound_usd).collect(),
                totals: records
                    .policies
                    .iter()
                    .map(|policy| policy.days.iter().map(|day| day.totals).collect())
                    .collect(),
            })
        };
        let records: Vec<Option<CellRecord>> = cells.iter().enumerate().map(record).collect();
        let days = u32::try_from(first.days).expect("a comparison has few days");
        let policies = names(first);
        let minutes = first.bound_step_s.map(|seconds| seconds / 60);
        let bound_step = minutes.map(Step::from_minutes).transpose()?;
        let cell = |(settings, _)| Cell::of(network, &factors, settings);
        let cells = cells.into_iter().map(cell).collect::<Result<Vec<Cell>, Error>>()?;
        if cells.iter().zip(&records).any(|(cell, found)| cell.network.is_ok() != found.is_some()) {
            return Err(differ("every cell of a sweep that has a network has a comparison"));
        }
        let drawn = DrawnDays { purpose: first.split, first: seed, days };
        let mut sweep = Self {
            base: network.clone(),
            factors,
            cells,
            policies,
            competitors: Vec::new(),
            drawn,
            bound_step,
            fingerprint: String::new(),
        };
        sweep.fingerprint = sweep.fingerprint();
        Ok((sweep, records))
    }
}
