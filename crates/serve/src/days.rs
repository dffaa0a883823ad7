//! The days that the service holds in memory, each with its lock, its readers and its policies.

mod archived;
mod reading;
mod shared;

use std::collections::HashMap;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use axum::body::Bytes;
use serde::Serialize;
use tokio::sync::{OnceCell, broadcast, oneshot, watch};
use vertifleet_core::Scenario;

pub(crate) use self::reading::replay;
use crate::calendar::Calendar;
use crate::clock::now_ms;
use crate::committer::{Append, Committer};
use crate::decide::Deciders;
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::event::Event;
use crate::keys::Busy;
use crate::mark::EventMark;
use crate::metrics::Metrics;
use crate::store::{AppendId, Store, StoredAnswer, StoredDay, StoredEvent};
use crate::turns::Turns;

/// Events that a slow reader may be behind before it has to read from the store.
const KEPT_FOR_READERS: usize = 1_024;
/// Beyond so many days, days that are not in use leave memory. A day of `paper` takes half a
/// megabyte.
const MOST_IN_MEMORY: usize = 1_000;
/// A write is tried so often when other services write to the same day.
const TRIES: u32 = 5;

/// A day in memory.
pub(crate) struct DayCell {
    stored: StoredDay,
    calendar: Option<Calendar>,
    state: Mutex<DispatchDay>,
    /// The number of the latest event that is stored.
    durable: watch::Sender<u64>,
    readers: broadcast::Sender<Arc<Published>>,
    /// Whether an event could not be stored, so that memory is ahead of the store and must be
    /// thrown away.
    pub(crate) has_failed: AtomicBool,
    pub(crate) deciders: Deciders,
}

impl fmt::Debug for DayCell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DayCell").field("stored", &self.stored).finish_non_exhaustive()
    }
}

/// An event that readers are told.
#[derive(Debug)]
pub(crate) struct Published {
    /// The event.
    pub(crate) event: StoredEvent,
    /// As a message of the stream, made once for all readers.
    pub(crate) shown: OnceLock<Bytes>,
}

/// What a write led to.
#[derive(Debug, Clone)]
pub(crate) struct Appended {
    /// The number of the last event.
    pub(crate) seq: u64,
    /// The events as they are stored.
    pub(crate) events: Vec<StoredEvent>,
}

/// Who writes, and what must hold for it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Writer {
    /// The name of the token, or empty.
    pub(crate) actor: String,
    /// The number of the event that the day must be at.
    pub(crate) if_match: Option<u64>,
    /// The request with its key, if it has one.
    pub(crate) idempotency: Option<Idempotency>,
    /// Holds the key until the events are stored, even if the client goes away before.
    pub(crate) busy: Option<Arc<Busy>>,
}

/// A request that is carried out once, however often it comes.
#[derive(Debug, Clone)]
pub(crate) struct Idempotency {
    /// The key.
    pub(crate) key: String,
    /// The request, shortened to a sum.
    pub(crate) request: String,
}

impl Writer {
    /// Checks that the day is where the writer expects it to be.
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

impl Idempotency {
    /// The answer, to be given again.
    pub(crate) fn answered_with(self, answer: &impl Serialize) -> StoredAnswer {
        let answer = serde_json::to_string(answer).expect("plain data can be written");
        StoredAnswer { key: self.key, request: self.request, answer }
    }
}

impl DayCell {
    fn new(stored: StoredDay, state: DispatchDay) -> Result<Self, Error> {
        let StoredDay { date, time_zone, .. } = &stored;
        let is_dated = !date.is_empty();
        let calendar = is_dated.then(|| Calendar::new(date, time_zone)).transpose()?;
        let durable = watch::Sender::new(state.seq());
        let readers = broadcast::Sender::new(KEPT_FOR_READERS);
        let deciders = Deciders::default();
        let has_failed = AtomicBool::new(false);
        let state = Mutex::new(state);
        Ok(Self { stored, calendar, state, durable, readers, has_failed, deciders })
    }

    /// The id of the day.
    pub(crate) fn id(&self) -> &str {
        &self.stored.id
    }

    /// The day as it is stored.
    pub(crate) fn stored(&self) -> &StoredDay {
        &self.stored
    }

    /// Its calendar, if it has a date.
    pub(crate) fn calendar(&self) -> Option<&Calendar> {
        self.calendar.as_ref()
    }

    /// The day after its events so far. Some of them may not be stored yet;
    /// [`stored_up_to`](Self::stored_up_to) waits for them.
    pub(crate) fn state(&self) -> MutexGuard<'_, DispatchDay> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Checks that the event after which a reader continues has happened.
    ///
    /// # Errors
    /// Returns [`Error::NoSuchEvent`] if it has not: the day may have been put back from a copy.
    pub(crate) fn check_begun(&self, after: u64) -> Result<(), Error> {
        let last = self.state().seq();
        if after <= last { Ok(()) } else { Err(Error::NoSuchEvent { asked: after, last }) }
    }

    /// Whether memory can no longer be trusted: an event could not be stored, or a panic happened
    /// over the state.
    pub(crate) fn is_spoilt(&self) -> bool {
        self.has_failed.load(Ordering::Acquire) || self.state.is_poisoned()
    }

    /// The events as they are stored from now on.
    pub(crate) fn subscribe(&self) -> broadcast::Receiver<Arc<Published>> {
        self.readers.subscribe()
    }

    /// Makes events public that are stored.
    pub(crate) fn publish(&self, events: Vec<StoredEvent>) {
        if let Some(last) = events.last() {
            let seq = last.seq;
            self.durable.send_if_modified(|stored| {
                let is_later = seq > *stored;
                *stored = seq.max(*stored);
                is_later
            });
        }
        for event in events {
            // There may be no reader.
            let _ = self.readers.send(Arc::new(Published { event, shown: OnceLock::new() }));
        }
    }

    /// Has the day read again by all who use it: an event could not be stored, or the day has
    /// changed in the store.
    pub(crate) fn fail(&self) {
        self.has_failed.store(true, Ordering::Release);
        // Those who wait for an event need not wait any longer.
        self.durable.send_modify(|_| ());
    }

    /// Waits until an event is stored, so that nothing is shown that a crash could take back.
    ///
    /// # Errors
    /// Returns [`Error::Conflict`] if the day has to be read again, and [`Error::Store`] if the
    /// event cannot be stored.
    pub(crate) async fn stored_up_to(&self, seq: u64) -> Result<(), Error> {
        let mut durable = self.durable.subscribe();
        let has_failed = || self.has_failed.load(Ordering::Acquire);
        let is_stored = durable.wait_for(|&stored| stored >= seq || has_failed());
        match tokio::time::timeout(std::time::Duration::from_secs(10), is_stored).await {
            Ok(Ok(stored)) if *stored >= seq => Ok(()),
            Ok(Ok(_)) => Err(Error::Conflict),
            _ => Err(Error::Store { cause: "events are not stored in time".to_owned() }),
        }
    }
}

/// All days.
#[derive(Debug)]
pub(crate) struct Days {
    store: Store,
    most_events: u64,
    metrics: Arc<Metrics>,
    committer: Committer,
    /// Turns for reading days from the store.
    turns: Turns,
    cells: Mutex<Cells>,
}

/// Days by their ids. One that is about to be read is empty.
type Cells = HashMap<String, Arc<OnceCell<Arc<DayCell>>>>;

impl Days {
    /// The days of a store, each with at most so many events. Each is read when it is first asked
    /// for.
    pub(crate) fn new(store: Store, most_events: u64, turns: Turns) -> Self {
        let metrics = Arc::new(Metrics::default());
        let committer = Committer::start(store.clone(), Arc::clone(&metrics));
        Self { store, most_events, metrics, committer, turns, cells: Mutex::default() }
    }

    /// Checks that the store takes what it is given.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if it does not, or has not a moment ago.
    pub(crate) async fn check(&self) -> Result<(), Error> {
        if self.committer.has_failed() {
            let cause = "it refused events a moment ago; the log says why".to_owned();
            return Err(Error::Store { cause });
        }
        self.store.check().await
    }

    /// What is measured.
    pub(crate) fn metrics(&self) -> &Metrics {
        &self.metrics
    }

    /// The store.
    pub(crate) fn store(&self) -> &Store {
        &self.store
    }

    fn cell(&self, id: &str) -> Arc<OnceCell<Arc<DayCell>>> {
        let mut cells = self.cells();
        if cells.len() >= MOST_IN_MEMORY && !cells.contains_key(id) {
            // Days that are not in use are read again when they are asked for.
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

    /// Checks that the event after which a reader continues has happened, in this very log if the
    /// mark says so.
    ///
    /// # Errors
    /// Returns [`Error::NoSuchEvent`] or [`Error::OtherLog`] if it has not: the day was put back
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
        answer: impl Fn(&Appended) -> T,
    ) -> Result<T, Error> {
        let mut day = Arc::clone(day);
        for _ in 0..TRIES {
            match self.append_once(&day, writer.clone(), events.clone(), &answer).await {
                // Another service was quicker. The day is read again, and the events are taken in
                // after those of the other, unless the writer expects the day to be where it was.
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
    /// Returns [`Error::KeyInUse`] if one has. Sent again, the request gets the answer that it got
    /// there.
    async fn check_key(&self, writer: &Writer) -> Result<(), Error> {
        let Some(Idempotency { key, .. }) = &writer.idempotency else { return Ok(()) };
        match self.store.answer(key).await? {
            Some(_) => Err(Error::KeyInUse { key: key.clone() }),
            None => Ok(()),
        }
    }

    async fn append_once<T: Serialize>(
        &self,
        day: &Arc<DayCell>,
        writer: Writer,
        events: Vec<Event>,
        answer: impl Fn(&Appended) -> T,
    ) -> Result<T, Error> {
        if day.stored.archived {
            return Err(Error::Archived { id: day.id().to_owned() });
        }
        let id = AppendId::draw()?;
        let (done, outcome) = oneshot::channel();
        let answer = {
            let mut state = day.state();
            writer.check(state.seq())?;
            if state.seq() + events.len() as u64 > self.most_events {
                return Err(Error::TooMuch { what: "events on a day", most: self.most_events });
            }
            let stored = take_all(&mut state, events, &writer.actor)?;
            let appended = Appended { seq: state.seq(), events: stored };
            let answer = answer(&appended);
            let Writer { idempotency, busy, .. } = writer;
            let kept = idempotency.map(|asked| asked.answered_with(&answer));
            let (day, events) = (Arc::clone(day), appended.events);
            self.committer.push(Append { id, day, events, answer: kept, _busy: busy, done });
            answer
        };
        let stopped = || Error::Store { cause: "the service is stopping".to_owned() };
        outcome.await.map_err(|_| stopped())??;
        Ok(answer)
    }
}

/// Takes events in, all or none.
fn take_all(
    state: &mut DispatchDay,
    events: Vec<Event>,
    actor: &str,
) -> Result<Vec<StoredEvent>, Error> {
    let at_ms = now_ms();
    let before = (events.len() > 1).then(|| state.clone());
    let of = events.len();
    let admit = |(at, event)| {
        let taken = state.admit(event, actor, at_ms);
        taken.map_err(|cause| match of {
            1 => cause,
            _ => Error::InList { number: at + 1, of, cause: Box::new(cause) },
        })
    };
    let taken = events.into_iter().enumerate().map(admit).collect();
    if let (Err(_), Some(before)) = (&taken, before) {
        *state = before;
    }
    taken
}
