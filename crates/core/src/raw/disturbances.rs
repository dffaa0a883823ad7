//! Routes and disturbances of the scenario file as they are written.

use serde::Deserialize;

use crate::limits;
use crate::parse::or_default;
use crate::raw::{Positions, each};
use crate::{AircraftIx, Closure, FormatError, Outage, Route, TakeoffDelays, Time, VertiportIx};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a route")]
pub(crate) struct RawRoute {
    pub(crate) from: String,
    pub(crate) to: String,
    #[serde(default, deserialize_with = "or_default")]
    pub(crate) both_ways: bool,
}

impl RawRoute {
    pub(crate) fn check(self, places: &Positions, member: &str) -> Result<Route, FormatError> {
        let end = |id: &str, end: &str| {
            places.position(id, || format!("{member}: {end}")).map(VertiportIx::new)
        };
        Ok(Route {
            from: end(&self.from, "from")?,
            to: end(&self.to, "to")?,
            both_ways: self.both_ways,
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a closure")]
pub(crate) struct RawClosure {
    from: String,
    to: String,
    #[serde(default, deserialize_with = "or_default")]
    both_ways: bool,
    start: Time,
    end: Time,
    #[serde(default, deserialize_with = "or_default")]
    known: bool,
}

impl RawClosure {
    pub(crate) fn check(self, at: usize, places: &Positions) -> Result<Closure, FormatError> {
        let Self { from, to, both_ways, start, end, known } = self;
        let route = RawRoute { from, to, both_ways };
        let route = route.check(places, &format!("closures[{at}]"))?;
        Ok(Closure { route, start, end, known })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of an outage")]
pub(crate) struct RawOutage {
    aircraft: String,
    start: Time,
    end: Time,
}

impl RawOutage {
    pub(crate) fn check(self, at: usize, fleet: &Positions) -> Result<Outage, FormatError> {
        let member = || format!("outages[{at}]: aircraft");
        let aircraft = AircraftIx::new(fleet.position(&self.aircraft, member)?);
        Ok(Outage { aircraft, start: self.start, end: self.end })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of takeoff_delays")]
pub(crate) struct RawTakeoffDelays {
    slot_s: f64,
    delay_s: Vec<Vec<f64>>,
}

impl RawTakeoffDelays {
    pub(crate) fn check(self) -> Result<TakeoffDelays, FormatError> {
        let slot_s =
            limits::SLOT_S.whole_number(self.slot_s, || "takeoff_delays: slot_s".to_owned())?;
        let delay_s = each(self.delay_s, |delays, slot| {
            each(delays, |delay, at| {
                let member = || format!("takeoff_delays: delay_s[{slot}][{at}]");
                limits::PHASE_S.whole_number(delay, member)
            })
        })?;
        Ok(TakeoffDelays { slot_s, delay_s })
    }
}
