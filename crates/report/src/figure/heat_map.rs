//! The joint effect of two factors of a sweep: a cell for each pair of their values, darker where
//! the first policy earns more.

use vertifleet_picture::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened};
use vertifleet_picture::numbers::{grouped, typeset};
use vertifleet_picture::palette::Paint;

use super::Figure;
use vertifleet_study::statistics::mean;
use vertifleet_study::sweep::{CellSummary, SweepReport};

const WIDTH: f64 = 760.0;
const LEFT: f64 = 130.0;
const TOP: f64 = 96.0;
const RIGHT: f64 = 24.0;
const ROW: f64 = 34.0;
const BOTTOM: f64 = 60.0;
/// Largest number of values in a direction: more leave no space for numbers.
const MOST_VALUES: usize = 14;

/// The figure of the two factors that matter most; `None` if there are not two, if they have too
/// many values, or if not every pair of their values is in the design.
pub(super) fn figure(report: &SweepReport) -> Option<Figure> {
    if !report.is_grid {
        return None;
    }
    let (across, down) = strongest(report)?;
    let columns = values(report, across);
    let rows = values(report, down);
    let fits = |values: &[String]| (2..=MOST_VALUES).contains(&values.len());
    if !fits(&columns) || !fits(&rows) {
        return None;
    }
    let label = |cell: &CellSummary, factor: usize| {
        vertifleet_study::sweep::format_value(&cell.settings[factor])
    };
    let cell_mean = |row: &String, column: &String| {
        let cells = report.cells.iter().filter(|cell| !cell.results.is_empty());
        let here = cells.filter(|cell| label(cell, down) == *row && label(cell, across) == *column);
        let profits: Vec<f64> = here.map(|cell| cell.results[0].profit_usd.mean).collect();
        (!profits.is_empty()).then(|| mean(&profits))
    };
    let table: Vec<Vec<Option<f64>>> = rows
        .iter()
        .map(|row| columns.iter().map(|column| cell_mean(row, column)).collect())
        .collect();
    let height = TOP + ROW * rows.len() as f64 + BOTTOM;
    let (first, second) = (&report.factors[across], &report.factors[down]);
    let subtitle = format!("Mean profit a day of {}, $", report.policies[0]);
    let mut canvas = Canvas::new(WIDTH, height, &format!("{first} and {second}"), &subtitle);
    draw(&mut canvas, &table, &columns, &rows);
    let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
    let floor = TOP + ROW * rows.len() as f64;
    canvas.text(
        (middle, floor + 42.0),
        Lettering::SMALL.anchored(Anchor::Middle),
        &shortened(first, 60),
    );
    canvas.text((16.0, TOP - 10.0), Lettering::SMALL, &shortened(second, 60));
    Some(Figure {
        slug: "figure-heat-map".into(),
        caption: "The two settings that matter most. Darker is more; the frame marks the best pair. Where other settings were varied \
                  too, cells are means over them. An empty cell had no fleet, or no place for it."
            .to_owned(),
        svg: canvas.into_svg(),
    })
}

/// The positions of the two factors with the largest effects, in the order of the report.
fn strongest(report: &SweepReport) -> Option<(usize, usize)> {
    let mut by_span: Vec<usize> = (0..report.effects.len()).collect();
    by_span.sort_by(|&one, &other| {
        report.effects[other].span_usd.total_cmp(&report.effects[one].span_usd)
    });
    let (&first, &second) = (by_span.first()?, by_span.get(1)?);
    Some((first.min(second), first.max(second)))
}

/// The values of a factor in ascending order if they are numbers, else in the order of the design.
fn values(report: &SweepReport, factor: usize) -> Vec<String> {
    let mut values: Vec<&serde_json::Value> = Vec::new();
    for cell in &report.cells {
        if !values.contains(&&cell.settings[factor]) {
            values.push(&cell.settings[factor]);
        }
    }
    if values.iter().all(|value| value.is_number()) {
        let number = |value: &serde_json::Value| value.as_f64().unwrap_or_default();
        values.sort_by(|one, other| number(one).total_cmp(&number(other)));
    }
    values.into_iter().map(vertifleet_study::sweep::format_value).collect()
}

fn draw(canvas: &mut Canvas, table: &[Vec<Option<f64>>], columns: &[String], rows: &[String]) {
    let known = || table.iter().flatten().flatten().copied();
    let (low, high) =
        (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
    let width = (WIDTH - LEFT - RIGHT) / columns.len() as f64;
    let floor = TOP + ROW * rows.len() as f64;
    for (at, column) in columns.iter().enumerate() {
        let x = LEFT + width * (at as f64 + 0.5);
        let label = typeset(&shortened(column, 10));
        canvas.text((x, floor + 20.0), Lettering::SMALL.anchored(Anchor::Middle), &label);
    }
    for (at, (row, cells)) in rows.iter().zip(table).enumerate() {
        let y = TOP + ROW * at as f64;
        let label = typeset(&shortened(row, 14));
        canvas.text(
            (LEFT - 10.0, y + ROW / 2.0 + 4.0),
            Lettering::LABEL.anchored(Anchor::End),
            &label,
        );
        for (column, &profit_usd) in cells.iter().enumerate() {
            let corner = (LEFT + width * column as f64, y);
            let Some(profit_usd) = profit_usd else { continue };
            let share = if high > low { (profit_usd - low) / (high - low) } else { 1.0 };
            let stroke = (profit_usd == high).then(|| Stroke::solid(Paint::Ink, 2.0));
            let look = Look { fill: Some((Paint::Series(0), 0.06 + 0.5 * share)), stroke };
            canvas.rectangle((corner.0 + 1.0, corner.1 + 1.0), (width - 2.0, ROW - 2.0), look);
            let number = typeset(&grouped(profit_usd, 0));
            let middle = (corner.0 + width / 2.0, corner.1 + ROW / 2.0 + 4.0);
            let lettering = Lettering { paint: Paint::Ink, ..Lettering::SMALL };
            canvas.text(middle, lettering.anchored(Anchor::Middle), &number);
        }
    }
}
