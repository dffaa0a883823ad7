//! A network as a picture: its vertiports, when people want to fly, and the matrix of demand in
//! each demand period.

use vertifleet_core::{Matrix, Scenario};

use crate::canvas::{Canvas, shortened};
use crate::day::{HEIGHT, WIDTH, map_and_demand, subtitle};
use crate::map::Area;
use crate::matrices::Matrices;
use crate::panel::heading;

const LEFT: f64 = 64.0;
const RIGHT: f64 = 24.0;

/// The picture of a network as SVG. `day` is its [mean day](vertifleet_core::Network::mean_day),
/// and `means` are the mean passengers by period. All of it is drawn from `means`: the day has them
/// rounded for each pair, which leaves no passengers where demand is thin.
pub fn network(day: &Scenario, means: &[Matrix<f64>]) -> String {
    let matrices = Matrices::of(day, means);
    let width = WIDTH - LEFT - RIGHT;
    let area = Area { left: LEFT, top: HEIGHT + 26.0, width, height: matrices.height(width) };
    let height = area.bottom() + 36.0;
    let mut canvas = Canvas::new(WIDTH, height, &shortened(&day.name, 60), &subtitle(day, means));
    map_and_demand(&mut canvas, day, means);
    heading(&mut canvas, area, &matrices.title());
    matrices.draw(&mut canvas, area);
    canvas.into_svg()
}
