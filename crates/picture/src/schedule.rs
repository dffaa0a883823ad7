//! A whole trace as a picture: where passengers flew, what every aircraft did, how full the vertiports were, and how
//! much demand was served and spilled.

use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};
use vertifleet_sim::TraceRow;

use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened};
use crate::demand::{all_passengers, served_and_spilled};
use crate::map::{Area, Map, pair, room};
use crate::moment::Moment;
use crate::numbers::{dollars, grouped};
use crate::palette::Paint;
use crate::panel::{Blocks, Clock, heading, key};

const WIDTH: f64 = 1_000.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 24.0;
/// The most aircraft and vertiports that have a row of their own.
const MOST_ROWS: usize = 60;
/// Length of a cell of the occupancy, seconds.
const CELL_S: u32 = 900;
/// Steps in which the load of a flight is shown.
const LOADS: usize = 4;

/// The picture of a trace as SVG.
pub fn schedule(day: &Scenario, rows: &[TraceRow]) -> String {
    let end = rows.iter().map(|row| row.ready).max().unwrap_or(day.operations.end);
    let end = end.max(day.operations.end);
    let (aircraft, vertiports) =
        (day.aircraft.len().min(MOST_ROWS), day.vertiports.len().min(MOST_ROWS));
    let map = Area { left: 16.0, top: 92.0, width: 470.0, height: 340.0 };
    let demand = Area { left: 560.0, top: 92.0, width: WIDTH - 560.0 - RIGHT, height: 300.0 };
    let band = |top, rows: usize, row: f64| Area {
        left: LEFT,
        top,
        width: WIDTH - LEFT - RIGHT,
        height: row * rows as f64,
    };
    let fleet = band(486.0, aircraft, if aircraft > 30 { 7.0 } else { 10.0 });
    let occupancy = band(fleet.bottom() + 76.0, vertiports, 14.0);
    let mut canvas = Canvas::new(
        WIDTH,
        occupancy.bottom() + 48.0,
        &shortened(&day.name, 60),
        &subtitle(day, rows, end),
    );
    flows(&mut canvas, map, day, rows);
    served_and_spilled(&mut canvas, demand, day, rows);
    gantt(&mut canvas, Clock::of(day, end, fleet), fleet, day, rows);
    stands(&mut canvas, Clock::of(day, end, occupancy), occupancy, (day, rows, end));
    canvas.into_svg()
}

fn subtitle(day: &Scenario, rows: &[TraceRow], end: Time) -> String {
    let Moment { profit_usd, flights, passengers, .. } = Moment::of(day, rows, end);
    let empty = rows.iter().filter(|row| row.to != row.from && row.passengers == 0).count();
    let wanted = all_passengers(day);
    format!(
        "profit {}, {} flights of which {} to reposition, {} passengers carried and {} spilled",
        dollars(profit_usd),
        grouped(f64::from(flights), 0),
        grouped(empty as f64, 0),
        grouped(passengers as f64, 0),
        grouped(wanted.saturating_sub(passengers) as f64, 0)
    )
}

/// Lines as wide as passengers flew between two vertiports, both ways together.
fn flows(canvas: &mut Canvas, area: Area, day: &Scenario, rows: &[TraceRow]) {
    heading(canvas, area, "passengers carried");
    let size = day.vertiports.len();
    let mut carried = vec![0_u32; size * size];
    for row in rows {
        carried[pair(size, row.from.at(), row.to.at())] += u32::from(row.passengers);
    }
    draw_flows(canvas, area, day, &carried);
}

/// Lines as wide as the numbers of an upper triangle, and the vertiports.
pub(crate) fn draw_flows(canvas: &mut Canvas, area: Area, day: &Scenario, numbers: &[u32]) {
    let (map, size) = (Map::of(day, area), day.vertiports.len());
    let most = f64::from(numbers.iter().copied().max().unwrap_or(0).max(1));
    for from in VertiportIx::all(size) {
        for to in VertiportIx::all(size).skip(from.at() + 1) {
            let share = f64::from(numbers[pair(size, from.at(), to.at())]) / most;
            if share > 0.01 {
                let paint = Paint::Series(0);
                let stroke = Stroke::solid(paint, 0.4 + 6.6 * share);
                canvas.line(map.at(from), map.at(to), stroke);
            }
        }
    }
    let radius = if map.is_named() { 7.0 } else { 4.0 };
    for at in VertiportIx::all(size) {
        map.disc(canvas, at, radius, 0.0);
        map.name(canvas, day, at, radius);
    }
}

/// What each aircraft does: flights by load, charging, and the rest of the time on a stand.
fn gantt(canvas: &mut Canvas, clock: Clock, area: Area, day: &Scenario, rows: &[TraceRow]) {
    let shown = day.aircraft.len().min(MOST_ROWS);
    let more = if shown < day.aircraft.len() {
        format!(", the first {shown} of {}", day.aircraft.len())
    } else {
        String::new()
    };
    heading(canvas, area, &format!("aircraft{more}"));
    clock.draw(canvas);
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
    charging.draw(canvas, Look { fill: Some((Paint::Series(2), 0.5)), stroke: None });
    empty.draw(canvas, empty_look());
    for (step, blocks) in loaded.iter().enumerate() {
        blocks.draw(canvas, loaded_look(step));
    }
    let every = if row_height < 9.0 { 5 } else { 2 };
    for aircraft in AircraftIx::all(shown).step_by(every) {
        let label = Lettering { size: 10.0, ..Lettering::SMALL }.anchored(Anchor::End);
        let id = shortened(&day.aircraft[aircraft.at()].id, 8);
        canvas.text((area.left - 6.0, top(aircraft) + 0.5 * row_height + 3.5), label, &id);
    }
    let entries = [
        (loaded_look(LOADS - 1), "flight, full"),
        (loaded_look(0), "a quarter full"),
        (empty_look(), "empty"),
        (Look { fill: Some((Paint::Series(2), 0.5)), stroke: None }, "charging"),
    ];
    key(canvas, (area.left, area.bottom() + 32.0), &entries);
}

fn loaded_look(step: usize) -> Look {
    let share = (step + 1) as f64 / LOADS as f64;
    Look { fill: Some((Paint::Series(0), 0.2 + 0.8 * share)), stroke: None }
}

fn empty_look() -> Look {
    Look { fill: Some((Paint::Ground, 1.0)), stroke: Some(Stroke::solid(Paint::Series(0), 0.8)) }
}

/// The share of each vertiport's stands that aircraft stand on or fly towards.
fn stands(
    canvas: &mut Canvas,
    clock: Clock,
    area: Area,
    (day, rows, end): (&Scenario, &[TraceRow], Time),
) {
    heading(canvas, area, "stands taken, at each vertiport");
    clock.draw(canvas);
    let shown = day.vertiports.len().min(MOST_ROWS);
    let row_height = area.height / shown as f64;
    let start_s = day.operations.start.seconds();
    let mut cells: [Blocks; LOADS] = Default::default();
    for from_s in (start_s..end.seconds()).step_by(CELL_S as usize) {
        let moment = Moment::of(day, rows, Time::from_seconds(from_s + CELL_S / 2));
        let x = clock.pixel(Time::from_seconds(from_s));
        let width = clock.pixel(Time::from_seconds(from_s + CELL_S)) - x;
        for at in 0..shown {
            let one = &day.vertiports[at];
            let stands = room(one);
            let taken = moment.standing[at] + moment.coming[at];
            let step = ((taken as usize * LOADS).div_ceil(stands.max(1) as usize)).min(LOADS);
            if step > 0 {
                let y = area.top + row_height * at as f64;
                cells[step - 1].add((x, y + 1.0), (width, row_height - 2.0));
            }
        }
    }
    for (step, blocks) in cells.iter().enumerate() {
        blocks.draw(canvas, taken_look(step));
    }
    for (at, one) in day.vertiports.iter().enumerate().take(shown) {
        let label = Lettering { size: 10.0, ..Lettering::SMALL }.anchored(Anchor::End);
        let y = area.top + row_height * (at as f64 + 0.5) + 3.5;
        canvas.text((area.left - 6.0, y), label, &shortened(&one.id, 8));
    }
    let entries = [
        (taken_look(0), "up to a quarter"),
        (taken_look(1), "half"),
        (taken_look(2), "three quarters"),
        (taken_look(3), "nearly all or all"),
    ];
    key(canvas, (area.left, area.bottom() + 32.0), &entries);
}

fn taken_look(step: usize) -> Look {
    let share = (step + 1) as f64 / LOADS as f64;
    Look { fill: Some((Paint::Series(1), share * share)), stroke: None }
}
