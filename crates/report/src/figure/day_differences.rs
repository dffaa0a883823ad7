//! The difference in profit between the best policy and a reference on each day, sorted. The paper
//! has no such figure; it shows whether a lead in the mean comes from most days or from a few.

use std::fmt::Write as _;

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{
    Anchor, Canvas, Lettering, Look, Stroke, pixels, shortened, text_width,
};
use vertifleet_picture::numbers::{counted, dollars, signed_dollars};
use vertifleet_picture::palette::Paint;

use super::Figure;
use vertifleet_study::ComparisonReport;
use vertifleet_study::comparison::PairedDifference;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 340.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 96.0;
const BOTTOM: f64 = 44.0;

/// The bars of the days on which the best policy earns more, and of those on which it earns less,
/// one path each.
struct Bars {
    ahead: String,
    behind: String,
}

/// The figure; `None` if there is only one policy.
pub(super) fn figure(summary: &ComparisonReport) -> Option<Figure> {
    let comparison = summary.best_against_reference()?;
    let (first, second) =
        (&summary.policies[comparison.pair.0], &summary.policies[comparison.pair.1]);
    let pairs = first.daily_profit_usd.iter().zip(&second.daily_profit_usd);
    let mut differences: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
    differences.sort_by(|a, b| b.total_cmp(a));

    let title =
        format!("{} minus {}, day by day", shortened(&first.name, 22), shortened(&second.name, 22));
    let mut canvas =
        Canvas::new(WIDTH, HEIGHT, &title, "Difference of the daily profit on the same day, $");
    let scale = Scale::around(differences.iter().copied().chain([0.0]), HEIGHT - BOTTOM, TOP, 6);
    draw_axis(&mut canvas, &scale);
    let bars = bars(&differences, &scale);
    let (ahead, behind) = looks(comparison);
    canvas.path(&bars.ahead, ahead);
    canvas.path(&bars.behind, behind);
    draw_mean(&mut canvas, &scale, comparison);
    draw_key(&mut canvas, comparison);
    Some(Figure {
        slug: "figure-day-by-day".into(),
        caption: caption(comparison, differences.len()),
        svg: canvas.into_svg(),
    })
}

fn looks(comparison: &PairedDifference) -> (Look, Look) {
    let behind = Paint::Series(comparison.pair.1);
    let outline = Some(Stroke::solid(behind, 1.0));
    (
        Look::filled(Paint::Series(comparison.pair.0)),
        Look { fill: Some((behind, 0.3)), stroke: outline },
    )
}

fn bars(differences: &[f64], scale: &Scale) -> Bars {
    let slot = (WIDTH - RIGHT - LEFT) / differences.len() as f64;
    // A gap separates the bars of single days as long as there is a pixel for it.
    let width = if slot >= 3.0 { (slot * 0.75).min(28.0) } else { slot };
    let zero = scale.pixel(0.0);
    let mut bars = Bars { ahead: String::new(), behind: String::new() };
    for (position, &difference) in differences.iter().enumerate() {
        let left = LEFT + slot * (position as f64 + 0.5) - width / 2.0;
        let path = if difference >= 0.0 { &mut bars.ahead } else { &mut bars.behind };
        let (left, right) = (format!("{left:.2}"), format!("{:.2}", left + width));
        let (zero, end) = (pixels(zero), pixels(scale.pixel(difference)));
        let _ = write!(path, "M{left} {zero}V{end}H{right}V{zero}Z");
    }
    bars
}

fn draw_axis(canvas: &mut Canvas, scale: &Scale) {
    for tick in scale.ticks() {
        let y = scale.pixel(tick);
        canvas.line((LEFT, y), (WIDTH - RIGHT, y), Stroke::solid(Paint::Grid, 1.0));
        let label = if tick == 0.0 { dollars(0.0) } else { signed_dollars(tick) };
        canvas.text((LEFT - 8.0, y + 4.0), Lettering::SMALL.anchored(Anchor::End), &label);
    }
    let zero = scale.pixel(0.0);
    canvas.line((LEFT, zero), (WIDTH - RIGHT, zero), Stroke::solid(Paint::Muted, 1.0));
    let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
    let below = (middle, HEIGHT - 16.0);
    canvas.text(below, Lettering::SMALL.anchored(Anchor::Middle), "days, largest difference first");
}

fn draw_mean(canvas: &mut Canvas, scale: &Scale, comparison: &PairedDifference) {
    let mean = comparison.profit_usd.difference.mean;
    let y = scale.pixel(mean);
    let stroke = Stroke { paint: Paint::Ink, width: 1.4, dash: Some("6 4") };
    canvas.line((LEFT, y), (WIDTH - RIGHT, y), stroke);
    let lettering = Lettering::LABEL.bold().anchored(Anchor::End);
    canvas.text((WIDTH - RIGHT, y - 7.0), lettering, &format!("mean {}", signed_dollars(mean)));
}

fn draw_key(canvas: &mut Canvas, comparison: &PairedDifference) {
    let (ahead, behind) = looks(comparison);
    let test = &comparison.profit_usd;
    let y = 72.0;
    let mut x = 16.0;
    for (look, name, days) in [
        (ahead, &comparison.first, test.first_larger),
        (behind, &comparison.second, test.second_larger),
    ] {
        canvas.rectangle((x, y - 6.0), (12.0, 12.0), look);
        let label =
            format!("{} earns more ({})", shortened(name, 22), counted(days, "day", "days"));
        canvas.text((x + 19.0, y + 4.0), Lettering::SMALL, &label);
        x += 19.0 + text_width(&label, 12.0) + 20.0;
    }
}

fn caption(comparison: &PairedDifference, days: usize) -> String {
    format!(
        "On {} of {} {} earns more than {}. Each bar is one day.",
        comparison.profit_usd.first_larger,
        counted(days, "day", "days"),
        comparison.first,
        comparison.second
    )
}
