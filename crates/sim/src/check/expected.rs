//! The times, energy, revenue and costs of one flight as the rules determine them (Eq. 2-4, 7, 9,
//! 13-15).

use vertifleet_core::Scenario;

use super::event::{Event, period_of};

/// Two ways to compute the same `f64` may differ by this share of it: far more than a handful of
/// roundings, and far less than the precision of any input.
const ROUNDING: f64 = 1e-12;

/// One flight as the rules determine it. Times are seconds since midnight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Expected {
    pub(super) arrival_s: u64,
    pub(super) ready_s: u64,
    /// The seconds by which a delayed take-off makes `arrival_s` later.
    pub(super) delay_s: u64,
    /// Whether an outage, rather than charging, determines when the aircraft is ready.
    pub(super) out_of_service: bool,
    pub(super) energy_kwh: f64,
    pub(super) revenue_usd: f64,
    pub(super) passenger_cost_usd: f64,
    pub(super) energy_cost_usd: f64,
    pub(super) flight_cost_usd: f64,
}

impl Expected {
    /// Determines the flight of `event` from the time of its decision and the passengers on board
    /// that its row states.
    pub(super) fn of(scenario: &Scenario, event: &Event<'_>) -> Self {
        let (operations, kind, row) = (&scenario.operations, event.kind, event.row);
        let distance_mi = scenario.distance_mi[event.pair()];
        let time_s = u64::from(row.time.seconds());

        let airborne_s = time_s + u64::from(operations.takeoff_s);
        let landing_s = u64::from(operations.landing_s);
        let delay_s = delay_s(scenario, event);
        let on_the_way_s = airborne_s + delay_s + landing_s;
        let stated_cruise_s = u64::from(row.arrival.seconds()).checked_sub(on_the_way_s);
        let cruise_s = nearest(3600.0 * distance_mi / kind.speed_mph, stated_cruise_s);
        let arrival_s = on_the_way_s + cruise_s;

        // A delayed flight waits on the ground, where the charger makes up for what the battery
        // loses.
        let flight_h = (arrival_s - delay_s - time_s) as f64 / 3600.0;
        let lost_kwh = kind.battery_kwh * kind.self_discharge_per_h * flight_h;
        let energy_kwh = kind.energy_kwh_per_mi * distance_mi + lost_kwh;
        let stated_charge_s = u64::from(row.ready.seconds()).checked_sub(arrival_s);
        let charge_s = nearest(3600.0 * energy_kwh / kind.charge_kw, stated_charge_s);

        let full_again_s = arrival_s + charge_s;
        let fit_again_s = fit_again_s(scenario, event, arrival_s);

        let passengers = f64::from(row.passengers);
        let fares_usd = scenario.fare_usd.in_period(period_of(scenario, time_s));
        Self {
            arrival_s,
            ready_s: full_again_s.max(fit_again_s),
            delay_s,
            out_of_service: fit_again_s > full_again_s,
            energy_kwh,
            revenue_usd: passengers * fares_usd[event.pair()],
            passenger_cost_usd: passengers * scenario.passenger_cost_usd[event.pair()],
            energy_cost_usd: energy_kwh * scenario.energy_price_usd[period_of(scenario, arrival_s)],
            flight_cost_usd: scenario.flight_cost_usd[event.pair()],
        }
    }

    /// Whether a battery of this capacity lasts for the flight. Both energies are rounded to whole
    /// milliwatt-hours.
    pub(super) fn fits(&self, battery_kwh: f64) -> bool {
        (self.energy_kwh * 1e6).round() <= (battery_kwh * 1e6).round()
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

/// A duration rounded to the nearest second, half a second up. Where the duration is half a second
/// and `f64` does not show which side is nearer, `stated` is taken if it is one of the two
/// neighbours.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "finite and never negative"
)]
fn nearest(seconds: f64, stated: Option<u64>) -> u64 {
    let past_half = seconds.fract() - 0.5;
    let in_doubt = past_half.abs() <= seconds * ROUNDING;
    let down = seconds as u64;
    match stated {
        Some(stated) if in_doubt && (down..=down + 1).contains(&stated) => stated,
        _ if past_half >= 0.0 => down + 1,
        _ => down,
    }
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn durations_go_to_the_nearest_second_and_halves_go_up() {
        for (seconds, rounded) in [
            (0.0, 0),
            (0.4, 0),
            (0.499_999, 0),
            (0.5, 1),
            (1.6, 2),
            (562.5, 563),
            (3.6e9, 3_600_000_000),
        ] {
            assert_eq!(nearest(seconds, None), rounded, "{seconds}");
        }
    }

    #[test]
    fn only_at_half_a_second_may_a_schedule_choose_the_rounding() {
        // 12.3 miles at 80 mph take half a second exactly, which in binary is on one side or the
        // other.
        let half = 3600.0 * 12.3 / 80.0;
        assert_eq!(nearest(half, Some(553)), 553);
        assert_eq!(nearest(half, Some(554)), 554);
        assert_eq!(nearest(half, Some(555)), 554);
        assert_eq!(nearest(553.499_999, Some(554)), 553);
        assert_eq!(nearest(553.500_001, Some(553)), 554);
    }
}
