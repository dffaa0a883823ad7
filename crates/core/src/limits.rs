//! Bounds of every number in a network or scenario, in one place, and their wording in messages.
//!
//! The bounds are wide. They keep every sum of durations, seats or dollars within the range of its
//! type, and they reveal a misplaced decimal point when the file is read rather than as a strange
//! result.

use std::fmt::Debug;

use crate::{FormatError, Time};

/// The values that a number may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    least: f64,
    most: f64,
    /// Whether `least` itself is refused.
    above: bool,
    whole: bool,
    hint: Option<&'static str>,
}

impl Limits {
    const fn between(least: f64, most: f64) -> Self {
        Self { least, most, above: false, whole: false, hint: None }
    }

    const fn above_zero(most: f64) -> Self {
        Self { least: 0.0, most, above: true, whole: false, hint: None }
    }

    const fn whole(least: u32, most: u32) -> Self {
        Self { least: least as f64, most: most as f64, above: false, whole: true, hint: None }
    }

    const fn hint(self, hint: &'static str) -> Self {
        Self { hint: Some(hint), ..self }
    }

    /// Refuses a `value` outside the limits. `member` is called for the member's name only then.
    pub(crate) fn check(
        &self,
        value: f64,
        member: impl FnOnce() -> String,
    ) -> Result<(), FormatError> {
        let Some(rule) = self.broken(value) else { return Ok(()) };
        Err(FormatError::OutOfRange {
            member: member(),
            rule,
            found: number(value),
            hint: self.hint,
        })
    }

    /// Checks a number and converts it to a type that holds every whole number within these limits.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked: whole and within u32"
    )]
    pub(crate) fn whole_number<T: TryFrom<u32, Error: Debug>>(
        &self,
        value: f64,
        member: impl FnOnce() -> String,
    ) -> Result<T, FormatError> {
        debug_assert!(self.whole, "limits of a whole number");
        self.check(value, member)?;
        Ok(T::try_from(value as u32).expect("the type holds every number within the limits"))
    }

    /// The requirement of the rule that `value` breaks, if it breaks one.
    fn broken(&self, value: f64) -> Option<String> {
        if !value.is_finite() {
            return Some("a finite number".to_owned());
        }
        if self.whole && value.fract() != 0.0 {
            return Some("a whole number".to_owned());
        }
        if self.above && value <= self.least {
            return Some(format!("more than {}", number(self.least)));
        }
        if value < self.least {
            return Some(format!("at least {}", number(self.least)));
        }
        (value > self.most).then(|| format!("at most {}", number(self.most)))
    }
}

/// A number in the shortest form that reads back as the same number: `110`, `0.64`, `1e300`.
pub(crate) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude != 0.0 && !(1e-5..1e16).contains(&magnitude) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// The most entries of each list.
pub(crate) mod entries {
    pub(crate) const VERTIPORTS: usize = 256;
    pub(crate) const AIRCRAFT: usize = 10_000;
    pub(crate) const AIRCRAFT_TYPES: usize = 64;
    pub(crate) const PERIODS: usize = 1_440;
    pub(crate) const CORRIDORS: usize = 65_536;
    pub(crate) const CLOSURES: usize = 10_000;
    pub(crate) const OUTAGES: usize = 10_000;
    pub(crate) const CURVE_POINTS: usize = 32;
    /// Cells of all demand tables together, bounded so that many copies of a day fit in memory and
    /// one fits in the longest file.
    pub(crate) const DEMAND: usize = 4_000_000;
}

/// Seeds are below 2^53, because every JSON reader holds such whole numbers exactly.
pub(crate) const SEED_LIMIT: u64 = 1 << 53;

/// The latest time of day that operations and periods may name.
pub(crate) const LATEST: Time = Time::from_seconds(36 * 3600);

/// The shortest take-off and landing together. A flight over no distance lasts this long, which
/// bounds the number of decisions of a day.
pub(crate) const FLIGHT_S: Limits = Limits::between(60.0, f64::INFINITY)
    .hint("flights that take no time would let a day go on for ever");
pub(crate) const PHASE_S: Limits = Limits::whole(0, 86_400);
pub(crate) const HOLD_S: Limits =
    Limits::whole(60, 86_400).hint("an aircraft that holds is asked again after hold_s seconds");
/// `check.rs` further bounds it by the length of the demand periods.
pub(crate) const PASSENGER_WAIT_S: Limits = Limits::whole(0, 86_400).hint(PASSENGER_WAIT_HINT);
pub(crate) const PASSENGER_WAIT_HINT: &str = "passengers wait for passenger_wait_s seconds into the next demand period, and into no period after it";

pub(crate) const POSITION_MI: Limits = Limits::between(-1e6, 1e6);
pub(crate) const STANDS: Limits = Limits::whole(1, 10_000)
    .hint("stands counts the aircraft that are at the vertiport or on their way to it");

pub(crate) const CHARGERS: Limits = Limits::whole(1, 10_000)
    .hint("chargers counts the aircraft that charge at the vertiport or are on their way to it");

/// A slot of delays lasts at least as long as the shortest flight, so that a day has a bounded
/// number of slots.
pub(crate) const SLOT_S: Limits = Limits::whole(60, 86_400);

pub(crate) const SEATS: Limits =
    Limits::whole(1, 1_000).hint("seats counts passengers, not the pilot");
// The least speed and charging power bound a flight to 1,000 hours and a charge to 5,000, so that
// every time of a day can be written in the four digits for hours that `Time` reads.
pub(crate) const SPEED_MPH: Limits = Limits::between(10.0, 1_000.0);
pub(crate) const BATTERY_KWH: Limits = Limits::above_zero(5_000.0);
pub(crate) const ENERGY_KWH_PER_MI: Limits = Limits::above_zero(1e3);
pub(crate) const CHARGE_KW: Limits = Limits::between(1.0, 1e5);
/// `check/energy.rs` further bounds it by the battery.
pub(crate) const RESERVE_KWH: Limits = Limits::between(0.0, 5_000.0);
/// `check/energy.rs` further bounds it by the battery.
pub(crate) const CHARGE_KWH: Limits = Limits::between(0.0, 5_000.0);
pub(crate) const SHARE: Limits =
    Limits::between(0.0, 1.0).hint("a charge is a share of the battery, 0.8 is 80 %");
/// The two numbers of a point of a charge curve.
pub(crate) const CURVE_CHARGE: Limits = Limits::between(0.0, 1.0).hint(CURVE_POINT);
pub(crate) const CURVE_KW: Limits = CHARGE_KW.hint(CURVE_POINT);
const CURVE_POINT: &str = "a point of a curve is [charge, power]: a share of the battery from 0 to 1, and kW from 1 to 100000";
pub(crate) const SELF_DISCHARGE_PER_H: Limits = Limits::between(0.0, 1.0)
    .hint("self-discharge is a share of the battery's capacity, 0.01 is 1 %");

pub(crate) const DISTANCE_MI: Limits = Limits::between(0.0, 1e4);
pub(crate) const MONEY_USD: Limits = Limits::between(0.0, 1e6);
pub(crate) const ENERGY_PRICE_USD: Limits =
    Limits::between(0.0, 1e3).hint("the price is in dollars per kWh");
/// Tariffs in dollars a passenger-mile, and the numbers that turn costs into fares. The fares have
/// separate bounds.
pub(crate) const TARIFF: Limits = Limits::between(0.0, 1e3);
pub(crate) const FEATURE_SCALE: Limits =
    Limits::above_zero(1e9).hint("a learned policy observes each quantity divided by its scale");
/// A type may have no aircraft, so that studies can remove it; the whole fleet has at least one.
pub(crate) const FLEET_COUNT: Limits = Limits::whole(0, 10_000);
/// Mean and standard deviation of a period's demand; far enough below `PASSENGERS` for any draw to
/// stay within it.
pub(crate) const DEMAND_MEAN: Limits = Limits::between(0.0, 1e5);
pub(crate) const DEMAND_SD: Limits = Limits::between(0.0, 1e4);
/// Mean passengers of a pair in a whole day, and a network's total of them.
pub(crate) const DAILY_DEMAND: Limits = Limits::between(0.0, 1e5);
pub(crate) const SHARE_PERCENT: Limits = Limits::between(0.0, 100.0).hint("100 is the whole day");
pub(crate) const WEIGHT: Limits = Limits::between(0.0, 1e6);
/// Standard deviation as a share of the mean. Draws stay within `PASSENGERS`, because a normal
/// deviation is below 10.
pub(crate) const NOISE: Limits = Limits::between(0.0, 0.4)
    .hint("noise is a standard deviation as a share of the mean, 0.1 is 10 %");
/// The variance of passengers in excess of a Poisson draw's, as a share of the mean's square. A
/// dispersion far below the least would be lost in the rounding of the gamma draw.
pub(crate) const DISPERSION: Limits =
    Limits::between(1e-6, 10.0).hint("the variance is mean + dispersion x mean^2");
pub(crate) const PROBABILITY: Limits =
    Limits::between(0.0, 1.0).hint("a probability is a share, 0.1 is 10 %");
pub(crate) const SURGE_FACTOR: Limits = Limits::between(1.0, 10.0);
/// A factor on the whole demand of a network. Draws times this and times the response to fares are
/// cut at `PASSENGERS`.
pub(crate) const DEMAND_FACTOR: Limits = Limits::between(0.0, 100.0);
pub(crate) const ELASTICITY: Limits = Limits::between(0.0, 20.0)
    .hint("elasticity is by how many percent demand falls where fares rise by one percent, 1.2 for example");
pub(crate) const FARE_FACTOR: Limits = Limits::between(0.0, 100.0);
pub(crate) const LATITUDE: Limits = Limits::between(-89.0, 89.0).hint("degrees, north is above 0");
pub(crate) const LONGITUDE: Limits =
    Limits::between(-180.0, 180.0).hint("degrees, east is above 0");
pub(crate) const MOST_PASSENGERS: f64 = 1_000_000.0;
pub(crate) const UNIFORM_DEMAND: Limits = Limits::whole(0, 100_000);
pub(crate) const PASSENGERS: Limits = Limits::whole(0, 1_000_000);

#[cfg(test)]
mod tests {
    use super::{
        BATTERY_KWH, CHARGE_KW, CHARGE_KWH, CHARGERS, DISTANCE_MI, ENERGY_KWH_PER_MI,
        ENERGY_PRICE_USD, HOLD_S, LATITUDE, LONGITUDE, Limits, MONEY_USD, PASSENGER_WAIT_S,
        PASSENGERS, PHASE_S, RESERVE_KWH, SEATS, SELF_DISCHARGE_PER_H, SLOT_S, SPEED_MPH, STANDS,
        entries,
    };

    /// A number as it is written in the book: `1,000,000`.
    fn grouped(value: f64) -> String {
        let digits = format!("{}", value.abs());
        let groups: Vec<&[u8]> = digits.as_bytes().rchunks(3).rev().collect();
        let groups: Vec<&str> =
            groups.iter().map(|group| str::from_utf8(group).expect("digits")).collect();
        format!("{}{}", if value < 0.0 { "-" } else { "" }, groups.join(","))
    }

    /// Limits as they are written in the book.
    fn stated(Limits { least, most, above, whole, .. }: Limits) -> String {
        let most = grouped(most);
        match (above, whole) {
            (true, _) => format!("above {}, to {most}", grouped(least)),
            (false, true) => format!("whole, {} to {most}", grouped(least)),
            (false, false) => format!("{} to {most}", grouped(least)),
        }
    }

    #[test]
    fn the_page_of_the_scenario_file_states_these_limits() {
        let page = include_str!("../../../docs/src/reference/files.md");
        let (_, page) = page.split_once("\n## The scenario file\n").expect("a section");
        let row = |member: &str| {
            let begin = format!("| {member} |");
            let row = page.lines().find(|line| line.starts_with(&begin));
            row.unwrap_or_else(|| panic!("{member} has no row"))
        };
        for (member, limits) in [
            ("`operations` `takeoff_s`, `landing_s`", PHASE_S),
            ("`operations` `hold_s`", HOLD_S),
            ("`operations` `passenger_wait_s`", PASSENGER_WAIT_S),
            ("`vertiports` `stands`", STANDS),
            ("`vertiports` `chargers`", CHARGERS),
            ("`vertiports` `stand_cost`, `charger_cost`", MONEY_USD),
            ("`vertiports` `latitude`, `longitude`", LATITUDE),
            ("`vertiports` `latitude`, `longitude`", LONGITUDE),
            ("`aircraft_types` `seats`", SEATS),
            ("`aircraft_types` `speed_mph`", SPEED_MPH),
            ("`aircraft_types` `battery_kwh`", BATTERY_KWH),
            ("`aircraft_types` `energy_kwh_per_mi`", ENERGY_KWH_PER_MI),
            ("`aircraft_types` `charge_kw`", CHARGE_KW),
            ("`aircraft_types` `self_discharge_per_h`", SELF_DISCHARGE_PER_H),
            ("`aircraft_types` `reserve_kwh`", RESERVE_KWH),
            ("`aircraft_types` `turnaround_s`", PHASE_S),
            ("`aircraft` `start_charge_kwh`", CHARGE_KWH),
            ("`vertiports` `charger_kw`", CHARGE_KW),
            ("`distance_mi`", DISTANCE_MI),
            ("`fare`", MONEY_USD),
            ("`passenger_cost`", MONEY_USD),
            ("`flight_cost`", MONEY_USD),
            ("`aircraft_cost`", MONEY_USD),
            ("`demand`", PASSENGERS),
            ("`energy_price`", ENERGY_PRICE_USD),
        ] {
            let stated = stated(limits);
            assert!(row(member).contains(&stated), "{member}: {stated} is not in {}", row(member));
        }
        assert!(row("`takeoff_delays`").contains(&format!("`slot_s` {}", &stated(SLOT_S)[7..])));
        for (member, most) in [
            ("`vertiports` `id`", entries::VERTIPORTS),
            ("`aircraft_types` `id`", entries::AIRCRAFT_TYPES),
            ("`aircraft` `id`, `type`, `at`", entries::AIRCRAFT),
            ("`periods`", entries::PERIODS),
            ("`corridors`", entries::CORRIDORS),
        ] {
            let stated = format!("1 to {}", grouped(most as f64));
            assert!(row(member).contains(&stated), "{member}: {stated}");
        }
    }
}
