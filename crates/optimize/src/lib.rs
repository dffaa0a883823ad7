//! Upper bounds on the profit of a day, and schedules that come close to them.
//!
//! [`upper_bound`] proves how much no schedule of a known day can exceed. The planner, [`plan()`],
//! searches for the schedule that earns the most, and [`plan_in_time`] also shows how far
//! it can be from the best. [`Rolling`] decides while the day goes on.
//!
//! This crate builds on `vertifleet-policy`; the planner starts from days played by its policies.
//!
//! ```
//! use vertifleet_core::{DaySeed, Network};
//! use vertifleet_optimize::{Step, upper_bound};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let day = Network::find("paper")?.draw(DaySeed::comparison(1)?);
//! let bound = upper_bound(&day, Step::from_minutes(60)?)?;
//! assert!((38_000.0..40_000.0).contains(&bound.upper_bound_usd()));
//! # Ok(())
//! # }
//! ```
//!
//! ```
//! use std::sync::Arc;
//!
//! use vertifleet_core::{DaySeed, Network};
//! use vertifleet_optimize::{Budget, SearchSettings, plan};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let day = Arc::new(Network::find("paper")?.draw(DaySeed::comparison(1)?));
//! let settings = SearchSettings { budget: Budget::Steps(100), searches: 1, seed: 1 };
//! let found = plan(&day, &settings, Vec::new(), &mut |_| true);
//! assert!(found.profit_usd >= found.best_policy_usd);
//! # Ok(())
//! # }
//! ```

mod bound;
pub mod error;
mod plan;
mod plan_in_time;
mod proof;
mod proven_plan;
mod rolling;

pub use bound::{
    Bound, DesignBound, Step, bound_without_foresight, day_of_passengers, gap, kept_upper_bound,
    upper_bound, upper_bound_of_rest, upper_bound_unless,
};
pub use error::Error;
pub use plan::{
    Budget, Plan, SearchProgress, SearchSettings, StartingPolicy, plan, steps_of_equal_work,
};
pub use plan_in_time::plan_in_time;
pub use proof::Proof;
pub use proven_plan::ProvenPlan;
pub use rolling::Rolling;
