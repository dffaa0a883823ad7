//! Expected errors of reading, checking, writing and drawing: causes in the user's files, and
//! remedies.
//!
//! Messages are lower-case fragments that name file, member, value and rule.
//! `docs/src/reference/errors.md` is written from the comments here, which give the cause first and
//! then the fix.

mod codes;
mod format;

use std::io;

use crate::OutputError;

pub use format::{FileKind, FormatError};

/// An error in a file, a network, a scenario or a seed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// V101 file cannot be read. The operating system does not let the file be read: it does not
    /// exist, is a folder, or belongs to another user.
    ///
    /// Fix: correct the path or the file's permissions.
    #[error("{origin}: cannot be read: {cause}")]
    CannotRead {
        /// The path.
        origin: String,
        /// The operating system's message.
        cause: io::Error,
    },

    /// V102 file cannot be written. The operating system does not let the file be written: the
    /// folder does not exist, is not yours, or is full. The former file is still there. A report
    /// replaces its whole folder. So this folder can be neither the one that the program runs in
    /// nor a mount point.
    ///
    /// Fix: create the folder, free some space, or choose a path that may be written.
    #[error("{origin}: cannot be written: {cause}")]
    CannotWrite {
        /// The path.
        origin: String,
        /// The operating system's message.
        cause: io::Error,
    },

    /// The contents of a file break a rule of its format.
    #[error("{origin}: {error}")]
    InFile {
        /// The file, or the other source of the text.
        origin: String,
        /// The rule that they break, and where.
        error: FormatError,
    },

    /// V118 seed out of range. A seed, or the number of a training or validation day, is outside
    /// [the range](../concepts/training.md#seeds) that keeps the days of different purposes apart.
    /// `--seed` of `scenario` and `compare` goes up to 2^40 - 1, counting all days asked for; that
    /// of `train` up to 2^24 - 1.
    ///
    /// Fix: choose a smaller seed.
    #[error("{member} must be a whole number below {limit}, found {found}")]
    SeedOutOfRange {
        /// The name of the number.
        member: String,
        /// The first number that is too large.
        limit: u64,
        /// The number.
        found: String,
    },

    /// V123 change of a member that is not there. A change of a network names a member by a path
    /// that does not exist, or that the format does not know.
    ///
    /// Fix: name members as in the network file, with dots between them. Name the entries of a list
    /// by their `id`, by their position from 0, or by `*` for all of them: `vertiports.V3.stands`,
    /// `fleet.0.count`.
    #[error("{path:?} leads nowhere: there is no {part:?}{expected}")]
    NoSuchMember {
        /// The path.
        path: String,
        /// The first part of the path that does not exist.
        part: String,
        /// A comma and the members that the format knows, or nothing.
        expected: String,
    },

    /// V119 unknown network. A name is neither a shipped network, nor `random:` with a number, nor
    /// a file.
    ///
    /// Fix: give one of the names that the message lists, `random:` and a number, as `random:7`, or
    /// the path of a network file.
    #[error(
        "there is no network {name:?}: shipped are {shipped}, random:NUMBER, random-training:NUMBER, random-validation:NUMBER and random-places:SIZE:NUMBER draw one, and no file has that path"
    )]
    UnknownNetwork {
        /// The name that was asked for.
        name: String,
        /// The names of the shipped networks.
        shipped: String,
        /// The question whether the user meant a similar shipped name, if there is one.
        meant: Option<String>,
    },

    /// A refusal to write over a file that would be lost (V141 to V144).
    #[error(transparent)]
    Output(#[from] OutputError),
}
