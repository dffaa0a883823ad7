//! The dispatch service: live days, their events, and decisions with their reasons, over HTTP.
//!
//! A day is a scenario and a log of events; its state is the fold of the log by the simulator's
//! rules ([`vertifleet_sim::live`]) and nothing else. An event is durable before it is
//! acknowledged: a day applies it in memory, one writer commits many at a time, and only then do
//! the client and the readers receive it.

mod access;
mod api;
mod calendar;
mod clock;
mod committer;
mod connections;
mod console;
mod day_cell;
mod days;
mod decide;
mod dispatch_day;
mod error;
mod event;
#[cfg(any(test, feature = "fuzz"))]
mod fuzz;
mod ids;
mod keep;
mod keys;
mod latest_events;
mod limits;
mod mark;
mod metrics;
mod moment;
mod names;
mod network_folder;
mod networks;
mod notice;
mod operate;
mod optional;
#[cfg(test)]
mod orders;
mod outlook;
mod policies;
mod problem;
mod renewals;
mod server;
mod service;
mod spans;
mod store;
mod studies;
mod taken_event;
mod tokens;
mod turns;

pub use api::openapi;
pub use error::Error;
#[cfg(any(test, feature = "fuzz"))]
pub use fuzz::AnyRequest;
pub use keep::{Contents, DayCheck, Keeper, Tokens, restore};
pub use limits::Limits;
pub use operate::{Operation, OperationReport, operate};
pub use server::{Protection, Settings, serve};
pub use store::{AuditRecord, Location};
pub use tokens::{Role, StoredToken};
