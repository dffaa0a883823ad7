//! `vertifleet._native`: the Python package's interface to the crates. It only converts and
//! forwards; every rule is in the crates.
//!
//! Calls that may take long release the GIL for Python's other threads, and check for Ctrl-C
//! (`interruptible.rs`). Arrays are filled in place. The docstrings come from the comments here,
//! and the types from `vertifleet/_native.pyi`.
//! and the types from `vertifleet/_native.pyi`.

#![expect(
    clippy::needless_pass_by_value,
    reason = "arguments from Python are converted, and so are ours to keep"
)]

mod batch;
mod board;
mod buffers;
mod comparison;
mod day;
mod days;
mod environment;
mod evaluation;
mod failure;
mod frames;
mod interruptible;
mod layout;
mod model;
mod network;
mod observation;
mod optimize;
mod own_policy;
mod pickle;
mod picture;
mod played;
mod policy;
mod policy_source;
mod recording;
mod scenario;
mod sweep;
mod threads;
mod trace;
mod training;
mod view;
mod whole_number;

use pyo3::prelude::pymodule;

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::batch::Batch;
    #[pymodule_export]
    use crate::board::{Board, board};
    #[pymodule_export]
    use crate::comparison::{Comparison, check_comparison, compare, read_days};
    #[pymodule_export]
    use crate::days::Days;
    #[pymodule_export]
    use crate::environment::Environment;
    #[pymodule_export]
    use crate::evaluation::{Evaluation, evaluate, find_suite, suite_names, verify};
    #[pymodule_export]
    use crate::layout::Layout;
    #[pymodule_export]
    use crate::model::{Model, settings};
    #[pymodule_export]
    use crate::network::Network;
    #[pymodule_export]
    use crate::optimize::{Bound, Plan, bound, plan};
    #[pymodule_export]
    use crate::picture::Picture;
    #[pymodule_export]
    use crate::played::{Played, simulate};
    #[pymodule_export]
    use crate::policy::{Policy, find_policy};
    #[pymodule_export]
    use crate::recording::record;
    #[pymodule_export]
    use crate::scenario::Scenario;
    #[pymodule_export]
    use crate::sweep::Sweep;
    #[pymodule_export]
    use crate::trace::{Trace, check};
    #[pymodule_export]
    use crate::training::{Training, train};
    #[pymodule_export]
    use crate::view::View;
}
