//! The world as data: networks, scenarios, and days drawn from a seed.
//!
//! A [`Scenario`] is one operating day with everything exogenous in it and nothing left to be
//! drawn. Days are drawn from a [`Network`]. Both are read in two stages: raw text, then checked
//! types that cannot hold invalid values. This crate builds on no other crate here, and has no
//! simulation clock, no policies and no motion. Its only randomness draws days and networks.
//!
//! `network_file` turns a network file into a [`Network`], and `change` makes a network from
//! another one. `scenario_file` reads and writes scenarios, and `check` has the rules that every
//! scenario obeys. `draw` draws days with `demand_model` and `disturbances`; `random_network` draws
//! networks. `output` writes files and folders.
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
mod charge_rate;
mod charging;
mod check;
mod code;
mod demand_model;
mod disturbances;
mod draw;
mod error;
mod fares;
mod feature_scales;
mod input;
mod ix;
mod limits;
mod matrix;
mod nearest;
mod network;
mod network_file;
mod output;
mod parse;
mod paths;
mod random;
mod random_network;
mod raw;
mod scenario;
mod scenario_file;
mod seeds;
mod stop;
mod time;
mod warning;
mod world;

pub use change::{DemandCell, Difference, split_path};
pub use charge_rate::{Battery, ChargeRate, Need, whole_mwh};
pub use charging::{ChargeCurve, Charging, CurvePoint};
pub use code::{Code, Coded, Exit};
pub use disturbances::{
    ClosedSpan, ClosedTimes, Closure, Disturbances, Outage, Route, TakeoffDelays,
};
pub use error::{Error, FileKind, FormatError};
pub use fares::Fares;
pub use feature_scales::FeatureScales;
pub use input::read_at_most;
pub use ix::{AircraftIx, TypeIx, VertiportIx};
pub use matrix::Matrix;
pub use nearest::nearest;
pub use network::Network;
pub use network_file::{EARTH_RADIUS_MI, great_circle_mi};
pub use output::{
    FolderKind, OutputError, OutputKind, Outputs, block_writes, check_folder, check_output,
    create_folder, replace_folder, write_atomically,
};
pub(crate) use random_network::drawn_for;
pub use random_network::{RANDOM_PLACES, random_city, random_network, random_places};
pub use scenario::{Aircraft, AircraftType, Day, Degrees, Operations, Scenario, Vertiport};
pub(crate) use seeds::purpose_of;
pub use seeds::{DaySeed, Purpose};
pub use stop::{Stop, Stopped};
pub use time::Time;
pub use warning::{Cause, Warning};
pub use world::World;
