//! What is in the batteries of a live day that charges as needed: what follows from take-offs, and
//! what is reported.

use vertifleet_core::{AircraftIx, Battery, Time, whole_mwh};

use super::report::ReportError;
use super::{LiveDay, LiveDecision, Phase};
use crate::batteries::Batteries;

impl LiveDay {
    /// What the battery of an aircraft on the ground holds now, kWh.
    pub(super) fn charge_kwh(&self, aircraft: AircraftIx) -> Option<f64> {
        if self.known.batteries.are_always_full() {
            return None;
        }
        let charge_mwh = match self.aircraft[aircraft.at()].phase {
            Phase::Standing => self.known.charge_mwh(aircraft, self.now),
            Phase::SentOff { flight, .. } => self.charge_before_mwh(flight, self.now),
            Phase::InTheAir { .. } => return None,
        };
        Some(charge_mwh as f64 / 1e6)
    }

    /// What the battery of an aircraft on its way will hold when it lands, kWh; below 0, what it
    /// lacks.
    pub(super) fn lands_with_kwh(&self, aircraft: AircraftIx) -> Option<f64> {
        if self.known.batteries.are_always_full() {
            return None;
        }
        let (flight, takeoff) = match self.aircraft[aircraft.at()].phase {
            Phase::Standing => return None,
            Phase::SentOff { flight, departs } => (flight, departs),
            Phase::InTheAir { flight, departed } => (flight, departed),
        };
        let charged_mwh = self.charge_before_mwh(flight, takeoff);
        let flight_mwh = whole_mwh(self.decisions[flight].row.energy_kwh);
        Some(if charged_mwh < flight_mwh {
            -((flight_mwh - charged_mwh) as f64 / 1e6)
        } else {
            (charged_mwh - flight_mwh) as f64 / 1e6
        })
    }

    /// The charge at a time before the take-off of a flight, mWh.
    pub(super) fn charge_before_mwh(&self, flight: usize, time: Time) -> u64 {
        let LiveDecision { row, before, .. } = &self.decisions[flight];
        let kind = self.scenario().aircraft[row.aircraft.at()].kind;
        self.known.legs.charge_mwh(kind, row.from, before.landed(), time)
    }

    /// Enters the charge with which a flight lands that takes off at a time. Nothing is entered on
    /// days that charge to full. A battery that lacks energy is empty when it lands; the report of
    /// such a take-off has a notice.
    pub(super) fn charge_until(&self, batteries: &mut Batteries, flight: usize, takeoff: Time) {
        if batteries.are_always_full() {
            return;
        }
        let row = &self.decisions[flight].row;
        let charged_mwh = self.charge_before_mwh(flight, takeoff);
        let landed_mwh = charged_mwh.saturating_sub(whole_mwh(row.energy_kwh));
        batteries.land(row.aircraft, self.battery(row.aircraft, landed_mwh));
    }

    /// Sets when a flight takes off, and with it the charge that it lands with.
    pub(super) fn set_takeoff(&mut self, flight: usize, takeoff: Time) {
        let mut batteries = std::mem::take(&mut self.known.batteries);
        self.charge_until(&mut batteries, flight, takeoff);
        self.known.batteries = batteries;
    }

    /// Keeps what an aircraft has charged until a time at which it is found elsewhere.
    pub(super) fn keep_charge(&mut self, aircraft: AircraftIx, time: Time) {
        if !self.known.batteries.are_always_full() {
            let charge_mwh = self.known.charge_mwh(aircraft, time);
            self.set_charge(aircraft, charge_mwh);
        }
    }

    /// Lets an aircraft that has been moved charge where it is now.
    pub(super) fn plug_in(&mut self, aircraft: AircraftIx) {
        if !self.known.batteries.are_always_full() {
            self.set_charge(aircraft, self.known.batteries.landed(aircraft).mwh);
        }
    }

    /// Refuses a charge that the battery of an aircraft cannot hold, or that the day does not keep.
    pub(super) fn check_charge(
        &self,
        aircraft: AircraftIx,
        charge_kwh: Option<f64>,
    ) -> Result<(), ReportError> {
        let of_fleet = self.scenario().aircraft.get(aircraft.at());
        let kind = of_fleet.ok_or(ReportError::Unknown("aircraft"))?.kind;
        let Some(charge_kwh) = charge_kwh else { return Ok(()) };
        if self.known.batteries.are_always_full() {
            return Err(ReportError::NoCharge);
        }
        let battery_kwh = self.scenario().aircraft_types[kind.at()].battery_kwh;
        if (0.0..=battery_kwh).contains(&charge_kwh) {
            return Ok(());
        }
        let aircraft = self.scenario().aircraft[aircraft.at()].id.clone();
        Err(ReportError::ChargeOutOfRange { aircraft, charge_kwh, battery_kwh })
    }

    /// Corrects the charge that an aircraft has landed with.
    pub(super) fn correct_charge(&mut self, aircraft: AircraftIx, charge_kwh: Option<f64>) {
        if let Some(charge_kwh) = charge_kwh {
            self.set_charge(aircraft, whole_mwh(charge_kwh));
        }
    }

    /// Sets the charge that an aircraft has landed with where it is, mWh.
    fn set_charge(&mut self, aircraft: AircraftIx, mwh: u64) {
        let battery = self.battery(aircraft, mwh);
        self.known.batteries.land(aircraft, battery);
    }

    /// The battery of an aircraft that begins to charge where it is, or will land.
    fn battery(&self, aircraft: AircraftIx, mwh: u64) -> Battery {
        let kind = self.scenario().aircraft[aircraft.at()].kind;
        self.known.legs.battery(kind, self.known.place[aircraft.at()], mwh)
    }
}
