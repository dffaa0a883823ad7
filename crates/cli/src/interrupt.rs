//! Ctrl-C. In a command whose partial results are worth keeping, the first Ctrl-C requests a clean
//! end and the second ends the program at once; in other commands the first one does. No file is
//! left incomplete.
//!
//! On Unix, SIGTERM and SIGHUP are handled in the same way. A signal that was ignored when the
//! program started stays ignored: `nohup`, and a shell without job control that starts a program in
//! the background, rely on this.

use std::process::exit;

use anstream::eprintln;
use vertifleet_core::Stop;

use crate::failure::Failure;

/// The exit code of a program that Ctrl-C ended, as shells define it: 128 plus the number of the
/// signal.
const INTERRUPTED: i32 = 130;

/// The stop request of the first Ctrl-C. Only one of the public functions of this file may be
/// called, and only once.
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

/// Makes the first Ctrl-C end the program from now on.
pub(crate) fn end_on_interrupt() -> Result<(), Failure> {
    end_saying("stopped")
}

/// The same for a study whose finished parts are always on disk.
pub(crate) fn end_study_on_interrupt() -> Result<(), Failure> {
    end_saying("stopped; finished parts are kept, and the same command continues")
}

fn end_saying(text: &'static str) -> Result<(), Failure> {
    on_interrupt(move || {
        eprintln!("\n{text}");
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

/// The signals that are ignored, one bit each, the lowest bit for signal 1, as Linux reports them.
/// Other systems do not report them, and all signals are handled.
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
