//! Asks long work to end early, with one handle and one answer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A handle to ask work to end, from any thread. All clones share one request, which cannot be
/// taken back.
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

/// The answer of work that was asked to end before it was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("stopped before the work was done")]
pub struct Stopped;

impl Stop {
    /// Asks the work to end soon. Returns whether it had been asked before.
    pub fn request(&self) -> bool {
        self.0.swap(true, Ordering::Relaxed)
    }

    /// Whether the work is asked to end.
    #[inline]
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Returns an error once the work is asked to end, for work that ends by `?`.
    ///
    /// # Errors
    /// [`Stopped`] once the work is asked to end.
    #[inline]
    pub fn check(&self) -> Result<(), Stopped> {
        if self.is_requested() { Err(Stopped) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Stop, Stopped};

    #[test]
    fn a_request_reaches_every_clone() {
        let stop = Stop::default();
        let heard = stop.clone();
        assert_eq!(heard.check(), Ok(()));
        assert!(!stop.request() && stop.request(), "only the second request finds an earlier one");
        assert_eq!((heard.check(), heard.is_requested()), (Err(Stopped), true));
    }
}
