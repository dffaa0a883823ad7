//! Profit as a function of each factor of a sweep: a panel for each factor, and a line with its
//! band for each policy.

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{Anchor, Canvas, Lettering, Look, Point, Stroke, shortened};
use vertifleet_picture::numbers::{grouped, typeset};
use vertifleet_picture::palette::{Paint, dash};

use super::Figure;
use super::key;
use vertifleet_study::sweep::{Effect, SweepReport};

const WIDTH: f64 = 760.0;
/// The distance from the left end of a mark of the key to its name.
const KEY_MARK: f64 = 18.0;
const LEFT: f64 = 64.0;
const BETWEEN: f64 = 84.0;
const RIGHT: f64 = 20.0;
const PANEL_HEIGHT: f64 = 190.0;
const PANEL_STEP: f64 = PANEL_HEIGHT + 78.0;
const BOTTOM: f64 = 52.0;

/// A panel's place in the picture.
struct Panel {
    left: f64,
    right: f64,
    top: f64,
}

/// The figure with a panel for each factor.
pub(super) fn curves(report: &SweepReport) -> Option<Figure> {
    let effects: Vec<&Effect> = report.varied().collect();
    if effects.is_empty() {
        return None;
    }
    let names: Vec<String> = report.policies.iter().map(|name| shortened(name, 22)).collect();
    let (places, last_row) = key::places(&names, KEY_MARK, WIDTH);
    let columns = effects.len().min(2);
    let rows = effects.len().div_ceil(columns);
    let top = last_row + 40.0;
    let height = top + (rows - 1) as f64 * PANEL_STEP + PANEL_HEIGHT + BOTTOM;
    let title = "Profit against each setting";
    let subtitle = "Mean profit a day over all designs with the same value; bands are 95 % intervals over days";
    let mut canvas = Canvas::new(WIDTH, height, title, subtitle);
    for (position, (name, (x, y))) in names.iter().zip(places).enumerate() {
        canvas.marker((x + 6.0, y), position);
        canvas.text((x + KEY_MARK, y + 4.0), Lettering::LABEL, name);
    }
    let ends = effects.iter().flat_map(|effect| &effect.levels).flat_map(|level| {
        level.profit_usd.iter().flat_map(|profit| {
            let half = profit.half_width_95.unwrap_or(0.0);
            [profit.mean - half, profit.mean + half]
        })
    });
    let ends: Vec<f64> = ends.collect();
    let width = (WIDTH - LEFT - RIGHT - (columns - 1) as f64 * BETWEEN) / columns as f64;
    for (at, &effect) in effects.iter().enumerate() {
        let left = LEFT + (at % columns) as f64 * (width + BETWEEN);
        let top = top + (at / columns) as f64 * PANEL_STEP;
        let panel = Panel { left, right: left + width, top };
        let y = Scale::around(ends.iter().copied(), top + PANEL_HEIGHT, top, 5);
        draw_panel(&mut canvas, effect, &panel, &y);
    }
    Some(Figure {
        slug: "figure-response-curves".into(),
        caption: format!(
            "All panels have the same vertical scale, so that settings can be compared by their slopes. Designs of a panel differ in \
             the other settings too, over which it takes the mean.{}",
            report.how_effects_were_found()
        ),
        svg: canvas.into_svg(),
    })
}

fn draw_panel(canvas: &mut Canvas, effect: &Effect, panel: &Panel, y: &Scale) {
    let &Panel { left, right, top } = panel;
    let floor = top + PANEL_HEIGHT;
    canvas.text((left - 48.0, top - 12.0), Lettering::LABEL.bold(), &shortened(&effect.factor, 44));
    let thousands = y.ticks().last().is_some_and(|&last| last >= 10_000.0);
    let (unit, mark) = if thousands { (1_000.0, "k") } else { (1.0, "") };
    let decimals = y.decimals(unit);
    for tick in y.ticks() {
        let height = y.pixel(tick);
        canvas.line((left, height), (right, height), Stroke::solid(Paint::Grid, 1.0));
        let label = typeset(&format!("{}{mark}", grouped(tick / unit, decimals)));
        canvas.text((left - 8.0, height + 4.0), Lettering::SMALL.anchored(Anchor::End), &label);
    }
    canvas.line((left, floor), (right, floor), Stroke::solid(Paint::Muted, 1.0));
    let places = places(effect, panel);
    let every = places.len().div_ceil(if right - left > 400.0 { 12 } else { 6 });
    for (x, level) in places.iter().zip(&effect.levels).step_by(every) {
        let label = typeset(&shortened(&level.label, 14));
        canvas.line((*x, floor), (*x, floor + 4.0), Stroke::solid(Paint::Muted, 1.0));
        canvas.text((*x, floor + 18.0), Lettering::SMALL.anchored(Anchor::Middle), &label);
    }
    let middle = f64::midpoint(left, right);
    let name = "value; profit a day in $";
    canvas.text((middle, floor + 36.0), Lettering::SMALL.anchored(Anchor::Middle), name);
    let policies = effect.levels.first().map_or(0, |level| level.profit_usd.len());
    for policy in (0..policies).rev() {
        draw_policy(canvas, effect, &places, y, policy);
    }
}

/// The horizontal place of each level: to scale if the values are numbers, else evenly spaced.
fn places(effect: &Effect, panel: &Panel) -> Vec<f64> {
    let values: Option<Vec<f64>> = effect.levels.iter().map(|level| level.value).collect();
    if let Some(values) = values {
        let x = Scale::around(values.iter().copied(), panel.left, panel.right, 6);
        return values.into_iter().map(|value| x.pixel(value)).collect();
    }
    let step = (panel.right - panel.left) / effect.levels.len() as f64;
    (0..effect.levels.len()).map(|at| panel.left + step * (at as f64 + 0.5)).collect()
}

fn draw_policy(canvas: &mut Canvas, effect: &Effect, places: &[f64], y: &Scale, policy: usize) {
    let edge = |side: f64| {
        places.iter().zip(&effect.levels).map(move |(&x, level)| {
            let profit = &level.profit_usd[policy];
            (x, y.pixel(profit.mean + side * profit.half_width_95.unwrap_or(0.0)))
        })
    };
    let mut band: Vec<Point> = edge(1.0).collect();
    band.extend(edge(-1.0).collect::<Vec<_>>().into_iter().rev());
    let look = Look { fill: Some((Paint::Series(policy), 0.12)), stroke: None };
    canvas.polyline(&band, true, look);
    let line: Vec<Point> = edge(0.0).collect();
    let stroke = Stroke { paint: Paint::Series(policy), width: 2.0, dash: dash(policy) };
    canvas.polyline(&line, false, Look::outlined(stroke));
    for point in line {
        canvas.marker(point, policy);
    }
}
