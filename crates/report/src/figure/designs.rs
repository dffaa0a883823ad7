//! The designs of a search: the cost of each, its profit or passengers, and their upper bounds.

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{Anchor, Canvas, Lettering, Stroke};
use vertifleet_picture::numbers::{grouped, typeset};
use vertifleet_picture::palette::Paint;

use super::Figure;
use vertifleet_study::size::{DesignSummary, SizeReport};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 430.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 108.0;
const FLOOR: f64 = HEIGHT - 64.0;

/// The figure: a mark for each design.
pub(super) fn figure(report: &SizeReport) -> Figure {
    let is_money = report.goal == "profit";
    let value = |design: &DesignSummary| {
        if is_money { design.profit_usd.mean } else { design.passengers }
    };
    let (title, y_name) = if is_money {
        ("What each design earns", "profit a day, $")
    } else {
        ("What each design carries", "passengers a day")
    };
    let subtitle = format!(
        "Means over {} days with {}; ticks above are upper bounds",
        report.days, report.policy
    );
    let mut canvas = Canvas::new(WIDTH, HEIGHT, title, &subtitle);
    let aircraft = |design: &DesignSummary| design.size.aircraft as f64;
    let x = Scale::around(report.designs.iter().map(aircraft), LEFT, WIDTH - RIGHT, 8);
    let ends = report.designs.iter().flat_map(|design| [value(design), design.ceiling]);
    let ends = ends.chain(report.needed_passengers);
    let y = Scale::around(ends, FLOOR, TOP, 6);
    axes(&mut canvas, &x, &y, y_name);
    if let Some(need) = report.needed_passengers {
        let height = y.pixel(need);
        canvas.line((LEFT, height), (WIDTH - RIGHT, height), Stroke::solid(Paint::Ink, 1.2));
        let label = Lettering::SMALL.anchored(Anchor::End);
        canvas.text_on_lines((WIDTH - RIGHT, height - 5.0), label, "to be carried");
    }
    for (number, design) in report.designs.iter().enumerate() {
        let place = x.pixel(aircraft(design));
        let (low, high) = (y.pixel(value(design)), y.pixel(design.ceiling));
        canvas.line((place, low), (place, high), Stroke::solid(Paint::Grid, 1.0));
        canvas.line((place - 5.0, high), (place + 5.0, high), Stroke::solid(Paint::Muted, 1.6));
        if number != report.best && number != report.now {
            canvas.marker((place, low), 0);
        }
    }
    for (number, series, name) in
        [(report.now, 1, report.name_of_start()), (report.best, 2, report.name_of_best())]
    {
        let design = &report.designs[number];
        let point = (x.pixel(aircraft(design)), y.pixel(value(design)));
        canvas.marker(point, series);
        let below = if series == 1 { 20.0 } else { -12.0 };
        let label = Lettering::LABEL.bold().anchored(Anchor::Middle);
        canvas.text_on_lines((point.0, point.1 + below), label, name);
    }
    Figure {
        slug: "figure-designs".into(),
        caption: "Designs with equally many aircraft differ in their types, or in stands and chargers. The line from a design to its tick is \
                  what its schedule leaves, at most."
            .to_owned(),
        svg: canvas.into_svg(),
    }
}

fn axes(canvas: &mut Canvas, x: &Scale, y: &Scale, y_name: &str) {
    let decimals = y.decimals(1.0);
    for tick in y.ticks() {
        let height = y.pixel(tick);
        canvas.line((LEFT, height), (WIDTH - RIGHT, height), Stroke::solid(Paint::Grid, 1.0));
        let label = Lettering::SMALL.anchored(Anchor::End);
        canvas.text((LEFT - 8.0, height + 4.0), label, &typeset(&grouped(tick, decimals)));
    }
    canvas.text((LEFT - 60.0, TOP - 14.0), Lettering::SMALL, y_name);
    canvas.line((LEFT, FLOOR), (WIDTH - RIGHT, FLOOR), Stroke::solid(Paint::Muted, 1.0));
    for tick in x.ticks() {
        let place = x.pixel(tick);
        canvas.line((place, FLOOR), (place, FLOOR + 4.0), Stroke::solid(Paint::Muted, 1.0));
        let label = Lettering::SMALL.anchored(Anchor::Middle);
        canvas.text((place, FLOOR + 18.0), label, &typeset(&grouped(tick, x.decimals(1.0))));
    }
    let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
    canvas.text((middle, FLOOR + 40.0), Lettering::SMALL.anchored(Anchor::Middle), "aircraft");
}
