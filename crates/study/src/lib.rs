//! Studies of many policies on many days, and their statistics.
//!
//! This crate builds on `vertifleet-optimize` and `vertifleet-learn`. [`PolicySpec`] gives the
//! names of policies their meaning, and [`competitor`] finds the policies of a study. There are
//! four studies: [`comparison`], of policies on the days of one network, [`evaluation`], on the
//! days of a [`Suite`], [`sweep`], over many settings of one network, and [`size`], which searches
//! for the best numbers of aircraft, stands and chargers. All go from the request to records. An
//! evaluation leaves result files, which can be verified. [`ComparisonReport`] turns records into
//! statistics. `vertifleet-report`, which builds on this crate, shows them.
//!
//! ```
//! use vertifleet_core::{Network, Stop};
//! use vertifleet_study::comparison::{Comparison, DrawnDays};
//! use vertifleet_study::competitor::Selection;
//! use vertifleet_study::{ComparisonReport, Unwatched};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let network = Network::find("paper")?;
//! let names = ["greedy".to_owned(), "random".to_owned()];
//! let selection = Selection { policies: &names, models: &[], seed: 1 };
//! let stop = Stop::default();
//! let comparison = Comparison::new(&network, &selection, DrawnDays::of_comparison(1, 5), None, &stop)?;
//! let records = comparison.run("an example".to_owned(), &stop, &Unwatched)?;
//! let report = ComparisonReport::of(&records)?;
//! assert_eq!(report.best().name, "greedy");
//! # Ok(())
//! # }
//! ```

pub mod account;
pub mod board;
pub mod comparison;
pub mod competitor;
mod error;
pub mod evaluation;
pub mod explain;
mod journal;
mod kept_bounds;
pub mod network_overview;
mod origin;
mod own_days;
mod policy_spec;
pub mod published;
pub mod record;
mod replay;
mod resolved_policy;
mod run;
mod sees;
mod share;
pub mod size;
mod starting_policies;
pub mod statistics;
mod study;
mod suite;
pub mod sweep;

pub use board::BoardReport;
pub use comparison::ComparisonReport;
pub use error::Error;
pub use journal::make_folder;
pub use kept_bounds::KeptBounds;
pub use origin::NetworkOrigin;
pub use own_days::OwnDays;
pub use policy_spec::{PolicySource, PolicySpec, ResolveFor};
pub use record::{
    ComparisonRecords, DayRecord, LatencySummary, LearningCurve, PolicyRecord, ValidationCurves,
};
pub use resolved_policy::{OnNetwork, PolicyFactory, ResolvedPolicy};
pub use sees::Sees;
pub use share::PolicyShare;
pub use starting_policies::starting_policies;
pub use study::{MOST_DAYS, Unwatched, Watch};
pub use suite::{SUITES, Suite, SuiteDay};
