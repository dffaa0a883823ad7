//! How full the vertiports were on a played day: for each of them the stands that are taken,
//! against its capacity.
//!
//! Every capacity is drawn at the same height, so that full is full wherever one looks; its number
//! stands next to it.

use vertifleet_core::{Scenario, Time, VertiportIx};
use vertifleet_sim::TraceRow;

use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened};
use crate::map::Area;
use crate::numbers::grouped;
use crate::occupancy::Occupancy;
use crate::palette::Paint;
use crate::panel::{Blocks, Clock, key};

/// The most vertiports that have separate panels.
const MOST_PANELS: usize = 60;
/// Height from a panel to the one below it, and of the part that is drawn in, pixels.
const PITCH: f64 = 94.0;
const HEIGHT: f64 = 50.0;
/// Room between panels side by side, for the numbers on the left.
const GAP: f64 = 44.0;

/// The height that the vertiports of a day need, pixels.
pub(crate) fn height(day: &Scenario) -> f64 {
    let shown = day.vertiports.len().min(MOST_PANELS);
    PITCH * shown.div_ceil(columns(shown)) as f64
}

/// A note on the vertiports that are left out, if there are more than panels.
pub(crate) fn left_out(day: &Scenario) -> String {
    if day.vertiports.len() > MOST_PANELS {
        format!(", the first {MOST_PANELS} of {}", day.vertiports.len())
    } else {
        String::new()
    }
}

fn columns(shown: usize) -> usize {
    match shown {
        0..=1 => 1,
        2..=4 => 2,
        5..=30 => 3,
        _ => 4,
    }
}

/// A panel for each vertiport, from the start of operations to `end`.
pub(crate) fn panels(
    canvas: &mut Canvas,
    area: Area,
    (day, rows, end): (&Scenario, &[TraceRow], Time),
) {
    let shown = day.vertiports.len().min(MOST_PANELS);
    let columns = columns(shown);
    let width = (area.width - GAP * (columns - 1) as f64) / columns as f64;
    for at in VertiportIx::all(shown) {
        let (row, column) = (at.at() / columns, at.at() % columns);
        let panel = Area {
            left: area.left + (width + GAP) * column as f64,
            top: area.top + PITCH * row as f64 + 18.0,
            width,
            height: HEIGHT,
        };
        let occupancy = Occupancy::of(day, rows, at);
        name(canvas, panel, &day.vertiports[at.at()].id, &occupancy);
        draw(canvas, Clock::of(day, end, panel), &occupancy, end);
    }
    let entries = [(taken_look(), "stands taken"), (full_look(), "all of them")];
    let y = area.bottom() + 14.0;
    key(canvas, (area.left, y), &entries);
    let x = area.left + 230.0;
    canvas.line((x, y - 4.0), (x + 22.0, y - 4.0), capacity_stroke());
    canvas.text((x + 28.0, y), Lettering { size: 11.0, ..Lettering::SMALL }, "capacity");
}

/// The name of a vertiport, and for how long it was full.
fn name(canvas: &mut Canvas, panel: Area, id: &str, occupancy: &Occupancy) {
    let y = panel.top - 8.0;
    let bold = Lettering { size: 12.0, ..Lettering::LABEL.bold() };
    canvas.text((panel.left, y), bold, &shortened(id, 18));
    let share = grouped(100.0 * occupancy.full_share(), 0);
    let small = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::End);
    canvas.text((panel.right(), y), small, &format!("full {share} % of the time"));
}

/// The number of stands taken, the times at which all of them are, and the capacity as a line.
fn draw(canvas: &mut Canvas, clock: Clock, occupancy: &Occupancy, end: Time) {
    clock.draw(canvas);
    let area = clock.area();
    let room = f64::from(occupancy.room.max(1));
    let y = |number: u32| area.bottom() - area.height * f64::from(number) / room;
    let mut outline = vec![(area.left, area.bottom())];
    let mut full = Blocks::default();
    let until = occupancy.steps.iter().skip(1).map(|&(time, _)| time).chain([end]);
    for (&(since, taken), until) in occupancy.steps.iter().zip(until) {
        let (from, to) = (clock.pixel(since), clock.pixel(until));
        outline.extend([(from, y(taken)), (to, y(taken))]);
        if taken >= occupancy.room {
            full.add((from, y(taken)), (to - from, area.bottom() - y(taken)));
        }
    }
    outline.push((area.right(), area.bottom()));
    canvas.polyline(&outline, true, taken_look());
    full.draw(canvas, full_look());
    canvas.line((area.left, area.top), (area.right(), area.top), capacity_stroke());
    let base = Stroke::solid(Paint::Muted, 1.0);
    canvas.line((area.left, area.bottom()), (area.right(), area.bottom()), base);
    let label = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::End);
    canvas.text((area.left - 6.0, area.top + 4.0), label, &occupancy.room.to_string());
    canvas.text((area.left - 6.0, area.bottom() + 4.0), label, "0");
}

fn taken_look() -> Look {
    Look { fill: Some((Paint::Series(1), 0.4)), stroke: None }
}

fn full_look() -> Look {
    Look { fill: Some((Paint::Series(1), 1.0)), stroke: None }
}

fn capacity_stroke() -> Stroke {
    Stroke { dash: Some("5 3"), ..Stroke::solid(Paint::Ink, 1.4) }
}
