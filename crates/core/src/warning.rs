//! What is allowed in a scenario but hardly meant: found on request, never a reason to refuse the file.

use std::fmt;

use crate::{AircraftType, Code, Scenario, VertiportIx};

/// Something in a scenario that is allowed but hardly meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Warning {
    /// V120. A full battery does not take the aircraft from where it starts to any other vertiport, so that it stands
    /// there all day. Fix: start it elsewhere, or check its type's battery and the distances.
    NoDestination {
        /// The aircraft.
        aircraft: String,
        /// Its type.
        kind: String,
        /// Where it starts.
        at: String,
    },
}

impl Warning {
    /// The stable number, printed as `V120`.
    pub fn code(&self) -> Code {
        match self {
            Self::NoDestination { .. } => Code(120),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::NoDestination { aircraft, kind, at } = self;
        write!(
            f,
            "aircraft {aircraft:?} of type {kind:?} reaches no other vertiport from {at:?}: it stands there all day"
        )
    }
}

impl Scenario {
    /// What is allowed in this scenario but hardly meant, in file order.
    pub fn warnings(&self) -> Vec<Warning> {
        let stranded = self.aircraft.iter().filter(|aircraft| {
            let kind = &self.aircraft_types[aircraft.kind.at()];
            !VertiportIx::all(self.vertiports.len()).any(|to| {
                to != aircraft.at
                    && self.is_corridor(aircraft.at, to)
                    && self.reaches(kind, self.distance_mi[(aircraft.at, to)])
            })
        });
        stranded
            .map(|aircraft| Warning::NoDestination {
                aircraft: aircraft.id.clone(),
                kind: self.aircraft_types[aircraft.kind.at()].id.clone(),
                at: self.vertiports[aircraft.at.at()].id.clone(),
            })
            .collect()
    }

    /// Whether a full battery lasts for a flight: e d_ij and the self-discharge of the journey, in whole seconds
    /// (design §2).
    fn reaches(&self, kind: &AircraftType, distance_mi: f64) -> bool {
        let cruise_s = (3600.0 * distance_mi / kind.speed_mph).round();
        let windows_s = self.operations.takeoff_s + self.operations.landing_s;
        let flight_h = (f64::from(windows_s) + cruise_s) / 3600.0;
        let lost_kwh = kind.battery_kwh * kind.self_discharge_per_h * flight_h;
        kind.lasts_for(kind.energy_kwh_per_mi * distance_mi + lost_kwh)
    }
}
