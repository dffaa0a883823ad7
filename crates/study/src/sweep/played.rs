//! A sweep of comparisons that were played elsewhere, such as on the nodes of a cluster: the same tables, figures and page.

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
    /// The sweep whose cells have these settings, by path, and the comparisons on their networks; with the records of the
    /// cells, from which [`records`](Self::records) makes the report.
    ///
    /// # Errors
    /// Returns [`Error::Empty`] without a cell, [`Error::PartsDiffer`] if the comparisons have not the same policies on the same
    /// drawn days, and the errors of [`Network::changed`].
    pub fn of_comparisons(
        network: &Network,
        paths: &[String],
        cells: Vec<(Vec<Value>, &ComparisonRecords)>,
    ) -> Result<(Self, Vec<Option<CellRecord>>), Error> {
        let Some(&(_, first)) = cells.first() else {
            return Err(Error::Empty { policies: 0, days: 0 });
        };
        let names = |records: &ComparisonRecords| -> Vec<String> {
            records.policies.iter().map(|policy| policy.name.clone()).collect()
        };
        let alike = |records: &ComparisonRecords| {
            let days = (records.seed, records.split, records.days, records.bound_step_s);
            (days, names(records))
        };
        let (Some(seed), true) = (first.seed, cells.iter().all(|one| alike(one.1) == alike(first)))
        else {
            let rule = "a sweep has the same policies on the same drawn days in all of its cells";
            return Err(Error::PartsDiffer { rule: rule.to_owned() });
        };
        let values = |at: usize| cells.iter().map(|(settings, _)| settings[at].clone()).collect();
        let factors: Vec<Factor> = (0..paths.len())
            .map(|at| Factor { path: paths[at].clone(), levels: Levels::List(values(at)) })
            .collect();
        let record = |(cell, (_, records)): (usize, &(Vec<Value>, &ComparisonRecords))| {
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
        let records = cells.iter().enumerate().map(record).collect();
        let days = u32::try_from(first.days).expect("a comparison has few days");
        let policies = names(first);
        let minutes = first.bound_step_s.map(|seconds| seconds / 60);
        let bound_step = minutes.map(Step::from_minutes).transpose()?;
        let cell = |(settings, _)| Cell::of(network, &factors, settings);
        let cells = cells.into_iter().map(cell).collect::<Result<Vec<Cell>, Error>>()?;
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
        sweep.fingerprint = sweep.print();
        Ok((sweep, records))
    }
}
