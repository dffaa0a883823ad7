//! How a battery fills over time: the power of a type's curve, limited by its charger and its
//! vertiport, integrated over the charge (page Model, section Energy).
//!
//! Between two points the power is linear in the charge, so the charge is an exponential function
//! of time: from dc/dt = p + k (c - c0) follows c = c0 + p (e^(k t) - 1) / k. Exponentials and
//! logarithms go through the `libm` crate, because the results of the system's library depend on
//! the machine.
//!
//! All times are finite, whatever a checked curve is. A segment has one width, from which both its
//! slope and its charges come, so that the power stays above 0 up to its end: the least power is
//! 1 kW and the greatest 100,000 kW, and k (c - c0) / p is at least -0.99999. No loop here ends by
//! a computed time.

use crate::{AircraftType, CurvePoint, Vertiport};

/// More than the errors of computed seconds of charging, of which there are at most 18 million.
const ROUNDING_S: f64 = 1e-3;
/// The power steps between points of a curve that are less than this apart, mWh: the slope of a
/// line there could exceed every number.
const STEP_MWH: f64 = 1e-200;
/// Milliwatt-hours a second that one kilowatt charges.
const MWH_A_SECOND: f64 = 1e6 / 3600.0;

/// An energy in whole milliwatt-hours, to the nearest.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "energies of a checked day are never negative and below 2^53 mWh"
)]
pub fn whole_mwh(kwh: f64) -> u64 {
    (1e6 * kwh).round() as u64
}

/// A battery that begins to charge at a vertiport.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Battery {
    /// What it holds, mWh.
    pub mwh: u64,
    /// The seconds in which an empty battery would charge as much there. Kept, because logarithms
    /// would take most of the time of a simulation.
    filled_s: f64,
}

/// A charge that a battery at a vertiport should reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Need {
    mwh: u64,
    /// The seconds in which an empty battery would reach it.
    filled_s: f64,
}

impl Need {
    /// Whether a charge is enough, mWh.
    #[inline]
    pub fn is_met_by(self, mwh: u64) -> bool {
        self.mwh <= mwh
    }
}

/// How fast the batteries of one aircraft type charge at one vertiport.
#[derive(Debug, Clone, PartialEq)]
pub struct ChargeRate {
    /// In the order of charge, the first from an empty battery.
    segments: Vec<Segment>,
    /// Capacity of the battery, mWh.
    full_mwh: u64,
    /// Seconds from empty to full.
    full_s: f64,
}

/// A range of charges in which the power is linear.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    /// The charge where it begins, mWh.
    from_mwh: f64,
    /// Energy that is charged in it, mWh; above 0.
    width_mwh: f64,
    /// The seconds that an empty battery charges until then.
    from_s: f64,
    /// Power there, mWh a second.
    power: f64,
    /// Change of the power with the charge, per second; 0 where it is constant.
    slope: f64,
}

impl Segment {
    /// The seconds to a charge of this segment. Below an empty battery, which only flights beyond
    /// the range would leave, the power is that at its start.
    #[inline]
    fn seconds_to(&self, mwh: f64) -> f64 {
        let more = (mwh - self.from_mwh).min(self.width_mwh);
        if self.slope == 0.0 || more < 0.0 {
            return self.from_s + more / self.power;
        }
        self.from_s + libm::log1p(self.slope * more / self.power) / self.slope
    }

    /// The charge at a time, at most that where the segment ends.
    #[inline]
    fn mwh_at(&self, seconds: f64) -> f64 {
        let more_s = seconds - self.from_s;
        let more = if self.slope == 0.0 {
            more_s * self.power
        } else {
            self.power * libm::expm1(self.slope * more_s) / self.slope
        };
        self.from_mwh + more.min(self.width_mwh)
    }
}

impl ChargeRate {
    /// The rate of a type at a vertiport, both of a checked day.
    pub fn of(kind: &AircraftType, vertiport: &Vertiport) -> Self {
        let most_kw = kind.charge_kw.min(vertiport.charger_kw.unwrap_or(f64::INFINITY));
        let constant =
            [CurvePoint { charge: 0.0, kw: most_kw }, CurvePoint { charge: 1.0, kw: most_kw }];
        let curve = kind.charge_curve.as_ref().map_or(&constant[..], |curve| curve.points());
        let full_mwh = whole_mwh(kind.battery_kwh);
        let mut rate = Self { segments: Vec::new(), full_mwh, full_s: 0.0 };
        for points in limited(curve, most_kw).windows(2) {
            rate.push(points[0], points[1]);
        }
        rate
    }

    /// Adds the range between two points, which begins where the last one ends.
    fn push(&mut self, from: CurvePoint, to: CurvePoint) {
        let [from_mwh, to_mwh] = [from, to].map(|point| point.charge * self.full_mwh as f64);
        let width_mwh = to_mwh - from_mwh;
        // A curve may also reach the limit in one of its points.
        if width_mwh < STEP_MWH {
            return;
        }
        let power = from.kw * MWH_A_SECOND;
        let slope = (to.kw * MWH_A_SECOND - power) / width_mwh;
        let segment = Segment { from_mwh, width_mwh, from_s: self.full_s, power, slope };
        self.full_s = segment.seconds_to(to_mwh);
        self.segments.push(segment);
    }

    /// Capacity of the battery, mWh.
    pub fn full_mwh(&self) -> u64 {
        self.full_mwh
    }

    /// The seconds that an empty battery takes to reach a charge, mWh.
    #[inline]
    fn seconds_to(&self, mwh: f64) -> f64 {
        let later = self.segments.partition_point(|segment| segment.from_mwh <= mwh);
        self.segments.get(later.saturating_sub(1)).map_or(0.0, |segment| segment.seconds_to(mwh))
    }

    /// The charge of an empty battery after some seconds, to the nearest mWh.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the capacity, which is below 2^53 mWh"
    )]
    #[inline]
    fn mwh_at(&self, seconds: f64) -> u64 {
        let later = self.segments.partition_point(|segment| segment.from_s <= seconds);
        let segment = self.segments.get(later.saturating_sub(1));
        segment.map_or(0, |segment| segment.mwh_at(seconds).round() as u64)
    }

    /// A battery that begins to charge here.
    #[inline]
    pub fn battery(&self, mwh: u64) -> Battery {
        Battery { mwh, filled_s: self.seconds_to(mwh as f64) }
    }

    /// A charge to reach, at most that of a full battery.
    pub fn need(&self, mwh: u64) -> Need {
        let mwh = mwh.min(self.full_mwh);
        // Charges are rounded to the nearest, so half a milliwatt-hour less is enough.
        Need { mwh, filled_s: self.seconds_to(mwh as f64 - 0.5) }
    }

    /// Seconds of charging from one charge to another that is not lower, kWh.
    pub fn seconds_between(&self, from_kwh: f64, to_kwh: f64) -> f64 {
        self.seconds_to(1e6 * to_kwh) - self.seconds_to(1e6 * from_kwh)
    }

    /// The most that is charged in a second, mWh.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 100,000 kW for a second"
    )]
    pub fn most_in_a_second_mwh(&self) -> u64 {
        let at_end =
            |segment: &Segment, mwh: f64| segment.power + segment.slope * (mwh - segment.from_mwh);
        let ends = self.segments.iter().skip(1).map(|segment| segment.from_mwh);
        let ends = ends.chain([self.full_mwh as f64]);
        let powers = self.segments.iter().zip(ends);
        let most = powers.map(|(segment, end)| segment.power.max(at_end(segment, end)));
        most.fold(0.0, f64::max).ceil() as u64 + 1
    }

    /// Seconds until a battery that has charged for some seconds is full.
    #[inline]
    pub fn to_full_s(&self, from: Battery, seconds: u32) -> f64 {
        if from.mwh >= self.full_mwh {
            return 0.0;
        }
        (self.full_s - (from.filled_s + f64::from(seconds))).max(0.0)
    }

    /// Seconds in which an empty battery is full.
    #[inline]
    pub fn full_s(&self) -> f64 {
        self.full_s
    }

    /// The charge from which a full battery is some seconds away, mWh.
    pub fn with_to_full_mwh(&self, seconds: f64) -> u64 {
        self.mwh_at((self.full_s - seconds).clamp(0.0, self.full_s)).min(self.full_mwh)
    }

    /// The charge after some seconds, to the nearest mWh and at most a full battery.
    #[inline]
    pub fn charged_mwh(&self, from: Battery, seconds: u32) -> u64 {
        if seconds == 0 || from.mwh >= self.full_mwh {
            return from.mwh;
        }
        let at_s = from.filled_s + f64::from(seconds);
        if at_s >= self.full_s {
            return self.full_mwh;
        }
        self.mwh_at(at_s).clamp(from.mwh, self.full_mwh)
    }

    /// The fewest whole seconds after which a battery has the charge that it needs.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "never negative, and a full charge takes at most 5,000 hours"
    )]
    #[inline]
    pub fn needed_s(&self, from: Battery, need: Need) -> u32 {
        if need.is_met_by(from.mwh) {
            return 0;
        }
        let exact_s = (need.filled_s - from.filled_s).max(0.0);
        let seconds = exact_s.ceil();
        let off_s = (exact_s - exact_s.round()).abs();
        if off_s > ROUNDING_S {
            seconds as u32
        } else {
            self.rounded_s(from, need, exact_s.round() as u32)
        }
    }

    /// The same where rounding may matter: the nearest whole number of seconds, if they suffice,
    /// or one more.
    #[cold]
    fn rounded_s(&self, from: Battery, need: Need, nearest_s: u32) -> u32 {
        let suffices = self.charged_mwh(from, nearest_s) >= need.mwh;
        if suffices { nearest_s } else { nearest_s + 1 }
    }
}

/// The points of a curve whose power is limited, with a new point wherever it crosses the limit.
fn limited(curve: &[CurvePoint], most_kw: f64) -> Vec<CurvePoint> {
    let limit = |point: CurvePoint| CurvePoint { kw: point.kw.min(most_kw), ..point };
    let mut points: Vec<CurvePoint> = curve.first().copied().map(limit).into_iter().collect();
    for pair in curve.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        if (from.kw < most_kw) != (to.kw < most_kw) {
            let share = (most_kw - from.kw) / (to.kw - from.kw);
            let charge = (from.charge + share * (to.charge - from.charge)).min(to.charge);
            points.push(CurvePoint { charge, kw: most_kw });
        }
        points.push(limit(to));
    }
    points
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::{Just, Strategy, prop_assert, prop_assert_eq, prop_oneof, proptest};

    use super::{ChargeRate, whole_mwh};
    use crate::{AircraftType, ChargeCurve, CurvePoint, Vertiport};

    fn kind(battery_kwh: f64, charge_kw: f64, curve: &[(f64, f64)]) -> AircraftType {
        let points = curve.iter().map(|&(charge, kw)| CurvePoint { charge, kw }).collect();
        AircraftType {
            id: "T".to_owned(),
            seats: 4,
            speed_mph: 74.5,
            battery_kwh,
            energy_kwh_per_mi: 2.2,
            charge_kw,
            self_discharge_per_h: 0.0,
            reserve_kwh: 0.0,
            turnaround_s: 0,
            charge_curve: (!curve.is_empty()).then(|| ChargeCurve::through(points)),
        }
    }

    fn vertiport(charger_kw: Option<f64>) -> Vertiport {
        Vertiport {
            id: "V".to_owned(),
            x_mi: 0.0,
            y_mi: 0.0,
            stands: 1,
            chargers: None,
            charger_kw,
            busy: false,
            degrees: None,
            stand_cost_usd: 0.0,
            charger_cost_usd: 0.0,
        }
    }

    #[test]
    fn constant_power_charges_energy_by_time() {
        let rate = ChargeRate::of(&kind(110.0, 150.0, &[]), &vertiport(Some(100.0)));
        assert_eq!(rate.charged_mwh(rate.battery(0), 36), whole_mwh(1.0));
        assert_eq!(rate.needed_s(rate.battery(0), rate.need(whole_mwh(1.0))), 36);
        assert_eq!(rate.needed_s(rate.battery(0), rate.need(whole_mwh(1.0) + 1)), 37);
        assert_eq!(rate.charged_mwh(rate.battery(whole_mwh(109.5)), 3600), whole_mwh(110.0));
    }

    #[test]
    fn a_curve_may_begin_at_its_limit() {
        let taper = [(0.0, 150.0), (0.8, 150.0), (1.0, 50.0)];
        let rate = ChargeRate::of(&kind(100.0, 150.0, &taper), &vertiport(None));
        assert_eq!(rate.charged_mwh(rate.battery(0), 1_920), whole_mwh(80.0));
        // The last 20 kWh take 20 / 100 ln 3 hours.
        assert_eq!(rate.needed_s(rate.battery(whole_mwh(80.0)), rate.need(whole_mwh(100.0))), 792);
        assert_eq!(rate.full_s().round(), 2_711.0);
    }

    /// A step that is written as two neighbouring numbers: 100 kWh take 0.8 / 1.5 and 20 hours.
    #[test]
    fn a_step_takes_no_time() {
        let neighbour = 0.8_f64.next_up();
        for step in [
            vec![(0.0, 150.0), (0.8, 150.0), (neighbour, 1.0), (1.0, 1.0)],
            vec![(0.0, 1.0), (5e-324, 150.0), (0.8, 150.0), (neighbour, 1.0), (1.0, 1.0)],
            vec![
                (0.0, 150.0),
                (0.8, 150.0),
                (neighbour, 1e5),
                (neighbour.next_up(), 1.0),
                (1.0, 1.0),
            ],
        ] {
            let rate = ChargeRate::of(&kind(100.0, 150.0, &step), &vertiport(None));
            assert!((rate.full_s() - 73_920.0).abs() < 1e-6, "{} {step:?}", rate.full_s());
            let (empty, full) = (rate.battery(0), rate.need(whole_mwh(100.0)));
            assert_eq!(rate.needed_s(empty, rate.need(whole_mwh(80.0))), 1_920);
            assert_eq!(rate.needed_s(empty, full), 73_920);
            assert_eq!(rate.charged_mwh(empty, 1_920 + 3_600), whole_mwh(81.0));
        }
    }

    #[test]
    fn a_battery_that_holds_nothing_is_full() {
        let rate = ChargeRate::of(&kind(1e-7, 150.0, &[]), &vertiport(None));
        assert_eq!((rate.full_mwh(), rate.full_s()), (0, 0.0));
        assert_eq!(rate.needed_s(rate.battery(0), rate.need(1)), 0);
        assert_eq!((rate.charged_mwh(rate.battery(0), 60), rate.with_to_full_mwh(5.0)), (0, 0));
    }

    /// Any charges, with some of their neighbours, and any powers within the limits.
    fn extreme_curve() -> impl Strategy<Value = Vec<(f64, f64)>> {
        let near = |charge: f64| vec![charge, charge.next_up(), charge.next_up().next_up()];
        let charge =
            prop_oneof![0.0..1.0_f64, (-320.0..0.0_f64).prop_map(|power| 10_f64.powf(power))];
        let clusters = vec(charge.prop_map(near), 0..6);
        let power = || {
            prop_oneof![
                Just(1.0),
                Just(1e5),
                Just(99_999.0),
                (0.0..5.0_f64).prop_map(|power| 10_f64.powf(power))
            ]
        };
        (clusters, vec(power(), 32)).prop_map(|(clusters, powers)| {
            let mut charges = vec![0.0, 5e-324, 1.0_f64.next_down(), 1.0];
            charges.extend(clusters.into_iter().flatten().filter(|&charge| charge < 1.0));
            charges.sort_by(f64::total_cmp);
            charges.dedup();
            charges.into_iter().zip(powers).collect()
        })
    }

    proptest! {
        /// Times lie between those at the greatest and at the least power, and the charge never
        /// falls.
        #[test]
        fn every_time_of_an_extreme_curve_is_finite(
            curve in extreme_curve(), battery_kwh in prop_oneof![Just(5e3), Just(1e-6), 1e-6..5e3_f64],
            charge_kw in prop_oneof![Just(1e5), Just(1.0), 1.0..1e5_f64],
            shares in vec(0.0..=1.0_f64, 8)
        ) {
            let rate = ChargeRate::of(&kind(battery_kwh, charge_kw, &curve), &vertiport(None));
            let full_mwh = rate.full_mwh();
            let slowest_s = 3_600.0 * full_mwh as f64 / 1e6;
            prop_assert!((0.0..=slowest_s * (1.0 + 1e-9)).contains(&rate.full_s()), "{}", rate.full_s());
            prop_assert!(rate.full_s() >= slowest_s / charge_kw * (1.0 - 1e-9) - 1e-6);
            let points = shares.iter().copied().chain(curve.iter().map(|&(charge, _)| charge));
            let charges = points.map(|share| whole_mwh(share * battery_kwh).min(full_mwh));
            let mut charges: Vec<u64> = charges.collect();
            charges.sort_unstable();
            for pair in charges.windows(2) {
                let (from, to) = (rate.battery(pair[0]), rate.need(pair[1]));
                let seconds = rate.needed_s(from, to);
                prop_assert!(rate.charged_mwh(from, seconds) >= pair[1]);
                prop_assert!(seconds == 0 || rate.charged_mwh(from, seconds - 1) < pair[1]);
                let between_s = rate.seconds_between(pair[0] as f64 / 1e6, pair[1] as f64 / 1e6);
                prop_assert!((0.0..=slowest_s * (1.0 + 1e-9)).contains(&between_s), "{between_s}");
            }
        }

        /// The curve is integrated in steps of a hundredth of a second.
        #[test]
        fn charges_agree_with_small_steps(
            kw in proptest::collection::vec(5.0..400.0_f64, 3),
            middle in 0.05..0.95_f64, most_kw in 20.0..300.0_f64,
            start in 0.0..1.0_f64, seconds in 0_u32..2000
        ) {
            let curve = [(0.0, kw[0]), (middle, kw[1]), (1.0, kw[2])];
            let rate = ChargeRate::of(&kind(100.0, 500.0, &curve), &vertiport(Some(most_kw)));
            let power = |share: f64| {
                let (from, to) =
                    if share < middle { (curve[0], curve[1]) } else { (curve[1], curve[2]) };
                let kw = from.1 + (to.1 - from.1) * (share - from.0) / (to.0 - from.0);
                kw.min(most_kw)
            };
            let mut kwh = 100.0 * start;
            for _ in 0..seconds * 100 {
                let half = (kwh + power(kwh / 100.0) * 0.005 / 3600.0).min(100.0);
                kwh = (kwh + power(half / 100.0) * 0.01 / 3600.0).min(100.0);
            }
            let charged = rate.charged_mwh(rate.battery(whole_mwh(100.0 * start)), seconds) as f64 / 1e6;
            prop_assert!((charged - kwh).abs() < 1e-3, "{charged} {kwh}");
        }

        #[test]
        fn the_seconds_needed_are_the_fewest(
            kw in proptest::collection::vec(1.0..400.0_f64, 3), middle in 0.05..0.95_f64,
            from in 0_u64..100_000_000, to in 0_u64..=100_000_000
        ) {
            let curve = [(0.0, kw[0]), (middle, kw[1]), (1.0, kw[2])];
            let rate = ChargeRate::of(&kind(100.0, 300.0, &curve), &vertiport(None));
            let battery = rate.battery(from);
            let seconds = rate.needed_s(battery, rate.need(to));
            prop_assert!(rate.charged_mwh(battery, seconds) >= to);
            if seconds > 0 {
                prop_assert!(rate.charged_mwh(battery, seconds - 1) < to);
            } else {
                prop_assert!(from >= to);
            }
            prop_assert_eq!(rate.charged_mwh(battery, 0), from);
        }
    }
}
