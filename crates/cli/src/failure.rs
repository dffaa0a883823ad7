//! How the program fails: it prints a coded message and a hint on stderr, and returns an exit code.
//!
//! Exit code 2 means that the arguments or the input files are wrong; 1 means that something else
//! failed, such as a write to a full disk or a training that diverged.

use std::fmt;
use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{Code, Coded, Exit};

/// Why a command failed.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The code of the error; `None` for an unexpected failure.
    code: Option<Code>,
    exit: Exit,
    message: String,
    hint: Option<String>,
}

impl Failure {
    /// V450 arguments that do not go together. The arguments contradict each other; the message and
    /// the hint explain how. For example, `train --set` names a setting that `gcaps-x` does not
    /// have.
    ///
    /// Fix: follow the hint.
    pub(crate) fn usage(message: String, hint: &str) -> Self {
        let hint = Some(hint.to_owned());
        Self { code: Some(Code(450)), exit: Exit::Input, message, hint }
    }

    /// A failure that the user cannot fix.
    pub(crate) fn internal(cause: &dyn fmt::Display) -> Self {
        Self { code: None, exit: Exit::Failed, message: cause.to_string(), hint: None }
    }

    /// Prints the message and the hint, and returns the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let (bold, red, reset) = ("\u{1b}[1m", "\u{1b}[1;31m", "\u{1b}[0m");
        match self.code {
            Some(code) => eprintln!("{red}error[{code}]{reset}: {}", self.message),
            None => eprintln!("{red}error{reset}: {}", self.message),
        }
        if let Some(hint) = &self.hint {
            eprintln!("{bold}hint{reset}: {hint}");
        }
        ExitCode::from(self.exit as u8)
    }
}

impl<E: Coded> From<E> for Failure {
    fn from(error: E) -> Self {
        Self {
            code: Some(error.code()),
            exit: error.exit(),
            message: error.to_string(),
            hint: error.hint().map(str::to_owned),
        }
    }
}
