//! The guarantees of the exports of a day: every flight of the trace, in a form that the readers of
//! each format accept.

mod calendars;
mod days;
mod feed;
mod map;
mod refusals;
mod tables;
