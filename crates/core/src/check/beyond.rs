//! The rules for the parts of a day that go beyond the paper: corridors, forecasts, delays,
//! closures, outages.

use super::{Check, entry_count, span};
use crate::limits::{self, entries};
use crate::{Error, Route, TakeoffDelays};

impl Check<'_> {
    pub(super) fn corridors(&self) -> Result<(), Error> {
        let Some(corridors) = &self.day.corridors else { return Ok(()) };
        entry_count(self.origin, "corridors", corridors.len(), entries::CORRIDORS)?;
        for (at, route) in corridors.iter().enumerate() {
            self.route(*route, || format!("corridors[{at}]"))?;
        }
        Ok(())
    }

    pub(super) fn disturbances(&self) -> Result<(), Error> {
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

    fn takeoff_delays(&self, delays: &TakeoffDelays) -> Result<(), Error> {
        let member = || "takeoff_delays: slot_s".to_owned();
        limits::SLOT_S.check(delays.slot_s.into(), self.origin, member)?;
        let operations = &self.day.operations;
        let slots = TakeoffDelays::slots(delays.slot_s, operations.start, operations.end);
        let wrong = |member: String, expected: String, found| Error::WrongShape {
            origin: self.origin.to_owned(),
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
                limits::PHASE_S.check(delay_s.into(), self.origin, member)?;
            }
        }
        Ok(())
    }

    fn closures(&self) -> Result<(), Error> {
        let closures = &self.day.disturbances.closures;
        self.at_most("closures", closures.len(), entries::CLOSURES)?;
        for (at, closure) in closures.iter().enumerate() {
            let member = || format!("closures[{at}]");
            self.route(closure.route, member)?;
            span(closure.start, closure.end, self.origin, member)?;
        }
        Ok(())
    }

    fn outages(&self) -> Result<(), Error> {
        let outages = &self.day.disturbances.outages;
        self.at_most("outages", outages.len(), entries::OUTAGES)?;
        for (at, outage) in outages.iter().enumerate() {
            let member = || format!("outages[{at}]");
            if outage.aircraft.at() >= self.day.aircraft.len() {
                return Err(self.unknown(member(), outage.aircraft.at(), "aircraft"));
            }
            span(outage.start, outage.end, self.origin, member)?;
        }
        Ok(())
    }

    fn route(&self, route: Route, member: impl Fn() -> String) -> Result<(), Error> {
        for end in [route.from, route.to] {
            if end.at() >= self.day.vertiports.len() {
                return Err(self.unknown(member(), end.at(), "vertiports"));
            }
        }
        if route.from == route.to {
            let vertiport = self.day.vertiports[route.from.at()].id.clone();
            let origin = self.origin.to_owned();
            return Err(Error::RouteToItself { origin, member: member(), vertiport });
        }
        Ok(())
    }

    fn unknown(&self, member: String, position: usize, list: &'static str) -> Error {
        let origin = self.origin.to_owned();
        Error::UnknownId { origin, member, found: format!("#{position}"), list }
    }

    /// Refuses a list of more than `most` entries. The list may be empty.
    fn at_most(&self, member: &str, found: usize, most: usize) -> Result<(), Error> {
        if found == 0 { Ok(()) } else { entry_count(self.origin, member, found, most) }
    }
}
