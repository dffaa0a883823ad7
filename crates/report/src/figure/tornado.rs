//! The factors of a sweep by their effect: the range of profit over the values of each, largest
//! first.

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened};
use vertifleet_picture::numbers::{grouped, signed, typeset};
use vertifleet_picture::palette::Paint;

use super::Figure;
use vertifleet_study::sweep::{Effect, SweepReport};

const WIDTH: f64 = 760.0;
const LEFT: f64 = 220.0;
const RIGHT: f64 = 90.0;
const TOP: f64 = 84.0;
const ROW: f64 = 40.0;
const BOTTOM: f64 = 56.0;

/// The figure; `None` if there is a single factor.
pub(super) fn figure(report: &SweepReport) -> Option<Figure> {
    let mut effects: Vec<&Effect> = report.varied().collect();
    if effects.len() < 2 {
        return None;
    }
    effects.sort_by(|one, other| other.span_usd.total_cmp(&one.span_usd));
    let middle_usd = middle(report);
    let mean = |level: &vertifleet_study::sweep::LevelEffect| level.profit_usd[0].mean - middle_usd;
    let ends: Vec<f64> = effects.iter().flat_map(|effect| &effect.levels).map(mean).collect();
    let floor = TOP + ROW * effects.len() as f64;
    let x = Scale::around(ends.iter().copied().chain([0.0]), LEFT, WIDTH - RIGHT, 6);
    let subtitle = format!(
        "Mean profit a day of {} by value, against the mean of all designs, $",
        report.policies[0]
    );
    let mut canvas = Canvas::new(WIDTH, floor + BOTTOM, "What matters most", &subtitle);
    let decimals = x.decimals(1.0);
    for tick in x.ticks() {
        let place = x.pixel(tick);
        canvas.line((place, TOP), (place, floor), Stroke::solid(Paint::Grid, 1.0));
        let label = typeset(&signed(tick, decimals));
        canvas.text((place, floor + 18.0), Lettering::SMALL.anchored(Anchor::Middle), &label);
    }
    for (at, effect) in effects.iter().enumerate() {
        draw_effect(&mut canvas, effect, &x, TOP + ROW * at as f64, middle_usd);
    }
    canvas.line((x.pixel(0.0), TOP), (x.pixel(0.0), floor), Stroke::solid(Paint::Ink, 1.4));
    let note = format!("0 is {} $", grouped(middle_usd, 0));
    canvas.text(
        (WIDTH - RIGHT, floor + 38.0),
        Lettering::SMALL.anchored(Anchor::End),
        &typeset(&note),
    );
    Some(Figure {
        slug: "figure-tornado".into(),
        caption: format!(
            "Each bar reaches from the value with the lowest mean profit to the one with the highest, which are written at its ends.{}",
            report.how_effects_were_found()
        ),
        svg: canvas.into_svg(),
    })
}

/// The mean over all designs that were played, dollars.
fn middle(report: &SweepReport) -> f64 {
    let cells = report.cells.iter().filter_map(|cell| cell.results.first());
    let profits: Vec<f64> = cells.map(|result| result.profit_usd.mean).collect();
    vertifleet_study::statistics::mean(&profits)
}

fn draw_effect(canvas: &mut Canvas, effect: &Effect, x: &Scale, top: f64, middle_usd: f64) {
    let by_mean = |one: &&vertifleet_study::sweep::LevelEffect,
                   other: &&vertifleet_study::sweep::LevelEffect| {
        one.profit_usd[0].mean.total_cmp(&other.profit_usd[0].mean)
    };
    let (Some(low), Some(high)) =
        (effect.levels.iter().min_by(by_mean), effect.levels.iter().max_by(by_mean))
    else {
        return;
    };
    let pixel = |level: &vertifleet_study::sweep::LevelEffect| {
        x.pixel(level.profit_usd[0].mean - middle_usd)
    };
    let (from, to) = (pixel(low), pixel(high));
    let look = Look { fill: Some((Paint::Series(0), 0.55)), stroke: None };
    canvas.rectangle((from, top + 9.0), ((to - from).max(1.0), ROW - 18.0), look);
    let label = Lettering::LABEL.anchored(Anchor::End);
    let baseline = top + ROW / 2.0 + 4.0;
    canvas.text((LEFT - 50.0, baseline), label, &shortened(&effect.factor, 24));
    let small = |anchor| Lettering::SMALL.anchored(anchor);
    let text = |level: &vertifleet_study::sweep::LevelEffect| typeset(&shortened(&level.label, 12));
    canvas.text_on_lines((from - 6.0, baseline), small(Anchor::End), &text(low));
    canvas.text_on_lines((to + 6.0, baseline), small(Anchor::Start), &text(high));
}
