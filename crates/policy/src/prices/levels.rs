//! Levels of charge, on days that charge as needed: the tables of worth have a row for each.
//!
//! An aircraft counts as ready at the level that is nearest in time, and as much later or earlier
//! as it takes to charge from one to the other. So rounding to a level neither wins nor loses
//! charge. On days that charge to full there is one level, a full battery.

use vertifleet_core::{TypeIx, VertiportIx, whole_mwh};
use vertifleet_sim::View;

/// Number of levels of a day that charges as needed.
const LEVELS: usize = 8;

/// A level, counted from a full battery down.
pub(super) type Level = u16;

/// The levels of all types at all vertiports.
#[derive(Debug, Clone)]
pub(super) struct Levels {
    pub(super) count: usize,
    vertiports: usize,
    /// By type, then level: the charge, mWh.
    charge_mwh: Vec<u64>,
    /// By type, vertiport, then level: seconds from there to a full battery.
    to_full_s: Vec<f64>,
    /// By type, then vertiport.
    nearest: Vec<Nearest>,
}

/// Number of parts of the time in which a battery charges, of each of which the first level is
/// kept: levels are looked up more often than anything else.
const PARTS: usize = 32;

/// The levels that are nearest to some numbers of seconds to a full battery.
#[derive(Debug, Clone)]
struct Nearest {
    parts_a_second: f64,
    /// The level nearest to the beginning of each part.
    first: [u8; PARTS],
    /// Up to how many seconds each level is the nearest.
    until_s: [f64; LEVELS],
}

impl Nearest {
    fn of(levels_s: &[f64; LEVELS], full_s: f64) -> Self {
        let mut until_s = [f64::INFINITY; LEVELS];
        for (until_s, pair) in until_s.iter_mut().zip(levels_s.windows(2)) {
            *until_s = f64::midpoint(pair[0], pair[1]);
        }
        let mut nearest =
            Self { parts_a_second: PARTS as f64 / full_s, first: [0; PARTS], until_s };
        for part in 1..PARTS {
            let level = nearest.level(part as f64 / nearest.parts_a_second);
            nearest.first[part..].fill(u8::try_from(level).expect("there are few levels"));
        }
        nearest
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the parts")]
    fn level(&self, to_full_s: f64) -> usize {
        let part = ((to_full_s * self.parts_a_second) as usize).min(PARTS - 1);
        let mut level = usize::from(self.first[part]);
        while to_full_s > self.until_s[level] {
            level += 1;
        }
        level
    }
}

/// The level of an aircraft and when it counts as ready, seconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ReadyAt {
    pub(super) level: Level,
    pub(super) time_s: u32,
}

impl ReadyAt {
    /// The same no sooner than a time: tables of worth begin with the present.
    pub(super) fn no_sooner_than(self, time_s: u32) -> Self {
        Self { time_s: self.time_s.max(time_s), ..self }
    }
}

impl Levels {
    /// Number of bands of charge: above the first level, between two levels, and below the last.
    pub(super) fn bands(&self) -> usize {
        if self.count == 1 { 1 } else { self.count + 1 }
    }

    /// The band of an aircraft from which a full battery is some seconds away.
    #[inline]
    pub(super) fn band(&self, (kind, at): (TypeIx, VertiportIx), to_full_s: f64) -> usize {
        self.to_full_s(kind, at).partition_point(|&level_s| level_s < to_full_s)
    }

    /// Seconds from each level to a full battery, in rising order.
    #[inline]
    pub(super) fn to_full_s(&self, kind: TypeIx, at: VertiportIx) -> &[f64] {
        &self.to_full_s[(kind.at() * self.vertiports + at.at()) * self.count..][..self.count]
    }

    /// The same, each with the range of seconds to which it is the [nearest](Self::nearest).
    pub(super) fn cells_s(
        &self,
        kind: TypeIx,
        at: VertiportIx,
    ) -> impl Iterator<Item = (f64, (f64, f64))> {
        let until_s = self.nearest[kind.at() * self.vertiports + at.at()].until_s;
        let from_s = std::iter::once(f64::NEG_INFINITY).chain(until_s);
        self.to_full_s(kind, at).iter().copied().zip(from_s.zip(until_s))
    }

    pub(super) fn of(view: View<'_>) -> Self {
        let vertiports = view.vertiports();
        if !view.charges_as_needed() {
            let (charge_mwh, to_full_s, nearest) = (Vec::new(), Vec::new(), Vec::new());
            return Self { count: 1, vertiports, charge_mwh, to_full_s, nearest };
        }
        let (mut charge_mwh, mut to_full_s) = (Vec::new(), Vec::new());
        let mut nearest = Vec::new();
        for (at, kind) in view.aircraft_types().iter().enumerate() {
            let usable_kwh = kind.battery_kwh - kind.reserve_kwh;
            let share = |level| 1.0 - level as f64 / (LEVELS - 1) as f64;
            let mwh = |level| whole_mwh(kind.reserve_kwh + share(level) * usable_kwh);
            let levels: [u64; LEVELS] = std::array::from_fn(mwh);
            for vertiport in VertiportIx::all(vertiports) {
                let rate = view.charge_rate(TypeIx::new(at), vertiport);
                let levels_s = levels.map(|mwh| rate.to_full_s(rate.battery(mwh), 0));
                nearest.push(Nearest::of(&levels_s, rate.full_s()));
                to_full_s.extend(levels_s);
            }
            charge_mwh.extend(levels);
        }
        Self { count: LEVELS, vertiports, charge_mwh, to_full_s, nearest }
    }

    /// The charge of a level, mWh.
    pub(super) fn charge_mwh(&self, kind: TypeIx, level: Level) -> u64 {
        self.charge_mwh[kind.at() * self.count + usize::from(level)]
    }

    /// The level nearest to the charge with which an aircraft is ready at a time. A full battery is
    /// some seconds away from it.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "there are few levels")]
    pub(super) fn nearest(
        &self,
        (kind, at): (TypeIx, VertiportIx),
        ready_s: u32,
        to_full_s: f64,
    ) -> ReadyAt {
        let level = self.nearest[kind.at() * self.vertiports + at.at()].level(to_full_s);
        ReadyAt {
            level: level as Level,
            time_s: moved_s(ready_s, to_full_s - self.to_full_s(kind, at)[level]),
        }
    }
}

/// A time moved by some seconds, which may be negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not below 0, and a full charge takes at most 5,000 hours"
)]
fn moved_s(time_s: u32, by_s: f64) -> u32 {
    // `as` cuts what is below 0, and the fraction.
    (f64::from(time_s) + by_s + 0.5) as u32
}
