//! Ctrl-C. Where what was done so far is worth having, the first one asks for a clean end and the second ends at once;
//! elsewhere the first one does. It never cuts off a file that is being written.
//!
//! On Unix a request to terminate and a terminal that goes away are heard in the same way. A signal that was ignored when the
//! program started stays ignored: that is how `nohup`, and a shell without job control that starts something in the background,
//! say that the program is to go on.

use std::process::exit;

use anstream::eprintln;
use vertifleet_core::Stop;

use crate::failure::Failure;

/// Exit code of a program that Ctrl-C ended, as shells give it: 128 and the number of the signal.
const INTERRUPTED: i32 = 130;

/// What the first Ctrl-C requests. Of the functions of this file, one may be called, once.
pub(crate) fn stop_on_interrupt() -> Result<Stop, Failure> {
    let stop = Stop::default();
    let raised = stop.clone();
    on_interrupt(move || {
        if raised.request() {
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

#[cfg(unix)]
fn on_interrupt(mut handler: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    let ignored = ignored();
    let heard =
        [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = Signals::new(heard).map_err(|error| Failure::internal(&error))?;
    std::thread::spawn(move || signals.forever().for_each(|_| handler()));
    Ok(())
}

/// A bit for each signal that is ignored, the first for signal 1, as Linux tells it. Elsewhere nothing is known of them and all are
/// heard.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let bits = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    bits.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(not(unix))]
fn on_interrupt(handler: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    ctrlc::set_handler(handler).map_err(|error| Failure::internal(&error))
}

fn end() -> ! {
    let _no_file_is_begun = vertifleet_core::block_writes();
    exit(INTERRUPTED)
}
