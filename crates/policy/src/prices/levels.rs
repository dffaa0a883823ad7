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
    pub(super) fn of(view: View<'_>) -> Self {
        let vertiports = view.vertiports();
        if !view.charges_as_needed() {
            let (charge_mwh, to_full_s) = (Vec::new(), Vec::new());
            return Self { count: 1, vertiports, charge_mwh, to_full_s };
        }
        let (mut charge_mwh, mut to_full_s) = (Vec::new(), Vec::new());
        for (at, kind) in view.aircraft_types().iter().enumerate() {
            let usable_kwh = kind.battery_kwh - kind.reserve_kwh;
            let share = |level| 1.0 - level as f64 / (LEVELS - 1) as f64;
            let mwh = |level| whole_mwh(kind.reserve_kwh + share(level) * usable_kwh);
            let levels: Vec<u64> = (0..LEVELS).map(mwh).collect();
            for vertiport in VertiportIx::all(vertiports) {
                let rate = view.charge_rate(TypeIx::new(at), vertiport);
                to_full_s.extend(levels.iter().map(|&mwh| rate.to_full_s(mwh)));
            }
            charge_mwh.extend(levels);
        }
        Self { count: LEVELS, vertiports, charge_mwh, to_full_s }
    }

    /// The charge of a level, mWh.
    pub(super) fn charge_mwh(&self, kind: TypeIx, level: Level) -> u64 {
        self.charge_mwh[kind.at() * self.count + usize::from(level)]
    }

    /// The level nearest to the charge with which an aircraft is ready at a time.
    pub(super) fn nearest(
        &self,
        view: View<'_>,
        (kind, at): (TypeIx, VertiportIx),
        ready_s: u32,
        charge_mwh: u64,
    ) -> ReadyAt {
        let to_full_s = view.charge_rate(kind, at).to_full_s(charge_mwh);
        self.nearest_to((kind, at), ready_s, to_full_s)
    }

    /// The same for a charge from which a full battery is some seconds away.
    #[inline]
    pub(super) fn nearest_to(
        &self,
        (kind, at): (TypeIx, VertiportIx),
        ready_s: u32,
        to_full_s: f64,
    ) -> ReadyAt {
        let first = (kind.at() * self.vertiports + at.at()) * self.count;
        let levels_s = &self.to_full_s[first..][..self.count];
        let below = levels_s.partition_point(|&level_s| level_s < to_full_s);
        let off_s = |level: usize| (levels_s[level] - to_full_s).abs();
        let level = match below.min(self.count - 1) {
            level if level > 0 && off_s(level - 1) <= off_s(level) => level - 1,
            level => level,
        };
        ReadyAt {
            level: u16::try_from(level).expect("there are few levels"),
            time_s: moved_s(ready_s, to_full_s - levels_s[level]),
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
    (f64::from(time_s) + by_s).round().max(0.0) as u32
}
