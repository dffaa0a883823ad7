//! The service over HTTP, as its users meet it.

mod api;
mod malformed;
mod operated_days;
#[cfg(unix)]
mod postgres;
mod running;
