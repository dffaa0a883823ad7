//! What a battery holds from a landing until the next take-off, on days that charge as needed (page
//! Model, section Energy).

use vertifleet_core::{Battery, Need, Time, TypeIx, VertiportIx};

use crate::Legs;

/// The latest landing of an aircraft, or the start of operations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Landed {
    /// The time from which on it charges.
    pub arrival: Time,
    /// Its battery then; empty on days that charge to full.
    pub battery: Battery,
}

/// For days that charge as needed. The others panic.
impl Legs {
    /// The battery of a type that begins to charge at a vertiport with a charge, mWh.
    #[inline]
    pub fn battery(&self, kind: TypeIx, at: VertiportIx, mwh: u64) -> Battery {
        self.rate(kind, at).battery(mwh)
    }

    /// The charge at a time from the landing until take-off of a type that stands at a vertiport,
    /// mWh.
    #[inline]
    pub fn charge_mwh(&self, kind: TypeIx, at: VertiportIx, landed: Landed, time: Time) -> u64 {
        self.rate(kind, at).charged_mwh(landed.battery, time.since(landed.arrival))
    }

    /// The first time, not before its decision, at which the charge suffices for a flight.
    #[inline]
    pub fn takeoff(
        &self,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
        landed: Landed,
        decided: Time,
    ) -> Time {
        let need = self.need(kind, (from, to));
        decided.max(landed.arrival + self.rate(kind, from).needed_s(landed.battery, need))
    }

    /// The charge that a flight needs at its take-off.
    #[inline]
    pub fn need(&self, kind: TypeIx, pair: (VertiportIx, VertiportIx)) -> Need {
        self.charge_of(kind, pair).need
    }

    /// The battery with which a flight lands that leaves at a time. A flight that a report forces
    /// may take more than there is.
    #[inline]
    pub fn lands_with(
        &self,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
        landed: Landed,
        left: Time,
    ) -> Battery {
        let charge_mwh = self.charge_mwh(kind, from, landed, left);
        self.battery(kind, to, self.left_mwh(kind, (from, to), charge_mwh))
    }

    /// What is left of a charge after a flight, mWh.
    #[inline]
    pub fn left_mwh(&self, kind: TypeIx, pair: (VertiportIx, VertiportIx), charge_mwh: u64) -> u64 {
        charge_mwh.saturating_sub(self.charge_of(kind, pair).energy_mwh)
    }
}
