//! What follows from a choice if nothing is late.

use vertifleet_core::{Time, VertiportIx};

use crate::{Decision, Simulation};

/// The next times of an aircraft after a choice, if nothing is late.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outcome {
    /// When it takes off: at the decision, or once its charge suffices. A hold has the time of the
    /// decision.
    pub takeoff: Time,
    /// When it lands; a hold has the time of the decision.
    pub arrival: Time,
    /// When it decides next.
    pub ready: Time,
    /// What its battery holds then, mWh; 0 on days that charge to full.
    pub charge_mwh: u64,
}

impl Outcome {
    #[inline]
    pub(crate) fn of(day: &Simulation, decision: &Decision, to: VertiportIx) -> Self {
        let Decision { aircraft, at, time, .. } = *decision;
        let keeps_charge = day.legs().charge_as_needed();
        if to == at {
            let ready = time + day.scenario().operations.hold_s;
            let charge_mwh = if keeps_charge { day.charge_mwh(aircraft, ready) } else { 0 };
            return Self { takeoff: time, arrival: time, ready, charge_mwh };
        }
        let kind = day.scenario().aircraft[aircraft.at()].kind;
        let leg = day.legs().leg(kind, at, to);
        let takeoff = if keeps_charge { day.takeoff(decision, to) } else { time };
        let arrival = takeoff + leg.flight_s;
        let charge_mwh = if keeps_charge {
            let landed = day.legs().lands_with(kind, (at, to), day.landed(aircraft), takeoff);
            day.legs().rate(kind, to).charged_mwh(landed, leg.ground_s)
        } else {
            0
        };
        Self { takeoff, arrival, ready: arrival + leg.ground_s, charge_mwh }
    }
}
