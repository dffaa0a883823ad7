//! Long calls: Python's other threads go on meanwhile, and Ctrl-C is heard.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::prelude::{PyResult, Python};

/// How often Ctrl-C is looked for.
const GLANCE: Duration = Duration::from_millis(50);

/// Does `work` on `threads` threads of its own (all cores without) while the thread that called waits and listens to Ctrl-C, which
/// raises the flag that `work` is given. Work that does not look at the flag ends late, not never.
///
/// Threads are made for each call and end with it: a process that forks later, as Python's `multiprocessing` does on Linux, would
/// find threads kept for longer gone, and wait for them for ever.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    work: impl FnOnce(&AtomicBool) -> T + Send,
) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let (to, mut from) = channel();
        let raised = &stop;
        scope.spawn(move || {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
            // A machine that gives no more threads has this one.
            let outcome = match pool {
                Ok(pool) => pool.install(|| work(raised)),
                Err(_) => work(raised),
            };
            // Nobody listens any more after Ctrl-C.
            let _ = to.send(outcome);
        });
        loop {
            let (glance, receiver) = py.detach(move || (from.recv_timeout(GLANCE), from));
            from = receiver;
            match glance {
                Ok(outcome) => return Ok(outcome),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => panic!("the work ends with an outcome"),
            }
            if let Err(interrupt) = py.check_signals() {
                stop.store(true, Ordering::Relaxed);
                // The work ends soon, and meanwhile Python's other threads go on.
                py.detach(
                    move || while let Err(RecvTimeoutError::Timeout) = from.recv_timeout(GLANCE) {},
                );
                return Err(interrupt);
            }
        }
    })
}
