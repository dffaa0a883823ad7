//! Stable numbers of expected errors, shared by all crates; docs/src/reference/errors.md has one
//! entry for each.

use std::fmt;

/// The stable number of an expected error or warning, printed as `V104`.
///
/// V1xx numbers belong to files, networks and scenarios (this crate), V2xx to decisions, traces and
/// checks, V3xx to models and training, V4xx to studies and the command line, V5xx to bounds and
/// plans, V6xx to the dispatch service, V7xx to imports and exports. A number is never reused for
/// something else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(pub u16);

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "V{:03}", self.0)
    }
}

/// An expected error: one that has a stable number and that the user can usually correct.
pub trait Coded: std::error::Error {
    /// The stable number.
    fn code(&self) -> Code;

    /// Advice beyond the message, where there is any.
    fn hint(&self) -> Option<&str>;

    /// How the program exits after the error.
    fn exit(&self) -> Exit;
}

/// How the program exits after an expected error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// The program failed although its input was right: a disk is full, or a training diverges.
    Failed = 1,
    /// The input has to be changed.
    Input = 2,
}
