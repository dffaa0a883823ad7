//! Pictures of days, schedules and fleets, and the kit that every figure of the project is drawn
//! with.
//!
//! This crate builds on `vertifleet-sim`. [`Moment`] represents where the fleet is at one time of a
//! trace; [`frame`] paints it as a frame of a video, and [`text`] for a terminal. [`day`] is the
//! picture of a day, [`network`] that of a network, and [`PlayedPicture`] has those of a day that
//! was played, most of which [`schedule`] puts on one sheet. [`activities`] lists what aircraft do
//! and when. The kit writes SVG ([`canvas`],
//! [`axis`], [`palette`]), and [`png`] and [`rgb`] turn SVG into pixels with the embedded font, the
//! same on every machine.

mod activities;
pub mod axis;
pub mod canvas;
mod day;
mod demand;
mod fleet;
mod flows;
mod frame;
mod ledger;
mod map;
mod matrices;
mod moment;
mod names;
mod network;
pub mod numbers;
mod occupancy;
pub mod palette;
mod panel;
mod raster;
mod schedule;
mod stands;
mod text;

pub use activities::{Activity, Span, activities};
pub use day::day;
pub use frame::{FRAME, frame};
pub use ledger::ledger_lines;
pub use moment::{Moment, Whereabouts};
pub use network::network;
pub use occupancy::Occupancy;
pub use raster::{png, rgb};
pub use schedule::{PlayedPicture, schedule};
pub use text::text;
