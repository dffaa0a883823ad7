//! Long calls, during which Python's other threads can run and Ctrl-C takes effect at once.

use std::ops::RangeInclusive;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::prelude::{PyResult, Python};
use rayon::{ThreadPool, ThreadPoolBuilder};
use vertifleet_core::Stop;

use crate::failure::Failure;
use crate::whole_number::WholeNumber;

/// The time between two checks for Ctrl-C.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// The permitted numbers of threads.
const THREADS: RangeInclusive<usize> = 1..=1024;

/// The requested number of threads, or the number of cores if no number is requested.
pub(crate) fn threads(asked: Option<WholeNumber>) -> Result<usize, Failure> {
    match asked.map(|asked| asked.of("threads")).transpose()? {
        None => Ok(std::thread::available_parallelism().map_or(1, usize::from)),
        Some(asked) if THREADS.contains(&asked) => Ok(asked),
        Some(asked) => {
            Err(Failure::argument(format!("threads must be from 1 to 1024, found {asked}")))
        }
    }
}

/// A pool of threads. If the machine refuses to start more threads, the pool consists of the
/// calling thread alone.
pub(crate) fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().unwrap_or_else(|_| {
        let of_this_thread = ThreadPoolBuilder::new().num_threads(1).use_current_thread();
        of_this_thread.build().expect("a pool that takes no thread can be made")
    })
}

/// Does `work` on `threads` new threads, while the calling thread waits for Ctrl-C. Ctrl-C raises
/// the flag that `work` gets. The call still returns only when the work has ended, because the work
/// may call a Python function of the caller, which must not happen after Python has shut down. A
/// second Ctrl-C returns without waiting.
///
/// The threads are started for each call and end with it. Threads that outlive a call would not
/// exist in a process that is forked later, for example by Python's `multiprocessing`, which would
/// then wait for them for ever.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    work: impl FnOnce(&Stop) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Stop::default();
    let (to, mut from) = channel();
    let raised = stop.clone();
    std::thread::spawn(move || {
        let outcome = pool(threads).install(|| work(&raised));
        // After a second Ctrl-C nothing receives the outcome any more.
        let _ = to.send(outcome);
    });
    let mut interrupt = None;
    loop {
        let (answer, receiver) = py.detach(move || (from.recv_timeout(POLL_INTERVAL), from));
        from = receiver;
        match answer {
            Ok(outcome) => return interrupt.map_or(Ok(outcome), Err),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => panic!("the work ends with an outcome"),
        }
        if let Err(signal) = py.check_signals() {
            if interrupt.is_some() {
                return Err(signal);
            }
            stop.request();
            interrupt = Some(signal);
        }
    }
}
