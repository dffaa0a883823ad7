//! The threads of a batch of days, which live as long as the batch.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use rayon::ThreadPool;

use crate::failure::Failure;
use crate::interruptible;
use crate::whole_number::WholeNumber;

/// A fixed number of threads, which are started at their first use.
pub(crate) struct Threads {
    number: usize,
    pool: Option<Pool>,
}

/// The threads, and the id of the process that they belong to. A process that is forked from it
/// does not have them.
struct Pool {
    threads: Option<ThreadPool>,
    process: u32,
    /// How many times work has been started.
    calls: Arc<AtomicU64>,
}

/// How long threads busy-wait for the next call. It is just longer than a policy of a few array
/// operations takes, because busy-waiting keeps the cores occupied.
const AWAKE: Duration = Duration::from_micros(100);

impl Threads {
    pub(crate) fn new(asked: Option<WholeNumber>) -> Result<Self, Failure> {
        Ok(Self { number: interruptible::threads(asked)?, pool: None })
    }

    /// The number of threads.
    pub(crate) fn number(&self) -> usize {
        self.number
    }

    /// Calls `work` once on each thread, including the calling thread. Its argument is the position
    /// of the thread, which is the same in every call.
    pub(crate) fn all(&mut self, work: impl Fn(usize) + Sync) {
        if self.number == 1 {
            return work(0);
        }
        let ours = |pool: &Pool| pool.process == std::process::id();
        if !self.pool.as_ref().is_some_and(ours) {
            let threads = Some(interruptible::pool(self.number - 1));
            self.pool = Some(Pool { threads, process: std::process::id(), calls: Arc::default() });
        }
        let pool = self.pool.as_ref().expect("it has just been made");
        let threads = pool.threads.as_ref().expect("they are there until the pool is dropped");
        let call = pool.calls.fetch_add(1, Ordering::Release) + 1;
        threads.in_place_scope(|scope| {
            scope.spawn_broadcast(|_, context| work(1 + context.index()));
            work(0);
        });
        let calls = Arc::clone(&pool.calls);
        threads.spawn_broadcast(move |_| stay_awake(&calls, call));
    }
}

/// Busy-waits for the next call for a while, because waking a thread takes as long as a step of a
/// hundred days.
fn stay_awake(calls: &AtomicU64, call: u64) {
    let since = Instant::now();
    while calls.load(Ordering::Acquire) == call && since.elapsed() < AWAKE {
        std::hint::spin_loop();
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        if self.process != std::process::id() {
            // The threads do not exist in a forked process, and dropping the pool there might wait
            // for them for ever.
            std::mem::forget(self.threads.take());
        }
    }
}
