//! The times, energy, revenue and costs of one flight as the rules determine them (Eq. 2-4, 7, 9,
//! 13-15), and when an aircraft decides first.

use vertifleet_core::{Aircraft, Charging, Scenario};

use super::charger::Charger;
use super::event::{Event, period_of};
use super::rounding::{nearest, whole_mwh};

/// One flight as the rules determine it. Times are seconds since midnight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Expected {
    /// When the battery suffices; the flight is late by `delay_s` besides.
    pub(super) takeoff_s: u64,
    pub(super) arrival_s: u64,
    pub(super) ready_s: u64,
    /// When the turnaround is over, which is part of `ready_s`.
    pub(super) turned_around_s: u64,
    /// The seconds by which a delayed take-off makes `arrival_s` later.
    pub(super) delay_s: u64,
    /// Whether an outage, rather than charging or the turnaround, determines when the aircraft is
    /// ready.
    pub(super) out_of_service: bool,
    pub(super) energy_kwh: f64,
    pub(super) revenue_usd: f64,
    pub(super) passenger_cost_usd: f64,
    pub(super) energy_cost_usd: f64,
    pub(super) flight_cost_usd: f64,
}

impl Expected {
    /// Determines the flight of `event` from the time of its decision and the passengers on board
    /// that its row states. The battery suffices at `takeoff_s`, on most days at the decision.
    pub(super) fn of(scenario: &Scenario, event: &Event<'_>, takeoff_s: u64) -> Self {
        let (operations, kind, row) = (&scenario.operations, event.kind, event.row);
        let distance_mi = scenario.distance_mi[event.pair()];
        let time_s = u64::from(row.time.seconds());

        let airborne_s = takeoff_s + u64::from(operations.takeoff_s);
        let landing_s = u64::from(operations.landing_s);
        let delay_s = delay_s(scenario, event);
        let on_the_way_s = airborne_s + delay_s + landing_s;
        let stated_cruise_s = u64::from(row.arrival.seconds()).checked_sub(on_the_way_s);
        let cruise_s = nearest(3600.0 * distance_mi / kind.speed_mph, stated_cruise_s);
        let arrival_s = on_the_way_s + cruise_s;

        // A delayed flight waits on the ground, where the charger makes up for what the battery
        // loses.
        let flight_h = (arrival_s - delay_s - takeoff_s) as f64 / 3600.0;
        let lost_kwh = kind.battery_kwh * kind.self_discharge_per_h * flight_h;
        let energy_kwh = kind.energy_kwh_per_mi * distance_mi + lost_kwh;
        let turned_around_s = arrival_s + u64::from(kind.turnaround_s);
        let charged_s = match operations.charging {
            Charging::AsNeeded => arrival_s,
            Charging::ToFull => {
                let stated_charge_s = u64::from(row.ready.seconds()).checked_sub(arrival_s);
                arrival_s + Charger::of(kind, event.to).refill_s(energy_kwh, stated_charge_s)
            }
        };
        let ready_again_s = charged_s.max(turned_around_s);
        let fit_again_s = fit_again_s(scenario, event, arrival_s);

        let passengers = f64::from(row.passengers);
        let fares_usd = scenario.fare_usd.in_period(period_of(scenario, time_s));
        Self {
            takeoff_s,
            arrival_s,
            ready_s: ready_again_s.max(fit_again_s),
            turned_around_s,
            delay_s,
            out_of_service: fit_again_s > ready_again_s,
            energy_kwh,
            revenue_usd: passengers * fares_usd[event.pair()],
            passenger_cost_usd: passengers * scenario.passenger_cost_usd[event.pair()],
            energy_cost_usd: energy_kwh * scenario.energy_price_usd[period_of(scenario, arrival_s)],
            flight_cost_usd: scenario.flight_cost_usd[event.pair()],
        }
    }

    /// The flight's energy in whole milliwatt-hours, rounded as the row states it where that is in
    /// doubt.
    pub(super) fn energy_mwh(&self, event: &Event<'_>) -> u64 {
        nearest(1e6 * self.energy_kwh, Some(whole_mwh(event.row.energy_kwh.clamp(0.0, 1e9))))
    }

    /// What the battery holds at take-off at least, in whole milliwatt-hours: the flight's energy
    /// and the reserve, each rounded.
    pub(super) fn needed_mwh(&self, event: &Event<'_>) -> u64 {
        self.energy_mwh(event) + whole_mwh(event.kind.reserve_kwh)
    }

    /// Whether a full battery lasts for the flight (Eq. 12).
    pub(super) fn within_range(&self, event: &Event<'_>) -> bool {
        self.needed_mwh(event) <= whole_mwh(event.kind.battery_kwh)
    }
}

/// When an aircraft decides first, in seconds since midnight. Where it is in doubt to which second
/// its charging is rounded, `stated_s` is taken if it is one of the two.
pub(super) fn first_decision_s(scenario: &Scenario, aircraft: &Aircraft, stated_s: u64) -> u64 {
    let start_s = u64::from(scenario.operations.start.seconds());
    match (scenario.operations.charging, aircraft.start_charge_kwh) {
        (Charging::ToFull, Some(charge_kwh)) => {
            let kind = &scenario.aircraft_types[aircraft.kind.at()];
            let charger = Charger::of(kind, &scenario.vertiports[aircraft.at.at()]);
            let lacking_kwh = kind.battery_kwh - charge_kwh;
            start_s + charger.refill_s(lacking_kwh, stated_s.checked_sub(start_s))
        }
        (Charging::AsNeeded, _) | (_, None) => start_s,
    }
}

/// Seconds by which the flight takes off late: the delay of its vertiport in the slot of its
/// decision.
fn delay_s(scenario: &Scenario, event: &Event<'_>) -> u64 {
    let Some(delays) = &scenario.disturbances.takeoff_delays else { return 0 };
    let into_day_s = event.row.time.seconds().saturating_sub(scenario.operations.start.seconds());
    let slot = delays.delay_s.get(into_day_s as usize / delays.slot_s as usize);
    slot.map_or(0, |slot| slot[event.row.from.at()].into())
}

/// The latest end of the outages during which the aircraft lands, or 0 if it lands during none.
fn fit_again_s(scenario: &Scenario, event: &Event<'_>, arrival_s: u64) -> u64 {
    let own = scenario.disturbances.outages.iter().filter(|outage| {
        outage.aircraft == event.row.aircraft
            && u64::from(outage.start.seconds()) <= arrival_s
            && arrival_s < u64::from(outage.end.seconds())
    });
    own.map(|outage| outage.end.seconds().into()).max().unwrap_or(0)
}
