//! The service over HTTP, as its users meet it.

mod api;
mod malformed;
mod operated_days;
mod postgres;
mod running;
