//! Ctrl-C. Where what was done so far is worth having, the first one asks for a clean end and the second ends at once;
//! elsewhere the first one does. It never cuts off a file that is being written.

use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anstream::eprintln;

use crate::failure::Failure;

/// Exit code of a program that Ctrl-C ended, as shells give it: 128 and the number of the signal.
const INTERRUPTED: i32 = 130;

/// A flag that the first Ctrl-C raises. Of the functions of this file, one may be called, once.
pub(crate) fn stop_on_interrupt() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&stop);
    on_interrupt(move || {
        if raised.swap(true, Ordering::Relaxed) {
            end();
        }
        eprintln!("\nstopping; press Ctrl-C again to stop at once");
    })?;
    Ok(stop)
}

/// From now on the first Ctrl-C ends the program.
pub(crate) fn end_on_interrupt() -> Result<(), Failure> {
    on_interrupt(|| {
        eprintln!("\nstopped");
        end();
    })
}

fn on_interrupt(handler: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    ctrlc::set_handler(handler).map_err(|error| Failure::internal(&error))
}

fn end() -> ! {
    let _no_file_is_begun = vertifleet_core::between_files();
    exit(INTERRUPTED)
}
