//! The ledger of a played day: how revenue becomes profit, cost by cost.

use vertifleet_core::Scenario;
use vertifleet_sim::TraceRow;

use crate::axis::Scale;
use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke};
use crate::map::Area;
use crate::numbers::{dollars, grouped};
use crate::palette::Paint;

/// Height of a line, pixels.
const LINE: f64 = 30.0;

/// A line of the ledger: its name, and its amount in dollars; costs are negative.
pub(crate) type Line = (&'static str, f64);

/// The lines of the ledger: revenue, the costs that there are, and profit. The cost of aircraft is
/// shown even if it is 0, so that the profit of a network without this cost is not mistaken for one
/// after it.
pub fn ledger_lines(day: &Scenario, rows: &[TraceRow]) -> Vec<Line> {
    // From 0, because the sum of no numbers is -0.
    let sum =
        |amount: fn(&TraceRow) -> f64| rows.iter().map(amount).fold(0.0, |sum, usd| sum + usd);
    let revenue_usd = sum(|row| row.revenue_usd);
    let costs = [
        ("passenger cost", sum(|row| row.passenger_cost_usd)),
        ("energy cost", sum(|row| row.energy_cost_usd)),
        ("flight cost", sum(|row| row.flight_cost_usd)),
        ("aircraft cost", day.fleet_cost_usd()),
        ("site cost", day.site_cost_usd()),
    ];
    let profit_usd = costs.iter().fold(revenue_usd, |left, (_, usd)| left - usd);
    let costs = costs.into_iter().filter(|&(name, usd)| usd != 0.0 || name == "aircraft cost");
    let costs = costs.map(|(name, usd)| (name, 0.0 - usd));
    [("revenue", revenue_usd)].into_iter().chain(costs).chain([("profit", profit_usd)]).collect()
}

/// The height that the ledger needs, pixels.
pub(crate) fn height(day: &Scenario, rows: &[TraceRow]) -> f64 {
    LINE * ledger_lines(day, rows).len() as f64
}

/// A bar for each line: revenue from 0, each cost from what was left before it, profit from 0.
pub(crate) fn bars(canvas: &mut Canvas, area: Area, day: &Scenario, rows: &[TraceRow]) {
    let lines = ledger_lines(day, rows);
    let revenue_usd = lines[0].1;
    let mut left_usd = 0.0;
    let mut ends = Vec::new();
    for &(name, usd) in &lines {
        let from_usd = if name == "profit" { 0.0 } else { left_usd };
        left_usd = from_usd + usd;
        ends.push((from_usd, left_usd));
    }
    let all = ends.iter().flat_map(|&(from, to)| [from, to]);
    let x = Scale::around(all.chain([0.0]), area.left, area.right(), 6);
    scale(canvas, area, &x);
    for (at, (&(name, usd), &(from_usd, to_usd))) in lines.iter().zip(&ends).enumerate() {
        let y = area.top + LINE * at as f64;
        let (low, high) = (x.pixel(from_usd.min(to_usd)), x.pixel(from_usd.max(to_usd)));
        let is_cost = at > 0 && name != "profit";
        let look = if is_cost { cost_look() } else { Look::filled(Paint::Series(0)) };
        canvas.rectangle((low, y + 5.0), ((high - low).max(1.0), LINE - 10.0), look);
        let baseline = y + LINE / 2.0 + 4.0;
        canvas.text((area.left - 10.0, baseline), Lettering::LABEL.anchored(Anchor::End), name);
        let share = if revenue_usd > 0.0 && at > 0 {
            format!(", {} % of revenue", grouped(100.0 * usd.abs() / revenue_usd, 1))
        } else {
            String::new()
        };
        let small = Lettering { paint: Paint::Ink, ..Lettering::SMALL };
        canvas.text((area.right() + 10.0, baseline), small, &(dollars(usd) + &share));
    }
    let zero = x.pixel(0.0);
    canvas.line((zero, area.top), (zero, area.bottom()), Stroke::solid(Paint::Ink, 1.4));
}

/// Lines at round amounts, with labels below.
fn scale(canvas: &mut Canvas, area: Area, x: &Scale) {
    for tick in x.ticks() {
        let place = x.pixel(tick);
        canvas.line((place, area.top), (place, area.bottom()), Stroke::solid(Paint::Grid, 1.0));
        let label = Lettering::SMALL.anchored(Anchor::Middle);
        canvas.text((place, area.bottom() + 18.0), label, &dollars(tick));
    }
}

fn cost_look() -> Look {
    Look {
        fill: Some((Paint::Series(1), 0.45)),
        stroke: Some(Stroke::solid(Paint::Series(1), 1.0)),
    }
}
