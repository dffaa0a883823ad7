//! The common state of all requests: the days, the keys of requests in progress, and the settings.

use std::sync::Arc;

use tokio::sync::watch;

use crate::access::Access;
use crate::days::Days;
use crate::error::Error;
use crate::keys::Keys;
use crate::limits::Limits;
use crate::policies::Policies;
use crate::renewals::Renewals;
use crate::spans::Spans;
use crate::store::Store;
use crate::studies::Studies;
use crate::turns::Turns;

/// Largest number of large bodies that are read at once.
const UPLOADS: usize = 4;

/// The running service.
pub(crate) struct Service {
    /// Its days.
    pub(crate) days: Days,
    /// The policies that decide.
    pub(crate) policies: Policies,
    /// Checks the rights of requests.
    pub(crate) access: Access,
    /// Whether the service is about to stop, so that streams end.
    pub(crate) stopping: watch::Sender<bool>,
    /// Its limits.
    pub(crate) limits: Limits,
    /// Turns for large bodies, which take memory while they are read.
    pub(crate) uploads: Turns,
    /// Makes the spans of requests, if a collector wants them.
    pub(crate) spans: Option<Arc<Spans>>,
    /// The keys of requests.
    pub(crate) keys: Arc<Keys>,
    /// The studies, which run in the background.
    pub(crate) studies: Studies,
    /// Turns for computations.
    pub(crate) turns: AllTurns,
    /// Recomputes prices in the background.
    pub(crate) renewals: Arc<Renewals>,
}

/// Turns for computations. Each kind has one turn for each core, and one more that neither a single
/// token nor the readers together can take from others.
#[derive(Debug)]
pub(crate) struct AllTurns {
    /// For outlooks and what-ifs, which take long.
    pub(crate) outlooks: Turns,
    /// For long lists, states of earlier events, and uploads.
    pub(crate) readings: Turns,
    /// For decisions.
    pub(crate) decisions: Turns,
    /// For the first decision of a policy on a day, which searches for prices, so that later ones
    /// do not wait for it.
    pub(crate) first_decisions: Turns,
    /// For the policy that replaces late ones, so that it never waits for them.
    pub(crate) quick_decisions: Turns,
}

impl Service {
    /// A service of the days in a store.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if the store cannot be read.
    pub(crate) async fn new(store: Store, limits: Limits) -> Result<Self, Error> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let turns = || Turns::new(cores + 1);
        let turns = AllTurns {
            outlooks: turns(),
            readings: turns(),
            decisions: turns(),
            first_decisions: turns(),
            quick_decisions: turns(),
        };
        let days = Days::new(store, limits.events, turns.readings.clone());
        let stopping = watch::Sender::new(false);
        let access = Access::new(days.store.clone(), limits.requests_per_s);
        let policies = Policies::new(days.store.clone());
        let used = days.store.keys().await?;
        let keys = Keys::new(used.as_deref());
        let uploads = Turns::new(UPLOADS);
        let studies = Studies::default();
        let renewals = Arc::new(Renewals::start());
        Ok(Self {
            days,
            policies,
            access,
            stopping,
            limits,
            uploads,
            spans: None,
            keys,
            studies,
            turns,
            renewals,
        })
    }
}
