//! What is in the battery of an aircraft on days that charge as needed, as the simulator has it.

use vertifleet_core::{
    AircraftIx, Battery, Charging, Scenario, Time, TypeIx, VertiportIx, whole_mwh,
};
use vertifleet_sim::{Landed, Legs};

/// The batteries of a day that charges as needed.
#[derive(Debug)]
pub(super) struct Batteries {
    pub(super) legs: Legs,
    /// By aircraft.
    start: Vec<Battery>,
}

impl Batteries {
    /// The batteries of a day; `None` if it charges to full.
    pub(super) fn of(scenario: &Scenario) -> Option<Self> {
        if scenario.operations.charging == Charging::ToFull {
            return None;
        }
        let legs = Legs::of(scenario);
        let start = scenario.aircraft.iter().map(|aircraft| {
            let rate = legs.rate(aircraft.kind, aircraft.at);
            rate.battery(whole_mwh(scenario.start_charge_kwh(aircraft)))
        });
        Some(Self { start: start.collect(), legs })
    }

    /// The battery with which an aircraft starts the day.
    pub(super) fn start(&self, aircraft: AircraftIx) -> Battery {
        self.start[aircraft.at()]
    }

    /// The second at which a battery is full.
    pub(super) fn full_s(&self, kind: TypeIx, at: VertiportIx, landed: Landed) -> u32 {
        let rate = self.legs.rate(kind, at);
        landed.arrival.seconds() + rate.needed_s(landed.battery, rate.need(rate.full_mwh()))
    }

    /// The part of a full battery that a type has charged at a second, as one of `of` numbers from
    /// 0, by the time that the battery takes to charge.
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    pub(super) fn part(
        &self,
        kind: TypeIx,
        at: VertiportIx,
        landed: Landed,
        time_s: u32,
        of: usize,
    ) -> usize {
        let rate = self.legs.rate(kind, at);
        let charged_s = Time::from_seconds(time_s).since(landed.arrival);
        let left = rate.to_full_s(landed.battery, charged_s) / rate.full_s();
        (((1.0 - left) * of as f64) as usize).min(of - 1)
    }
}
