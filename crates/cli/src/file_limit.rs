//! A limit on the length of files, which the operating system sets for a process (`ulimit -f`,
//! `LimitFSIZE=` of systemd).
//!
//! A write beyond it fails, and SIGXFSZ ends a program that does not handle it. This program
//! handles it: a failed write is an error as on a full disk, after which the service continues and
//! no file is incomplete.

use crate::failure::Failure;

/// Lets writes beyond the limit fail without ending the program. Only Unix has the signal.
pub(crate) fn survive() -> Result<(), Failure> {
    #[cfg(unix)]
    {
        // The handler does nothing, and its flag is never read: ignoring the signal would need
        // unsafe code.
        let not_read = std::sync::Arc::default();
        signal_hook::flag::register(signal_hook::consts::SIGXFSZ, not_read)
            .map_err(|error| Failure::internal(&error))?;
    }
    Ok(())
}
