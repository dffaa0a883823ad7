//! Demand by period: served and spilled.

use vertifleet_core::{Matrix, Scenario, Time};
use vertifleet_sim::{Boarded, TraceRow};

use crate::canvas::{Anchor, Canvas, Lettering, Look};
use crate::map::Area;
use crate::palette::Paint;
use crate::panel::{Blocks, counts, heading, key};

/// With more periods, only every second one and so on has a label.
const MOST_LABELS: usize = 18;

/// Everyone who wants to fly on a day.
pub(crate) fn all_passengers(day: &Scenario) -> u64 {
    day.demand.iter().flat_map(Matrix::cells).map(|&some| u64::from(some)).sum()
}

/// Bars of the passengers who flew and of those who did not, by the period in which they wanted to.
pub(crate) fn served_and_spilled(
    canvas: &mut Canvas,
    area: Area,
    day: &Scenario,
    rows: &[TraceRow],
) {
    let mut served = vec![0.0; day.periods.len()];
    let mut boarded = Boarded::of(day);
    for row in rows {
        for (period, passengers) in boarded.board(row) {
            served[period] += f64::from(passengers);
        }
    }
    let wanted = |table: &Matrix<u32>| f64::from(table.cells().iter().sum::<u32>());
    bars(canvas, area, day, &day.demand.iter().map(wanted).zip(served).collect::<Vec<_>>());
    let entries = [(served_look(), "carried"), (spilled_look(), "spilled")];
    key(canvas, (area.left, area.bottom() + 34.0), &entries);
}

/// Bars of all passengers who want to fly, or of their means.
pub(crate) fn wanted(canvas: &mut Canvas, area: Area, day: &Scenario, demand: &[Matrix<f64>]) {
    heading(canvas, area, "passengers who want to fly, by demand period");
    let all = |table: &Matrix<f64>| table.cells().iter().sum::<f64>();
    bars(canvas, area, day, &demand.iter().map(all).map(|all| (all, all)).collect::<Vec<_>>());
}

/// A bar for each demand period, of the passengers who want to fly and of those of them who are
/// served.
fn bars(canvas: &mut Canvas, area: Area, day: &Scenario, passengers: &[(f64, f64)]) {
    let scale = counts(canvas, area, passengers.iter().map(|&(wanted, _)| wanted));
    let width = area.width / passengers.len() as f64;
    let (mut below, mut above) = (Blocks::default(), Blocks::default());
    for (period, &(wanted, served)) in passengers.iter().enumerate() {
        let x = area.left + width * period as f64 + 0.1 * width;
        let (bottom, middle, top) =
            (area.bottom(), scale.pixel(served), scale.pixel(wanted.max(served)));
        below.add((x, middle), (0.8 * width, bottom - middle));
        above.add((x, top), (0.8 * width, middle - top));
    }
    below.draw(canvas, served_look());
    above.draw(canvas, spilled_look());
    let every = passengers.len().div_ceil(MOST_LABELS);
    for (period, &start) in day.periods.iter().enumerate().step_by(every) {
        let x = area.left + width * (period as f64 + 0.5);
        let label = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::Middle);
        canvas.text((x, area.bottom() + 14.0), label, &hour(start));
    }
}

/// The hour of a time, with its minutes if it has any.
fn hour(time: Time) -> String {
    let minutes = time.seconds() / 60;
    if minutes.is_multiple_of(60) {
        format!("{}", minutes / 60)
    } else {
        format!("{}:{:02}", minutes / 60, minutes % 60)
    }
}

fn served_look() -> Look {
    Look { fill: Some((Paint::Series(0), 0.9)), stroke: None }
}

fn spilled_look() -> Look {
    Look { fill: Some((Paint::Series(1), 0.45)), stroke: None }
}
