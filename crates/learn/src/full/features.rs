//! The full observation: every vertiport as it looks from the deciding aircraft, with what the
//! forecast and the fleet say of it, in numbers that mean the same on every network.
//!
//! Dollars are measured in the profit of a typical full flight of the network, times in hours, and
//! passengers in flights; every number is bounded. Writing a row looks at every pair of vertiports
//! four times, which [boards](Boards) make cheap, and once at the fleet.

use vertifleet_core::{AircraftIx, Time, TypeIx, VertiportIx};
use vertifleet_sim::{Decision, View};

use crate::full::board::{Board, Boards, Onward};
use crate::gcaps_x::features::saturating_count;
use crate::nn::{Adjacency, Architecture, Shape};
use crate::rows::{Row, Rows, has_edges};

/// F, the number of node features.
pub(crate) const NODE_FEATURES: usize = 37;
/// G, the number of aircraft features.
pub(crate) const AIRCRAFT_FEATURES: usize = 11;
/// The node features in their order; docs/src/concepts/policies.md says what each means.
#[cfg(test)]
pub(crate) const NODE_FEATURE_NAMES: [&str; NODE_FEATURES] = [
    "is_possible",
    "is_own",
    "is_in_range",
    "block_h",
    "profit",
    "profit_per_h",
    "seats_filled",
    "next_seats_filled",
    "demand_left",
    "demand_next",
    "stands_free",
    "stands_taken",
    "ready_before",
    "ready_about",
    "ready_0",
    "ready_15",
    "ready_30",
    "ready_60",
    "ready_120",
    "day_left",
    "last_hour",
    "last_two_hours",
    "onward_best",
    "onward_second",
    "onward_third",
    "later_best",
    "later_second",
    "last_best",
    "onward_flights",
    "later_flights",
    "last_flights",
    "onward_profit",
    "later_profit",
    "last_profit",
    "arriving",
    "crowding",
    "routes_open",
];
/// The aircraft features in their order.
#[cfg(test)]
pub(crate) const AIRCRAFT_FEATURE_NAMES: [&str; AIRCRAFT_FEATURES] = [
    "day_left",
    "last_hour",
    "last_two_hours",
    "last_four_hours",
    "period_left",
    "queue_15",
    "queue_30",
    "queue_60",
    "choices",
    "aircraft_a_vertiport",
    "aircraft_a_stand",
];
/// Other aircraft that are ready this long before or after the deciding one want the same flights,
/// seconds.
const NEAR_S: u32 = 900;
/// How soon other aircraft at a vertiport are ready, seconds; they are counted for each of these
/// times.
const READY_S: [u32; 5] = [0, 900, 1_800, 3_600, 7_200];
/// What can be flown from a vertiport is looked at when the aircraft is ready there, and so long
/// afterwards, seconds.
const ONWARD_S: [u32; 3] = [0, 3_600, 7_200];

/// The shape of the features for this many vertiports.
pub(crate) fn shape(vertiports: usize) -> Shape {
    Shape { vertiports, node_features: NODE_FEATURES, aircraft_features: AIRCRAFT_FEATURES }
}

/// Writes rows. It remembers the flights of the days that it wrote lately, and keeps its memory
/// from row to row.
#[derive(Debug, Clone)]
pub(crate) struct Writer {
    adjacency: Adjacency,
    has_edges: bool,
    boards: Boards,
    /// What the row being written says of each vertiport.
    seen: Vec<Seen>,
}

/// A vertiport as the deciding aircraft would find it: the other aircraft that stand there or are
/// on their way there, and the flights from there.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    /// The time at which the deciding aircraft would be ready there.
    ready: Time,
    /// The number of aircraft that are ready before that time, and the number that are ready at
    /// about that time.
    before: u16,
    near: u16,
    /// The number of aircraft that are ready within each time of [`READY_S`].
    within: [u16; 5],
    /// What can be flown from there at each time of [`ONWARD_S`].
    onward: [Onward; 3],
}

/// A decision with the unit of money.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scene<'a> {
    view: View<'a>,
    decision: &'a Decision,
    kind: TypeIx,
    /// The profit of a typical full flight, dollars.
    unit_usd: f64,
}

impl Writer {
    /// A writer of what a policy's network reads.
    pub(crate) fn of(policy: &Architecture) -> Self {
        let (adjacency, has_edges) = (policy.adjacency(), has_edges(policy));
        Self { adjacency, has_edges, ..Self::of_features() }
    }

    /// A writer of the features of vertiports and aircraft alone.
    pub(crate) fn of_features() -> Self {
        let adjacency = Adjacency::Complete;
        Self { adjacency, has_edges: false, boards: Boards::default(), seen: Vec::new() }
    }

    /// No rows yet, for days with so many vertiports.
    pub(crate) fn rows(&self, vertiports: usize) -> Rows {
        Rows::new(shape(vertiports), self.has_edges)
    }

    /// Adds the row of a decision between all of its feasible choices. Returns the decision with
    /// the unit of money.
    pub(crate) fn push<'a>(
        &mut self,
        view: View<'a>,
        decision: &'a Decision,
        rows: &mut Rows,
    ) -> Scene<'a> {
        let kind = view.kind(decision.aircraft);
        let unit_usd = self.boards.of(view).unit_usd(kind);
        let scene = Scene { view, decision, kind, unit_usd };
        self.write_vertiport_features(scene);
        let (adjacency, seen) = (self.adjacency, &self.seen);
        let board = self.boards.latest();
        rows.push(|row| {
            scene.write(seen, row);
            if !row.edges.is_empty() {
                scene.write_edges(board, adjacency, view.vertiports(), row.edges);
            }
        });
        scene
    }

    /// The flights of the day that was written last.
    pub(super) fn board(&self) -> &Board {
        self.boards.latest()
    }

    /// Looks at the flights from each vertiport, and counts the other aircraft there.
    fn write_vertiport_features(&mut self, Scene { view, decision, kind, .. }: Scene<'_>) {
        let legs = view.legs_from(kind, decision.at);
        let board = self.boards.of(view);
        self.seen.resize(legs.len(), Seen::default());
        for (to, (seen, leg)) in self.seen.iter_mut().zip(legs).enumerate() {
            let stays = to == decision.at.at();
            let block_s = if stays { view.hold_s() } else { leg.block_s() };
            let (to, ready) = (VertiportIx::new(to), decision.time + block_s);
            let onward = ONWARD_S.map(|later_s| board.onward(view, kind, to, ready + later_s));
            // What leaves now is looked at last, so that it is there when edges are written.
            board.look(view, kind, to, decision.time);
            *seen = Seen { ready, onward, ..Seen::default() };
        }
        for (other, place) in AircraftIx::all(view.places().len()).zip(view.places()) {
            if other == decision.aircraft {
                continue;
            }
            let ready = view.ready_at(other);
            let seen = &mut self.seen[place.at()];
            seen.before += u16::from(ready < seen.ready);
            let apart_s = ready.since(seen.ready).max(seen.ready.since(ready));
            seen.near += u16::from(apart_s <= NEAR_S);
            for (count, within_s) in seen.within.iter_mut().zip(READY_S) {
                *count += u16::from(ready <= decision.time + within_s);
            }
        }
    }
}

impl Scene<'_> {
    fn write(self, seen: &[Seen], row: &mut Row<'_>) {
        let Self { view, decision, .. } = self;
        let feasible = view.feasible(decision);
        *row.clock = self.share_of_day(decision.time) as f32;
        let own = &seen[decision.at.at()];
        let choices = feasible.iter().count();
        for (to, value) in row.aircraft.iter_mut().zip(self.aircraft(own, choices)) {
            *to = value as f32;
        }
        for (at, to) in row.nodes.chunks_exact_mut(NODE_FEATURES).enumerate() {
            let at = VertiportIx::new(at);
            to[0] = f32::from(u8::from(feasible.contains(at)));
            for (to, value) in to[1..].iter_mut().zip(self.node(at, &seen[at.at()])) {
                *to = value as f32;
            }
        }
    }

    /// Writes the weights of the edges of an adjacency, with a row of `stride` entries for each
    /// vertiport, over zeros: what is 0, as pairs out of range are, need not be written.
    pub(super) fn write_edges(
        self,
        board: &Board,
        adjacency: Adjacency,
        stride: usize,
        edges: &mut [f32],
    ) {
        let Self { view, decision, kind, .. } = self;
        let period = view.period_at(decision.time);
        let vertiports = VertiportIx::all(view.vertiports());
        for (from, row) in vertiports.zip(edges.chunks_exact_mut(stride)) {
            let (in_range, closed) = (view.within_range(kind, from), view.closed(from));
            match adjacency {
                Adjacency::Complete | Adjacency::Similarity => {
                    in_range.iter().for_each(|to| row[to.at()] = 1.0);
                }
                Adjacency::Distance => {
                    for to in in_range.iter() {
                        let flight_h = hours(view.leg(kind, from, to).flight_s);
                        row[to.at()] = (1.0 / (1.0 + flight_h)) as f32;
                    }
                }
                Adjacency::Reachable => {
                    in_range.without(&closed).iter().for_each(|to| row[to.at()] = 1.0);
                }
                Adjacency::Profit => {
                    row[..view.vertiports()].copy_from_slice(board.rates(kind, from, period));
                    closed.iter().for_each(|to| row[to.at()] = 0.0);
                }
            }
        }
    }

    fn share_of_day(self, time: Time) -> f64 {
        let day_s = self.view.day_end().since(self.view.day_start()).max(1);
        f64::from(self.view.day_end().since(time)) / f64::from(day_s)
    }

    /// The aircraft features; `own` is what is counted at its own vertiport.
    fn aircraft(self, own: &Seen, choices: usize) -> [f64; AIRCRAFT_FEATURES] {
        let Self { view, decision, .. } = self;
        let time = decision.time;
        let next_period = view.period_starts().get(view.period() + 1).copied();
        let period_left_s = next_period.map_or(3_600, |next| next.since(time));
        let stands: u32 =
            VertiportIx::all(view.vertiports()).map(|at| u32::from(view.stands(at))).sum();
        let fleet = view.places().len() as f64;
        let left_h = hours(view.day_end().since(time));
        [
            self.share_of_day(time),
            left_h.min(1.0),
            (left_h / 2.0).min(1.0),
            (left_h / 4.0).min(1.0),
            hours(period_left_s).min(1.0),
            saturating_count(own.within[1], 4.0),
            saturating_count(own.within[2], 4.0),
            saturating_count(own.within[3], 4.0),
            (choices as f64 / 8.0).min(4.0),
            (fleet / view.vertiports() as f64 / 8.0).min(2.0),
            (fleet / f64::from(stands.max(1))).min(2.0),
        ]
    }

    /// The features of a vertiport, except for whether it may be chosen.
    fn node(self, to: VertiportIx, seen: &Seen) -> [f64; NODE_FEATURES - 1] {
        let Self { view, decision, kind, unit_usd } = self;
        let Decision { time, at: from, .. } = *decision;
        let stays = to == from;
        let in_range = stays || view.within_range(kind, from).contains(to);
        let seats = u32::from(view.aircraft_type(kind).seats);
        let (profit, waiting) = if stays || !in_range {
            (0.0, 0)
        } else {
            let waiting = view.demand_left(view.period(), from, to);
            let profit_usd = view.flight_profit_usd(time, kind, (from, to), waiting);
            (profit_usd / unit_usd, waiting)
        };
        let next_period = (view.period() + 1).min(view.period_starts().len() - 1);
        let later = if stays { 0 } else { view.demand_left(next_period, from, to) };
        let flights = |passengers: u32| log(f64::from(passengers) / f64::from(seats));
        let block_h = hours(seen.ready.since(time));
        let (stands, taken) = (view.stands(to), view.stands_taken()[to.at()]);
        let left_h = hours(view.day_end().since(seen.ready));
        let [onward, then, last] = seen.onward;
        let period = view.demand_left_in(view.period());
        let arriving: u32 = period.iter().skip(to.at()).step_by(view.vertiports()).sum();
        let neighbours = view.within_range(kind, to);
        let (all, shut) = (neighbours.len(), neighbours.and(&view.closed(to)).len());
        [
            f64::from(u8::from(stays)),
            f64::from(u8::from(in_range)),
            block_h.min(3.0),
            profit.clamp(-1.0, 3.0),
            (profit / block_h.max(0.1)).clamp(-1.0, 3.0),
            f64::from(waiting.min(seats)) / f64::from(seats),
            f64::from(waiting.saturating_sub(seats).min(seats)) / f64::from(seats),
            flights(waiting),
            flights(later),
            saturating_count(stands.saturating_sub(taken), 4.0),
            (f64::from(taken) / f64::from(stands.max(1))).min(2.0),
            saturating_count(seen.before, 4.0),
            saturating_count(seen.near, 4.0),
            saturating_count(seen.within[0], 4.0),
            saturating_count(seen.within[1], 4.0),
            saturating_count(seen.within[2], 4.0),
            saturating_count(seen.within[3], 4.0),
            saturating_count(seen.within[4], 4.0),
            self.share_of_day(seen.ready),
            left_h.min(1.0),
            (left_h / 2.0).min(1.0),
            onward.best[0].min(3.0),
            onward.best[1].min(3.0),
            onward.best[2].min(3.0),
            then.best[0].min(3.0),
            then.best[1].min(3.0),
            last.best[0].min(3.0),
            log(onward.flights),
            log(then.flights),
            log(last.flights),
            log(onward.profit),
            log(then.profit),
            log(last.profit),
            log(f64::from(arriving) / f64::from(seats)),
            (f64::from(seen.before) / (onward.flights + 1.0)).min(2.0),
            1.0 - f64::from(shut) / f64::from(all.max(1)),
        ]
    }
}

pub(super) fn hours(seconds: u32) -> f64 {
    f64::from(seconds) / 3_600.0
}

/// A number that may be large, on a scale on which it stays small.
fn log(number: f64) -> f64 {
    (number.ln_1p() / 3.0).min(3.0)
}
