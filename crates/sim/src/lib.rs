//! The simulator: events, stands, feasible decisions, the ledger, and the trace of a day.
//!
//! Every day is played by two calls: [`Simulation::next_decision`] returns the aircraft that must
//! decide now, and [`Simulation::apply`] carries its decision out or refuses it. A policy sees the
//! day through a [`View`]. The [checker](check) judges finished schedules from the rules alone and
//! shares no code with the simulator.
//!
//! This crate builds on `vertifleet-core` and has no policies. In this example every aircraft holds
//! all day:
//!
//! ```
//! use std::sync::Arc;
//!
//! use vertifleet_core::{DaySeed, Network};
//! use vertifleet_sim::Simulation;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let day = Network::find("paper")?.draw(DaySeed::comparison(1)?);
//! let mut simulation = Simulation::new(Arc::new(day));
//! while let Some(decision) = simulation.next_decision() {
//!     simulation.apply(decision.at)?;
//! }
//! assert_eq!(simulation.totals().flights, 0);
//! # Ok(())
//! # }
//! ```

mod batteries;
mod boarded;
pub mod check;
mod closures;
mod day_totals;
mod delays;
mod demand;
mod departures;
mod error;
mod imagined;
mod landed;
mod ledger;
mod legs;
pub mod live;
mod outages;
mod outcome;
mod queue;
mod room;
mod simulation;
mod snapshot;
mod stands;
mod trace;
mod vertiport_set;
mod view;

pub use boarded::Boarded;
pub use day_totals::{DayNumber, DayTotals};
pub use departures::Departures;
pub use error::{Refusal, Shortfall};
pub use imagined::Imagined;
pub use landed::Landed;
pub use ledger::Ledger;
pub use legs::{Leg, Legs, refill_s};
pub use outcome::Outcome;
pub use simulation::{Decision, Simulation, first_decision};
pub use snapshot::Snapshot;
pub use trace::{Trace, TraceError, TraceRow};
pub use vertiport_set::VertiportSet;
pub use view::{DayKey, View};
