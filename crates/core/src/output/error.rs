//! Refusals to write over a file that would be lost.

use crate::Code;
use crate::code::{Coded, Exit};

/// The reason why a command does not write to a file or folder. Nothing has been written then.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// V141 output that is an input. A command was asked to write to a file that it reads, or to
    /// replace a folder with a report while a file that it reads is in that folder. The two may
    /// have different names: on Unix files are identified by device and inode, so links are
    /// recognised.
    ///
    /// Fix: name another output file. `--force` does not help here, since the input would be lost.
    #[error("{output}: cannot be written, because this command reads it (as {input})")]
    IsInput {
        /// The file that was to be written.
        output: String,
        /// The file that the command reads, as it was named.
        input: String,
    },

    /// V142 two outputs in one file. Two results of a command would go to the same file, so one of
    /// them would be lost. An example is a trace in the file to which stdout is redirected.
    ///
    /// Fix: name two different files.
    #[error("{second}: cannot be written, because this command writes it already (as {first})")]
    Twice {
        /// The first name of the file.
        first: String,
        /// The second name.
        second: String,
    },

    /// V143 file of others in the way. A file is there already, and this program did not write it
    /// for the same purpose ([how it recognises its files](files.md#what-is-replaced)). Or the
    /// folder for a report holds something else.
    ///
    /// Fix: name another file or folder, or replace it with `--force` (in Python `force=True`). A
    /// folder is then kept next to the report, as `NAME.old`.
    #[error("{origin}: is there already, and is no {kind} that this program wrote")]
    NotOurs {
        /// The file or folder.
        origin: String,
        /// The kind of file that would be written there.
        kind: &'static str,
    },

    /// V144 read-only file in the way. A file is there already, and even its owner may not write to
    /// it. Or the report folder or a file in it is read-only.
    ///
    /// Fix: name another file, or replace it with `--force` (in Python `force=True`). A file stays
    /// read-only; the files of a report do not.
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
