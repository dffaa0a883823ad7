//! The demand by pair and time: the matrix of demand as small heat maps, one for each demand
//! period.
//!
//! Demand is far from even, so the classes of the colours grow with the square of their number: the
//! few great numbers do not make all others look alike. The legend has their limits.

use vertifleet_core::{Matrix, Scenario, Time, VertiportIx};

use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke, shortened, text_width};
use crate::map::Area;
use crate::numbers::grouped;
use crate::palette::Paint;
use crate::panel::{Blocks, key};

/// The most heat maps; with more periods, each of them shows some that follow each other.
const MOST_PANELS: usize = 24;
/// The most vertiports whose ids stand next to the rows and columns.
const MOST_NAMED: usize = 16;
/// Classes of numbers, each with a different colour.
const CLASSES: usize = 6;
/// Room between heat maps, across and down, pixels.
const GAP: (f64, f64) = (18.0, 42.0);
const NAME_SIZE: f64 = 8.0;

/// The demand of one or several periods that follow each other.
struct Panel {
    start: Time,
    passengers: Matrix<f64>,
}

/// The heat maps of a demand, `[period](from, to)`, below each other in rows.
pub(crate) struct Matrices<'a> {
    day: &'a Scenario,
    panels: Vec<Panel>,
    /// Periods of a panel.
    periods: usize,
    /// The largest number of a pair in a panel.
    most: f64,
}

impl<'a> Matrices<'a> {
    pub(crate) fn of(day: &'a Scenario, demand: &[Matrix<f64>]) -> Self {
        let periods = demand.len().div_ceil(MOST_PANELS).max(1);
        let size = day.vertiports.len();
        let sum = |tables: &[Matrix<f64>], pair| tables.iter().map(|table| table[pair]).sum();
        let joined = demand.chunks(periods).zip(day.periods.iter().step_by(periods));
        let panels: Vec<Panel> = joined
            .map(|(tables, &start)| Panel {
                start,
                passengers: Matrix::from_fn(size, |from, to| sum(tables, (from, to))),
            })
            .collect();
        let cells = panels.iter().flat_map(|panel| panel.passengers.cells());
        let most = cells.copied().fold(0.0, f64::max);
        Self { day, panels, periods, most }
    }

    /// The text of a heading, with how the numbers are to be read.
    pub(crate) fn title(&self) -> String {
        let each = if self.periods == 1 {
            "each demand period".to_owned()
        } else {
            format!("each {} demand periods", self.periods)
        };
        let order = if self.is_named() { "" } else { ", in the order of the file" };
        format!(
            "mean passengers in {each}, from (rows) and to (columns) each vertiport{order}, with their sum"
        )
    }

    fn is_named(&self) -> bool {
        self.day.vertiports.len() <= MOST_NAMED
    }

    fn columns(&self) -> usize {
        if self.is_named() { 5 } else { 4 }
    }

    /// The side of a heat map.
    fn side(&self, width: f64) -> f64 {
        let columns = self.columns() as f64;
        (width - GAP.0 * (columns - 1.0)) / columns
    }

    /// The height that all of them need in this width, pixels.
    pub(crate) fn height(&self, width: f64) -> f64 {
        (self.side(width) + GAP.1) * self.panels.len().div_ceil(self.columns()) as f64
    }

    /// Draws the heat maps and the legend below them.
    pub(crate) fn draw(&self, canvas: &mut Canvas, area: Area) {
        let side = self.side(area.width);
        for (at, panel) in self.panels.iter().enumerate() {
            let (row, column) = (at / self.columns(), at % self.columns());
            let place = Area {
                left: area.left + (side + GAP.0) * column as f64,
                top: area.top + (side + GAP.1) * row as f64 + 18.0,
                width: side,
                height: side,
            };
            self.heat_map(canvas, place, panel);
            if self.is_named() {
                self.names(canvas, place, column == 0);
            }
        }
        let limits: Vec<String> = (0..CLASSES).map(|class| self.limits(class)).collect();
        let entries: Vec<(Look, &str)> =
            limits.iter().enumerate().map(|(class, text)| (look(class), text.as_str())).collect();
        key(canvas, (area.left, area.bottom() + 20.0), &entries);
    }

    fn heat_map(&self, canvas: &mut Canvas, area: Area, panel: &Panel) {
        let bold = Lettering { size: 12.0, ..Lettering::LABEL.bold() };
        let start = panel.start.to_string();
        let start = start.strip_suffix(":00").unwrap_or(&start);
        canvas.text((area.left, area.top - 6.0), bold, start);
        let all = panel.passengers.cells().iter().sum();
        let small = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::End);
        canvas.text((area.right(), area.top - 6.0), small, &grouped(all, 0));
        let size = panel.passengers.size();
        let cell = area.width / size as f64;
        let mut classes: [Blocks; CLASSES] = Default::default();
        for from in VertiportIx::all(size) {
            let y = area.top + cell * from.at() as f64;
            let row: Vec<Option<usize>> =
                panel.passengers.row(from).iter().map(|&number| self.class(number)).collect();
            let mut start = 0;
            // Cells of one class that lie side by side are one block, so that pictures of large
            // networks stay small.
            for run in row.chunk_by(|one, next| one == next) {
                if let Some(class) = run[0] {
                    let x = area.left + cell * start as f64;
                    classes[class].add((x, y), (cell * run.len() as f64, cell));
                }
                start += run.len();
            }
        }
        for (class, blocks) in classes.iter().enumerate() {
            blocks.draw(canvas, look(class));
        }
        let frame = Look::outlined(Stroke::solid(Paint::Muted, 0.8));
        canvas.rectangle((area.left, area.top), (area.width, area.height), frame);
    }

    /// The ids of the vertiports below the columns and, in the first column of heat maps, next to
    /// the rows. Where they are wide for their columns, every second one stands lower.
    fn names(&self, canvas: &mut Canvas, area: Area, is_first: bool) {
        let ids = || self.day.vertiports.iter().map(|one| one.id.as_str());
        let cell = area.width / self.day.vertiports.len() as f64;
        let lettering = Lettering { size: NAME_SIZE, ..Lettering::SMALL };
        let is_tight = ids().any(|id| text_width(id, NAME_SIZE) > cell - 4.0);
        let room = if is_tight { 2.0 * cell } else { cell };
        let fits = |letters: &usize| text_width(&"m".repeat(*letters), NAME_SIZE) <= room - 2.0;
        let letters = (1..9).rev().find(fits).unwrap_or(1);
        for (at, id) in ids().enumerate() {
            let middle = cell * (at as f64 + 0.5);
            let lower = if is_tight && at % 2 == 1 { NAME_SIZE } else { 0.0 };
            let below = (area.left + middle, area.bottom() + 10.0 + lower);
            canvas.text(below, lettering.anchored(Anchor::Middle), &shortened(id, letters));
            if is_first {
                let left_of_row = (area.left - 5.0, area.top + middle + 3.0);
                canvas.text(left_of_row, lettering.anchored(Anchor::End), &shortened(id, 9));
            }
        }
    }

    /// The class of a number; `None` for none.
    fn class(&self, number: f64) -> Option<usize> {
        (0..CLASSES).find(|&class| number <= self.upper(class)).filter(|_| number > 0.0)
    }

    /// The upper limit of a class.
    fn upper(&self, class: usize) -> f64 {
        if class + 1 == CLASSES {
            return self.most;
        }
        let share = (class + 1) as f64 / CLASSES as f64;
        self.most * share * share
    }

    fn limits(&self, class: usize) -> String {
        let decimals = match self.most {
            most if most < 1.0 => 3,
            most if most < 100.0 => 1,
            _ => 0,
        };
        let upper = grouped(self.upper(class), decimals);
        if class == 0 { format!("more than 0, up to {upper}") } else { format!("up to {upper}") }
    }
}

fn look(class: usize) -> Look {
    let share = (class + 1) as f64 / CLASSES as f64;
    Look { fill: Some((Paint::Series(0), 0.05 + 0.95 * share * share.sqrt())), stroke: None }
}
