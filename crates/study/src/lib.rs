//! Many policies on many days: statistics, figures, report.
//!
//! [`policies`] and [`entrants`] know who is meant by a name, [`comparison`] goes from what is asked for to its records, [`run`] plays the days, [`record`] holds what they leave behind, [`ComparisonReport`] turns it into statistics, and [`table`], [`figure`] and
//! [`report`] present those; [`generalisation`] does the same for a day each of many networks. Presentation computes nothing; statistics know nothing of pages.

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
