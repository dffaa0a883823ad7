//! Pictures of days, schedules and fleets, and the kit that every figure of the project is drawn with.
//!
//! This crate builds on `vertifleet-sim`. [`Moment`] says where the fleet is at one time of a trace; [`frame`] paints it
//! as a frame of a video, and [`text`] for a terminal. [`day`] and [`schedule`] are the pictures of a day and of a whole
//! trace. The kit writes SVG ([`canvas`], [`axis`], [`palette`]), and [`png`] and [`rgb`] turn SVG into pixels with the
//! embedded font, the same on every machine.

pub mod axis;
pub mod canvas;
mod day;
mod demand;
mod frame;
mod map;
mod moment;
pub mod numbers;
pub mod palette;
mod panel;
mod raster;
mod schedule;
mod text;

pub use day::day;
pub use frame::{FRAME, frame};
pub use moment::{Moment, Whereabouts};
pub use raster::{png, rgb};
pub use schedule::schedule;
pub use text::text;
