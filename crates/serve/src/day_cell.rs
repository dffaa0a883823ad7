//! A day in memory that requests share: its state, its readers, and the number of its last stored
//! event.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Duration;

use axum::body::Bytes;
use tokio::sync::{broadcast, watch};

use crate::calendar::Calendar;
use crate::decide::Deciders;
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::store::StoredDay;
use crate::taken_event::TakenEvent;

/// Largest number of events that a reader may be behind before it must read from the store.
const KEPT_FOR_READERS: usize = 1_024;
/// Time limit for a request that waits until the events in memory are stored.
const STORE_TIMEOUT: Duration = Duration::from_secs(10);

/// A day in memory.
pub(crate) struct DayCell {
    /// The day's row in the store.
    pub(crate) stored: StoredDay,
    calendar: Option<Calendar>,
    state: Mutex<DispatchDay>,
    /// The number of the latest event that is stored.
    durable: watch::Sender<u64>,
    readers: broadcast::Sender<Arc<Published>>,
    /// Whether an event could not be stored, so that memory is ahead of the store and must be
    /// discarded.
    has_failed: AtomicBool,
    pub(crate) deciders: Deciders,
}

/// An event that is published to readers.
#[derive(Debug)]
pub(crate) struct Published {
    /// The event.
    pub(crate) event: TakenEvent,
    /// The message of the stream, formatted once for all readers.
    pub(crate) shown: OnceLock<Bytes>,
}

impl DayCell {
    /// A day with its state after all stored events.
    ///
    /// # Errors
    /// Returns [`Error::BadRequest`] if its date or its time zone is invalid.
    pub(crate) fn new(stored: StoredDay, state: DispatchDay) -> Result<Self, Error> {
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
    /// Returns [`Error::NoSuchEvent`] if it has not: the day may have been restored from a copy.
    pub(crate) fn check_begun(&self, after: u64) -> Result<(), Error> {
        let last = self.state().seq();
        if after <= last { Ok(()) } else { Err(Error::NoSuchEvent { asked: after, last }) }
    }

    /// Whether the day in memory is invalid: an event could not be stored, or a panic happened
    /// while the state was locked.
    pub(crate) fn is_spoilt(&self) -> bool {
        self.has_failed() || self.state.is_poisoned()
    }

    /// Whether an event could not be stored; later ones must then be refused.
    pub(crate) fn has_failed(&self) -> bool {
        self.has_failed.load(Ordering::Acquire)
    }

    /// Subscribes to the events that are stored from now on.
    pub(crate) fn subscribe(&self) -> broadcast::Receiver<Arc<Published>> {
        self.readers.subscribe()
    }

    /// Publishes stored events.
    pub(crate) fn publish(&self, events: Vec<TakenEvent>) {
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

    /// Makes all users read the day again: an event could not be stored, or the day has changed in
    /// the store.
    pub(crate) fn fail(&self) {
        self.has_failed.store(true, Ordering::Release);
        // Wake those who wait for an event.
        self.durable.send_modify(|_| ());
    }

    /// Waits until an event is stored, so that a crash cannot undo a state that was shown.
    ///
    /// # Errors
    /// Returns [`Error::Conflict`] if the day must be read again, and [`Error::Store`] if the event
    /// cannot be stored.
    pub(crate) async fn stored_up_to(&self, seq: u64) -> Result<(), Error> {
        let mut durable = self.durable.subscribe();
        let is_stored = durable.wait_for(|&stored| stored >= seq || self.has_failed());
        match tokio::time::timeout(STORE_TIMEOUT, is_stored).await {
            Ok(Ok(stored)) if *stored >= seq => Ok(()),
            Ok(Ok(_)) => Err(Error::Conflict),
            _ => Err(Error::Store { cause: "events are not stored in time".to_owned() }),
        }
    }

    /// Whether its stream has a reader.
    pub(crate) fn is_read(&self) -> bool {
        self.readers.receiver_count() > 0 && !self.has_failed()
    }

    /// The number of the latest event that is stored.
    pub(crate) fn stored_seq(&self) -> u64 {
        *self.durable.borrow()
    }
}
