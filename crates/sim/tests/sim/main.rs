//! What the simulator and the checker of schedules promise.

mod authors_days;
mod check_day;
mod check_rules;
mod check_simulated;
mod check_trace;
mod clone_reuse;
mod foresight;
mod invariants;
mod known_closures;
mod live;
mod shown;
mod waiting;
