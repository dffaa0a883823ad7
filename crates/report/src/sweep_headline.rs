//! The result of a sweep in two or three sentences.

use vertifleet_picture::numbers::{counted, dollars, grouped};

use vertifleet_study::sweep::{CellSummary, SweepReport};

/// Names the most profitable design, a cheaper one that earns nearly as much, and the factor with
/// the largest effect.
pub(crate) fn headline(report: &SweepReport) -> String {
    let best = report.cell(report.best);
    let earns = |cell: &CellSummary| cell.results[0].profit_usd.written(dollars);
    let mut sentences = vec![format!(
        "{} earns most with {}: {} a day on average over {}.",
        report.policies[0],
        report.settings(best),
        earns(best),
        counted(report.days as usize, "day", "days")
    )];
    let cheapest = report.cell(report.cheapest);
    if let (Some(size), Some(most)) = (cheapest.size, best.size)
        && cheapest.cell != best.cell
    {
        let cost = if size.fixed_cost_usd < most.fixed_cost_usd {
            format!(
                "; its fixed cost is {} a day lower",
                dollars(most.fixed_cost_usd - size.fixed_cost_usd)
            )
        } else {
            String::new()
        };
        sentences.push(format!(
            "The cheapest design within 1 % of that is {} ({} and {}{cost}): {}.",
            report.settings(cheapest),
            counted(size.aircraft, "aircraft", "aircraft"),
            counted(size.stands as usize, "stand", "stands"),
            earns(cheapest)
        ));
    }
    let largest = report.varied().max_by(|one, other| one.span_usd.total_cmp(&other.span_usd));
    if let Some(effect) =
        largest.filter(|effect| report.varied().count() > 1 && effect.span_usd > 0.0)
    {
        let (matters, between) = if report.is_grid {
            ("matters most", "its values")
        } else {
            ("seems to matter most", "groups of its values")
        };
        sentences.push(format!(
            "{} {matters}: between {between} mean profits are up to ${} apart.",
            effect.factor,
            grouped(effect.span_usd, 0)
        ));
    }
    sentences.join(" ")
}
