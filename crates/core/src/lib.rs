//! The world as data: networks, scenarios, and days drawn from a seed.
//!
//! A [`Scenario`] is one operating day with everything exogenous in it and nothing left to be
//! drawn. Days are drawn from a [`Network`]. Both are read in two stages: raw text, then checked
//! types that cannot hold nonsense. This crate builds on no other crate here, and has no simulation
//! clock, no policies and no motion. Its only randomness draws days and networks.
//!
//! ```
//! use vertifleet_core::{DaySeed, Network};
//!
//! # fn main() -> Result<(), vertifleet_core::Error> {
//! let network = Network::find("paper")?;
//! let day = network.draw(DaySeed::comparison(1)?);
//! assert_eq!((day.vertiports.len(), day.aircraft.len()), (8, 40));
//! # Ok(())
//! # }
//! ```

mod change;
mod check;
mod closed_times;
mod code;
mod corridors;
mod demand_model;
mod demand_table;
mod differences;
mod disturbance_model;
mod disturbances;
mod draw;
mod edit;
mod error;
mod fares;
mod feature_scales;
mod file_kind;
mod files;
mod folders;
mod ix;
mod kept;
mod limits;
mod market;
mod matrix;
mod member_path;
mod nearest;
mod network;
mod network_file;
mod output_error;
mod outputs;
mod parse;
mod paths;
mod random;
mod random_city;
mod random_network;
mod random_places;
mod raw;
mod raw_disturbances;
mod read;
mod scenario;
mod scheduled_closures;
mod seeds;
mod sites;
mod stop;
mod tariffs;
mod time;
mod warning;
mod world;
mod write;

pub use closed_times::{ClosedSpan, ClosedTimes};
pub use code::{Code, Coded, Exit};
pub use differences::Difference;
pub use disturbances::{Closure, Disturbances, Outage, Route, TakeoffDelays};
pub use error::Error;
pub use fares::Fares;
pub use feature_scales::FeatureScales;
pub use file_kind::FileKind;
pub use files::{block_writes, create_folder, read_at_most, write_atomically};
pub use folders::{FolderKind, check_folder, replace_folder};
pub use ix::{AircraftIx, TypeIx, VertiportIx};
pub use matrix::Matrix;
pub use member_path::split_path;
pub use nearest::nearest;
pub use network::Network;
pub use output_error::OutputError;
pub use outputs::{OutputKind, Outputs, check_output};
pub use random_city::random_city;
pub use random_network::random_network;
pub use random_places::{RANDOM_PLACES, random_places};
pub use scenario::{Aircraft, AircraftType, Day, Degrees, Operations, Scenario, Vertiport};
pub use seeds::{DaySeed, Purpose};
pub use sites::{EARTH_RADIUS_MI, great_circle_mi};
pub use stop::{Stop, Stopped};
pub use time::Time;
pub use warning::{Cause, Warning};
pub use world::World;
