//! What each aircraft did on a played day: flights by load, charging, and the rest of the time on a stand.

use vertifleet_core::{AircraftIx, Scenario};
use vertifleet_sim::TraceRow;

use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened};
use crate::map::Area;
use crate::palette::Paint;
use crate::panel::{Blocks, Clock, key};

/// The most aircraft that have a row of their own.
const MOST_ROWS: usize = 60;
/// Steps in which the load of a flight is shown.
const LOADS: usize = 4;

/// The height that the aircraft of a day need, pixels.
pub(crate) fn height(day: &Scenario) -> f64 {
    let shown = day.aircraft.len().min(MOST_ROWS);
    let row = if shown > 30 { 7.0 } else { 10.0 };
    row * shown as f64
}

/// What is left out, if there are more aircraft than rows.
pub(crate) fn left_out(day: &Scenario) -> String {
    if day.aircraft.len() > MOST_ROWS {
        format!(", the first {MOST_ROWS} of {}", day.aircraft.len())
    } else {
        String::new()
    }
}

/// A row for each aircraft.
pub(crate) fn timeline(canvas: &mut Canvas, clock: Clock, day: &Scenario, rows: &[TraceRow]) {
    clock.draw(canvas);
    let area = clock.area();
    let shown = day.aircraft.len().min(MOST_ROWS);
    let row_height = area.height / shown as f64;
    let top = |aircraft: AircraftIx| area.top + row_height * aircraft.at() as f64;
    let (mut charging, mut empty) = (Blocks::default(), Blocks::default());
    let mut loaded: [Blocks; LOADS] = Default::default();
    for row in rows.iter().filter(|row| row.to != row.from && row.aircraft.at() < shown) {
        let (start, arrival) = (clock.pixel(row.time), clock.pixel(row.arrival));
        let (y, height) = (top(row.aircraft) + 1.0, row_height - 2.0);
        let seats = day.aircraft_types[day.aircraft[row.aircraft.at()].kind.at()].seats;
        let step = (usize::from(row.passengers) * LOADS).div_ceil(usize::from(seats.max(1)));
        let blocks = match step {
            0 => &mut empty,
            step => &mut loaded[step.min(LOADS) - 1],
        };
        blocks.add((start, y), ((arrival - start).max(0.5), height));
        let ready = clock.pixel(row.ready);
        charging.add((arrival, y + 0.3 * height), ((ready - arrival).max(0.0), 0.4 * height));
    }
    charging.draw(canvas, charging_look());
    empty.draw(canvas, empty_look());
    for (step, blocks) in loaded.iter().enumerate() {
        blocks.draw(canvas, loaded_look(step));
    }
    names(canvas, area, day, row_height);
    let entries = [
        (loaded_look(LOADS - 1), "flight, full"),
        (loaded_look(0), "a quarter full"),
        (empty_look(), "empty"),
        (charging_look(), "charging"),
    ];
    key(canvas, (area.left, area.bottom() + 32.0), &entries);
}

/// The ids of some aircraft, as many as there is room for.
fn names(canvas: &mut Canvas, area: Area, day: &Scenario, row_height: f64) {
    let every = if row_height < 9.0 { 5 } else { 2 };
    for aircraft in (0..day.aircraft.len().min(MOST_ROWS)).step_by(every) {
        let label = Lettering { size: 10.0, ..Lettering::SMALL }.anchored(Anchor::End);
        let y = area.top + row_height * (aircraft as f64 + 0.5) + 3.5;
        canvas.text((area.left - 6.0, y), label, &shortened(&day.aircraft[aircraft].id, 8));
    }
}

fn loaded_look(step: usize) -> Look {
    let share = (step + 1) as f64 / LOADS as f64;
    Look { fill: Some((Paint::Series(0), 0.2 + 0.8 * share)), stroke: None }
}

fn empty_look() -> Look {
    Look { fill: Some((Paint::Ground, 1.0)), stroke: Some(Stroke::solid(Paint::Series(0), 0.8)) }
}

fn charging_look() -> Look {
    Look { fill: Some((Paint::Series(2), 0.5)), stroke: None }
}
