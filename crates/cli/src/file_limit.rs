//! A limit on the length of files, which the operating system sets for a process (`ulimit -f`,
//! `LimitFSIZE=` of systemd).
//!
//! A write beyond it fails, and SIGXFSZ ends a program that does not expect it. Ours expects it:
//! what cannot be written is an error as on a full disk, after which a service goes on and nothing
//! is left half written.

use crate::failure::Failure;

/// Lets writes beyond the limit fail without ending the program. Only Unix has the signal.
pub(crate) fn survive() -> Result<(), Failure> {
    #[cfg(unix)]
    {
        // A handler that does nothing that anybody looks at: ignoring the signal would take unsafe
        // code.
        let not_read = std::sync::Arc::default();
        signal_hook::flag::register(signal_hook::consts::SIGXFSZ, not_read)
            .map_err(|error| Failure::internal(&error))?;
    }
    Ok(())
}
