//! iCalendar: every flight is an event at both of its ends, and calendars are read back.

use std::collections::HashSet;

use icalendar::{CalendarComponent, Component, Event, Property};
use proptest::prelude::{prop_assert, prop_assert_eq, proptest};
use vertifleet_core::VertiportIx;
use vertifleet_export::{ICALENDAR_FILE, VertiportCalendar, icalendar};

use crate::days::{Played, any_played, calendar, tiny};

fn calendars(played: &Played) -> Vec<VertiportCalendar> {
    icalendar(&played.flown(), &calendar())
}

fn events(written: &VertiportCalendar) -> Vec<Event> {
    let read: icalendar::Calendar = written.text.parse().expect("a calendar");
    let event = |component: &CalendarComponent| match component {
        CalendarComponent::Event(event) => event.clone(),
        other => panic!("a calendar has {other:?}"),
    };
    read.components.iter().map(event).collect()
}

fn value<'a>(event: &'a Event, property: &str) -> &'a str {
    // The reader keeps properties that an event may have several times in another place.
    let several = || event.multi_properties().get(property)?.first().map(Property::value);
    event.property_value(property).or_else(several).expect("a property")
}

#[test]
fn the_calendar_of_a_tiny_day_reads_as_it_should() {
    let calendars = calendars(&tiny());
    let files: Vec<&str> = calendars.iter().map(|calendar| calendar.file.as_str()).collect();
    assert_eq!(files, ["vertiport-Pier___East_.ics", "vertiport-Z_rich.ics"]);
    assert!(calendars[0].text.starts_with(ICALENDAR_FILE.opening));
    insta::assert_snapshot!(calendars[0].text.replace("\r\n", "\n"));
}

#[test]
fn lines_end_and_fold_as_the_standard_says() {
    for calendar in calendars(&tiny()) {
        assert!(calendar.text.ends_with("END:VCALENDAR\r\n"));
        assert!(calendar.text.split("\r\n").all(|line| line.len() <= 75 && !line.contains('\n')));
    }
}

#[test]
fn a_departure_lasts_for_the_take_off_and_an_arrival_for_the_landing() {
    let calendars = calendars(&tiny());
    let times =
        |event: &Event| [value(event, "DTSTART").to_owned(), value(event, "DTEND").to_owned()];
    let departure = &events(&calendars[0])[0];
    assert_eq!(times(departure), ["20261125T041500Z", "20261125T042500Z"]);
    assert_eq!(value(departure, "SUMMARY"), "A1 to Zürich, 3 passengers");
    let arrival = &events(&calendars[1])[0];
    assert_eq!(times(arrival), ["20261125T043100Z", "20261125T043600Z"]);
    assert_eq!(value(arrival, "SUMMARY"), "A1 from Pier, \"East\", 3 passengers");
}

#[test]
fn an_event_that_takes_no_time_has_no_end() {
    let mut played = tiny();
    let mut day = played.day.into_day();
    day.operations.takeoff_s = 0;
    played.day = day.check("a day without take-off").expect("a day within the rules");
    let events = events(&calendars(&played)[0]);
    assert_eq!(events[0].property_value("DTEND"), None);
}

proptest! {
    #[test]
    fn every_flight_is_an_event_at_both_of_its_ends(played in any_played()) {
        let calendars = calendars(&played);
        prop_assert_eq!(calendars.len(), played.day.vertiports.len());
        let mut uids = HashSet::new();
        for (written, at) in calendars.iter().zip(VertiportIx::all(calendars.len())) {
            prop_assert_eq!(&written.vertiport, &played.vertiport(at).id);
            prop_assert!(written.text.split("\r\n").all(|line| line.len() <= 75));
            let events = events(written);
            let here = |event: &&Event| value(event, "LOCATION") == played.vertiport(at).id;
            prop_assert_eq!(events.iter().filter(here).count(), events.len());
            let of = |word: &str| events.iter().filter(|event| value(event, "CATEGORIES") == word).count();
            prop_assert_eq!(of("DEPARTURE"), played.flights().filter(|row| row.from == at).count());
            prop_assert_eq!(of("ARRIVAL"), played.flights().filter(|row| row.to == at).count());
            for event in &events {
                prop_assert!(uids.insert(value(event, "UID").to_owned()));
                prop_assert_eq!(value(event, "DTSTAMP"), "20261124T110000Z");
                if let Some(end) = event.property_value("DTEND") {
                    prop_assert!(value(event, "DTSTART") < end);
                }
            }
        }
        prop_assert_eq!(uids.len(), 2 * played.flights().count());
    }

    #[test]
    fn ids_survive_in_the_words_of_an_event(played in any_played()) {
        for (written, at) in calendars(&played).iter().zip(VertiportIx::all(played.day.vertiports.len())) {
            let departures = events(written).into_iter().filter(|event| value(event, "CATEGORIES") == "DEPARTURE");
            for (event, row) in departures.zip(played.flights().filter(|row| row.from == at)) {
                let (aircraft, to) = (&played.aircraft(row).id, &played.vertiport(row.to).id);
                let load = match row.passengers {
                    0 => "no passengers".to_owned(),
                    1 => "1 passenger".to_owned(),
                    many => format!("{many} passengers"),
                };
                prop_assert_eq!(value(&event, "SUMMARY"), format!("{aircraft} to {to}, {load}"));
            }
        }
    }

    #[test]
    fn file_names_are_plain_and_differ_and_the_same_day_gives_the_same_text(played in any_played()) {
        let written = calendars(&played);
        let files: HashSet<String> = written.iter().map(|calendar| calendar.file.to_lowercase()).collect();
        prop_assert_eq!(files.len(), written.len());
        for calendar in &written {
            let letters = calendar.file.strip_suffix(".ics").expect("the end of a calendar's name");
            prop_assert!(letters.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_'));
        }
        prop_assert_eq!(calendars(&played.clone()), written);
    }
}
