//! Results on stdout.

use std::io::{self, Write};

use crate::failure::Failure;

/// Prints a result and a line break. A reader that has seen enough, like `head`, is no failure; a full disk is.
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
