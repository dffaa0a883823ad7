//! Long calls: Python's other threads go on meanwhile, and Ctrl-C is heard at once.

use std::ops::RangeInclusive;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::prelude::{PyResult, Python};
use rayon::{ThreadPool, ThreadPoolBuilder};
use vertifleet_core::Stop;

use crate::failure::Failure;
use crate::whole_number::WholeNumber;

/// How often Ctrl-C is looked for.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Threads that may be asked for.
const THREADS: RangeInclusive<usize> = 1..=1024;

/// So many threads, or as many as there are cores.
pub(crate) fn threads(asked: Option<WholeNumber>) -> Result<usize, Failure> {
    match asked.map(|asked| asked.of("threads")).transpose()? {
        None => Ok(std::thread::available_parallelism().map_or(1, usize::from)),
        Some(asked) if THREADS.contains(&asked) => Ok(asked),
        Some(asked) => {
            Err(Failure::argument(format!("threads must be from 1 to 1024, found {asked}")))
        }
    }
}

/// A pool of threads; on a machine that gives no more of them, of the thread that calls.
pub(crate) fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().unwrap_or_else(|_| {
        let of_this_thread = ThreadPoolBuilder::new().num_threads(1).use_current_thread();
        of_this_thread.build().expect("a pool that takes no thread can be made")
    })
}

/// Does `work` on so many threads of its own while the thread that called waits and listens to Ctrl-C, which raises the flag that
/// `work` is given. The call ends with the work, since a function of the caller's that it asks must not be asked once Python ends; a
/// second Ctrl-C does not wait.
///
/// Threads are made for each call and end with it: a process that forks later, as Python's `multiprocessing` may, would find
/// threads kept for longer gone, and wait for them for ever.
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
        // After a second Ctrl-C there is no listener.
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
