//! All findings about a network file in one pass, for people who are writing one.
//!
//! Reading stops at the first error, because later checks rely on earlier ones. Here each entry of
//! each list is checked alone, and what refers to vertiports is checked if these are sound. A
//! text that cannot be parsed has one finding.

use std::path::Path;

use super::sites::Sites;
use super::{
    DemandModels, FORMAT, RawNetwork, fleet, name, network, start_charge, start_stands, time_zone,
};
use crate::raw::Positions;
use crate::{Error, FormatError, Network, parse};

/// The errors that have been found.
struct Found(Vec<FormatError>);

impl Found {
    /// Keeps the error, or returns what was checked.
    fn check<T>(&mut self, outcome: Result<T, FormatError>) -> Option<T> {
        outcome.map_err(|error| self.0.push(error)).ok()
    }
}

/// The network of a text, or all its errors that can be found in one pass.
pub(crate) fn network_or_findings(
    text: &str,
    folder: Option<&Path>,
    origin: &str,
) -> Result<Network, Vec<Error>> {
    let first = match network(text, folder, origin) {
        Ok(network) => return Ok(network),
        Err(first) => first,
    };
    let text = text.strip_prefix(parse::MARK).unwrap_or(text);
    let Ok(raw) = parse::toml::<RawNetwork>(text, FORMAT) else { return Err(vec![first]) };
    let mut found = Found(Vec::new());
    raw.findings(&mut found);
    // An error that only the whole file has, as of distances or a table of demand, comes last.
    let message = first.to_string();
    let mut found: Vec<Error> = found.0.into_iter().map(|error| error.in_file(origin)).collect();
    if found.iter().all(|error| error.to_string() != message) {
        found.push(first);
    }
    Err(found)
}

impl RawNetwork {
    fn findings(self, found: &mut Found) {
        found.check(name(&self.name));
        found.check(self.time_zone.as_deref().map_or(Ok(()), time_zone));
        found.check(self.operations.check());
        let vertiports = self.vertiports.len();
        found.check(
            self.start_stands.map_or(Ok(()), |raw| start_stands(raw, vertiports).map(|_| ())),
        );
        found.check(self.start_charge.map_or(Ok(()), |raw| start_charge(raw).map(|_| ())));
        let types = self.aircraft_types.len();
        let kinds: Vec<_> = self
            .aircraft_types
            .into_iter()
            .enumerate()
            .filter_map(|(at, raw)| found.check(raw.check(at)))
            .collect();
        let costs = self.tariffs.site_costs_usd();
        let before = found.0.len();
        for (at, site) in self.vertiports.iter().enumerate() {
            found.check(site.clone().check(at, costs));
        }
        if found.0.len() > before {
            return;
        }
        let Some(Sites { vertiports, mut distance_mi }) =
            found.check(Sites::of(self.vertiports, costs))
        else {
            return;
        };
        let Some(places) = found.check(Positions::of_vertiports(&vertiports)) else {
            return;
        };
        if kinds.len() == types {
            found.check(fleet(&self.fleet, &kinds, &vertiports));
        }
        for (at, raw) in self.corridors.into_iter().flatten().enumerate() {
            found.check(raw.check(at, &places, &mut distance_mi));
        }
        for (at, raw) in self.closures.into_iter().enumerate() {
            found.check(raw.check(at, &places, &vertiports));
        }
        found.check(self.disturbances.check(&places, vertiports.len()));
        found.check(self.market.check(&places, vertiports.len()));
        found.check(self.feature_scales.map_or(Ok(()), |raw| raw.check().map(|_| ())));
        let models = DemandModels {
            equation_1: self.demand,
            daily: self.daily_demand,
            // A table in another file is read with the whole file.
            hourly: self.hourly_demand.filter(|hourly| hourly.table.is_none()),
            uniform: self.uniform_demand,
        };
        let is_given = models.count() > 0;
        if let Some(demand) =
            is_given.then(|| found.check(models.single_table(&vertiports, &places))).flatten()
        {
            found.check(self.tariffs.check(demand.periods.len(), &places));
        }
    }
}
