//! `networks.csv`: one row for every policy and network.

use serde::Serialize;

use super::GeneralisationReport;

#[derive(Serialize)]
struct Row<'a> {
    network: &'a str,
    seed: u64,
    vertiports: usize,
    aircraft: usize,
    upper_bound_usd: f64,
    policy: &'a str,
    profit_usd: f64,
    bound_share: f64,
}

/// The rows as CSV with a header; networks in order, and policies in the order in which they were named.
pub(super) fn text(summary: &GeneralisationReport) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for network in &summary.networks {
        for outcome in &network.results {
            let row = Row {
                network: &network.network,
                seed: network.seed,
                vertiports: network.vertiports,
                aircraft: network.aircraft,
                upper_bound_usd: network.upper_bound_usd,
                policy: &outcome.policy,
                profit_usd: outcome.profit_usd,
                bound_share: outcome.bound_share,
            };
            writer.serialize(row).expect("flat rows written to memory");
        }
    }
    let bytes = writer.into_inner().expect("memory takes every byte");
    String::from_utf8(bytes).expect("text and numbers are UTF-8")
}
