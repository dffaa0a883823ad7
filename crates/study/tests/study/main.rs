//! What evaluations promise.

mod evaluations;
