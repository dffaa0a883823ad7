//! The rules for reserves, curves and charges, which go beyond the paper's full battery (Eq. 14).

use super::{Check, entry_count};
use crate::limits::{self, Limits, entries};
use crate::{AircraftType, ChargeCurve, FormatError};

impl Check<'_> {
    /// Checks the members of an aircraft type that say when it may leave.
    pub(super) fn energy(kind: &AircraftType) -> Result<(), FormatError> {
        let number = |value: f64, limits: &Limits, member: &str| {
            limits.check(value, || format!("aircraft type {:?}: {member}", kind.id))
        };
        number(kind.reserve_kwh, &limits::RESERVE_KWH, "reserve_kwh")?;
        number(kind.turnaround_s.into(), &limits::PHASE_S, "turnaround_s")?;
        if kind.reserve_kwh >= kind.battery_kwh {
            return Err(FormatError::OutOfRange {
                member: format!("aircraft type {:?}: reserve_kwh", kind.id),
                rule: format!("less than battery_kwh, {}", limits::number(kind.battery_kwh)),
                found: limits::number(kind.reserve_kwh),
                hint: Some("a flight uses what is in the battery above the reserve"),
            });
        }
        kind.charge_curve.as_ref().map_or(Ok(()), |curve| charge_curve(kind, curve))
    }

    pub(super) fn start_charges(&self) -> Result<(), FormatError> {
        for aircraft in &self.day.aircraft {
            let Some(charge_kwh) = aircraft.start_charge_kwh else { continue };
            let battery_kwh = self.day.aircraft_types[aircraft.kind.at()].battery_kwh;
            let member = || format!("aircraft {:?}: start_charge_kwh", aircraft.id);
            limits::CHARGE_KWH.check(charge_kwh, member)?;
            if charge_kwh > battery_kwh {
                return Err(FormatError::OutOfRange {
                    member: member(),
                    rule: format!("at most battery_kwh, {}", limits::number(battery_kwh)),
                    found: limits::number(charge_kwh),
                    hint: Some("leave start_charge_kwh out if the battery is full"),
                });
            }
        }
        Ok(())
    }
}

/// Checks that a curve leads from an empty battery to a full one and never falls too low.
fn charge_curve(kind: &AircraftType, curve: &ChargeCurve) -> Result<(), FormatError> {
    let member = |at: usize| format!("aircraft type {:?}: charge_curve: point {}", kind.id, at + 1);
    let points = curve.points();
    let whole = format!("aircraft type {:?}: charge_curve", kind.id);
    entry_count(&whole, points.len(), entries::CURVE_POINTS)?;
    for (at, point) in points.iter().enumerate() {
        limits::CURVE_CHARGE.check(point.charge, || format!("{}: charge", member(at)))?;
        limits::CURVE_KW.check(point.kw, || format!("{}: power", member(at)))?;
    }
    let wrong = |at: usize, rule: &str| FormatError::OutOfRange {
        member: format!("{}: charge", member(at)),
        rule: rule.to_owned(),
        found: limits::number(points[at].charge),
        hint: Some("a curve begins at charge 0, ends at charge 1, and its charges increase"),
    };
    if points[0].charge != 0.0 {
        return Err(wrong(0, "0, an empty battery"));
    }
    if let Some(at) = points.windows(2).position(|pair| pair[1].charge <= pair[0].charge) {
        return Err(wrong(at + 1, "more than that of the point before it"));
    }
    let last = points.len() - 1;
    if points[last].charge != 1.0 {
        return Err(wrong(last, "1, a full battery"));
    }
    Ok(())
}
