//! A day as a picture: its vertiports, and who wants to fly where and when.

use vertifleet_core::{Scenario, VertiportIx};

use crate::canvas::{Canvas, shortened};
use crate::demand::{all_passengers, wanted};
use crate::flows::draw_flows;
use crate::map::{Area, pair, room};
use crate::numbers::{counted, grouped};
use crate::panel::heading;

pub(crate) const WIDTH: f64 = 1_000.0;
pub(crate) const HEIGHT: f64 = 470.0;

/// The picture of a day as SVG.
pub fn day(day: &Scenario) -> String {
    let mut canvas = Canvas::new(WIDTH, HEIGHT, &shortened(&day.name, 60), &subtitle(day));
    map_and_demand(&mut canvas, day);
    canvas.into_svg()
}

/// Who wants to fly between which vertiports, and when, side by side.
pub(crate) fn map_and_demand(canvas: &mut Canvas, day: &Scenario) {
    let map = Area { left: 16.0, top: 92.0, width: 470.0, height: 330.0 };
    let demand = Area { left: 560.0, top: 92.0, width: WIDTH - 560.0 - 24.0, height: 320.0 };
    heading(canvas, map, "passengers who want to fly");
    draw_flows(canvas, map, day, &both_ways(day));
    wanted(canvas, demand, day);
}

pub(crate) fn subtitle(day: &Scenario) -> String {
    let stands: u32 = day.vertiports.iter().map(room).sum();
    let wanted = all_passengers(day);
    format!(
        "{} with {}, {}, {} passengers, {} to {}",
        counted(day.vertiports.len(), "vertiport", "vertiports"),
        counted(stands as usize, "stand", "stands"),
        counted(day.aircraft.len(), "aircraft", "aircraft"),
        grouped(wanted as f64, 0),
        day.operations.start,
        day.operations.end
    )
}

/// The passengers of all periods between two vertiports, both ways together, in the upper triangle.
fn both_ways(day: &Scenario) -> Vec<u32> {
    let size = day.vertiports.len();
    let mut numbers = vec![0_u32; size * size];
    for table in &day.demand {
        for from in VertiportIx::all(size) {
            for (to, &number) in table.row(from).iter().enumerate() {
                numbers[pair(size, from.at(), to)] += number;
            }
        }
    }
    numbers
}
