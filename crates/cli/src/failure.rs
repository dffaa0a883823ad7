//! How the program fails: a coded message and a hint on stderr, and an exit code.
//!
//! Exit code 2 is for what the user typed or wrote; 1 is for what went wrong although that was right: a disk that is
//! full, a training that diverges.

use std::fmt;
use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::Code;

/// Codes of failures that no other input would have avoided.
const NOT_THE_INPUT: [u16; 4] = [102, 309, 401, 405];

/// An outcome that is none.
#[derive(Debug)]
pub(crate) struct Failure {
    code: Option<Code>,
    message: String,
    hint: Option<String>,
}

impl Failure {
    /// Something that the user can put right.
    pub(crate) fn expected(code: Code, message: String, hint: Option<&str>) -> Self {
        Self { code: Some(code), message, hint: hint.map(str::to_owned) }
    }

    /// V450: arguments that do not go together. Cause and fix are in the message and its hint.
    pub(crate) fn usage(message: String, hint: &str) -> Self {
        Self::expected(Code(450), message, Some(hint))
    }

    /// Something that the user cannot put right.
    pub(crate) fn internal(cause: &dyn fmt::Display) -> Self {
        Self { code: None, message: cause.to_string(), hint: None }
    }

    /// Tells the user; gives the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let (bold, red, reset) = ("\u{1b}[1m", "\u{1b}[1;31m", "\u{1b}[0m");
        match self.code {
            Some(code) => eprintln!("{red}error[{code}]{reset}: {}", self.message),
            None => eprintln!("{red}error{reset}: {}", self.message),
        }
        if let Some(hint) = &self.hint {
            eprintln!("{bold}hint{reset}: {hint}");
        }
        let input = self.code.is_some_and(|code| !NOT_THE_INPUT.contains(&code.0));
        ExitCode::from(if input { 2 } else { 1 })
    }
}

macro_rules! from_coded {
    ($($error:ty),*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::expected(error.code(), error.to_string(), error.hint())
            }
        })*
    };
}

from_coded!(
    vertifleet_core::Error,
    vertifleet_sim::TraceError,
    vertifleet_optimize::Error,
    vertifleet_learn::Error,
    vertifleet_study::Error
);
