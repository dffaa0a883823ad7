//! The only writer of events. It commits all waiting events together, so that many clients share
//! the cost of one write to the disk, and answers each when its events are durable.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::mpsc;

use crate::clock::LastTime;
use crate::day_cell::DayCell;
use crate::error::Error;
use crate::metrics::Metrics;
use crate::store::{AppendId, NewEvent, Store, StoredAnswer};
use crate::taken_event::TakenEvent;

/// Largest number of requests that are committed together.
const MOST_TOGETHER: usize = 1_024;

/// How long a failure counts as recent.
const A_MOMENT: Duration = Duration::from_secs(5);

/// Called when the store has accepted or refused events. The events of a day arrive here in order.
pub(crate) type Done = Box<dyn FnOnce(Result<(), Error>, Vec<TakenEvent>) + Send + Sync>;

/// Events of a day that wait to be stored.
pub(crate) struct Append {
    pub(crate) id: AppendId,
    pub(crate) day: Arc<DayCell>,
    pub(crate) events: Vec<TakenEvent>,
    pub(crate) answer: Option<StoredAnswer>,
    pub(crate) done: Done,
}

impl Append {
    fn new_events(&self) -> impl Iterator<Item = NewEvent<'_>> {
        let (day, append) = (self.day.id(), self.id);
        self.events.iter().map(move |event| NewEvent { day, append, event })
    }
}

/// Stores events.
#[derive(Debug, Clone)]
pub(crate) struct Committer {
    queue: mpsc::UnboundedSender<Append>,
    /// When the store last refused events.
    failed: Arc<LastTime>,
}

impl Committer {
    /// Starts the writer. It ends when the last committer is dropped.
    pub(crate) fn start(store: Store, metrics: Arc<Metrics>) -> Self {
        let (queue, waiting) = mpsc::unbounded_channel();
        let failed = Arc::<LastTime>::default();
        tokio::spawn(write_all(store, metrics, failed.clone(), waiting));
        Self { queue, failed }
    }

    /// Whether the store has recently refused events.
    pub(crate) fn has_failed(&self) -> bool {
        self.failed.was_within(A_MOMENT)
    }

    /// Adds events to the queue. Events of a day must arrive in order, so the caller holds the
    /// day's lock.
    pub(crate) fn push(&self, append: Append) {
        if let Err(refused) = self.queue.send(append) {
            let stopped = Error::Store { cause: "the service is stopping".to_owned() };
            (refused.0.done)(Err(stopped), refused.0.events);
        }
    }
}

async fn write_all(
    store: Store,
    metrics: Arc<Metrics>,
    failed: Arc<LastTime>,
    mut waiting: mpsc::UnboundedReceiver<Append>,
) {
    let mut batch = Vec::new();
    while waiting.recv_many(&mut batch, MOST_TOGETHER).await > 0 {
        metrics.commits.inc();
        write(&store, &metrics, &failed, &mut batch).await;
    }
}

/// Stores a batch and answers every request in it. If the batch cannot be stored, each of its
/// requests is tried alone, so that one that conflicts does not fail the others. A database that
/// hangs is waited for only once.
async fn write(store: &Store, metrics: &Metrics, failed: &LastTime, batch: &mut Vec<Append>) {
    let mut together = match &batch[..] {
        [_] => None,
        _ => Some(store_together(store, batch).await),
    };
    for append in batch.drain(..) {
        let outcome = match &together {
            Some(Ok(())) => Ok(()),
            Some(Err(Error::StoreHangs { s })) => Err(Error::StoreHangs { s: *s }),
            // An earlier event of the day could not be stored. The day is read again before this
            // one is retried.
            _ if append.day.has_failed() => Err(Error::Conflict),
            _ => store_alone(store, &append).await,
        };
        if let Err(Error::StoreHangs { s }) = outcome {
            together = Some(Err(Error::StoreHangs { s }));
        }
        match &outcome {
            Ok(()) => {
                metrics.events.inc_by(append.events.len() as u64);
            }
            Err(error) => {
                let day = append.day.id();
                match error {
                    // Another service was quicker, or has archived or deleted the day; the client
                    // gets an error.
                    Error::Conflict | Error::Archived { .. } | Error::NotFound { .. } => {
                        tracing::debug!(day, %error, "events were not stored");
                    }
                    _ => tracing::error!(day, %error, "events could not be stored"),
                }
                if matches!(error, Error::Store { .. } | Error::StoreHangs { .. }) {
                    failed.is_now();
                }
            }
        }
        (append.done)(outcome, append.events);
    }
}

/// Stores the events of one request. If they are stored already, an earlier commit succeeded whose
/// answer was lost.
async fn store_alone(store: &Store, append: &Append) -> Result<(), Error> {
    let outcome = store_together(store, std::slice::from_ref(append)).await;
    match (&outcome, append.events.last()) {
        (Err(Error::Conflict), Some(last))
            if store.is_stored_by(append.id, append.day.id(), last.seq).await? =>
        {
            Ok(())
        }
        _ => outcome,
    }
}

async fn store_together(store: &Store, batch: &[Append]) -> Result<(), Error> {
    if batch.iter().any(|append| append.day.has_failed()) {
        return Err(Error::Store { cause: "a day has failed".to_owned() });
    }
    let events: Vec<NewEvent<'_>> = batch.iter().flat_map(Append::new_events).collect();
    let answers: Vec<&StoredAnswer> =
        batch.iter().filter_map(|append| append.answer.as_ref()).collect();
    store.append(&events, &answers).await
}
