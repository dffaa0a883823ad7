//! What is in each battery on days that charge as needed (page Model, section Energy).
//!
//! The charge at landing and the time of landing determine the charge at every later time until
//! take-off, so that no event is needed while an aircraft charges or holds.

use vertifleet_core::{AircraftIx, Charging, Scenario, Time, VertiportIx, whole_mwh};

use crate::room::clone_into_room;
use crate::{Decision, Leg, Simulation, VertiportSet};

/// The charge of each aircraft at its latest landing, decided or done.
#[derive(Debug, Default)]
pub(crate) struct Batteries {
    /// Milliwatt-hours by aircraft; empty on days that charge to full.
    landed_mwh: Vec<u64>,
}

clone_into_room!(Batteries { landed_mwh });

impl Batteries {
    /// The batteries when operations start.
    pub(crate) fn at_start(scenario: &Scenario) -> Self {
        if scenario.operations.charging == Charging::ToFull {
            return Self { landed_mwh: Vec::new() };
        }
        let fleet = scenario.aircraft.iter();
        let charges = fleet.map(|aircraft| whole_mwh(scenario.start_charge_kwh(aircraft)));
        Self { landed_mwh: charges.collect() }
    }

    /// Whether the day charges to full, so that no charge is kept.
    #[inline]
    pub(crate) fn are_always_full(&self) -> bool {
        self.landed_mwh.is_empty()
    }

    /// The charge at the latest landing, mWh.
    pub(crate) fn landed_mwh(&self, aircraft: AircraftIx) -> u64 {
        self.landed_mwh[aircraft.at()]
    }

    /// The charge at the latest landing, mWh; 0 on days that charge to full.
    pub(crate) fn kept_mwh(&self, aircraft: AircraftIx) -> u64 {
        self.landed_mwh.get(aircraft.at()).copied().unwrap_or(0)
    }

    /// Takes a charge of [`kept_mwh`](Self::kept_mwh) back.
    pub(crate) fn restore(&mut self, aircraft: AircraftIx, mwh: u64) {
        if let Some(landed_mwh) = self.landed_mwh.get_mut(aircraft.at()) {
            *landed_mwh = mwh;
        }
    }

    /// Sets the charge at the latest landing, mWh.
    pub(crate) fn land(&mut self, aircraft: AircraftIx, mwh: u64) {
        self.landed_mwh[aircraft.at()] = mwh;
    }
}

/// Most of these functions are for days that charge as needed.
impl Simulation {
    /// The charge of an aircraft at a time from its latest landing until it takes off, mWh.
    pub(crate) fn charge_mwh(&self, aircraft: AircraftIx, time: Time) -> u64 {
        let kind = self.scenario.aircraft[aircraft.at()].kind;
        let rate = self.legs.rate(kind, self.place[aircraft.at()]);
        let charged_s = time.since(self.arrival[aircraft.at()]);
        rate.charged_mwh(self.batteries.landed_mwh(aircraft), charged_s)
    }

    /// The charge of an aircraft at its next decision, kWh; `None` on days that charge to full.
    pub(crate) fn charge_when_ready_kwh(&self, aircraft: AircraftIx) -> Option<f64> {
        let ready = self.queue.ready_at(aircraft);
        (!self.batteries.are_always_full()).then(|| self.charge_mwh(aircraft, ready) as f64 / 1e6)
    }

    /// The first time, not before the decision, at which the charge suffices for a flight.
    pub(crate) fn takeoff(&self, decision: &Decision, to: VertiportIx) -> Time {
        let Decision { aircraft, at, time, .. } = *decision;
        let kind = self.scenario.aircraft[aircraft.at()].kind;
        let rate = self.legs.rate(kind, at);
        let energy_kwh = self.legs.leg(kind, at, to).energy_kwh;
        let needed_mwh = self.scenario.aircraft_types[kind.at()].needed_mwh(energy_kwh);
        let needed_mwh = needed_mwh.min(rate.full_mwh());
        let landed_mwh = self.batteries.landed_mwh(aircraft);
        time.max(self.arrival[aircraft.at()] + rate.needed_s(landed_mwh, needed_mwh))
    }

    /// Of some vertiports, those for which the charge suffices by the end of operations.
    #[cold]
    pub(crate) fn charged_in_time(&self, decision: &Decision, of: VertiportSet) -> VertiportSet {
        let end = self.scenario.operations.end;
        let is_full = |by| {
            let kind = self.scenario.aircraft[decision.aircraft.at()].kind;
            let full_mwh = self.legs.rate(kind, decision.at).full_mwh();
            self.charge_mwh(decision.aircraft, by) >= full_mwh
        };
        if is_full(end) {
            return of;
        }
        of.iter().filter(|&to| self.takes_off_in_time(decision, to)).collect()
    }

    /// When a flight takes off, and the charge at its decision, kWh.
    #[cold]
    pub(crate) fn takeoff_and_charge(&self, decision: &Decision, to: VertiportIx) -> (Time, f64) {
        let charge_mwh = self.charge_mwh(decision.aircraft, decision.time);
        (self.takeoff(decision, to), charge_mwh as f64 / 1e6)
    }

    /// Enters the charge with which a flight lands at a time.
    #[cold]
    pub(crate) fn discharge(&mut self, aircraft: AircraftIx, arrival: Time, leg: &Leg) {
        let left = Time::from_seconds(arrival.seconds() - leg.flight_s);
        let mwh = self.lands_with_mwh(aircraft, left, leg.energy_kwh);
        self.batteries.land(aircraft, mwh);
    }

    /// Whether the charge suffices for a flight by the end of operations.
    #[cold]
    pub(crate) fn takes_off_in_time(&self, decision: &Decision, to: VertiportIx) -> bool {
        self.takeoff(decision, to) <= self.scenario.operations.end
    }

    /// Lets an aircraft hold, which leaves its charger only if its battery is full. Returns its
    /// charge, kWh.
    #[cold]
    pub(crate) fn hold_charging(&mut self, decision: &Decision) -> f64 {
        let Decision { aircraft, at, time, .. } = *decision;
        let kind = self.scenario.aircraft[aircraft.at()].kind;
        let charge_mwh = self.charge_mwh(aircraft, time);
        if charge_mwh >= self.legs.rate(kind, at).full_mwh() {
            self.stands.hold(aircraft, at);
        }
        charge_mwh as f64 / 1e6
    }

    /// The charge that an aircraft lands with after it takes off at a time, mWh. A flight that a
    /// report forces may take more than there is.
    pub(crate) fn lands_with_mwh(
        &self,
        aircraft: AircraftIx,
        takeoff: Time,
        energy_kwh: f64,
    ) -> u64 {
        self.charge_mwh(aircraft, takeoff).saturating_sub(whole_mwh(energy_kwh))
    }
}
