//! A day in memory: the fold of its scenario and its events.

use std::collections::HashSet;
use std::sync::Arc;

use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::Scenario;
use vertifleet_sim::live::{LiveDay, Phase, ReportError};

use crate::error::Error;
use crate::event::{Event, EventKind};
use crate::ids::Ids;
use crate::latest_events::{Happened, LatestEvents, in_words};
use crate::moment::Moment;
use crate::notice::{self, EventNotice};
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
    latest: LatestEvents,
    acknowledged: Vec<Acknowledgement>,
}

/// An alert that people have seen.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub(crate) struct Acknowledgement {
    /// The alert.
    pub(crate) alert: String,
    /// The number of the event.
    pub(crate) seq: u64,
    /// The name of the sender's token; empty without tokens.
    pub(crate) actor: String,
    /// The time of the event.
    pub(crate) time: Moment,
    /// The comment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) reason: Option<String>,
}

/// Largest number of corrections of a day: each computes the day again.
const MOST_CORRECTIONS: u64 = 1_000;

/// Largest number of acknowledgements in a state.
const MOST_ACKNOWLEDGEMENTS: usize = 1_000;

impl DispatchDay {
    /// A day before its first event.
    pub(crate) fn new(scenario: Arc<Scenario>) -> Self {
        let ids = Arc::new(Ids::of(&scenario));
        Self {
            live: LiveDay::new(scenario),
            ids,
            seq: 0,
            chain: 0,
            latest: LatestEvents::default(),
            acknowledged: Vec::new(),
        }
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
    pub(crate) fn notices(&self) -> impl Iterator<Item = (Option<u64>, EventNotice)> + '_ {
        let told = self.live.past_notices().map(|(seq, notice)| (Some(seq), notice.into()));
        told.chain(self.live.notices().map(|notice| (None, (&notice).into())))
    }

    /// The alerts that people have seen, each by its latest acknowledgement; the oldest first.
    pub(crate) fn acknowledged(&self) -> Vec<Acknowledgement> {
        let mut seen = HashSet::new();
        let newest = self.acknowledged.iter().rev();
        let latest = newest.filter(|one| seen.insert(&one.alert)).take(MOST_ACKNOWLEDGEMENTS);
        let mut latest: Vec<_> = latest.cloned().collect();
        latest.reverse();
        latest
    }

    /// The latest events about its aircraft.
    pub(crate) fn latest(&self) -> &LatestEvents {
        &self.latest
    }

    /// Checks that the time of a client's event is plausible, and that the day does not have too
    /// many corrections.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`], [`Error::ReportError`] or [`Error::TooMuch`].
    pub(crate) fn check(&self, event: &Event) -> Result<(), Error> {
        if matches!(event.what, EventKind::Corrected { .. })
            && self.live.corrections() as u64 >= MOST_CORRECTIONS
        {
            return Err(Error::TooMuch { what: "corrections of a day", most: MOST_CORRECTIONS });
        }
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
        let time = event.time.map_or(self.live.now(), Moment::time);
        let notices = self.live.take(time, &report).map_err(refused)?;
        // A correction may take the clock back. Then it happens at the clock of the corrected day.
        let time = *event.time.get_or_insert_with(|| time.min(self.live.now()).into());
        let json = |value: serde_json::Result<String>| value.expect("plain data can be written");
        let mut taken = TakenEvent {
            seq: self.seq + 1,
            chain: 0,
            at_ms,
            actor: actor.to_owned(),
            body: json(serde_json::to_string(&event)),
            notices: notice::to_json(&notices),
        };
        taken.chain = taken.chain_after(self.chain);
        self.enter(&taken, event, time);
        Ok(taken)
    }

    /// Enters an event that the simulator has taken.
    fn enter(&mut self, taken: &TakenEvent, event: Event, time: Moment) {
        let TakenEvent { seq, chain, at_ms, actor, .. } = taken;
        (self.seq, self.chain) = (*seq, *chain);
        match &event.what {
            EventKind::Acknowledged { alert, reason } => self.acknowledged.push(Acknowledgement {
                alert: alert.clone(),
                seq: *seq,
                actor: actor.clone(),
                time,
                reason: reason.clone(),
            }),
            EventKind::Corrected { event, .. } => {
                self.acknowledged.retain(|one| one.seq != *event);
            }
            _ => {}
        }
        let Some(aircraft) = self.aircraft_of(&event.what) else { return };
        let ix = self.ids.aircraft(&aircraft).expect("the event was taken");
        let holds = self.live.aircraft_now(ix).phase == Phase::Standing;
        let text = in_words(&event.what, &aircraft, holds, actor);
        let happened = Happened { seq: *seq, actor: actor.clone(), at_ms: *at_ms, text, event };
        self.latest.note(&aircraft, holds, happened);
    }

    /// The aircraft that an event is about; of a correction, that of the corrected event.
    fn aircraft_of(&self, what: &EventKind) -> Option<String> {
        let EventKind::Corrected { event, .. } = what else {
            return what.aircraft().map(str::to_owned);
        };
        let position = usize::try_from(*event).ok()?.checked_sub(1)?;
        let aircraft = self.live.reports().nth(position)?.aircraft()?;
        Some(self.live.scenario().aircraft[aircraft.at()].id.clone())
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
        let time = event.time.ok_or_else(|| bad("it has no time".to_owned()))?;
        self.live.take(time.time(), &report).map_err(|unfit| bad(unfit.to_string()))?;
        self.enter(taken, event, time);
        Ok(())
    }
}

/// The refusal of an event by the simulator.
fn refused(error: ReportError) -> Error {
    match error {
        ReportError::CannotCorrect { .. } | ReportError::NeededLater { .. } => {
            Error::CannotCorrect(error)
        }
        other => other.into(),
    }
}
