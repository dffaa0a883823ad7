//! The activities of each aircraft on a played day: flights by load, charging, outages, and the
//! rest of the time on a stand.

use vertifleet_core::Scenario;
use vertifleet_sim::TraceRow;

use crate::activities::{Activity, Span, activities};
use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened};
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
    /// Enters an activity in a row that begins at `y`. Only flights take its whole height.
    fn add(&mut self, clock: Clock, day: &Scenario, (y, height): (f64, f64), span: &Span<'_>) {
        let (start, end) = (clock.pixel(span.start), clock.pixel(span.end));
        let on_ground = ((start, y + 0.3 * height), (end - start, 0.4 * height));
        let (blocks, (place, size)) = match span.activity {
            Activity::Flight(row) => {
                let seats = day.aircraft_types[day.aircraft[row.aircraft.at()].kind.at()].seats;
                let load = usize::from(row.passengers) * LOADS;
                let blocks = match load.div_ceil(usize::from(seats.max(1))) {
                    0 => &mut self.empty,
                    step => &mut self.loaded[step.min(LOADS) - 1],
                };
                (blocks, ((start, y), ((end - start).max(0.5), height)))
            }
            Activity::Charging => (&mut self.charging, on_ground),
            Activity::OutOfService => (&mut self.out_of_service, on_ground),
        };
        blocks.add(place, size);
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
    let mut spans = Spans::default();
    let all = activities(day, rows, clock.end());
    for span in all.iter().filter(|span| span.aircraft.at() < shown) {
        let y = area.top + row_height * span.aircraft.at() as f64 + 1.0;
        spans.add(clock, day, (y, row_height - 2.0), span);
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
