//! Tests of the service over HTTP.

mod advised_choices;
mod any_state;
mod api;
mod archived_days;
mod changed_minds;
mod collected_spans;
mod console;
mod corrections;
mod days_of_ones_own;
mod described_requests;
mod fair_turns;
mod logs;
mod malformed;
mod openapi;
mod operated_days;
mod outlooks;
#[cfg(unix)]
mod postgres;
mod protected;
mod running;
mod studies;
mod waiting_passengers;
