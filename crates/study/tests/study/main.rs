//! What evaluations and the accounts of days promise.

mod evaluations;
mod hours;
