//! Results on stdout, warnings on stderr.

use std::fmt;
use std::io::{self, Write};

use anstream::eprintln;
use vertifleet_core::Code;

use crate::failure::Failure;

/// Prints a result and a line break. A reader such as `head` that closes the pipe early is not a
/// failure; a full disk is.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    let written = writeln!(stdout, "{}", text.trim_end_matches('\n')).and_then(|()| stdout.flush());
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::internal(&format!("cannot write to stdout: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a warning about something that is allowed but probably not intended.
pub(crate) fn warn(code: Code, warning: &dyn fmt::Display) {
    let (yellow, reset) = ("\u{1b}[1;33m", "\u{1b}[0m");
    eprintln!("{yellow}warning[{code}]{reset}: {warning}");
}
