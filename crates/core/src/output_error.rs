//! Refusals to write over a file that would be lost.

use crate::Code;
use crate::code::{Coded, Exit};

/// The reason why a command does not write to a file or folder. Nothing has been written then.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// V141. A file that a command is to write is one that it reads, perhaps by another name that links to it. Fix:
    /// name another file to write to. No flag allows it.
    #[error("{output}: cannot be written, because this command reads it (as {input})")]
    IsInput {
        /// The file that was to be written.
        output: String,
        /// The file that the command reads, as it was named.
        input: String,
    },

    /// V142. Two results of one command would go to the same file, so that one of them would be lost. Fix: name two
    /// files.
    #[error("{second}: cannot be written, because this command writes it already (as {first})")]
    Twice {
        /// The first name of the file.
        first: String,
        /// The second name.
        second: String,
    },

    /// V143. A file or folder of this name exists, and this program did not write it for the same purpose. Fix: name
    /// another one, or say with `--force` (in Python `force=True`) that it may be replaced.
    #[error("{origin}: is there already, and is no {kind} that this program wrote")]
    NotOurs {
        /// The file or folder.
        origin: String,
        /// The kind of file that would be written there.
        kind: &'static str,
    },

    /// V144. A file of this name exists and is read-only. Fix: name another one, or say with `--force` (in Python
    /// `force=True`) that it may be replaced.
    #[error("{origin}: is there already, and is read-only")]
    ReadOnly {
        /// The file.
        origin: String,
    },
}

impl Coded for OutputError {
    fn code(&self) -> Code {
        Code(match self {
            Self::IsInput { .. } => 141,
            Self::Twice { .. } => 142,
            Self::NotOurs { .. } => 143,
            Self::ReadOnly { .. } => 144,
        })
    }

    fn hint(&self) -> Option<&str> {
        Some(match self {
            Self::IsInput { .. } => "name another file to write to; nothing was changed",
            Self::Twice { .. } => "name two files",
            Self::NotOurs { .. } | Self::ReadOnly { .. } => {
                "name another one, or give --force (in Python force=True) to replace this one"
            }
        })
    }

    fn exit(&self) -> Exit {
        Exit::Input
    }
}
