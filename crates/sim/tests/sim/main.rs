//! The guarantees of the simulator and of the checker of schedules.

mod authors_days;
mod check_as_needed;
mod check_charging;
mod check_day;
mod check_rules;
mod check_simulated;
mod check_trace;
mod clone_reuse;
mod foresight;
mod invariants;
mod known_closures;
mod live;
mod live_closures;
mod live_notices;
mod shown;
mod waiting;
