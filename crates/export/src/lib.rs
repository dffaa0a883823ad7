//! Played days in the formats of other programs.
//!
//! A played day is a scenario and the rows of its trace. A plan is written in the same way, because
//! a plan is a trace too. Every function returns bytes or text, and the caller writes the file; the
//! same day gives the same bytes on every machine.
//!
//! | function | format | for |
//! |---|---|---|
//! | [`csv()`] | CSV, one row a flight or hold | spreadsheets |
//! | [`parquet()`] | Apache Parquet with the same columns | data frames and databases |
//! | [`geojson()`] | GeoJSON, one line a flight with the time at every point | maps, and the trip layer of kepler.gl |
//! | [`gtfs()`] | a GTFS Schedule feed, one trip a flight | trip planners and tools of public transport |
//! | [`icalendar()`] | iCalendar, one calendar a vertiport | calendars |
//!
//! [`typed_table`] writes tables of any kind as Parquet, such as the results of sweeps.
//!
//! In every format the departure of a flight is the time of its decision, which is when boarding
//! begins. The aircraft cruises once the take-off time and any delay are over; it arrives when
//! landing is over, which is when passengers leave it.
//!
//! Two formats are left out, because vertiports and aircraft of a scenario have none of the codes
//! that these need: IATA SSIM names flights by airline, flight number and airport, and the flight
//! lists of OpenSky name aircraft by their transponders and airports by their ICAO codes. Invented
//! codes would name airports and aircraft that exist.
//!
//! ```
//! use vertifleet_core::{DaySeed, Network};
//! use vertifleet_export::{Calendar, Flown};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let day = Network::find("paper")?.draw(DaySeed::comparison(1)?);
//! let flown = Flown::new(&day, &[])?;
//! let calendar = Calendar::new("2026-11-24", "America/New_York")?;
//! assert!(vertifleet_export::csv(&flown, Some(&calendar)).starts_with(b"aircraft,type,kind,"));
//! // The vertiports of `paper` have positions in miles only, and maps need latitude and longitude.
//! assert!(vertifleet_export::geojson(&flown, &calendar).is_err());
//! # Ok(())
//! # }
//! ```

mod calendar;
mod columns;
mod error;
mod flight_path;
mod flown;
mod great_circle;
mod map_features;
mod output_kinds;
mod parquet_table;
mod safe_ids;
mod spreadsheet;
mod transit_feed;
mod typed_table;
mod vertiport_calendars;

pub use calendar::Calendar;
pub use error::Error;
pub use flown::Flown;
pub use map_features::geojson;
pub use output_kinds::{CSV_FILE, GEOJSON_FILE, GTFS_FILE, ICALENDAR_FILE, PARQUET_FILE};
pub use parquet_table::parquet;
pub use spreadsheet::csv;
pub use transit_feed::gtfs;
pub use typed_table::{Cells, TypedColumn, csv_table, typed_table};
pub use vertiport_calendars::{VertiportCalendar, icalendar};
