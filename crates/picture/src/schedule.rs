//! A played day as pictures: where passengers flew, what every aircraft did, how full the
//! vertiports were, how much demand was served and spilled, and where the money went. Each can be
//! drawn alone, or the first four on one sheet.

use vertifleet_core::{Scenario, Time};
use vertifleet_sim::TraceRow;

use crate::canvas::{Canvas, shortened};
use crate::demand::{all_passengers, served_and_spilled};
use crate::map::Area;
use crate::moment::Moment;
use crate::numbers::{counted, dollars, grouped};
use crate::panel::{Clock, heading};
use crate::{fleet, flows, ledger, stands};

const WIDTH: f64 = 1_000.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 24.0;
/// Where a picture begins below its title and subtitle.
const TOP: f64 = 76.0;

/// A picture of a played day.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlayedPicture {
    /// Where passengers flew.
    Map,
    /// The activities of every aircraft.
    Aircraft,
    /// The stands taken at every vertiport, against its capacity.
    Occupancy,
    /// Demand served and spilled.
    Demand,
    /// How revenue becomes profit.
    Ledger,
}

impl PlayedPicture {
    /// All of them, in the order of a page.
    pub const ALL: [Self; 5] =
        [Self::Ledger, Self::Map, Self::Aircraft, Self::Occupancy, Self::Demand];

    /// Its name in commands and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Aircraft => "aircraft",
            Self::Occupancy => "occupancy",
            Self::Demand => "demand",
            Self::Ledger => "ledger",
        }
    }

    /// The picture as SVG. `rows` is the trace of the day.
    pub fn draw(self, day: &Scenario, rows: &[TraceRow]) -> String {
        let (title, subtitle, height) = self.heading(day, rows);
        let title = format!("{title}, {}", shortened(&day.name, 50));
        let below = if matches!(self, Self::Aircraft | Self::Demand) { 48.0 } else { 30.0 };
        let mut canvas = Canvas::new(WIDTH, TOP + height + below, &title, &subtitle);
        let area = Area { left: LEFT, top: TOP, width: WIDTH - LEFT - RIGHT, height };
        let end = end_of(day, rows);
        match self {
            Self::Map => flows::carried(&mut canvas, area, day, rows),
            Self::Aircraft => {
                fleet::timeline(&mut canvas, Clock::of(day, end, area), day, rows);
            }
            Self::Occupancy => stands::panels(&mut canvas, area, (day, rows, end)),
            Self::Demand => served_and_spilled(&mut canvas, area, day, rows),
            Self::Ledger => {
                let area = Area { left: 130.0, width: WIDTH - 130.0 - 230.0, ..area };
                ledger::bars(&mut canvas, area, day, rows);
            }
        }
        canvas.into_svg()
    }

    /// Title, subtitle with the unit, and the height of what is drawn.
    fn heading(self, day: &Scenario, rows: &[TraceRow]) -> (&'static str, String, f64) {
        match self {
            Self::Map => {
                let carried = grouped(carried(rows) as f64, 0);
                let subtitle = format!(
                    "{carried} passengers; lines are as wide as passengers flew, north is up"
                );
                ("Passengers carried", subtitle, 440.0)
            }
            Self::Aircraft => {
                let flown = counted(
                    rows.iter().filter(|row| row.to != row.from).count(),
                    "flight",
                    "flights",
                );
                let subtitle = format!(
                    "{flown} by time of the day; a row for each aircraft{}",
                    fleet::left_out(day)
                );
                ("What every aircraft did", subtitle, fleet::height(day))
            }
            Self::Occupancy => {
                let subtitle = format!(
                    "Aircraft at each vertiport or on their way to it, by time of the day{}",
                    stands::left_out(day)
                );
                ("Stands taken against capacity", subtitle, stands::height(day))
            }
            Self::Demand => {
                let wanted = all_passengers(day);
                let spilled = grouped(wanted.saturating_sub(carried(rows)) as f64, 0);
                let wanted = grouped(wanted as f64, 0);
                let subtitle = format!(
                    "Passengers by the period in which they want to fly; {spilled} of {wanted} are not carried"
                );
                ("Demand served and spilled", subtitle, 240.0)
            }
            Self::Ledger => (
                "From revenue to profit",
                subtitle(day, rows, end_of(day, rows)),
                ledger::height(day, rows),
            ),
        }
    }
}

/// Map, aircraft, stands and demand on one sheet, as SVG.
pub fn schedule(day: &Scenario, rows: &[TraceRow]) -> String {
    let end = end_of(day, rows);
    let map = Area { left: 16.0, top: 92.0, width: 470.0, height: 320.0 };
    let demand = Area { left: 560.0, top: 92.0, width: WIDTH - 560.0 - RIGHT, height: 300.0 };
    let band = |top, height| Area { left: LEFT, top, width: WIDTH - LEFT - RIGHT, height };
    let aircraft = band(486.0, fleet::height(day));
    let taken = band(aircraft.bottom() + 86.0, stands::height(day));
    let mut canvas = Canvas::new(
        WIDTH,
        taken.bottom() + 32.0,
        &shortened(&day.name, 60),
        &subtitle(day, rows, end),
    );
    heading(&mut canvas, map, "passengers carried");
    flows::carried(&mut canvas, map, day, rows);
    heading(&mut canvas, demand, "passengers by demand period");
    served_and_spilled(&mut canvas, demand, day, rows);
    heading(&mut canvas, aircraft, &format!("aircraft{}", fleet::left_out(day)));
    fleet::timeline(&mut canvas, Clock::of(day, end, aircraft), day, rows);
    let text = format!("stands taken, against capacity{}", stands::left_out(day));
    heading(&mut canvas, taken, &text);
    stands::panels(&mut canvas, taken, (day, rows, end));
    canvas.into_svg()
}

/// The end of operations, or of the last charging if that is later.
fn end_of(day: &Scenario, rows: &[TraceRow]) -> Time {
    let ready = rows.iter().map(|row| row.ready).max();
    ready.unwrap_or(day.operations.end).max(day.operations.end)
}

/// Passengers carried.
fn carried(rows: &[TraceRow]) -> u64 {
    rows.iter().map(|row| u64::from(row.passengers)).sum()
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
