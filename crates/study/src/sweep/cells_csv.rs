//! `cells.csv`: one row for every cell and policy.

use super::SweepReport;
use super::design::format_value;
use crate::statistics::Estimate;

const TO_MEMORY: &str = "memory takes every row";

/// The cells as CSV with a header row. A cell that was not played has one row, without results.
pub(super) fn text(report: &SweepReport) -> String {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    let head = ["cell"].into_iter().chain(report.factors.iter().map(String::as_str)).chain([
        "aircraft",
        "stands",
        "chargers",
        "fixed_cost_usd",
        "policy",
        "profit_usd",
        "profit_half_width_95_usd",
        "minus_best_usd",
        "minus_best_half_width_95_usd",
        "bound_share",
        "revenue_usd",
        "flights",
        "repositioning_flights",
        "passengers",
        "spilled_passengers",
        "served_share",
        "load_factor",
        "left_out",
    ]);
    writer.write_record(head).expect(TO_MEMORY);
    for cell in &report.cells {
        let mut start = vec![cell.cell.to_string()];
        start.extend(cell.settings.iter().map(format_value));
        match cell.size {
            Some(size) => start.extend([
                size.aircraft.to_string(),
                size.stands.to_string(),
                size.chargers.to_string(),
                size.fixed_cost_usd.to_string(),
            ]),
            None => start.extend(std::iter::repeat_n(String::new(), 4)),
        }
        for result in &cell.results {
            let mut row = start.clone();
            row.push(result.policy.clone());
            let half = |estimate: &Estimate| number(estimate.half_width_95);
            row.extend([result.profit_usd.mean.to_string(), half(&result.profit_usd)]);
            let minus = result.minus_best_usd.as_ref();
            row.extend([number(minus.map(|one| one.mean)), minus.map_or_else(String::new, half)]);
            row.push(number(result.bound_share.as_ref().map(|share| share.mean)));
            row.extend(
                [
                    result.revenue_usd,
                    result.flights,
                    result.repositioning_flights,
                    result.passengers,
                    result.spilled_passengers,
                    result.served_share,
                    result.load_factor,
                ]
                .map(|number| number.to_string()),
            );
            row.push(String::new());
            writer.write_record(row).expect(TO_MEMORY);
        }
        if let Some(reason) = &cell.left_out {
            let mut row = start.clone();
            row.extend(std::iter::repeat_n(String::new(), 13));
            row.push(reason.clone());
            writer.write_record(row).expect(TO_MEMORY);
        }
    }
    String::from_utf8(writer.into_inner().expect(TO_MEMORY)).expect("text and numbers are UTF-8")
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
