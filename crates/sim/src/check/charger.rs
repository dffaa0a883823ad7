//! The time that charging takes, and what a battery holds after a time of it (page Model, section
//! Energy).
//!
//! Between two points of a curve the power is linear in the charge, so the charge follows an
//! exponential and the time a logarithm: dE/dt = p(E) = p0 + m (E - E0) gives t = ln(p1 / p0) / m.
//! The functions come from `libm`, so that a report is the same on every machine.

use vertifleet_core::{AircraftType, ChargeCurve, CurvePoint, Vertiport};

use super::rounding::{ROUNDING, nearest_within, whole_mwh};

/// A time of charging from empty to full is known to this share of it, by any way to add up the
/// times of its pieces.
const TIME_ROUNDING: f64 = 1e-15;

/// An aircraft's battery at a vertiport's charger.
#[derive(Debug, Clone, Copy)]
pub(super) struct Charger<'a> {
    battery_kwh: f64,
    /// The battery in whole milliwatt-hours, of which the charges of a curve are shares.
    full_kwh: f64,
    /// The most power that aircraft and vertiport allow.
    pub(super) kw: f64,
    curve: Option<&'a [CurvePoint]>,
}

/// A part of the battery in which the power is linear in the charge.
#[derive(Debug, Clone, Copy)]
struct Piece {
    from_kwh: f64,
    to_kwh: f64,
    from_kw: f64,
    to_kw: f64,
}

impl<'a> Charger<'a> {
    pub(super) fn of(kind: &'a AircraftType, vertiport: &Vertiport) -> Self {
        let kw = vertiport.charger_kw.map_or(kind.charge_kw, |limit| limit.min(kind.charge_kw));
        let curve = kind.charge_curve.as_ref().map(ChargeCurve::points);
        let full_kwh = whole_mwh(kind.battery_kwh) as f64 / 1e6;
        Self { battery_kwh: kind.battery_kwh, full_kwh, kw, curve }
    }

    /// Whether the power changes with the charge.
    pub(super) fn has_curve(&self) -> bool {
        self.curve.is_some()
    }

    /// Whole seconds in which a battery that lacks this much becomes full. Where it is in doubt
    /// which second is nearest, `stated` is taken if it is one of the two.
    pub(super) fn refill_s(&self, lacking_kwh: f64, stated: Option<u64>) -> u64 {
        let Some(points) = self.curve else {
            let seconds = 3600.0 * lacking_kwh / self.kw;
            return nearest_within(seconds, seconds * ROUNDING, stated);
        };
        let from_kwh = (self.battery_kwh - lacking_kwh).max(0.0);
        let mut seconds = 0.0;
        let mut slowest_kw = self.kw;
        for piece in self.pieces(points).filter(|piece| piece.to_kwh > from_kwh) {
            seconds += piece.seconds_from(from_kwh);
            slowest_kw = slowest_kw.min(piece.from_kw).min(piece.to_kw);
        }
        // The charge at the start is a difference, so it is known to a share of the whole battery.
        let battery_s = 3600.0 * self.battery_kwh / slowest_kw;
        let rounded_s = 3600.0 * (self.battery_kwh - self.full_kwh).abs() / slowest_kw;
        nearest_within(seconds, (seconds + battery_s) * ROUNDING + rounded_s, stated)
    }

    /// The precision to which a charge after some seconds is known, kWh. Where the power rises
    /// steeply, a tiny time of charging at the least power is a larger charge at the greatest.
    pub(super) fn doubt_kwh(&self, held_kwh: f64) -> f64 {
        let steepness = self.curve.map_or(0.0, |points| {
            let powers = || points.iter().map(|point| point.kw.min(self.kw));
            powers().fold(1.0, f64::max) / powers().fold(self.kw, f64::min)
        });
        held_kwh * ROUNDING + self.full_kwh * TIME_ROUNDING * steepness
    }

    /// What a battery that holds `from_kwh` holds after `seconds` of charging.
    pub(super) fn after(&self, from_kwh: f64, seconds: f64) -> f64 {
        let Some(points) = self.curve else {
            return (from_kwh + self.kw * seconds / 3600.0).min(self.battery_kwh);
        };
        let mut left_s = seconds;
        for piece in self.pieces(points).filter(|piece| piece.to_kwh > from_kwh) {
            let piece_s = piece.seconds_from(from_kwh);
            if left_s < piece_s {
                return piece.after(from_kwh, left_s);
            }
            left_s -= piece_s;
        }
        self.full_kwh
    }

    /// The curve under the limit on the power: each line between two points, cut in two where it
    /// crosses the limit.
    fn pieces(&self, points: &'a [CurvePoint]) -> impl Iterator<Item = Piece> {
        let (full_kwh, limit_kw) = (self.full_kwh, self.kw);
        points.windows(2).flat_map(move |pair| {
            let (from, to) = (pair[0], pair[1]);
            let (from_kw, to_kw) = (from.kw.min(limit_kw), to.kw.min(limit_kw));
            // No number on lines that do not rise or fall, which cross nothing.
            let crossing = (limit_kw - from.kw) / (to.kw - from.kw);
            let (middle, middle_kw) = if crossing > 0.0 && crossing < 1.0 {
                let middle = from.charge + crossing * (to.charge - from.charge);
                (middle.min(to.charge), limit_kw)
            } else {
                (to.charge, to_kw)
            };
            let [from_kwh, middle_kwh, to_kwh] =
                [from.charge, middle, to.charge].map(|charge| charge * full_kwh);
            [
                Piece { from_kwh, to_kwh: middle_kwh, from_kw, to_kw: middle_kw },
                Piece { from_kwh: middle_kwh, to_kwh, from_kw: middle_kw, to_kw },
            ]
            .into_iter()
            .filter(|piece| piece.to_kwh > piece.from_kwh)
        })
    }
}

impl Piece {
    /// The charge at which charging in this piece begins, and the power there.
    fn entry(&self, from_kwh: f64) -> (f64, f64) {
        if from_kwh <= self.from_kwh {
            return (self.from_kwh, self.from_kw);
        }
        // Weights, and not a slope, keep a small power exact at the end of a steep line.
        let width_kwh = self.to_kwh - self.from_kwh;
        let up = (from_kwh - self.from_kwh) / width_kwh;
        let down = (self.to_kwh - from_kwh) / width_kwh;
        (from_kwh, self.from_kw * down + self.to_kw * up)
    }

    /// Seconds from a charge, or from the start of the piece if the charge is below it, to its end.
    fn seconds_from(&self, from_kwh: f64) -> f64 {
        let (start_kwh, start_kw) = self.entry(from_kwh);
        let growth = (self.to_kw - start_kw) / start_kw;
        // ln(1 + x) / x, which is 1 where the power is constant.
        let log_share = if growth == 0.0 {
            1.0
        } else if growth.abs() < 0.5 {
            libm::log1p(growth) / growth
        } else {
            libm::log(self.to_kw / start_kw) / growth
        };
        3600.0 * (self.to_kwh - start_kwh) / start_kw * log_share
    }

    /// The charge after some seconds in this piece.
    fn after(&self, from_kwh: f64, seconds: f64) -> f64 {
        let (start_kwh, start_kw) = self.entry(from_kwh);
        let hours = seconds / 3600.0;
        let exponent = (self.to_kw - self.from_kw) / (self.to_kwh - self.from_kwh) * hours;
        let share = if exponent == 0.0 { 1.0 } else { libm::expm1(exponent) / exponent };
        (start_kwh + start_kw * hours * share).min(self.to_kwh)
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::CurvePoint;

    use super::Charger;

    fn curve(points: &[(f64, f64)]) -> Vec<CurvePoint> {
        points.iter().map(|&(charge, kw)| CurvePoint { charge, kw }).collect()
    }

    fn close(found: f64, due: f64) {
        assert!((found - due).abs() <= 1e-9 * due, "{found} and not {due}");
    }

    #[test]
    fn constant_power_needs_no_curve() {
        let charger = Charger { battery_kwh: 100.0, full_kwh: 100.0, kw: 60.0, curve: None };
        assert_eq!(charger.refill_s(45.0, None), 2_700);
        close(charger.after(55.0, 600.0), 65.0);
        close(charger.after(55.0, 2_701.0), 100.0);
    }

    /// From 60 kW at half a battery to 30 kW when it is full, the power is 60 - 0.6 E' after E'
    /// kWh. Half a battery takes ln(60 / 30) / 0.6 hours, which is 4158.88 s.
    #[test]
    fn a_taper_takes_a_logarithm() {
        let points = curve(&[(0.0, 60.0), (0.5, 60.0), (1.0, 30.0)]);
        let charger =
            Charger { battery_kwh: 100.0, full_kwh: 100.0, kw: 80.0, curve: Some(&points) };
        let half_s = 3600.0 * std::f64::consts::LN_2 / 0.6;
        assert_eq!(charger.refill_s(50.0, None), 4_159);
        assert_eq!(charger.refill_s(60.0, None), 4_759, "10 minutes of constant power more");
        // After as long as half of the logarithm, the power is 60 / sqrt(2).
        let middle_kwh = 50.0 + (60.0 - 60.0 / std::f64::consts::SQRT_2) / 0.6;
        close(charger.after(50.0, half_s / 2.0), middle_kwh);
        close(charger.after(40.0, 600.0 + half_s / 2.0), middle_kwh);
        close(charger.after(40.0, 600.0 + half_s), 100.0);
        close(charger.after(100.0, 5.0), 100.0);
    }

    /// At most 45 kW, the taper is constant up to 75 kWh, where the curve is 45 kW.
    #[test]
    fn a_limit_cuts_the_curve_where_it_crosses() {
        let points = curve(&[(0.0, 60.0), (0.5, 60.0), (1.0, 30.0)]);
        let charger =
            Charger { battery_kwh: 100.0, full_kwh: 100.0, kw: 45.0, curve: Some(&points) };
        close(charger.after(50.0, 2_000.0), 75.0);
        let taper_s = 3600.0 * 1.5_f64.ln() / 0.6;
        close(taper_s, 2_432.790_648_648_986);
        assert_eq!(charger.refill_s(50.0, None), 2_000 + 2_433);
        assert_eq!(charger.refill_s(100.0, None), 6_000 + 2_433);
    }

    /// The time to a charge and the charge after a time are worked out apart, and agree.
    #[test]
    fn charges_and_times_agree_on_steep_and_flat_curves() {
        for points in [
            curve(&[(0.0, 1e5), (1.0, 1.0)]),
            curve(&[(0.0, 1.0), (0.999, 1e5), (1.0, 1.0)]),
            curve(&[(0.0, 50.0), (0.3, 50.000_000_001), (1.0, 50.0)]),
        ] {
            let charger =
                Charger { battery_kwh: 200.0, full_kwh: 200.0, kw: 9e4, curve: Some(&points) };
            for lacking_kwh in [200.0, 123.456, 1.0, 0.25] {
                let due_s = charger.refill_s(lacking_kwh, None) as f64;
                let from_kwh = 200.0 - lacking_kwh;
                assert!(charger.after(from_kwh, due_s - 0.6) < 200.0, "{lacking_kwh} {due_s}");
                close(charger.after(from_kwh, due_s + 0.6), 200.0);
            }
        }
    }
}
