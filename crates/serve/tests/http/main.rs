//! The service over HTTP, as its users meet it.

mod api;
mod days_of_ones_own;
mod malformed;
mod operated_days;
#[cfg(unix)]
mod postgres;
mod protected;
mod running;
