//! iCalendar: one calendar a vertiport, with the departures and arrivals of the day as events.
//!
//! A departure lasts from the decision, when boarding begins, to the end of the take-off time; an
//! arrival lasts from the beginning of landing to the time at which the aircraft has arrived. Times
//! are UTC. Nothing in a calendar depends on when it is written: `DTSTAMP` is the start of
//! operations, and `UID` is made of date, aircraft, time and day.

use icalendar::{Component, Event, EventStatus, Property};
use vertifleet_core::{Time, Vertiport, VertiportIx};

use crate::flown::Taken;
use crate::safe_ids::{safe, safe_ids};
use crate::{Calendar, Flown};

/// The calendar of one vertiport.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VertiportCalendar {
    /// The id of the vertiport.
    pub vertiport: String,
    /// A name for the file, which no other vertiport of the day has on any file system:
    /// `vertiport-V1.ics`.
    pub file: String,
    /// The text of the file.
    pub text: String,
}

/// The calendars of all vertiports, in file order. A vertiport without flights has a calendar
/// without events.
pub fn icalendar(flown: &Flown<'_>, calendar: &Calendar) -> Vec<VertiportCalendar> {
    let vertiports = &flown.day().vertiports;
    let names = safe_ids(vertiports.iter().map(|vertiport| vertiport.id.as_str()));
    let aircraft = safe_ids(flown.day().aircraft.iter().map(|aircraft| aircraft.id.as_str()));
    let writer = Writer { flown, calendar, aircraft };
    let mut events = writer.events();
    VertiportIx::all(vertiports.len())
        .zip(names)
        .map(|(at, name)| {
            let vertiport = &vertiports[at.at()];
            VertiportCalendar {
                vertiport: vertiport.id.clone(),
                // The word before the id keeps clear of the names that Windows has for devices,
                // such as CON.
                file: format!("vertiport-{name}.ics"),
                text: writer.text(vertiport, std::mem::take(&mut events[at.at()])),
            }
        })
        .collect()
}

/// Whether a flight leaves the vertiport of a calendar or reaches it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Departure,
    Arrival,
}

struct Writer<'a> {
    flown: &'a Flown<'a>,
    calendar: &'a Calendar,
    /// The id of each aircraft in `UID`s.
    aircraft: Vec<String>,
}

impl Writer<'_> {
    /// The events of each vertiport, in the order of the trace.
    fn events(&self) -> Vec<Vec<Event>> {
        let mut events = vec![Vec::new(); self.flown.day().vertiports.len()];
        for flight in self.flown.flights() {
            events[flight.row.from.at()].push(self.event(&flight, End::Departure));
            events[flight.row.to.at()].push(self.event(&flight, End::Arrival));
        }
        events
    }

    fn text(&self, vertiport: &Vertiport, events: Vec<Event>) -> String {
        let mut calendar = icalendar::Calendar::new();
        let name = format!("{}, {}", vertiport.id, self.flown.day().name);
        calendar.properties = Property::from_array([
            ("VERSION", "2.0"),
            ("PRODID", "-//Vertifleet//Flights//EN"),
            ("CALSCALE", "GREGORIAN"),
            ("METHOD", "PUBLISH"),
            ("X-WR-CALNAME", &name),
            ("X-WR-TIMEZONE", self.calendar.zone_name()),
        ]);
        calendar.extend(events);
        folded(&calendar.to_string())
    }

    fn event(&self, flight: &Taken<'_>, end: End) -> Event {
        let (begins, ends) = self.span(flight, end);
        let (word, here) = match end {
            End::Departure => ("departure", flight.from),
            End::Arrival => ("arrival", flight.to),
        };
        let mut event = Event::new();
        event
            .uid(&self.uid(flight, word))
            .summary(&summary(flight, end))
            .description(&description(flight))
            .status(EventStatus::Confirmed)
            .add_property("DTSTAMP", self.utc(self.flown.day().operations.start))
            .add_property("DTSTART", self.utc(begins))
            .add_property("CATEGORIES", word.to_ascii_uppercase())
            .add_property("LOCATION", &here.id)
            // Aircraft come and go all day, and no one is busy for it.
            .add_property("TRANSP", "TRANSPARENT");
        if ends > begins {
            // RFC 5545 wants an end to be later than the start, or no end.
            event.add_property("DTEND", self.utc(ends));
        }
        if let Some(degrees) = here.degrees {
            event.add_property("GEO", format!("{};{}", degrees.latitude, degrees.longitude));
        }
        event
    }

    /// When an event begins and ends: within the flight, and no longer than take-off or landing
    /// takes.
    fn span(&self, flight: &Taken<'_>, end: End) -> (Time, Time) {
        let operations = &self.flown.day().operations;
        let (departure, arrival) = (flight.row.takeoff, flight.row.arrival);
        let flight_s = arrival.since(departure);
        match end {
            End::Departure => (departure, departure + operations.takeoff_s.min(flight_s)),
            End::Arrival => (departure + flight_s.saturating_sub(operations.landing_s), arrival),
        }
    }

    fn uid(&self, flight: &Taken<'_>, word: &str) -> String {
        let date = self.calendar.date().strftime("%Y%m%d");
        let aircraft = &self.aircraft[flight.row.aircraft.at()];
        let time = flight.row.time.to_string().replace(':', "");
        format!("{date}-{aircraft}-{time}-{word}@{}.vertifleet", safe(&self.flown.day().name))
    }

    fn utc(&self, time: Time) -> String {
        self.calendar.instant(time).strftime("%Y%m%dT%H%M%SZ").to_string()
    }
}

/// The text with its long lines folded again. The `icalendar` crate folds them too, but its last
/// part of a line may have 76 bytes, one more than RFC 5545 grants.
fn folded(text: &str) -> String {
    const MOST: usize = 75;
    let mut folded = String::with_capacity(text.len());
    for line in text.replace("\r\n ", "").split_terminator("\r\n") {
        let mut length = 0;
        for letter in line.chars() {
            if length + letter.len_utf8() > MOST {
                folded.push_str("\r\n ");
                length = 1;
            }
            folded.push(letter);
            length += letter.len_utf8();
        }
        folded.push_str("\r\n");
    }
    folded
}

fn summary(flight: &Taken<'_>, end: End) -> String {
    let load = match flight.row.passengers {
        0 => "no passengers".to_owned(),
        1 => "1 passenger".to_owned(),
        passengers => format!("{passengers} passengers"),
    };
    let aircraft = &flight.aircraft.id;
    match end {
        End::Departure => format!("{aircraft} to {}, {load}", flight.to.id),
        End::Arrival => format!("{aircraft} from {}, {load}", flight.from.id),
    }
}

fn description(flight: &Taken<'_>) -> String {
    format!(
        "Aircraft {} ({}) flies from {} to {}, departs at {}, arrives at {}, with {} of {} seats taken.",
        flight.aircraft.id,
        flight.kind.id,
        flight.from.id,
        flight.to.id,
        flight.row.takeoff,
        flight.row.arrival,
        flight.row.passengers,
        flight.kind.seats,
    )
}
