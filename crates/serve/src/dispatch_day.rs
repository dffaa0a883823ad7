//! A day in memory: the fold of its scenario and its events.

use std::sync::Arc;

use vertifleet_core::Scenario;
use vertifleet_sim::live::{LiveDay, Notice};

use crate::error::Error;
use crate::event::Event;
use crate::ids::Ids;
use crate::moment::Moment;
use crate::store::Head;
use crate::taken_event::TakenEvent;

/// The state of a day after its events so far.
#[derive(Debug, Clone)]
pub(crate) struct DispatchDay {
    live: LiveDay,
    ids: Arc<Ids>,
    /// Number of events.
    seq: u64,
    /// The checksum over them.
    chain: u32,
    notices: Vec<(u64, String)>,
}

impl DispatchDay {
    /// A day before its first event.
    pub(crate) fn new(scenario: Arc<Scenario>) -> Self {
        let ids = Arc::new(Ids::of(&scenario));
        Self { live: LiveDay::new(scenario), ids, seq: 0, chain: 0, notices: Vec::new() }
    }

    /// The simulator's state of the day.
    pub(crate) fn live(&self) -> &LiveDay {
        &self.live
    }

    /// The simulator's state of the day, mutable for evaluation.
    pub(crate) fn live_mut(&mut self) -> &mut LiveDay {
        &mut self.live
    }

    /// The positions of its aircraft and vertiports.
    pub(crate) fn ids(&self) -> &Ids {
        &self.ids
    }

    /// The number of its events.
    pub(crate) fn seq(&self) -> u64 {
        self.seq
    }

    /// The checksum over its events.
    pub(crate) fn chain(&self) -> u32 {
        self.chain
    }

    /// Notices for people: those that came with events, with their numbers, and those about the
    /// current state.
    pub(crate) fn notices(&self) -> impl Iterator<Item = (Option<u64>, String)> + '_ {
        let told = self.notices.iter().map(|(seq, text)| (Some(*seq), text.clone()));
        told.chain(self.live.notices().map(|notice| (None, notice.to_string())))
    }

    /// Checks that the time of a client's event is plausible.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`] or [`Error::ReportError`].
    pub(crate) fn check_time(&self, event: &Event) -> Result<(), Error> {
        let time = event.time.map_or(self.live.now(), Moment::time);
        Ok(self.live.check_times(time, &event.what.report(&self.ids)?)?)
    }

    /// Applies an event, and returns it in the form in which it is stored.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`] or [`Error::ReportError`] if the event is invalid on this day.
    /// Nothing has changed then.
    pub(crate) fn take(
        &mut self,
        mut event: Event,
        actor: &str,
        at_ms: i64,
    ) -> Result<TakenEvent, Error> {
        let report = event.what.report(&self.ids)?;
        let time = event.time.get_or_insert_with(|| self.live.now().into()).time();
        let notices = self.live.take(time, &report)?;
        let texts: Vec<String> = notices.iter().map(Notice::to_string).collect();
        let json = |value: serde_json::Result<String>| value.expect("plain data can be written");
        let mut taken = TakenEvent {
            seq: self.seq + 1,
            chain: 0,
            at_ms,
            actor: actor.to_owned(),
            body: json(serde_json::to_string(&event)),
            notices: json(serde_json::to_string(&texts)),
        };
        taken.chain = taken.chain_after(self.chain);
        self.enter(taken.seq, taken.chain, texts);
        Ok(taken)
    }

    fn enter(&mut self, seq: u64, chain: u32, notices: Vec<String>) {
        (self.seq, self.chain) = (seq, chain);
        self.notices.extend(notices.into_iter().map(|text| (seq, text)));
    }

    /// Checks that all events exist that the day's row counts.
    ///
    /// # Errors
    /// Returns [`Error::BadData`] if one is missing.
    pub(crate) fn check_head(&self, head: Head) -> Result<(), Error> {
        if self.seq < head.seq {
            let (next, last) = (self.seq + 1, head.seq);
            let rule = format!("event {next} is missing; the last event is {last}");
            return Err(Error::BadData { rule });
        }
        // Events may have been added since the row was read.
        if self.seq == head.seq && self.chain != head.chain {
            let rule = "the checksum of its events differs from the day's".to_owned();
            return Err(Error::BadData { rule });
        }
        Ok(())
    }

    /// Applies a stored event.
    ///
    /// # Errors
    /// Returns [`Error::BadData`] if it is not the next one, is damaged, or is invalid.
    pub(crate) fn replay(&mut self, taken: &TakenEvent) -> Result<(), Error> {
        let bad = |rule: String| Error::BadData { rule: format!("event {}: {rule}", taken.seq) };
        if taken.seq != self.seq + 1 {
            return Err(bad(format!("it follows event {}", self.seq)));
        }
        if taken.chain != taken.chain_after(self.chain) {
            return Err(bad("its sum is wrong".to_owned()));
        }
        let event: Event =
            serde_json::from_str(&taken.body).map_err(|error| bad(error.to_string()))?;
        let report = event.what.report(&self.ids).map_err(|error| bad(error.to_string()))?;
        let time = event.time.ok_or_else(|| bad("it has no time".to_owned()))?.time();
        let notices = self.live.take(time, &report).map_err(|unfit| bad(unfit.to_string()))?;
        self.enter(taken.seq, taken.chain, notices.iter().map(Notice::to_string).collect());
        Ok(())
    }
}
