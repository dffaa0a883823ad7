//! Columns: the numbers that describe a vertiport or an aircraft, each with its name.
//!
//! `gcaps-x` and `gcaps-full` observe lists of columns, and share those that mean the same in both.
//! docs/src/concepts/policies.md defines each column; a test compares its tables with the lists.

use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::{Decision, View};

/// A number that describes a `T`, and its name.
pub(crate) struct Column<T>(pub(crate) &'static str, pub(crate) fn(&T) -> f64);

/// Writes a row of columns. The lists are constants of known length, so the compiler inlines each
/// column.
#[inline]
pub(crate) fn write<T, const COLUMNS: usize>(
    columns: &'static [Column<T>; COLUMNS],
    of: &T,
    to: &mut [f32],
) {
    let to: &mut [f32; COLUMNS] = to.try_into().expect("a row has as many numbers as columns");
    for (to, Column(_, number)) in to.iter_mut().zip(columns) {
        *to = number(of) as f32;
    }
}

/// The names of columns in their order.
pub(crate) fn names<T>(columns: &[Column<T>]) -> Vec<&'static str> {
    columns.iter().map(|column| column.0).collect()
}

/// Other aircraft compete for the same flights if they are ready this long before or after the
/// deciding one, seconds.
const NEAR_S: u32 = 900;

/// The other aircraft that stand at a vertiport or are on their way there, and the fields that an
/// observation adds.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Around<M> {
    /// The time at which the deciding aircraft would be ready there.
    pub(crate) ready: Time,
    /// The number of aircraft that are ready before that time.
    pub(crate) before: u16,
    /// The number that are ready within [`NEAR_S`] of that time.
    pub(crate) near: u16,
    pub(crate) more: M,
}

/// Counts the other aircraft at each vertiport. `fresh` creates the record of a vertiport, given
/// the time at which the deciding aircraft would be ready there. `each` adds another aircraft,
/// given the vertiport and the time at which it is ready.
pub(crate) fn look_around<M>(
    around: &mut Vec<Around<M>>,
    view: View<'_>,
    decision: &Decision,
    mut fresh: impl FnMut(VertiportIx, Time) -> M,
    mut each: impl FnMut(&mut [Around<M>], Decision),
) {
    around.clear();
    around.extend(VertiportIx::all(view.vertiports()).map(|to| {
        let ready = view.outcome(decision, to).ready;
        Around { ready, before: 0, near: 0, more: fresh(to, ready) }
    }));
    for (aircraft, &at) in AircraftIx::all(view.places().len()).zip(view.places()) {
        if aircraft == decision.aircraft {
            continue;
        }
        let time = view.ready_at(aircraft);
        let seen = &mut around[at.at()];
        seen.before += u16::from(time < seen.ready);
        let apart_s = time.since(seen.ready).max(seen.ready.since(time));
        seen.near += u16::from(apart_s <= NEAR_S);
        each(around, Decision { time, aircraft, at, ..*decision });
    }
}

/// A vertiport as the deciding aircraft would find it, with the fields of a single observation.
pub(crate) struct Node<M> {
    /// Whether it may be chosen.
    pub(crate) is_open: bool,
    pub(crate) is_own: bool,
    /// Whether the aircraft can fly there, or is there.
    pub(crate) is_in_range: bool,
    /// Time from the decision until the aircraft is ready there, hours.
    pub(crate) block_h: f64,
    /// Profit of the flight, in units.
    pub(crate) profit: f64,
    /// Passengers who wait for the flight now, and those of the next period.
    pub(crate) waiting: u32,
    pub(crate) later: u32,
    pub(crate) seats: u32,
    pub(crate) stands: u16,
    pub(crate) taken: u16,
    pub(crate) before: u16,
    pub(crate) near: u16,
    /// Share of the day that is left when the aircraft is ready there.
    pub(crate) day_left: f64,
    pub(crate) more: M,
}

impl<M> Node<M> {
    pub(crate) const IS_OWN: Column<Self> = Column("is_own", |node| flag(node.is_own));
    pub(crate) const BLOCK_H: Column<Self> = Column("block_h", |node| node.block_h.min(3.0));
    pub(crate) const PROFIT: Column<Self> = Column("profit", |node| node.profit.clamp(-1.0, 3.0));
    pub(crate) const PROFIT_PER_H: Column<Self> =
        Column("profit_per_h", |node| (node.profit / node.block_h.max(0.1)).clamp(-1.0, 3.0));
    pub(crate) const SEATS_FILLED: Column<Self> =
        Column("seats_filled", |node| share(node.waiting.min(node.seats), node.seats));
    pub(crate) const NEXT_SEATS_FILLED: Column<Self> = Column("next_seats_filled", |node| {
        share(node.waiting.saturating_sub(node.seats).min(node.seats), node.seats)
    });
    pub(crate) const STANDS_FREE: Column<Self> =
        Column("stands_free", |node| counted(node.stands.saturating_sub(node.taken)));
    pub(crate) const READY_BEFORE: Column<Self> =
        Column("ready_before", |node| counted(node.before));
    pub(crate) const READY_ABOUT: Column<Self> = Column("ready_about", |node| counted(node.near));
    pub(crate) const DAY_LEFT: Column<Self> = Column("day_left", |node| node.day_left);

    /// A vertiport to which the profit of a flight is measured in `unit_usd`.
    #[inline]
    pub(crate) fn of<A>(
        view: View<'_>,
        decision: &Decision,
        (to, around): (VertiportIx, &Around<A>),
        unit_usd: f64,
        is_open: bool,
        more: M,
    ) -> Self {
        let Decision { time, at: from, .. } = *decision;
        let kind = view.kind(decision.aircraft);
        let is_own = to == from;
        let is_in_range = is_own || view.within_range(kind, from).contains(to);
        let (profit, waiting) = if is_own || !is_in_range {
            (0.0, 0)
        } else {
            let waiting = view.demand_left(view.period(), from, to);
            let takeoff = view.outcome(decision, to).takeoff;
            let departures = view.departures(time, kind, from);
            (departures.profit_from_usd(takeoff, to, waiting) / unit_usd, waiting)
        };
        let next_period = (view.period() + 1).min(view.period_starts().len() - 1);
        Self {
            is_open,
            is_own,
            is_in_range,
            block_h: hours(around.ready.since(time)),
            profit,
            waiting,
            later: if is_own { 0 } else { view.demand_left(next_period, from, to) },
            seats: u32::from(view.aircraft_type(kind).seats),
            stands: view.stands(to),
            taken: view.stands_taken()[to.at()],
            before: around.before,
            near: around.near,
            day_left: day_left(view, around.ready),
            more,
        }
    }
}

/// The deciding aircraft and its fleet, with the fields of a single observation.
pub(crate) struct Aircraft<M> {
    /// Share of the day, and hours of it, that are left.
    pub(crate) day_left: f64,
    pub(crate) left_h: f64,
    /// Time until the next demand period, hours.
    period_left_h: f64,
    /// The number of other aircraft that are ready here within each time of [`QUEUE_S`].
    queue: [u16; 3],
    /// The number of choices.
    pub(crate) choices: usize,
    pub(crate) fleet: f64,
    vertiports: f64,
    pub(crate) stands: u32,
    pub(crate) more: M,
}

/// How soon other aircraft at the same vertiport are ready, seconds.
pub(crate) const QUEUE_S: [u32; 3] = [900, 1_800, 3_600];

impl<M> Aircraft<M> {
    pub(crate) const DAY_LEFT: Column<Self> = Column("day_left", |aircraft| aircraft.day_left);
    pub(crate) const PERIOD_LEFT: Column<Self> =
        Column("period_left", |aircraft| aircraft.period_left_h.min(1.0));
    pub(crate) const QUEUE_15: Column<Self> =
        Column("queue_15", |aircraft| counted(aircraft.queue[0]));
    pub(crate) const QUEUE_30: Column<Self> =
        Column("queue_30", |aircraft| counted(aircraft.queue[1]));
    pub(crate) const QUEUE_60: Column<Self> =
        Column("queue_60", |aircraft| counted(aircraft.queue[2]));
    pub(crate) const A_VERTIPORT: Column<Self> = Column("aircraft_a_vertiport", |aircraft| {
        (aircraft.fleet / aircraft.vertiports / 8.0).min(2.0)
    });

    pub(crate) fn of(
        view: View<'_>,
        decision: &Decision,
        queue: [u16; 3],
        choices: usize,
        more: M,
    ) -> Self {
        let time = decision.time;
        let next_period = view.period_starts().get(view.period() + 1);
        let vertiports = VertiportIx::all(view.vertiports());
        Self {
            day_left: day_left(view, time),
            left_h: hours(view.day_end().since(time)),
            period_left_h: next_period.map_or(1.0, |next| hours(next.since(time))),
            queue,
            choices,
            fleet: view.places().len() as f64,
            vertiports: view.vertiports() as f64,
            stands: vertiports.map(|at| u32::from(view.stands(at))).sum(),
            more,
        }
    }
}

/// The share of the day that is left at a time.
pub(crate) fn day_left(view: View<'_>, time: Time) -> f64 {
    let day_s = view.day_end().since(view.day_start()).max(1);
    f64::from(view.day_end().since(time)) / f64::from(day_s)
}

pub(crate) fn flag(is_so: bool) -> f64 {
    f64::from(u8::from(is_so))
}

pub(crate) fn share(part: u32, whole: u32) -> f64 {
    f64::from(part) / f64::from(whole)
}

/// A small count, divided by four and at most 2.
pub(crate) fn counted(count: u16) -> f64 {
    (f64::from(count) / 4.0).min(2.0)
}

pub(crate) fn hours(seconds: u32) -> f64 {
    f64::from(seconds) / 3_600.0
}
