//! The methods of a board on one suite: their mean shares with intervals, and below, on the same
//! scale, their performance profiles.
//!
//! Each method has a row above, whose mark and dash are those of its profile below, so that no
//! information depends on colour.

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{
    Anchor, Canvas, Lettering, Look, Point, Stroke, shortened, text_width,
};
use vertifleet_picture::numbers::{counted, grouped, typeset};
use vertifleet_picture::palette::{Paint, dash};
use vertifleet_study::board::{MethodSummary, SuiteBoard};

use super::Figure;

const WIDTH: f64 = 760.0;
const TOP: f64 = 92.0;
const ROW: f64 = 26.0;
const RIGHT: f64 = 150.0;
const BETWEEN: f64 = 40.0;
const PLOT_HEIGHT: f64 = 240.0;
const BOTTOM: f64 = 52.0;
const LONGEST_NAME: usize = 26;
/// Number of markers on a profile.
const MARKERS: usize = 6;
/// Half the height of the ends of an interval.
const END: f64 = 5.0;

/// The figure of a suite.
pub(super) fn figure(board: &SuiteBoard) -> Figure {
    let names = board.methods.iter().map(|method| shortened(&method.method, LONGEST_NAME));
    let left = names.map(|name| text_width(&name, 13.0)).fold(60.0, f64::max) + 66.0;
    let rows_end = TOP + ROW * board.methods.len() as f64;
    let top = rows_end + BETWEEN;
    let floor = top + PLOT_HEIGHT;
    let ends = [board.thresholds.first(), board.thresholds.last()];
    let x = Scale::around(ends.into_iter().flatten().copied(), left, WIDTH - RIGHT, 6);
    let y = Scale::around([0.0, 1.0].into_iter(), floor, top, 5);
    let subtitle = format!("{}: {}", board.suite, board.description);
    let title = "Share of the certified bound by method";
    let mut canvas = Canvas::new(WIDTH, floor + BOTTOM, title, &subtitle);
    let heading = Lettering::SMALL.anchored(Anchor::End);
    canvas.text((WIDTH - 16.0, TOP - 10.0), heading, "mean and 95 % interval, %");
    draw_axes(&mut canvas, (&x, &y), (TOP - 4.0, rows_end), (top, floor));
    for (position, method) in board.methods.iter().enumerate() {
        let middle = TOP + ROW * (position as f64 + 0.5);
        draw_row(&mut canvas, method, &x, (left, middle), position);
    }
    for (position, method) in board.methods.iter().enumerate().rev() {
        draw_profile(&mut canvas, (method, &board.thresholds), (&x, &y), position);
    }
    Figure {
        slug: format!("figure-board-{}", board.suite.replace(':', "-")).into(),
        caption: "Above: the mean share over runs and days with its two-level interval. Below: the share of runs and days that lie \
                  above each share of the bound, with 95 % bands. A curve further to the right is better; where curves cross, one \
                  method is better on its bad days and the other on its good ones."
            .to_owned(),
        svg: canvas.into_svg(),
    }
}

fn draw_axes(
    canvas: &mut Canvas,
    (x, y): (&Scale, &Scale),
    rows: (f64, f64),
    (top, floor): (f64, f64),
) {
    let decimals = x.decimals(0.01);
    let grid = Stroke::solid(Paint::Grid, 1.0);
    for tick in x.ticks() {
        let place = x.pixel(tick);
        canvas.line((place, rows.0), (place, rows.1), grid);
        canvas.line((place, top), (place, floor), grid);
        let label = typeset(&grouped(100.0 * tick, decimals));
        canvas.text((place, floor + 18.0), Lettering::SMALL.anchored(Anchor::Middle), &label);
    }
    let (left, right) = (x.pixel(x.lowest()), x.pixel(x.highest()));
    for tick in y.ticks() {
        let height = y.pixel(tick);
        canvas.line((left, height), (right, height), grid);
        let label = grouped(100.0 * tick, 0);
        canvas.text((left - 8.0, height + 4.0), Lettering::SMALL.anchored(Anchor::End), &label);
    }
    canvas.line((left, floor), (right, floor), Stroke::solid(Paint::Muted, 1.0));
    let middle = Lettering::SMALL.anchored(Anchor::Middle);
    canvas.text((f64::midpoint(left, right), floor + 38.0), middle, "share of the bound, %");
    canvas.text((left, top - 12.0), Lettering::SMALL, "runs and days above, %");
}

/// A method's name with the mark and dash of its profile, and its mean with the interval.
fn draw_row(
    canvas: &mut Canvas,
    method: &MethodSummary,
    x: &Scale,
    (left, middle): Point,
    series: usize,
) {
    let paint = Paint::Series(series);
    let key = Stroke { paint, width: 2.0, dash: dash(series) };
    canvas.line((16.0, middle), (46.0, middle), key);
    canvas.marker((31.0, middle), series);
    let name = shortened(&method.method, LONGEST_NAME);
    canvas.text((54.0, middle + 4.5), Lettering::LABEL, &name);
    let runs = method.runs.len();
    let (low, high) = method.bound_share.interval_95;
    let (from, to) = (x.pixel(low).max(left), x.pixel(high).max(left));
    let stroke = Stroke::solid(paint, 2.0);
    canvas.line((from, middle), (to, middle), stroke);
    for end in [from, to] {
        canvas.line((end, middle - END), (end, middle + END), stroke);
    }
    canvas.marker((x.pixel(method.bound_share.estimate).max(left), middle), series);
    let percent = |share: f64| typeset(&grouped(100.0 * share, 2));
    let mean = percent(method.bound_share.estimate);
    let interval = format!("{mean} ({} to {})", percent(low), percent(high));
    let place = (WIDTH - 16.0, middle + 0.5);
    canvas.text(place, Lettering::SMALL.anchored(Anchor::End), &interval);
    let place = (WIDTH - 16.0, middle + 12.5);
    if runs > 1 {
        let runs = counted(runs, "run", "runs");
        canvas.text(place, Lettering::SMALL.anchored(Anchor::End), &runs);
    }
}

fn draw_profile(
    canvas: &mut Canvas,
    (method, thresholds): (&MethodSummary, &[f64]),
    (x, y): (&Scale, &Scale),
    series: usize,
) {
    let paint = Paint::Series(series);
    let points = |value: &dyn Fn(usize) -> f64| -> Vec<Point> {
        let place = |(at, &threshold): (usize, &f64)| (x.pixel(threshold), y.pixel(value(at)));
        thresholds.iter().enumerate().map(place).collect()
    };
    let mut band = points(&|at| method.profile[at].interval_95.1);
    band.extend(points(&|at| method.profile[at].interval_95.0).into_iter().rev());
    canvas.polyline(&band, true, Look { fill: Some((paint, 0.14)), stroke: None });
    let line = points(&|at| method.profile[at].estimate);
    let stroke = Stroke { paint, width: 2.0, dash: dash(series) };
    canvas.polyline(&line, false, Look::outlined(stroke));
    // Marks stand where the profile falls, at other heights for each series.
    let offset = series as f64 / (8.0 * MARKERS as f64);
    for mark in 0..MARKERS {
        let height = (mark as f64 + 0.5) / MARKERS as f64 - offset;
        let at = method.profile.iter().position(|point| point.estimate <= height);
        if let Some(&place) = at.and_then(|at| line.get(at)) {
            canvas.marker(place, series);
        }
    }
}
