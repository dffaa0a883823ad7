//! The rules for the parts of a day that go beyond the paper: corridors, forecasts, delays,
//! closures, outages.

use super::{Check, entry_count, span};
use crate::limits::{self, entries};
use crate::{FormatError, Route, TakeoffDelays};

impl Check<'_> {
    pub(super) fn corridors(&self) -> Result<(), FormatError> {
        let Some(corridors) = &self.day.corridors else { return Ok(()) };
        entry_count("corridors", corridors.len(), entries::CORRIDORS)?;
        for (at, route) in corridors.iter().enumerate() {
            self.route(*route, || format!("corridors[{at}]"))?;
        }
        Ok(())
    }

    pub(super) fn disturbances(&self) -> Result<(), FormatError> {
        let disturbances = &self.day.disturbances;
        if let Some(forecast) = &disturbances.forecast {
            self.passengers(forecast, "forecast")?;
        }
        if let Some(delays) = &disturbances.takeoff_delays {
            self.takeoff_delays(delays)?;
        }
        self.closures()?;
        self.outages()
    }

    fn takeoff_delays(&self, delays: &TakeoffDelays) -> Result<(), FormatError> {
        let member = || "takeoff_delays: slot_s".to_owned();
        limits::SLOT_S.check(delays.slot_s.into(), member)?;
        let operations = &self.day.operations;
        let slots = TakeoffDelays::slots(delays.slot_s, operations.start, operations.end);
        let wrong = |member: String, expected: String, found| FormatError::WrongShape {
            member,
            expected,
            found,
        };
        let member = "takeoff_delays: delay_s";
        if delays.delay_s.len() != slots {
            let expected = format!("a row for each of {slots} slots of the day");
            return Err(wrong(member.to_owned(), expected, delays.delay_s.len()));
        }
        let size = self.day.vertiports.len();
        for (slot, delays_s) in delays.delay_s.iter().enumerate() {
            if delays_s.len() != size {
                let expected = format!("an entry for each of {size} vertiports");
                return Err(wrong(format!("{member}[{slot}]"), expected, delays_s.len()));
            }
            for (at, &delay_s) in delays_s.iter().enumerate() {
                let member = || format!("{member}[{slot}][{at}]");
                limits::PHASE_S.check(delay_s.into(), member)?;
            }
        }
        Ok(())
    }

    fn closures(&self) -> Result<(), FormatError> {
        let closures = &self.day.disturbances.closures;
        at_most("closures", closures.len(), entries::CLOSURES)?;
        for (at, closure) in closures.iter().enumerate() {
            let member = || format!("closures[{at}]");
            self.route(closure.route, member)?;
            span(closure.start, closure.end, member)?;
        }
        Ok(())
    }

    fn outages(&self) -> Result<(), FormatError> {
        let outages = &self.day.disturbances.outages;
        at_most("outages", outages.len(), entries::OUTAGES)?;
        for (at, outage) in outages.iter().enumerate() {
            let member = || format!("outages[{at}]");
            if outage.aircraft.at() >= self.day.aircraft.len() {
                return Err(unknown(member(), outage.aircraft.at(), "aircraft"));
            }
            span(outage.start, outage.end, member)?;
        }
        Ok(())
    }

    fn route(&self, route: Route, member: impl Fn() -> String) -> Result<(), FormatError> {
        for end in [route.from, route.to] {
            if end.at() >= self.day.vertiports.len() {
                return Err(unknown(member(), end.at(), "vertiports"));
            }
        }
        if route.from == route.to {
            let vertiport = self.day.vertiports[route.from.at()].id.clone();
            return Err(FormatError::RouteToItself { member: member(), vertiport });
        }
        Ok(())
    }
}

fn unknown(member: String, position: usize, list: &'static str) -> FormatError {
    FormatError::UnknownId { member, found: format!("#{position}"), list }
}

/// Refuses a list of more than `most` entries. The list may be empty.
fn at_most(member: &str, found: usize, most: usize) -> Result<(), FormatError> {
    if found == 0 { Ok(()) } else { entry_count(member, found, most) }
}
