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
    /// By type, then vertiport; empty on days that charge to full.
    all: Vec<LevelsAt>,
}

/// The levels of a type at a vertiport.
#[derive(Debug, Clone)]
pub(super) struct LevelsAt {
    /// Seconds from each level to a full battery, in rising order.
    levels_s: [f64; LEVELS],
    /// Up to how many seconds to a full battery each level is the nearest.
    until_s: [f64; LEVELS],
    /// The level nearest to the beginning of each part of the time in which a battery charges.
    first: [u8; PARTS],
    parts_a_second: f64,
}

/// Number of parts of the time in which a battery charges: levels are looked up more often than
/// anything else.
const PARTS: usize = 32;

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

impl LevelsAt {
    fn of(levels_s: [f64; LEVELS], full_s: f64) -> Self {
        let mut until_s = [f64::INFINITY; LEVELS];
        for (until_s, pair) in until_s.iter_mut().zip(levels_s.windows(2)) {
            *until_s = f64::midpoint(pair[0], pair[1]);
        }
        let parts_a_second = PARTS as f64 / full_s;
        let mut made = Self { levels_s, until_s, first: [0; PARTS], parts_a_second };
        for part in 1..PARTS {
            let level = made.level(part as f64 / parts_a_second);
            made.first[part..].fill(u8::try_from(level).expect("there are few levels"));
        }
        made
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

    /// The level nearest to the charge with which an aircraft is ready at a time. A full battery is
    /// some seconds away from it.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "there are few levels")]
    pub(super) fn nearest(&self, ready_s: u32, to_full_s: f64) -> ReadyAt {
        let level = self.level(to_full_s);
        let time_s = moved_s(ready_s, to_full_s - self.levels_s[level]);
        ReadyAt { level: level as Level, time_s }
    }

    /// The band of an aircraft from which a full battery is some seconds away.
    #[inline]
    pub(super) fn band(&self, to_full_s: f64) -> usize {
        self.levels_s.iter().filter(|&&level_s| level_s < to_full_s).count()
    }

    /// Seconds from each level to a full battery, in rising order.
    pub(super) fn levels_s(&self) -> [f64; LEVELS] {
        self.levels_s
    }

    /// The same, each with the range of seconds to which it is the [nearest](Self::nearest).
    pub(super) fn cells_s(&self) -> impl Iterator<Item = (f64, (f64, f64))> {
        let from_s = std::iter::once(f64::NEG_INFINITY).chain(self.until_s);
        self.levels_s.into_iter().zip(from_s.zip(self.until_s))
    }
}

impl Levels {
    /// Number of bands of charge: above the first level, between two levels, and below the last.
    pub(super) fn bands(&self) -> usize {
        if self.count == 1 { 1 } else { self.count + 1 }
    }

    pub(super) fn of(view: View<'_>) -> Self {
        let vertiports = view.vertiports();
        let (mut charge_mwh, mut all) = (Vec::new(), Vec::new());
        if !view.charges_as_needed() {
            return Self { count: 1, vertiports, charge_mwh, all };
        }
        for (at, kind) in view.aircraft_types().iter().enumerate() {
            let usable_kwh = kind.battery_kwh - kind.reserve_kwh;
            let share = |level| 1.0 - level as f64 / (LEVELS - 1) as f64;
            let mwh = |level| whole_mwh(kind.reserve_kwh + share(level) * usable_kwh);
            let levels: [u64; LEVELS] = std::array::from_fn(mwh);
            for vertiport in VertiportIx::all(vertiports) {
                let rate = view.charge_rate(TypeIx::new(at), vertiport);
                let levels_s = levels.map(|mwh| rate.to_full_s(rate.battery(mwh), 0));
                all.push(LevelsAt::of(levels_s, rate.full_s()));
            }
            charge_mwh.extend(levels);
        }
        Self { count: LEVELS, vertiports, charge_mwh, all }
    }

    /// The charge of a level, mWh.
    pub(super) fn charge_mwh(&self, kind: TypeIx, level: Level) -> u64 {
        self.charge_mwh[kind.at() * self.count + usize::from(level)]
    }

    /// The levels of a type by vertiport. For days that charge as needed.
    #[inline]
    pub(super) fn of_kind(&self, kind: TypeIx) -> &[LevelsAt] {
        &self.all[kind.at() * self.vertiports..][..self.vertiports]
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
