//! The map of a played day: where passengers flew.

use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_sim::TraceRow;

use crate::canvas::{Anchor, Canvas, Lettering, Stroke};
use crate::map::{Area, Map, pair};
use crate::names;
use crate::numbers::{grouped, mean};
use crate::palette::Paint;

/// Widths of the widest line, pixels, where vertiports have names and where there are too many.
const WIDEST: (f64, f64) = (7.0, 3.0);
/// Width of a line without passengers, pixels, so that every line can be seen.
const NARROWEST: f64 = 0.4;
/// The most lines; with more, the map would be one spot.
const MOST_LINES: usize = 200;

/// Lines as wide as passengers flew between two vertiports, both ways together.
pub(crate) fn carried(canvas: &mut Canvas, area: Area, day: &Scenario, rows: &[TraceRow]) {
    let size = day.vertiports.len();
    let mut carried = vec![0.0; size * size];
    for row in rows {
        carried[pair(size, row.from.at(), row.to.at())] += f64::from(row.passengers);
    }
    draw_flows(canvas, area, day, &carried);
}

/// Lines as wide as the numbers of an upper triangle, the vertiports, and what the widest line
/// stands for.
pub(crate) fn draw_flows(canvas: &mut Canvas, area: Area, day: &Scenario, numbers: &[f64]) {
    let (map, size) = (Map::of(day, area), day.vertiports.len());
    let mut flows: Vec<(f64, usize, usize)> = (0..size)
        .flat_map(|from| (from + 1..size).map(move |to| (from, to)))
        .map(|(from, to)| (numbers[pair(size, from, to)], from, to))
        .filter(|&(number, ..)| number > 0.0)
        .collect();
    flows.sort_by(|(one, ..), (other, ..)| other.total_cmp(one));
    let all = flows.len();
    flows.truncate(MOST_LINES);
    let most = flows.first().map_or(0.0, |&(number, ..)| number);
    let widest = if map.is_named() { WIDEST.0 } else { WIDEST.1 };
    let stroke = |number: f64| {
        let share = if most > 0.0 { number / most } else { 0.0 };
        Stroke::solid(Paint::Series(0), NARROWEST + (widest - NARROWEST) * share)
    };
    for &(number, from, to) in &flows {
        let (from, to) = (VertiportIx::new(from), VertiportIx::new(to));
        canvas.line(map.at(from), map.at(to), stroke(number));
    }
    let radius = if map.is_named() { 7.0 } else { 4.0 };
    for at in VertiportIx::all(size) {
        map.disc(canvas, at, radius, 0.0);
    }
    names::draw(canvas, &map, day, radius);
    let mut text = format!("{} passengers, both ways together", mean(most));
    if flows.len() < all {
        let (shown, all) = (flows.len(), grouped(all as f64, 0));
        text = format!("{text}; the {shown} busiest of {all} pairs");
    }
    let y = area.bottom() + 10.0;
    canvas.line((area.left, y - 4.0), (area.left + 28.0, y - 4.0), stroke(most));
    let lettering = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::Start);
    canvas.text((area.left + 36.0, y), lettering, &text);
}
