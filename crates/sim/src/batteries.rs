//! What is in each battery on days that charge as needed (page Model, section Energy).
//!
//! The charge at landing and the time of landing determine the charge at every later time until
//! take-off, so that no event is needed while an aircraft charges or holds.

use vertifleet_core::{AircraftIx, Battery, Charging, Scenario, Time, VertiportIx, whole_mwh};

use crate::room::clone_into_room;
use crate::{Decision, Landed, Legs, Simulation, VertiportSet};

/// The battery of each aircraft at its latest landing, decided or done.
#[derive(Debug, Default)]
pub(crate) struct Batteries {
    /// By aircraft; empty on days that charge to full.
    landed: Vec<Battery>,
}

clone_into_room!(Batteries { landed });

impl Batteries {
    /// The batteries when operations start.
    pub(crate) fn at_start(scenario: &Scenario, legs: &Legs) -> Self {
        if scenario.operations.charging == Charging::ToFull {
            return Self { landed: Vec::new() };
        }
        let landed = scenario.aircraft.iter().map(|aircraft| {
            let start_mwh = whole_mwh(scenario.start_charge_kwh(aircraft));
            legs.battery(aircraft.kind, aircraft.at, start_mwh)
        });
        Self { landed: landed.collect() }
    }

    /// Whether the day charges to full, so that no charge is kept.
    #[inline]
    pub(crate) fn are_always_full(&self) -> bool {
        self.landed.is_empty()
    }

    /// The battery at the latest landing.
    #[inline]
    pub(crate) fn landed(&self, aircraft: AircraftIx) -> Battery {
        self.landed[aircraft.at()]
    }

    /// The battery at the latest landing; an empty one on days that charge to full.
    pub(crate) fn kept(&self, aircraft: AircraftIx) -> Battery {
        self.landed.get(aircraft.at()).copied().unwrap_or_default()
    }

    /// Takes what was [kept](Self::kept) back.
    pub(crate) fn restore(&mut self, aircraft: AircraftIx, battery: Battery) {
        if let Some(landed) = self.landed.get_mut(aircraft.at()) {
            *landed = battery;
        }
    }

    /// Sets the battery at the latest landing.
    pub(crate) fn land(&mut self, aircraft: AircraftIx, battery: Battery) {
        self.landed[aircraft.at()] = battery;
    }
}

/// Most of these functions are for days that charge as needed.
impl Simulation {
    /// The latest landing of an aircraft.
    #[inline]
    pub(crate) fn landed(&self, aircraft: AircraftIx) -> Landed {
        let arrival = self.arrival[aircraft.at()];
        Landed { arrival, battery: self.batteries.landed(aircraft) }
    }

    /// The charge of an aircraft at a time from its latest landing until it takes off, mWh.
    pub(crate) fn charge_mwh(&self, aircraft: AircraftIx, time: Time) -> u64 {
        let kind = self.scenario.aircraft[aircraft.at()].kind;
        self.legs.charge_mwh(kind, self.place[aircraft.at()], self.landed(aircraft), time)
    }

    /// The seconds after a time until an aircraft that stays is full.
    #[inline]
    pub(crate) fn to_full_s(&self, aircraft: AircraftIx, time: Time) -> f64 {
        let kind = self.scenario.aircraft[aircraft.at()].kind;
        let Landed { arrival, battery } = self.landed(aircraft);
        let rate = self.legs.rate(kind, self.place[aircraft.at()]);
        rate.to_full_s(battery, time.since(arrival))
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
        self.legs.takeoff(kind, (at, to), self.landed(aircraft), time)
    }

    /// Of some vertiports, those for which the charge suffices by the end of operations.
    #[inline]
    pub(crate) fn charged_in_time(&self, decision: &Decision, of: VertiportSet) -> VertiportSet {
        if self.to_full_s(decision.aircraft, self.scenario.operations.end) <= 0.0 {
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
    pub(crate) fn discharge(&mut self, decision: &Decision, to: VertiportIx, arrival: Time) {
        let Decision { aircraft, at, .. } = *decision;
        let kind = self.scenario.aircraft[aircraft.at()].kind;
        let flight_s = self.legs.leg(kind, at, to).flight_s;
        let left = Time::from_seconds(arrival.seconds() - flight_s);
        let battery = self.legs.lands_with(kind, (at, to), self.landed(aircraft), left);
        self.batteries.land(aircraft, battery);
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
}
