//! The latest event about each aircraft: the loser of a race learns what happened, and by whom.

use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_sim::Refusal;
use vertifleet_sim::live::ReportError;

use crate::error::Error;
use crate::event::{Event, EventKind};

/// The event that made a request impossible.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Happened {
    /// Its number.
    pub(crate) seq: u64,
    /// The name of the sender's token; empty without tokens.
    pub(crate) actor: String,
    /// When the service stored it, milliseconds of the Unix clock.
    pub(crate) at_ms: i64,
    /// The event in words.
    pub(crate) text: String,
    /// The event.
    pub(crate) event: Event,
}

impl fmt::Display for Happened {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (event {})", self.text, self.seq)
    }
}

/// The latest events of a day.
#[derive(Debug, Clone, Default)]
pub(crate) struct LatestEvents {
    by_aircraft: HashMap<String, Arc<Happened>>,
    /// The latest decision for a flight to each vertiport.
    sent_to: HashMap<String, Arc<Happened>>,
}

impl LatestEvents {
    /// Remembers an event about an aircraft. `holds` if it is a decision to hold.
    pub(crate) fn note(&mut self, aircraft: &str, holds: bool, happened: Happened) {
        let happened = Arc::new(happened);
        if let EventKind::Decided { to, .. } = &happened.event.what
            && !holds
        {
            self.sent_to.insert(to.clone(), Arc::clone(&happened));
        }
        self.by_aircraft.insert(aircraft.to_owned(), happened);
    }

    /// Adds the event that made an event impossible, if there is one.
    pub(crate) fn explain(&self, error: Error, what: &EventKind) -> Error {
        let aircraft = what.aircraft().unwrap_or_default();
        let full = match what {
            EventKind::Decided { to, .. } => self.sent_to.get(to),
            _ => None,
        };
        self.explained(error, aircraft, full)
    }

    /// Adds the event that made a decision of an aircraft impossible, if there is one.
    pub(crate) fn explain_decision(&self, error: Error, aircraft: &str) -> Error {
        self.explained(error, aircraft, None)
    }

    fn explained(&self, error: Error, aircraft: &str, full: Option<&Arc<Happened>>) -> Error {
        let of_aircraft = self.by_aircraft.get(aircraft);
        let happened = match &error {
            Error::Moved { expected, .. } => of_aircraft.filter(|latest| latest.seq > *expected),
            Error::ReportError(ReportError::Refused(Refusal::NoStandFree { .. })) => full,
            Error::ReportError(
                ReportError::OnItsWay { .. }
                | ReportError::NotReady { .. }
                | ReportError::OutOfService { .. }
                | ReportError::WrongPlace { .. }
                | ReportError::NothingToUndo { .. }
                | ReportError::InService { .. },
            ) => of_aircraft,
            _ => None,
        };
        let Some(happened) = happened else { return error };
        let happened = Box::new(Happened::clone(happened));
        Error::Overtaken { cause: Box::new(error), happened }
    }
}

/// An event about an aircraft in words.
pub(crate) fn in_words(what: &EventKind, aircraft: &str, holds: bool, actor: &str) -> String {
    let text = match what {
        EventKind::Decided { to, .. } if holds => format!("{aircraft} was told to hold at {to}"),
        EventKind::Decided { to, .. } => format!("{aircraft} was sent to {to}"),
        EventKind::Undone { .. } => format!("the decision of {aircraft} was cancelled"),
        EventKind::Departed { .. } => format!("{aircraft} was reported departed"),
        EventKind::Landed { .. } => format!("{aircraft} was reported landed"),
        EventKind::Charging { .. } => format!("{aircraft} was reported charging"),
        EventKind::Ready { .. } => format!("{aircraft} was reported ready"),
        EventKind::Delayed { .. } => format!("{aircraft} was reported delayed"),
        EventKind::OutOfService { .. } => format!("{aircraft} was reported out of service"),
        EventKind::BackInService { .. } => format!("{aircraft} was reported back in service"),
        EventKind::Corrected { event, .. } => format!("event {event} of {aircraft} was corrected"),
        _ => format!("an event of {aircraft} was reported"),
    };
    if actor.is_empty() { text } else { format!("{text} by {actor}") }
}
