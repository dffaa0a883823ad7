//! The activities of each aircraft on a played day: flights by load, charging, outages, and the
//! rest of the time on a stand.

use vertifleet_core::{Scenario, Time};
use vertifleet_sim::TraceRow;

use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened};
use crate::charged::Charged;
use crate::map::Area;
use crate::palette::Paint;
use crate::panel::{Blocks, Clock, key};

/// The most aircraft that have separate rows.
const MOST_ROWS: usize = 60;
/// Steps in which the load of a flight is shown.
const LOADS: usize = 4;

/// The height that the aircraft of a day need, pixels.
pub(crate) fn height(day: &Scenario) -> f64 {
    let shown = day.aircraft.len().min(MOST_ROWS);
    let row = if shown > 30 { 7.0 } else { 10.0 };
    row * shown as f64
}

/// A note on the aircraft that are left out, if there are more than rows.
pub(crate) fn left_out(day: &Scenario) -> String {
    if day.aircraft.len() > MOST_ROWS {
        format!(", the first {MOST_ROWS} of {}", day.aircraft.len())
    } else {
        String::new()
    }
}

/// The activities of aircraft, as blocks of one look each.
#[derive(Default)]
struct Spans {
    empty: Blocks,
    loaded: [Blocks; LOADS],
    charging: Blocks,
    out_of_service: Blocks,
}

impl Spans {
    /// Enters a flight and the time on the ground after it, in a row that begins at `y`.
    fn add(
        &mut self,
        clock: Clock,
        (y, height): (f64, f64),
        step: usize,
        row: &TraceRow,
        charged: Time,
    ) {
        let flight = match step {
            0 => &mut self.empty,
            step => &mut self.loaded[step.min(LOADS) - 1],
        };
        let (start, arrival) = (clock.pixel(row.takeoff), clock.pixel(row.arrival));
        flight.add((start, y), ((arrival - start).max(0.5), height));
        let (charged, ready) = (clock.pixel(charged), clock.pixel(row.ready));
        let (y, height) = (y + 0.3 * height, 0.4 * height);
        if row.takeoff > row.time {
            let decided = clock.pixel(row.time);
            self.charging.add((decided, y), (start - decided, height));
        }
        self.charging.add((arrival, y), ((charged - arrival).max(0.0), height));
        if ready > charged {
            self.out_of_service.add((charged, y), (ready - charged, height));
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.charging.draw(canvas, charging_look());
        self.out_of_service.draw(canvas, out_of_service_look());
        self.empty.draw(canvas, empty_look());
        for (step, blocks) in self.loaded.iter().enumerate() {
            blocks.draw(canvas, loaded_look(step));
        }
    }
}

/// A row for each aircraft.
pub(crate) fn timeline(canvas: &mut Canvas, clock: Clock, day: &Scenario, rows: &[TraceRow]) {
    clock.draw(canvas);
    let area = clock.area();
    let shown = day.aircraft.len().min(MOST_ROWS);
    let row_height = area.height / shown as f64;
    let (mut spans, charged) = (Spans::default(), Charged::of(day));
    for row in rows.iter().filter(|row| row.to != row.from && row.aircraft.at() < shown) {
        let y = area.top + row_height * row.aircraft.at() as f64 + 1.0;
        let seats = day.aircraft_types[day.aircraft[row.aircraft.at()].kind.at()].seats;
        let step = (usize::from(row.passengers) * LOADS).div_ceil(usize::from(seats.max(1)));
        spans.add(clock, (y, row_height - 2.0), step, row, charged.at(row));
    }
    spans.draw(canvas);
    names(canvas, area, day, row_height);
    let mut entries = vec![
        (loaded_look(LOADS - 1), "flight, full"),
        (loaded_look(0), "a quarter full"),
        (empty_look(), "empty"),
        (charging_look(), "charging"),
    ];
    if !spans.out_of_service.is_empty() {
        entries.push((out_of_service_look(), "out of service"));
    }
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

/// Dark, so that it differs from charging in grey too.
fn out_of_service_look() -> Look {
    Look { fill: Some((Paint::Ink, 0.75)), stroke: None }
}
