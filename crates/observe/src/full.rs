//! The full observation, of `gcaps-full` and `mlp-full`: every vertiport relative to the deciding
//! aircraft, with the forecast and the fleet. Its numbers mean the same on every network. It needs
//! no bid prices.
//!
//! Dollars are measured in the profit of a typical full flight of the network, times in hours, and
//! passengers in flights; every number is bounded. A decision evaluates every pair of vertiports
//! four times, which [boards](Boards) make cheap, and the fleet once.

use vertifleet_core::{TypeIx, VertiportIx};
use vertifleet_sim::{Decision, VertiportSet, View};

use crate::board::{Board, Boards, Onward};
use crate::column::{
    self, Aircraft, Around, Column, Node, counted, flag, hours, look_around, share,
};

/// How soon other aircraft at a vertiport are ready, seconds; they are counted for each of these
/// times.
const READY_S: [u32; 5] = [0, 900, 1_800, 3_600, 7_200];
/// The flights that can leave a vertiport are evaluated when the aircraft is ready there, and this
/// long afterwards, seconds.
const ONWARD_S: [u32; 3] = [0, 3_600, 7_200];

type FullNode = Node<Outlook>;
type FullAircraft = Aircraft<()>;

/// The columns of a vertiport.
pub(crate) const NODES: [Column<FullNode>; 37] = [
    Column("is_possible", |node| flag(node.is_open)),
    Node::IS_OWN,
    Column("is_in_range", |node| flag(node.is_in_range)),
    Node::BLOCK_H,
    Node::PROFIT,
    Node::PROFIT_PER_H,
    Node::SEATS_FILLED,
    Node::NEXT_SEATS_FILLED,
    Column("demand_left", |node| log(share(node.waiting, node.seats))),
    Column("demand_next", |node| log(share(node.later, node.seats))),
    Node::STANDS_FREE,
    Column("stands_taken", |node| share(node.taken.into(), node.stands.max(1).into()).min(2.0)),
    Node::READY_BEFORE,
    Node::READY_ABOUT,
    Column("ready_0", |node| counted(node.more.ahead.within[0])),
    Column("ready_15", |node| counted(node.more.ahead.within[1])),
    Column("ready_30", |node| counted(node.more.ahead.within[2])),
    Column("ready_60", |node| counted(node.more.ahead.within[3])),
    Column("ready_120", |node| counted(node.more.ahead.within[4])),
    Node::DAY_LEFT,
    Column("last_hour", |node| node.more.left_h.min(1.0)),
    Column("last_two_hours", |node| (node.more.left_h / 2.0).min(1.0)),
    Column("onward_best", |node| node.more.ahead.onward[0].best[0].min(3.0)),
    Column("onward_second", |node| node.more.ahead.onward[0].best[1].min(3.0)),
    Column("onward_third", |node| node.more.ahead.onward[0].best[2].min(3.0)),
    Column("later_best", |node| node.more.ahead.onward[1].best[0].min(3.0)),
    Column("later_second", |node| node.more.ahead.onward[1].best[1].min(3.0)),
    Column("last_best", |node| node.more.ahead.onward[2].best[0].min(3.0)),
    Column("onward_flights", |node| log(node.more.ahead.onward[0].flights)),
    Column("later_flights", |node| log(node.more.ahead.onward[1].flights)),
    Column("last_flights", |node| log(node.more.ahead.onward[2].flights)),
    Column("onward_profit", |node| log(node.more.ahead.onward[0].profit)),
    Column("later_profit", |node| log(node.more.ahead.onward[1].profit)),
    Column("last_profit", |node| log(node.more.ahead.onward[2].profit)),
    Column("arriving", |node| log(share(node.more.arriving, node.seats))),
    Column("crowding", |node| {
        (f64::from(node.before) / (node.more.ahead.onward[0].flights + 1.0)).min(2.0)
    }),
    Column("routes_open", |node| 1.0 - share(node.more.shut, node.more.neighbours.max(1))),
];

/// The columns of the deciding aircraft.
pub(crate) const AIRCRAFT: [Column<FullAircraft>; 11] = [
    Aircraft::DAY_LEFT,
    Column("last_hour", |aircraft| aircraft.left_h.min(1.0)),
    Column("last_two_hours", |aircraft| (aircraft.left_h / 2.0).min(1.0)),
    Column("last_four_hours", |aircraft| (aircraft.left_h / 4.0).min(1.0)),
    Aircraft::PERIOD_LEFT,
    Aircraft::QUEUE_15,
    Aircraft::QUEUE_30,
    Aircraft::QUEUE_60,
    Column("choices", |aircraft| (aircraft.choices as f64 / 8.0).min(4.0)),
    Aircraft::A_VERTIPORT,
    Column("aircraft_a_stand", |aircraft| {
        (aircraft.fleet / f64::from(aircraft.stands.max(1))).min(2.0)
    }),
];

/// The fields that the forecast and the routes add to a vertiport.
pub(crate) struct Outlook {
    ahead: Ahead,
    /// Hours of the day that are left when the aircraft is ready there.
    left_h: f64,
    /// Passengers of this period who want to fly there.
    arriving: u32,
    /// The number of vertiports in range from there, and of those to which the route is closed.
    neighbours: u32,
    shut: u32,
}

/// The number of aircraft that are ready at a vertiport within each time of [`READY_S`], and the
/// flights that can leave it at each time of [`ONWARD_S`].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Ahead {
    within: [u16; 5],
    onward: [Onward; 3],
}

/// The weight of an edge from one vertiport to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edges {
    /// 1 / (1 + flight time in hours), for pairs that can be flown.
    Distance,
    /// 1 for every pair that the deciding aircraft's type can fly now.
    Reachable,
    /// The profit per hour of a flight, in hourly profits of a typical full flight, with the
    /// passengers who wait now.
    Profit,
}

/// Evaluates decisions. It caches the flights of recent days.
#[derive(Debug, Clone, Default)]
pub(crate) struct Eye {
    boards: Boards,
    around: Vec<Around<Ahead>>,
}

/// A decision as `gcaps-full` and `mlp-full` observe it.
#[derive(Clone, Copy)]
pub(crate) struct Look<'a> {
    view: View<'a>,
    decision: &'a Decision,
    kind: TypeIx,
    feasible: VertiportSet,
    board: &'a Board,
    around: &'a [Around<Ahead>],
}

impl Eye {
    pub(crate) fn look<'a>(
        &'a mut self,
        view: View<'a>,
        decision: &'a Decision,
        feasible: VertiportSet,
    ) -> Look<'a> {
        let kind = view.kind(decision.aircraft);
        let board = self.boards.of(view);
        let fresh = |to, ready| {
            let onward = ONWARD_S.map(|later_s| board.onward(view, kind, to, ready + later_s));
            // The departures of now come last, so that their rates are in the board when edges are
            // written.
            board.look(view, kind, to, decision.time);
            Ahead { within: [0; 5], onward }
        };
        look_around(&mut self.around, view, decision, fresh, |around, other| {
            let within = around[other.at.at()].more.within.iter_mut();
            for (count, within_s) in within.zip(READY_S) {
                *count += u16::from(other.time <= decision.time + within_s);
            }
        });
        Look { view, decision, kind, feasible, board, around: &self.around }
    }
}

impl Look<'_> {
    /// Writes the columns of the aircraft.
    pub(crate) fn write_aircraft(&self, to: &mut [f32]) {
        let [_, queue @ .., _] = self.around[self.decision.at.at()].more.within;
        let choices = self.feasible.iter().count();
        let aircraft = Aircraft::of(self.view, self.decision, queue, choices, ());
        column::write(&AIRCRAFT, &aircraft, to);
    }

    /// Writes the columns of the vertiports into the first columns of their rows, which have
    /// `stride` columns each.
    pub(crate) fn write_nodes(&self, stride: usize, to: &mut [f32]) {
        let Self { view, decision, kind, .. } = *self;
        let unit_usd = self.board.unit_usd(kind);
        let period = view.demand_left_in(view.period());
        let vertiports = VertiportIx::all(self.around.len()).zip(self.around);
        for ((at, around), row) in vertiports.zip(to.chunks_exact_mut(stride)) {
            let neighbours = view.within_range(kind, at);
            let more = Outlook {
                ahead: around.more,
                left_h: hours(view.day_end().since(around.ready)),
                arriving: period.iter().skip(at.at()).step_by(view.vertiports()).sum(),
                neighbours: neighbours.len(),
                shut: neighbours.and(&view.closed(at)).len(),
            };
            let is_open = self.feasible.contains(at);
            let node = Node::of(view, decision, (at, around), unit_usd, is_open, more);
            column::write(&NODES, &node, &mut row[..NODES.len()]);
        }
    }

    /// Writes the weights of the edges between vertiports, in the direction of flights. Each
    /// vertiport of departure has a row of `stride` entries. The array must hold zeros: entries
    /// that are 0, such as pairs out of range, are not written.
    pub(crate) fn write_edges(&self, edges: Edges, stride: usize, to: &mut [f32]) {
        let Self { view, decision, kind, board, .. } = *self;
        let period = view.period_at(decision.time);
        let vertiports = VertiportIx::all(view.vertiports());
        for (from, row) in vertiports.zip(to.chunks_exact_mut(stride)) {
            let (in_range, closed) = (view.within_range(kind, from), view.closed(from));
            match edges {
                Edges::Distance => {
                    for to in in_range.iter() {
                        let flight_h = hours(view.leg(kind, from, to).flight_s);
                        row[to.at()] = (1.0 / (1.0 + flight_h)) as f32;
                    }
                }
                Edges::Reachable => {
                    in_range.without(&closed).iter().for_each(|to| row[to.at()] = 1.0);
                }
                Edges::Profit => {
                    row[..view.vertiports()].copy_from_slice(board.rates(kind, from, period));
                    closed.iter().for_each(|to| row[to.at()] = 0.0);
                }
            }
        }
    }
}

/// A logarithmic scale for a number that may be large.
fn log(number: f64) -> f64 {
    (number.ln_1p() / 3.0).min(3.0)
}
