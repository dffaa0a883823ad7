//! Stable numbers of expected errors, shared by all crates; docs/src/reference/errors.md has one entry for each.

use std::fmt;

/// The stable number of an expected error or warning, printed as `V104`.
///
/// V1xx are files, networks and scenarios (this crate), V2xx decisions, traces and checks, V3xx models and training,
/// V4xx studies and the command line, V5xx bounds and plans. A number is never used again for something else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(pub u16);

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "V{:03}", self.0)
    }
}

/// An expected error: something that the user can know the number of, and mostly put right.
pub trait Coded: std::error::Error {
    /// The stable number.
    fn code(&self) -> Code;

    /// What helps beside the message, where there is more to say.
    fn hint(&self) -> Option<&str>;

    /// How the program ends after it.
    fn exit(&self) -> Exit;
}

/// How the program ends after an expected error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// It failed although the input was right: a disk that is full, a training that diverges.
    Failed = 1,
    /// The input must change.
    Input = 2,
}
