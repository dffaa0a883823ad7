//! The one writer of events. It takes all events that wait and commits them together, so that many clients share the
//! cost of one write to the disk, and answers each when its events are durable.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use tokio::sync::{mpsc, oneshot};

use crate::days::DayCell;
use crate::error::Error;
use crate::keys::Busy;
use crate::metrics::Metrics;
use crate::store::{Store, StoredAnswer, StoredEvent};

/// At most this many requests are committed together.
const MOST_TOGETHER: usize = 1_024;

/// Events of a day that wait to be stored.
pub(crate) struct Append {
    pub(crate) day: Arc<DayCell>,
    pub(crate) events: Vec<StoredEvent>,
    pub(crate) answer: Option<StoredAnswer>,
    pub(crate) _busy: Option<Arc<Busy>>,
    pub(crate) done: oneshot::Sender<Result<(), Error>>,
}

/// Takes events to be stored.
#[derive(Debug, Clone)]
pub(crate) struct Committer {
    queue: mpsc::UnboundedSender<Append>,
}

impl Committer {
    /// Starts the writer. It ends when the last committer is dropped.
    pub(crate) fn start(store: Store, metrics: Arc<Metrics>) -> Self {
        let (queue, waiting) = mpsc::unbounded_channel();
        tokio::spawn(write_all(store, metrics, waiting));
        Self { queue }
    }

    /// Puts events into the queue. Events of a day must come in their order, so the caller holds the day's lock.
    pub(crate) fn push(&self, append: Append) {
        if let Err(refused) = self.queue.send(append) {
            let stopped = Error::Store { cause: "the service is stopping".to_owned() };
            let _ = refused.0.done.send(Err(stopped));
        }
    }
}

async fn write_all(
    store: Store,
    metrics: Arc<Metrics>,
    mut waiting: mpsc::UnboundedReceiver<Append>,
) {
    let mut batch = Vec::new();
    while waiting.recv_many(&mut batch, MOST_TOGETHER).await > 0 {
        metrics.commits.inc();
        write(&store, &metrics, &mut batch).await;
    }
}

/// Stores a batch and answers everybody in it. If the batch cannot be stored, each of its requests is tried alone, so
/// that one that conflicts does not fail the others.
async fn write(store: &Store, metrics: &Metrics, batch: &mut Vec<Append>) {
    let one_by_one = batch.len() == 1 || store_together(store, batch).await.is_err();
    for append in batch.drain(..) {
        let outcome = if !one_by_one {
            Ok(())
        } else if append.day.has_failed.load(Ordering::Acquire) {
            // An earlier event of the day could not be stored. The day is read again before this one is tried again.
            Err(Error::Conflict)
        } else {
            store_together(store, std::slice::from_ref(&append)).await
        };
        match &outcome {
            Ok(()) => {
                metrics.events.inc_by(append.events.len() as u64);
                append.day.publish(append.events);
            }
            Err(error) => {
                tracing::error!(day = append.day.id(), %error, "events could not be stored");
                append.day.has_failed.store(true, Ordering::Release);
            }
        }
        // Whoever asked may have gone.
        let _ = append.done.send(outcome);
    }
}

async fn store_together(store: &Store, batch: &[Append]) -> Result<(), Error> {
    if batch.iter().any(|append| append.day.has_failed.load(Ordering::Acquire)) {
        return Err(Error::Store { cause: "a day has failed".to_owned() });
    }
    let events: Vec<(&str, &StoredEvent)> = batch
        .iter()
        .flat_map(|append| append.events.iter().map(|event| (append.day.id(), event)))
        .collect();
    let answers: Vec<&StoredAnswer> =
        batch.iter().filter_map(|append| append.answer.as_ref()).collect();
    store.append(&events, &answers).await
}
