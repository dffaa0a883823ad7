//! Reports of the impossible: departures before the landing, flights without energy or faster than
//! the aircraft, and batteries that charge faster than they can.
//!
//! The times and charges of the simulator are estimates, so a notice needs more than a small
//! deviation from them. Where a departure was not reported, a notice assumes the latest take-off
//! that the landing permits.

use vertifleet_core::{AircraftIx, Time, VertiportIx, whole_mwh};

use super::notice::Notice;
use super::{Before, LiveDay, LiveDecision, Phase};
use crate::TraceRow;
use crate::legs::refill_s;

/// A duration below this share of the expected one is impossible: 4 / 5, for the tail wind of a
/// flight. See also [`TOLERANCE_S`].
const LEAST: (u64, u64) = (4, 5);
/// Reports of times may be wrong by a minute.
const TOLERANCE_S: u32 = 60;

/// The shortest possible duration of something that is expected to take this long.
fn shortest_s(expected_s: u32) -> u32 {
    let share_s = (u64::from(expected_s) * LEAST.0).div_ceil(LEAST.1);
    let share_s = u32::try_from(share_s).expect("a share of 32 bits");
    share_s.min(expected_s.saturating_sub(TOLERANCE_S))
}

impl LiveDay {
    /// The reason why a flight cannot have departed at a time, if it cannot.
    pub(super) fn departed_too_soon(&self, flight: usize, time: Time) -> Option<Notice> {
        let LiveDecision { row, before: Before { arrival, prepared, .. }, .. } =
            self.decisions[flight];
        let aircraft = self.id(row.aircraft);
        // The day begins with its aircraft on the ground.
        if time < arrival && arrival > self.scenario().operations.start {
            return Some(Notice::DepartedBeforeLanding {
                aircraft,
                departed: time,
                landed: arrival,
            });
        }
        (time < prepared).then_some(Notice::DepartedUnready { aircraft, ready: prepared })
    }

    /// The energy that a flight lacks if it takes off at a time, on days that charge as needed.
    pub(super) fn lacks_energy(&self, flight: usize, takeoff: Time) -> Option<Notice> {
        self.lacks_energy_for(flight, self.decisions[flight].row.to, takeoff)
    }

    /// The energy that a flight lacks that ends at a vertiport.
    pub(super) fn lacks_energy_for(
        &self,
        flight: usize,
        to: VertiportIx,
        takeoff: Time,
    ) -> Option<Notice> {
        if self.known.batteries.are_always_full() {
            return None;
        }
        let row = &self.decisions[flight].row;
        let kind = self.scenario().aircraft[row.aircraft.at()].kind;
        let charged_mwh = self.charge_before_mwh(flight, takeoff);
        let flight_mwh = whole_mwh(row.energy_kwh);
        let needs_mwh = self.scenario().aircraft_types[kind.at()].needed_mwh(row.energy_kwh);
        if charged_mwh >= needs_mwh {
            return None;
        }
        let (aircraft, to) = (self.id(row.aircraft), self.vertiport_id(to));
        let kwh = |mwh: u64| mwh as f64 / 1e6;
        let has_kwh = kwh(charged_mwh);
        Some(if charged_mwh < flight_mwh {
            Notice::WithoutEnergy { aircraft, to, has_kwh, needs_kwh: kwh(flight_mwh) }
        } else {
            Notice::BelowReserve { aircraft, to, has_kwh, needs_kwh: kwh(needs_mwh) }
        })
    }

    /// The energy that an aircraft on its way lacks.
    pub(super) fn lacks_energy_now(&self, aircraft: AircraftIx) -> Option<Notice> {
        match self.aircraft[aircraft.at()].phase {
            Phase::Standing => None,
            Phase::SentOff { flight, departs: takeoff }
            | Phase::InTheAir { flight, departed: takeoff } => self.lacks_energy(flight, takeoff),
        }
    }

    /// The latest take-off that the landing of an aircraft at a vertiport permits, with its flight;
    /// `None` if it was not sent off.
    pub(super) fn latest_takeoff(
        &self,
        aircraft: AircraftIx,
        landed: Time,
        at: VertiportIx,
    ) -> Option<(usize, Time)> {
        match self.aircraft[aircraft.at()].phase {
            Phase::Standing => None,
            Phase::InTheAir { flight, departed } => Some((flight, departed)),
            // It did not depart before its decision. If it came back, it may never have left.
            Phase::SentOff { flight, .. } => {
                let TraceRow { time: decided, from, .. } = self.decisions[flight].row;
                let kind = self.scenario().aircraft[aircraft.at()].kind;
                let least_s = if at == from {
                    0
                } else {
                    shortest_s(self.known.legs.leg(kind, from, at).flight_s)
                };
                let takeoff = Time::from_seconds(landed.seconds().saturating_sub(least_s));
                Some((flight, takeoff.max(decided)))
            }
        }
    }

    /// Compares the landing of a flight at a vertiport with the time that the aircraft needs.
    pub(super) fn landed_too_soon(
        &self,
        aircraft: AircraftIx,
        time: Time,
        at: VertiportIx,
    ) -> Option<Notice> {
        let (flight, departed) = match self.aircraft[aircraft.at()].phase {
            Phase::Standing => return None,
            // Its departure was not reported, but it did not depart before its decision.
            Phase::SentOff { flight, .. } => (flight, self.decisions[flight].row.time),
            Phase::InTheAir { flight, departed } => (flight, departed),
        };
        let from = self.decisions[flight].row.from;
        if at == from {
            return None;
        }
        let kind = self.scenario().aircraft[aircraft.at()].kind;
        let flight_s = self.known.legs.leg(kind, from, at).flight_s;
        let flown_s = time.since(departed);
        (flown_s < shortest_s(flight_s)).then(|| Notice::TooFast {
            aircraft: self.id(aircraft),
            at: self.vertiport_id(at),
            flown_s,
            flight_s,
        })
    }

    /// Compares the reported charge of an aircraft that lands at a vertiport with the expected one.
    /// A flight there may take half of its energy, but not less. One that came back may have taken
    /// nothing.
    pub(super) fn charged_too_high(
        &self,
        aircraft: AircraftIx,
        time: Time,
        at: VertiportIx,
        charge_kwh: Option<f64>,
    ) -> Option<Notice> {
        let reported_mwh = whole_mwh(charge_kwh?);
        let kind = self.scenario().aircraft[aircraft.at()].kind;
        let battery_kwh = self.scenario().aircraft_types[kind.at()].battery_kwh;
        let of_battery_mwh = whole_mwh(battery_kwh) / 20;
        let (expected_mwh, spare_mwh) = match self.latest_takeoff(aircraft, time, at) {
            None => (self.known.charge_mwh(aircraft, time), of_battery_mwh),
            Some((flight, takeoff)) => {
                let charged_mwh = self.charge_before_mwh(flight, takeoff);
                let from = self.decisions[flight].row.from;
                if at == from {
                    (charged_mwh, of_battery_mwh)
                } else {
                    let flight_mwh = whole_mwh(self.known.legs.leg(kind, from, at).energy_kwh);
                    (charged_mwh.saturating_sub(flight_mwh), flight_mwh / 2)
                }
            }
        };
        (reported_mwh > expected_mwh + spare_mwh).then(|| Notice::ChargeTooHigh {
            aircraft: self.id(aircraft),
            charge_kwh: reported_mwh as f64 / 1e6,
            expected_kwh: expected_mwh as f64 / 1e6,
        })
    }

    /// Compares the time at which an aircraft on the ground is ready with the time that its
    /// turnaround takes and, on days that charge to full, charging. An aircraft that came back to
    /// where it had departed may have nothing to charge.
    pub(super) fn ready_too_soon(&self, aircraft: AircraftIx, ready: Time) -> Option<Notice> {
        let of_aircraft = |one: &&LiveDecision| {
            one.row.aircraft == aircraft && !one.is_undone && one.row.from != one.row.to
        };
        let row = &self.decisions.iter().rev().find(of_aircraft)?.row;
        let landed = self.known.arrival[aircraft.at()];
        let scenario = self.scenario();
        let kind = &scenario.aircraft_types[scenario.aircraft[aircraft.at()].kind.at()];
        let at = &scenario.vertiports[self.known.place[aircraft.at()].at()];
        let came_back = self.known.place[aircraft.at()] == row.from;
        let charge_s = if self.known.batteries.are_always_full() && !came_back {
            refill_s(row.energy_kwh, kind, at)
        } else {
            0
        };
        let (work, takes_s) = if charge_s > kind.turnaround_s {
            ("charging", charge_s)
        } else {
            ("its turnaround", kind.turnaround_s)
        };
        let aircraft = self.id(aircraft);
        (ready < landed || ready.since(landed) < shortest_s(takes_s))
            .then_some(Notice::ReadyTooSoon { aircraft, ready, landed, work, takes_s })
    }
}
