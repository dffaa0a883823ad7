//! The days that the service holds in memory, each with its lock, its readers and its policies.

mod archived;
mod reading;
mod shared;

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use tokio::sync::{OnceCell, oneshot};
use vertifleet_core::Scenario;

pub(crate) use self::reading::replay;
use crate::access::Actor;
use crate::clock::now_ms;
use crate::committer::{Append, Committer};
use crate::day_cell::DayCell;
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::event::Event;
use crate::keys::{Busy, Idempotency};
use crate::mark::EventMark;
use crate::metrics::Metrics;
use crate::store::{AppendId, Store, StoredAnswer, StoredDay};
use crate::taken_event::TakenEvent;
use crate::turns::Turns;

/// Largest number of days in memory; beyond it, unused ones are dropped. A day of `paper` takes
/// half a megabyte.
const MOST_IN_MEMORY: usize = 1_000;
/// Largest number of tries of a write while other services write to the same day.
const TRIES: u32 = 5;

/// The sender of a write, and its conditions.
#[derive(Debug, Clone, Default)]
pub(crate) struct Writer {
    /// The sender.
    pub(crate) actor: Actor,
    /// The number of the event that the day must be at.
    pub(crate) if_match: Option<u64>,
    /// The request with its key, if it has one.
    pub(crate) idempotency: Option<Idempotency>,
    /// Reserves the key until the events are stored, even if the client disconnects before.
    pub(crate) busy: Option<Arc<Busy>>,
}

impl Writer {
    /// Checks that the day is at the event that the writer expects.
    ///
    /// # Errors
    /// Returns [`Error::Moved`] if it is not.
    pub(crate) fn check(&self, found: u64) -> Result<(), Error> {
        match self.if_match {
            Some(expected) if expected != found => Err(Error::Moved { expected, found }),
            _ => Ok(()),
        }
    }
}

/// All days.
pub(crate) struct Days {
    /// The store.
    pub(crate) store: Store,
    most_events: u64,
    /// The metrics.
    pub(crate) metrics: Arc<Metrics>,
    committer: Committer,
    /// Turns for reading days from the store.
    turns: Turns,
    cells: Mutex<Cells>,
}

/// Days by their ids; empty while a day is being read.
type Cells = HashMap<String, Arc<OnceCell<Arc<DayCell>>>>;

impl Days {
    /// The days of a store, each with at most `most_events` events. A day is read at its first use.
    pub(crate) fn new(store: Store, most_events: u64, turns: Turns) -> Self {
        let metrics = Arc::new(Metrics::default());
        let committer = Committer::start(store.clone(), Arc::clone(&metrics));
        Self { store, most_events, metrics, committer, turns, cells: Mutex::default() }
    }

    /// Checks that the store accepts writes.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if it does not, or recently did not.
    pub(crate) async fn check(&self) -> Result<(), Error> {
        if self.committer.has_failed() {
            let cause = "it refused events a moment ago; the log has the cause".to_owned();
            return Err(Error::Store { cause });
        }
        self.store.check().await
    }

    fn cell(&self, id: &str) -> Arc<OnceCell<Arc<DayCell>>> {
        let mut cells = self.cells();
        if cells.len() >= MOST_IN_MEMORY && !cells.contains_key(id) {
            // Unused days are read again at their next use.
            cells.retain(|_, cell| {
                Arc::strong_count(cell) > 1
                    || cell.get().is_some_and(|day| Arc::strong_count(day) > 1)
            });
        }
        let cell = cells.entry(id.to_owned()).or_default();
        if cell.get().is_some_and(|day| day.is_spoilt()) {
            *cell = Arc::default();
        }
        let cell = Arc::clone(cell);
        self.metrics.days.set(i64::try_from(cells.len()).unwrap_or(i64::MAX));
        cell
    }

    fn cells(&self) -> MutexGuard<'_, Cells> {
        self.cells.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A day; it is read from the store if it is not in memory.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such day, [`Error::BadData`] if it is damaged,
    /// and [`Error::Store`].
    pub(crate) async fn get(&self, id: &str) -> Result<Arc<DayCell>, Error> {
        let day = self.in_memory(id).await?;
        if !self.store.is_shared() || self.catch_up(&day).await? {
            return Ok(day);
        }
        self.drop_from_memory(&day);
        self.in_memory(id).await
    }

    async fn in_memory(&self, id: &str) -> Result<Arc<DayCell>, Error> {
        let cell = self.cell(id);
        let day = cell.get_or_try_init(|| self.read(id)).await;
        if day.is_err() {
            // Only if no other request is reading it.
            let mut cells = self.cells();
            if cells
                .get(id)
                .is_some_and(|kept| Arc::ptr_eq(kept, &cell) && Arc::strong_count(kept) == 2)
            {
                cells.remove(id);
            }
            self.metrics.days.set(i64::try_from(cells.len()).unwrap_or(i64::MAX));
        }
        day.cloned()
    }

    /// Checks that the event after which a reader continues has happened, and, if the mark has a
    /// checksum, in this log.
    ///
    /// # Errors
    /// Returns [`Error::NoSuchEvent`] or [`Error::OtherLog`] if it has not: the day was restored
    /// from a copy.
    pub(crate) async fn check_mark(&self, day: &DayCell, mark: EventMark) -> Result<(), Error> {
        let EventMark { seq, chain: Some(chain) } = mark else { return day.check_begun(mark.seq) };
        let latest = {
            let state = day.state();
            (state.seq(), state.chain())
        };
        let found = if latest.0 == seq {
            Some(latest.1)
        } else {
            self.store.chain_at(day.id(), seq).await?
        };
        if seq == 0 || found == Some(chain) {
            Ok(())
        } else {
            Err(Error::OtherLog { mark: mark.to_string() })
        }
    }

    /// Makes a day.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if it cannot be stored.
    pub(crate) async fn add(
        &self,
        stored: StoredDay,
        scenario: Scenario,
        answer: Option<&StoredAnswer>,
    ) -> Result<Arc<DayCell>, Error> {
        self.store.add_day(&stored, &scenario.to_json(), answer).await?;
        let cell = self.cell(&stored.id);
        let state = DispatchDay::new(Arc::new(scenario));
        let new = Arc::new(DayCell::new(stored, state)?);
        let day = cell.get_or_init(|| async { new }).await;
        Ok(Arc::clone(day))
    }

    /// Adds events to a day, all or none, and returns once they are stored. `answer` makes the
    /// answer to the writer, which is stored with the events if the request has a key.
    ///
    /// # Errors
    /// Returns [`Error::Moved`] if the day is at another event than the writer expects,
    /// [`Error::Archived`], the errors of [`DispatchDay::take`], and [`Error::Store`].
    pub(crate) async fn append<T: Serialize>(
        &self,
        day: &Arc<DayCell>,
        writer: Writer,
        events: Vec<Event>,
        answer: impl Fn(&[TakenEvent]) -> T,
    ) -> Result<T, Error> {
        let mut day = Arc::clone(day);
        for _ in 0..TRIES {
            match self.append_once(&day, writer.clone(), events.clone(), &answer).await {
                // Another service was quicker. The day is read again, and the events are applied
                // after those of the other service, unless the writer requires the earlier state.
                Err(Error::Conflict) => {
                    self.check_key(&writer).await?;
                    day = self.get(day.id()).await?;
                }
                outcome => return outcome,
            }
        }
        Err(Error::Conflict)
    }

    /// Checks that no other service has carried the request out.
    ///
    /// # Errors
    /// Returns [`Error::KeyInUse`] if one has. If the client repeats the request, it gets the
    /// stored answer.
    async fn check_key(&self, writer: &Writer) -> Result<(), Error> {
        let Some(Idempotency { key, .. }) = &writer.idempotency else { return Ok(()) };
        match self.store.answer(key).await? {
            Some(_) => Err(Error::KeyInUse { key: key.clone() }),
            None => Ok(()),
        }
    }

    /// Applies events to a day, appends them to its log, and publishes them: the complete path of
    /// an event.
    async fn append_once<T: Serialize>(
        &self,
        day: &Arc<DayCell>,
        writer: Writer,
        events: Vec<Event>,
        answer: impl Fn(&[TakenEvent]) -> T,
    ) -> Result<T, Error> {
        if day.stored.archived {
            return Err(Error::Archived { id: day.id().to_owned() });
        }
        let id = AppendId::draw()?;
        let (done, outcome) = oneshot::channel();
        let answer = {
            // Held until they are in the queue, so that a day's events are stored in order.
            let mut state = day.state();
            writer.check(state.seq()).map_err(|moved| match &events[..] {
                [Event { what, .. }] => state.latest().explain(moved, what),
                _ => moved,
            })?;
            if state.seq() + events.len() as u64 > self.most_events {
                return Err(Error::TooMuch { what: "events on a day", most: self.most_events });
            }
            // Applied in memory, so that the next events can be checked at once.
            let events = take_all(&mut state, events, &writer.actor.name)?;
            let answer = answer(&events);
            let Writer { idempotency, busy, .. } = writer;
            let kept = idempotency.map(|asked| asked.answered_with(&answer));
            // Published once they are stored, even if the client has disconnected. Readers do not
            // receive them before, because a crash could undo them.
            let cell = Arc::clone(day);
            let publish = move |outcome: Result<(), Error>, events| {
                match outcome {
                    Ok(()) => cell.publish(events),
                    Err(_) => cell.fail(),
                }
                drop(busy);
                let _ = done.send(outcome);
            };
            let (day, done) = (Arc::clone(day), Box::new(publish));
            let append = Append { id, day, events, answer: kept, done };
            self.committer.push(append);
            answer
        };
        let stopped = || Error::Store { cause: "the service is stopping".to_owned() };
        outcome.await.map_err(|_| stopped())??;
        Ok(answer)
    }
}

/// The number of the last of some events; there is at least one.
pub(crate) fn last_seq(events: &[TakenEvent]) -> u64 {
    events.last().map_or(0, |event| event.seq)
}

/// Applies events, all or none.
fn take_all(
    state: &mut DispatchDay,
    events: Vec<Event>,
    actor: &str,
) -> Result<Vec<TakenEvent>, Error> {
    let at_ms = now_ms();
    let before = (events.len() > 1).then(|| state.clone());
    let of = events.len();
    let take = |(at, event): (usize, Event)| {
        let what = event.what.clone();
        let taken = state.check(&event).and_then(|()| state.take(event, actor, at_ms));
        let taken = taken.map_err(|refused| state.latest().explain(refused, &what));
        taken.map_err(|cause| match of {
            1 => cause,
            _ => Error::InList { number: at + 1, of, cause: Box::new(cause) },
        })
    };
    let taken = events.into_iter().enumerate().map(take).collect();
    if let (Err(_), Some(before)) = (&taken, before) {
        *state = before;
    }
    taken
}
