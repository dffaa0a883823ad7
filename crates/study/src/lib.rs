//! Many policies on many days: statistics, figures, report.
//!
//! This crate builds on `vertifleet-optimize` and `vertifleet-learn`. [`policies`] and [`entrants`] know which policy a name means,
//! [`comparison`] goes from what is asked for to its records, [`run`] plays the days, and [`record`] holds what they leave behind.
//! [`ComparisonReport`] turns that into statistics, and [`table`], [`figure`] and [`report`] present them; [`generalisation`] does the same
//! for a day each of many networks. Presentation computes nothing, and statistics know nothing of pages.
//!
//! ```
//! use vertifleet_core::{Network, Stop};
//! use vertifleet_study::comparison::{Comparison, Watch};
//! use vertifleet_study::entrants::Asked;
//! use vertifleet_study::{ComparisonReport, table};
//!
//! /// Watches nothing.
//! struct Unwatched;
//!
//! impl Watch for Unwatched {
//!     type Bar = fn();
//!     fn bounds(&self, _: usize) -> fn() {
//!         || ()
//!     }
//!     fn policy(&self, _: &str, _: usize, _: usize, _: usize) -> fn() {
//!         || ()
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let network = Network::find("paper")?;
//! let names = ["greedy".to_owned(), "random".to_owned()];
//! let asked = Asked { policies: &names, models: &[], seed: 1, network: network.name() };
//! let stop = Stop::default();
//! let comparison = Comparison::new(&network, &asked, (1, 5), None, &stop)?;
//! let records = comparison.run("an example".to_owned(), &stop, &Unwatched)?;
//! let report = ComparisonReport::of(&records)?;
//! assert_eq!(report.best().name, "greedy");
//! println!("{}", table::text(&report));
//! # Ok(())
//! # }
//! ```

pub mod comparison;
mod days_csv;
pub mod entrants;
mod error;
pub mod figure;
pub mod generalisation;
mod headline;
mod join;
mod kept_bounds;
mod numbers;
mod origin;
mod own_days;
mod page;
pub mod policies;
pub mod published;
pub mod record;
pub mod report;
pub mod run;
pub mod statistics;
pub mod summary;
pub mod table;

pub use error::Error;
pub use kept_bounds::KeptBounds;
pub use origin::NetworkOrigin;
pub use own_days::OwnDays;
pub use record::{
    ComparisonRecords, DayRecord, LatencySummary, LearningCurve, PolicyRecord, ValidationCurves,
};
pub use summary::ComparisonReport;
