//! Stable numbers of expected errors, shared by all crates; docs/src/reference/errors.md has one entry for each.

use std::fmt;

/// The stable number of an expected error or warning, printed as `V104`.
///
/// V1xx are files, networks and scenarios (this crate), V2xx decisions, traces and checks, V3xx models and training,
/// V4xx studies and the command line. A number is never used again for something else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(pub u16);

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "V{:03}", self.0)
    }
}
