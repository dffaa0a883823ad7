//! Reads days from the store: their current state, and the state after an earlier event.

use std::sync::Arc;

use vertifleet_core::Scenario;

use super::Days;
use crate::access::Actor;
use crate::day_cell::DayCell;
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::store::Store;

impl Days {
    /// Reads a day from the store.
    pub(super) async fn read(&self, id: &str) -> Result<Arc<DayCell>, Error> {
        let (store, id) = (self.store.clone(), id.to_owned());
        // The first caller reads the day for all, so it is attributed to no token.
        self.turns.run(&Actor::default(), async move { read(&store, &id).await }).await
    }

    /// A day as it was after an event.
    ///
    /// # Errors
    /// Returns [`Error::NoSuchEvent`] if the day has no such event, and the errors of
    /// [`get`](Self::get).
    pub(crate) async fn at(
        &self,
        actor: &Actor,
        day: &DayCell,
        seq: u64,
    ) -> Result<DispatchDay, Error> {
        day.check_begun(seq)?;
        let scenario = Arc::clone(day.state().live().scenario());
        self.replayed(actor, day, scenario, seq).await
    }

    /// A day after its events up to a number, with another beginning.
    ///
    /// # Errors
    /// Returns [`Error::BadData`] if an event is not possible then.
    pub(crate) async fn replayed(
        &self,
        actor: &Actor,
        day: &DayCell,
        scenario: Arc<Scenario>,
        seq: u64,
    ) -> Result<DispatchDay, Error> {
        let (store, id) = (self.store.clone(), day.id().to_owned());
        let replay = async move {
            let mut state = DispatchDay::new(scenario);
            replay(&store, &id, &mut state, seq).await?;
            if state.seq() < seq {
                return Err(Error::NoSuchEvent { asked: seq, last: state.seq() });
            }
            Ok(state)
        };
        self.turns.run(actor, replay).await
    }
}

/// Reads a day from the store.
async fn read(store: &Store, id: &str) -> Result<Arc<DayCell>, Error> {
    let found = store.day(id).await?;
    let (stored, scenario) = found.ok_or_else(|| Error::not_found("day", id))?;
    let head = store.head(id).await?.ok_or_else(|| Error::not_found("day", id))?;
    let scenario = Scenario::from_json(scenario.as_bytes(), id)?;
    let mut state = DispatchDay::new(Arc::new(scenario));
    let replayed = replay(store, id, &mut state, u64::MAX).await;
    if let Err(damaged) = replayed.and_then(|()| state.check_head(head)) {
        // A day that was deleted in the meantime is not damaged.
        store.head(id).await?.ok_or_else(|| Error::not_found("day", id))?;
        return Err(damaged.of_day(id));
    }
    Ok(Arc::new(DayCell::new(stored, state)?))
}

/// Replays the events of a day after those of a state, up to a number or to the last stored one.
///
/// # Errors
/// Returns the errors of [`DispatchDay::replay`]; the events before the invalid one have been
/// replayed then.
pub(crate) async fn replay(
    store: &Store,
    day: &str,
    state: &mut DispatchDay,
    until: u64,
) -> Result<(), Error> {
    let read = |after: u64| {
        let (store, day) = (store.clone(), day.to_owned());
        tokio::spawn(async move { store.events_to_replay(&day, after, until).await })
    };
    let mut reading = (state.seq() < until).then(|| read(state.seq()));
    while let Some(page) = reading {
        let died = |error| Error::Internal { cause: format!("{error}") };
        let page = page.await.map_err(died)??;
        // The next page is read while this one is replayed.
        let last = page.last().map(|event| event.seq);
        reading = last.filter(|last| *last < until).map(read);
        for event in &page {
            state.replay(event)?;
        }
    }
    Ok(())
}
