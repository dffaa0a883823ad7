//! The parts that scenario and network files share, as they are written. Any number is allowed
//! here; the next stage checks it.
//!
//! Whole numbers are read as `f64` on purpose, so that `-1` or `2.5` stands are refused with the
//! rule that they break and not with a message about types.

mod disturbances;

use std::collections::HashMap;

use serde::Deserialize;

use crate::limits::{self, Limits};
use crate::parse::{or_default, shortened};
use crate::{
    Aircraft, AircraftType, ChargeCurve, Charging, CurvePoint, Degrees, FormatError, Operations,
    Time, Vertiport, check,
};

pub(crate) use disturbances::{RawClosure, RawOutage, RawRoute, RawTakeoffDelays};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of operations")]
pub(crate) struct RawOperations {
    start: Time,
    end: Time,
    takeoff_s: f64,
    landing_s: f64,
    hold_s: f64,
    #[serde(default, deserialize_with = "or_default")]
    passenger_wait_s: f64,
    charging: Option<String>,
}

impl RawOperations {
    pub(crate) fn check(&self) -> Result<Operations, FormatError> {
        let seconds = |value: f64, limits: &Limits, member: &str| {
            limits.whole_number(value, || format!("operations: {member}"))
        };
        Ok(Operations {
            start: self.start,
            end: self.end,
            takeoff_s: seconds(self.takeoff_s, &limits::PHASE_S, "takeoff_s")?,
            landing_s: seconds(self.landing_s, &limits::PHASE_S, "landing_s")?,
            hold_s: seconds(self.hold_s, &limits::HOLD_S, "hold_s")?,
            passenger_wait_s: seconds(
                self.passenger_wait_s,
                &limits::PASSENGER_WAIT_S,
                "passenger_wait_s",
            )?,
            charging: self.charging.as_deref().map_or(Ok(Charging::default()), charging)?,
        })
    }
}

/// The rule of charging that a file names.
fn charging(name: &str) -> Result<Charging, FormatError> {
    let named = Charging::NAMES.iter().find(|(known, _)| *known == name);
    named.map(|&(_, charging)| charging).ok_or_else(|| FormatError::BadId {
        member: "operations: charging".to_owned(),
        rule: "\"to_full\" or \"as_needed\"",
        found: shortened(name, 64),
    })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a vertiport")]
pub(crate) struct RawVertiport {
    id: String,
    x_mi: f64,
    y_mi: f64,
    stands: f64,
    chargers: Option<f64>,
    charger_kw: Option<f64>,
    busy: bool,
    latitude: Option<f64>,
    longitude: Option<f64>,
    #[serde(default, deserialize_with = "or_default")]
    stand_cost: f64,
    #[serde(default, deserialize_with = "or_default")]
    charger_cost: f64,
}

impl RawVertiport {
    pub(crate) fn check(self, at: usize) -> Result<Vertiport, FormatError> {
        check::id(|| format!("vertiports[{at}]: id"), &self.id)?;
        let member = || format!("vertiport {:?}: stands", self.id);
        let stands = limits::STANDS.whole_number(self.stands, member)?;
        let chargers = chargers(&self.id, self.chargers)?;
        let degrees = match (self.latitude, self.longitude) {
            (None, None) => None,
            (Some(latitude), Some(longitude)) => Some(Degrees { latitude, longitude }),
            _ => {
                return Err(FormatError::NotOneOf {
                    member: format!("vertiport {:?}", self.id),
                    choices: "latitude and longitude together, or neither",
                    found: 1,
                });
            }
        };
        Ok(Vertiport {
            id: self.id,
            x_mi: self.x_mi,
            y_mi: self.y_mi,
            stands,
            chargers,
            charger_kw: self.charger_kw,
            busy: self.busy,
            degrees,
            stand_cost_usd: self.stand_cost,
            charger_cost_usd: self.charger_cost,
        })
    }
}

/// The number of a vertiport's chargers, if it also has stands without chargers.
pub(crate) fn chargers(id: &str, raw: Option<f64>) -> Result<Option<u16>, FormatError> {
    let member = || format!("vertiport {id:?}: chargers");
    raw.map(|chargers| limits::CHARGERS.whole_number(chargers, member)).transpose()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of an aircraft type")]
pub(crate) struct RawAircraftType {
    id: String,
    seats: f64,
    speed_mph: f64,
    battery_kwh: f64,
    energy_kwh_per_mi: f64,
    charge_kw: f64,
    self_discharge_per_h: f64,
    #[serde(default, deserialize_with = "or_default")]
    reserve_kwh: f64,
    #[serde(default, deserialize_with = "or_default")]
    turnaround_s: f64,
    charge_curve: Option<Vec<[f64; 2]>>,
}

impl RawAircraftType {
    pub(crate) fn check(self, at: usize) -> Result<AircraftType, FormatError> {
        check::id(|| format!("aircraft_types[{at}]: id"), &self.id)?;
        let member = || format!("aircraft type {:?}: seats", self.id);
        let seats = limits::SEATS.whole_number(self.seats, member)?;
        let member = || format!("aircraft type {:?}: turnaround_s", self.id);
        let turnaround_s = limits::PHASE_S.whole_number(self.turnaround_s, member)?;
        let point = |[charge, kw]: [f64; 2]| CurvePoint { charge, kw };
        let through =
            |points: Vec<_>| ChargeCurve::through(points.into_iter().map(point).collect());
        Ok(AircraftType {
            id: self.id,
            seats,
            speed_mph: self.speed_mph,
            battery_kwh: self.battery_kwh,
            energy_kwh_per_mi: self.energy_kwh_per_mi,
            charge_kw: self.charge_kw,
            self_discharge_per_h: self.self_discharge_per_h,
            reserve_kwh: self.reserve_kwh,
            turnaround_s,
            charge_curve: self.charge_curve.map(through),
        })
    }
}

/// Checks the entries of a list one by one; `check` gets each entry with its position.
pub(crate) fn each<Raw, Checked>(
    entries: Vec<Raw>,
    mut check: impl FnMut(Raw, usize) -> Result<Checked, FormatError>,
) -> Result<Vec<Checked>, FormatError> {
    entries.into_iter().enumerate().map(|(at, raw)| check(raw, at)).collect()
}

/// The position of each id in a list.
pub(crate) struct Positions<'a> {
    list: &'static str,
    by_id: HashMap<&'a str, usize>,
}

impl<'a> Positions<'a> {
    /// The positions of the vertiports. Duplicate ids are refused.
    pub(crate) fn of_vertiports(vertiports: &'a [Vertiport]) -> Result<Self, FormatError> {
        let ids = vertiports.iter().map(|vertiport| &vertiport.id);
        check::ids("vertiports", "vertiport", ids.clone())?;
        Ok(Self::of("vertiports", ids))
    }

    /// The positions of the aircraft types. Duplicate ids are refused.
    pub(crate) fn of_types(kinds: &'a [AircraftType]) -> Result<Self, FormatError> {
        let ids = kinds.iter().map(|kind| &kind.id);
        check::ids("aircraft_types", "aircraft type", ids.clone())?;
        Ok(Self::of("aircraft types", ids))
    }

    /// The positions of the aircraft. Duplicate ids are refused.
    pub(crate) fn of_aircraft(aircraft: &'a [Aircraft]) -> Result<Self, FormatError> {
        let ids = aircraft.iter().map(|aircraft| &aircraft.id);
        check::ids("aircraft", "aircraft", ids.clone())?;
        Ok(Self::of("aircraft", ids))
    }

    fn of(list: &'static str, ids: impl Iterator<Item = &'a String>) -> Self {
        Self { list, by_id: ids.enumerate().map(|(at, id)| (id.as_str(), at)).collect() }
    }

    /// The position of the entry that `member` refers to.
    pub(crate) fn position(
        &self,
        id: &str,
        member: impl FnOnce() -> String,
    ) -> Result<usize, FormatError> {
        self.by_id.get(id).copied().ok_or_else(|| FormatError::UnknownId {
            member: member(),
            found: shortened(id, 64),
            list: self.list,
        })
    }
}
