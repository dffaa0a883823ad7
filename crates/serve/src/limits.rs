//! Limits of the service, so that no client can block others.

use std::time::Duration;

/// The limits of a running service.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Connections at once. Further ones wait until one of them ends; fewer if the operating system
    /// permits fewer files.
    pub connections: usize,
    /// Connections of one address of another machine at once. Further ones are closed.
    pub connections_per_address: usize,
    /// Streams of events at once.
    pub streams: usize,
    /// Requests of one token per second, on average; twice as many in a burst.
    pub requests_per_s: u32,
    /// Largest number of days.
    pub days: u64,
    /// Events of a day.
    pub events: u64,
    /// Time for the head of a request, after which the connection is closed.
    pub head: Duration,
    /// A request is read and answered within this time.
    pub request: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            connections: 16_384,
            connections_per_address: 4_096,
            streams: 4_096,
            requests_per_s: 2_000,
            days: 100_000,
            events: 1_000_000,
            head: Duration::from_secs(30),
            request: Duration::from_secs(30),
        }
    }
}

/// Files that the service needs besides its connections: the store, the log, the standard streams.
const OTHER_FILES: u64 = 256;

impl Limits {
    /// Connections at once; the operating system may limit the files of this process to fewer.
    pub(crate) fn connections_here(self) -> usize {
        let files = rlimit::increase_nofile_limit(u64::MAX).unwrap_or(u64::MAX);
        let most = usize::try_from(files.saturating_sub(OTHER_FILES)).unwrap_or(usize::MAX);
        self.connections.min(most.max(1))
    }
}
