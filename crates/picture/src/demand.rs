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
    let mut served = vec![0_u32; day.periods.len()];
    let mut boarded = Boarded::of(day);
    for row in rows {
        for (period, passengers) in boarded.board(row) {
            served[period] += u32::from(passengers);
        }
    }
    bars(canvas, area, day, &served);
    let entries = [(served_look(), "carried"), (spilled_look(), "spilled")];
    key(canvas, (area.left, area.bottom() + 34.0), &entries);
}

/// Bars of all passengers who want to fly.
pub(crate) fn wanted(canvas: &mut Canvas, area: Area, day: &Scenario) {
    heading(canvas, area, "passengers who want to fly, by demand period");
    bars(canvas, area, day, &by_period(day));
}

/// The passengers who want to fly in each demand period.
fn by_period(day: &Scenario) -> Vec<u32> {
    day.demand.iter().map(|table| table.cells().iter().sum()).collect()
}

fn bars(canvas: &mut Canvas, area: Area, day: &Scenario, served: &[u32]) {
    let wanted = by_period(day);
    let scale = counts(canvas, area, wanted.iter().map(|&number| f64::from(number)));
    let width = area.width / wanted.len() as f64;
    let (mut below, mut above) = (Blocks::default(), Blocks::default());
    for (period, (&wanted, &served)) in wanted.iter().zip(served).enumerate() {
        let x = area.left + width * period as f64 + 0.1 * width;
        let (bottom, middle, top) = (
            area.bottom(),
            scale.pixel(f64::from(served)),
            scale.pixel(f64::from(wanted.max(served))),
        );
        below.add((x, middle), (0.8 * width, bottom - middle));
        above.add((x, top), (0.8 * width, middle - top));
    }
    below.draw(canvas, served_look());
    above.draw(canvas, spilled_look());
    let every = wanted.len().div_ceil(MOST_LABELS);
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
