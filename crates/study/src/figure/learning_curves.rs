//! Learning curves: mean episode reward against steps of training, one line a policy (Fig. 3).

use super::Figure;
use super::axis::Scale;
use super::canvas::{Anchor, Canvas, Lettering, Look, Point, Stroke, shortened};
use super::key;
use super::palette::{Paint, dash};
use crate::numbers::{grouped, typeset};
use crate::record::Curve;
use crate::summary::Summary;

const WIDTH: f64 = 760.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 24.0;
/// From the left end of a line of the key to its name.
const KEY_LINE: f64 = 41.0;
const PLOT_HEIGHT: f64 = 272.0;
const BOTTOM: f64 = 52.0;

/// Markers on a line: enough to tell lines apart in grey, few enough to see the line.
const MARKERS: usize = 9;

/// A curve's points in pixels and the series whose colour, dash and marker it has.
struct Line {
    name: String,
    series: usize,
    points: Vec<Point>,
}

/// Fig. 3; `None` if no curve has a point.
pub(super) fn figure(summary: &Summary) -> Option<Figure> {
    // Before the first episode ends there is no mean reward to draw.
    let defined = |curve: &Curve| -> Vec<Point> {
        let points = curve.points.iter().filter(|point| point.1.is_finite());
        points.map(|&(steps, reward)| (steps as f64, reward)).collect()
    };
    let curves: Vec<(&Curve, Vec<Point>)> = summary
        .curves
        .iter()
        .map(|curve| (curve, defined(curve)))
        .filter(|(_, p)| !p.is_empty())
        .collect();
    if curves.is_empty() {
        return None;
    }
    let names: Vec<String> = curves.iter().map(|(curve, _)| shortened(&curve.name, 22)).collect();
    let (places, last_row) = key::places(&names, KEY_LINE, WIDTH);
    let top = last_row + 24.0;
    let floor = top + PLOT_HEIGHT;
    let values = || curves.iter().flat_map(|(_, points)| points);
    let x = Scale::around(values().map(|p| p.0).chain([0.0]), (LEFT, WIDTH - RIGHT), 6);
    let y = Scale::around(values().map(|p| p.1), (floor, top), 6);
    let lines: Vec<Line> = curves
        .iter()
        .zip(names)
        .enumerate()
        .map(|(position, ((curve, points), name))| Line {
            name,
            series: series(summary, &curve.name, position),
            points: points.iter().map(|p| (x.pixel(p.0), y.pixel(p.1))).collect(),
        })
        .collect();

    let mut canvas = Canvas::new(
        WIDTH,
        floor + BOTTOM,
        "Learning curves",
        "Mean episode reward on the training days against steps of training",
    );
    draw_axes(&mut canvas, &x, &y, floor);
    for line in &lines {
        draw_line(&mut canvas, line);
    }
    for (line, place) in lines.iter().zip(places) {
        draw_key(&mut canvas, line, place);
    }
    Some(Figure {
        slug: "figure-3-learning-curves",
        caption: "Corresponds to Fig. 3 of the paper. Reward: profit as a share of the revenue if every passenger flew; a step is one decision."
            .to_owned(),
        svg: canvas.into_svg(),
    })
}

/// A curve looks like the policy of its name; other curves take what no policy has.
fn series(summary: &Summary, name: &str, position: usize) -> usize {
    let policy = summary.policies.iter().position(|policy| policy.name == name);
    policy.unwrap_or(summary.policies.len() + position)
}

fn draw_axes(canvas: &mut Canvas, x: &Scale, y: &Scale, floor: f64) {
    let decimals = y.decimals(1.0);
    for tick in y.ticks() {
        let height = y.pixel(tick);
        canvas.line((LEFT, height), (WIDTH - RIGHT, height), Stroke::solid(Paint::Grid, 1.0));
        let label = typeset(&grouped(tick, decimals));
        canvas.text((LEFT - 8.0, height + 4.0), Lettering::SMALL.anchored(Anchor::End), &label);
    }
    let steps = x.ticks();
    let (unit, name) = match steps.last() {
        Some(&last) if last >= 1e6 => (1e6, "steps of training, millions"),
        Some(&last) if last >= 1e4 => (1e3, "steps of training, thousands"),
        _ => (1.0, "steps of training"),
    };
    let decimals = x.decimals(unit);
    for tick in steps {
        let place = x.pixel(tick);
        canvas.line((place, floor), (place, floor + 4.0), Stroke::solid(Paint::Muted, 1.0));
        let label = format!("{:.decimals$}", tick / unit);
        canvas.text((place, floor + 18.0), Lettering::SMALL.anchored(Anchor::Middle), &label);
    }
    canvas.line((LEFT, floor), (WIDTH - RIGHT, floor), Stroke::solid(Paint::Muted, 1.0));
    let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
    canvas.text((middle, floor + 38.0), Lettering::SMALL.anchored(Anchor::Middle), name);
}

fn draw_line(canvas: &mut Canvas, line: &Line) {
    let stroke = Stroke { paint: Paint::Series(line.series), width: 2.0, dash: dash(line.series) };
    canvas.polyline(&line.points, false, Look::outlined(stroke));
    // Each series starts its markers a little later, so that lines that run together keep theirs apart.
    let every = (line.points.len() / MARKERS).max(1);
    let first = (line.series * every / 3) % every;
    for &point in line.points.iter().skip(first).step_by(every) {
        canvas.marker(point, line.series);
    }
}

fn draw_key(canvas: &mut Canvas, line: &Line, (x, y): Point) {
    let stroke = Stroke { paint: Paint::Series(line.series), width: 2.0, dash: dash(line.series) };
    canvas.line((x, y), (x + 34.0, y), stroke);
    canvas.marker((x + 17.0, y), line.series);
    canvas.text((x + KEY_LINE, y + 4.0), Lettering::LABEL, &line.name);
}
