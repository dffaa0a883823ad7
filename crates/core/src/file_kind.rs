//! The kinds of files that commands read, for an error that says so when a file of one kind is
//! given for the other.

use std::fmt;

/// A kind of file that a command may expect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// One day, as JSON.
    Scenario,
    /// A network, as TOML.
    Network,
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scenario => "a scenario (JSON)",
            Self::Network => "a network (TOML)",
        })
    }
}
