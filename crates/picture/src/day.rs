//! A day as a picture: its vertiports, and who wants to fly where and when.

use vertifleet_core::{Matrix, Scenario, VertiportIx};

use crate::canvas::{Canvas, shortened};
use crate::demand::wanted;
use crate::flows::draw_flows;
use crate::map::{Area, pair, room};
use crate::numbers::{counted, grouped};
use crate::panel::heading;

pub(crate) const WIDTH: f64 = 1_000.0;
pub(crate) const HEIGHT: f64 = 470.0;

/// The picture of a day as SVG.
pub fn day(day: &Scenario) -> String {
    let demand: Vec<Matrix<f64>> = day.demand.iter().map(numbers).collect();
    let mut canvas = Canvas::new(WIDTH, HEIGHT, &shortened(&day.name, 60), &subtitle(day, &demand));
    map_and_demand(&mut canvas, day, &demand);
    canvas.into_svg()
}

/// Passengers as numbers that may also be means.
fn numbers(table: &Matrix<u32>) -> Matrix<f64> {
    Matrix::from_fn(table.size(), |from, to| f64::from(table[(from, to)]))
}

/// The demand by pair of vertiports and period, side by side. `demand` has the passengers of each
/// demand period, or their means.
pub(crate) fn map_and_demand(canvas: &mut Canvas, day: &Scenario, demand: &[Matrix<f64>]) {
    let map = Area { left: 16.0, top: 92.0, width: 470.0, height: 330.0 };
    let bars = Area { left: 560.0, top: 92.0, width: WIDTH - 560.0 - 24.0, height: 320.0 };
    heading(canvas, map, "passengers who want to fly");
    draw_flows(canvas, map, day, &both_ways(demand));
    wanted(canvas, bars, day, demand);
}

/// The sizes of a day or network.
pub(crate) fn subtitle(day: &Scenario, demand: &[Matrix<f64>]) -> String {
    let stands: u32 = day.vertiports.iter().map(room).sum();
    let wanted: f64 = demand.iter().flat_map(Matrix::cells).sum();
    format!(
        "{} with {}, {}, {} passengers, {} to {}",
        counted(day.vertiports.len(), "vertiport", "vertiports"),
        counted(stands as usize, "stand", "stands"),
        counted(day.aircraft.len(), "aircraft", "aircraft"),
        grouped(wanted, 0),
        day.operations.start,
        day.operations.end
    )
}

/// The passengers of all periods between two vertiports, both ways together, in the upper triangle.
fn both_ways(demand: &[Matrix<f64>]) -> Vec<f64> {
    let size = demand.first().map_or(0, Matrix::size);
    let mut numbers = vec![0.0; size * size];
    for table in demand {
        for from in VertiportIx::all(size) {
            for (to, &number) in table.row(from).iter().enumerate() {
                numbers[pair(size, from.at(), to)] += number;
            }
        }
    }
    numbers
}
