//! Shows the progress of long work on the terminal, for the program and the Python package alike.
//!
//! This crate builds on `vertifleet-study` and `vertifleet-optimize`, whose long calls it watches,
//! and on nothing else here. [`Bars`] watches the days of a study, [`SearchBar`] the search for a
//! plan, and [`Bar`] any work whose units can be counted. Without a terminal nothing is shown.
//!
//! ```
//! use vertifleet_core::{Network, Stop};
//! use vertifleet_progress::Bars;
//! use vertifleet_study::comparison::{Comparison, DrawnDays};
//! use vertifleet_study::competitor::Selection;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (network, policies) = (Network::find("paper")?, ["greedy".to_owned()]);
//! let selection = Selection { policies: &policies, models: &[], seed: 1 };
//! let stop = Stop::default();
//! let comparison = Comparison::new(&network, &selection, DrawnDays::of_comparison(1, 2), None, &stop)?;
//! let records = comparison.run("an example".to_owned(), &stop, &Bars)?;
//! assert_eq!(records.policies[0].days.len(), 2);
//! # Ok(())
//! # }
//! ```

mod bar;
mod days;
mod search;

pub use bar::Bar;
pub use days::Bars;
pub use search::SearchBar;
