//! The ids of a day, which name aircraft and vertiports everywhere outside the simulator.

use std::collections::HashMap;

use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};

use crate::error::Error;

/// The positions of a day's aircraft and vertiports by their ids.
#[derive(Debug)]
pub(crate) struct Ids {
    aircraft: HashMap<String, AircraftIx>,
    vertiports: HashMap<String, VertiportIx>,
    periods: Vec<Time>,
}

impl Ids {
    /// The ids of a day.
    pub(crate) fn of(day: &Scenario) -> Self {
        let aircraft = day.aircraft.iter().map(|one| one.id.clone());
        let vertiports = day.vertiports.iter().map(|one| one.id.clone());
        Self {
            aircraft: aircraft.zip(AircraftIx::all(day.aircraft.len())).collect(),
            vertiports: vertiports.zip(VertiportIx::all(day.vertiports.len())).collect(),
            periods: day.periods.clone(),
        }
    }

    /// The position of an aircraft.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`] if the day has no such aircraft.
    pub(crate) fn aircraft(&self, id: &str) -> Result<AircraftIx, Error> {
        self.aircraft.get(id).copied().ok_or_else(|| Error::unknown("aircraft", id))
    }

    /// The position of a vertiport.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`] if the day has no such vertiport.
    pub(crate) fn vertiport(&self, id: &str) -> Result<VertiportIx, Error> {
        self.vertiports.get(id).copied().ok_or_else(|| Error::unknown("vertiport", id))
    }

    /// The position of a vertiport, if one is named.
    pub(crate) fn vertiport_if_any(
        &self,
        id: Option<&String>,
    ) -> Result<Option<VertiportIx>, Error> {
        id.map(|id| self.vertiport(id)).transpose()
    }

    /// The position of the period that contains a time; the last one lasts for the rest of the day.
    pub(crate) fn period(&self, time: Time) -> Result<usize, Error> {
        let position = self.periods.iter().rposition(|&start| start <= time);
        position.ok_or_else(|| Error::unknown("period that contains", &time.to_string()))
    }
}
