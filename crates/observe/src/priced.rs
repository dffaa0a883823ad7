//! The observation of `gcaps-x`: every vertiport relative to the deciding aircraft at the day's bid
//! prices. Its numbers mean the same on every network.
//!
//! Dollars are measured in the profit of a typical full flight of the network, times in hours, and
//! passengers in flights; every number is bounded. A decision takes one pass over the fleet. For up
//! to 48 of the aircraft that are ready soon, the pass also computes which choice they would
//! prefer.

use vertifleet_core::VertiportIx;
use vertifleet_policy::{DayPrices, PricedChoice};
use vertifleet_sim::{Decision, View};

use crate::column::{
    self, Aircraft, Around, Column, Node, QUEUE_S, counted, flag, look_around, share,
};

/// A logit of 1 is worth the unit divided by this.
pub const LOGITS_A_UNIT: f64 = 20.0;
/// The lowest worth in a part; lower values are written as this.
const LEAST_WORTH: f64 = -1e6;
/// A factor for differences in worth, so that the network can distinguish the small ones that
/// matter.
const SHARPER: f64 = 8.0;
/// The preferred choice is computed for other aircraft that are ready within this time, seconds;
/// for at most `MOST_COMPETITORS` of them, and for fewer if more than 30 vertiports can be chosen.
const COMPETITORS_S: u32 = 1_800;
const MOST_COMPETITORS: usize = 48;
const MOST_ASKED: usize = 30 * MOST_COMPETITORS;

type PricedNode = Node<Worth>;
type PricedAircraft = Aircraft<Stake>;

/// The columns of a vertiport.
pub(crate) const NODES: [Column<PricedNode>; 24] = [
    Column("listed", |node| flag(node.is_open)),
    Column("regret", |node| -node.more.regret.clamp(0.0, 1.0)),
    Column("regret_sharp", |node| -(SHARPER * node.more.regret).clamp(0.0, 1.0)),
    Node::IS_OWN,
    Column("is_possible", |node| flag(node.is_in_range)),
    Node::BLOCK_H,
    Node::PROFIT,
    Node::PROFIT_PER_H,
    Node::SEATS_FILLED,
    Node::NEXT_SEATS_FILLED,
    Column("demand_left", |node| flights(node.waiting, node.seats)),
    Column("demand_next", |node| flights(node.later, node.seats)),
    Column("passenger_price", |node| node.more.passengers.min(2.0)),
    Column("rent", |node| node.more.rent.min(2.0)),
    Column("rent_after", |node| node.more.rent_after.min(2.0)),
    Column("worth_beside_staying", |node| node.more.beside_staying.clamp(-2.0, 2.0)),
    Column("worth_falling", |node| node.more.falling.clamp(-1.0, 1.0)),
    Node::STANDS_FREE,
    Column("stands_taken", |node| share(node.taken.into(), node.stands.into())),
    Node::READY_BEFORE,
    Node::READY_ABOUT,
    Column("competitors", |node| counted(node.more.rivals.competitors)),
    Column("contention", |node| (2.0 * node.more.rivals.contention).min(2.0)),
    Node::DAY_LEFT,
];

/// The columns of the deciding aircraft.
pub(crate) const AIRCRAFT: [Column<PricedAircraft>; 10] = [
    Aircraft::DAY_LEFT,
    Aircraft::PERIOD_LEFT,
    Aircraft::QUEUE_15,
    Aircraft::QUEUE_30,
    Aircraft::QUEUE_60,
    Column("rent", |aircraft| aircraft.more.rent.min(2.0)),
    Column("lead", |aircraft| (SHARPER * aircraft.more.lead).min(1.0)),
    Column("choices", |aircraft| aircraft.choices as f64 / 4.0),
    Aircraft::A_VERTIPORT,
    Column("aircraft_a_stand", |aircraft| aircraft.fleet / f64::from(aircraft.stands)),
];

/// The worth of a vertiport at the prices; dollars in units.
pub(crate) struct Worth {
    /// The worth of the best choice less that of this one.
    regret: f64,
    /// The price of the passengers who would board.
    passengers: f64,
    /// The rent of a stand until the aircraft is ready, and for an hour afterwards.
    rent: f64,
    rent_after: f64,
    /// The worth of the aircraft there less its worth here, and less its worth there a quarter of
    /// an hour later.
    beside_staying: f64,
    falling: f64,
    rivals: Rivals,
}

/// The money at stake in a decision; dollars in units.
pub(crate) struct Stake {
    /// The rent of the stand that the aircraft has, for a quarter of an hour.
    rent: f64,
    /// The worth of the best choice less that of the second.
    lead: f64,
}

/// The aircraft that are ready soon and for which a vertiport is the best choice, and the sum of
/// what they would lose by another choice, in units.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rivals {
    competitors: u16,
    contention: f64,
}

/// A decision together with the state of the day and its prices, which its choices are valued by.
#[derive(Debug, Clone, Copy)]
pub struct PricedDecision<'a> {
    /// The view of the day.
    pub view: View<'a>,
    /// The decision.
    pub decision: &'a Decision,
    /// The day's bid prices.
    pub prices: &'a DayPrices,
    /// The profit of a typical full flight, dollars.
    pub unit_usd: f64,
}

impl<'a> PricedDecision<'a> {
    /// A decision at these prices.
    pub fn of(view: View<'a>, decision: &'a Decision, prices: &'a DayPrices) -> Self {
        Self { view, decision, prices, unit_usd: prices.unit_usd(view.kind(decision.aircraft)) }
    }

    /// The unit of the network's additions, dollars: the profit of a typical full flight, or less
    /// where less is at stake in the decision. The network learns on days on which most flights are
    /// full. Where most seats stay empty, the prices are the better guide, and an addition of a
    /// share of a full flight would outweigh them.
    pub fn addition_usd(&self) -> f64 {
        let fullness = (self.prices.stake_usd() / self.unit_usd).min(1.0);
        self.unit_usd * fullness * fullness
    }

    fn units(&self, usd: f64) -> f64 {
        usd / self.unit_usd
    }

    /// Records which choice another aircraft would prefer, among those that are open now and not
    /// known to be closed when it is ready.
    fn count_competitor(&self, around: &mut [Around<Rivals>], other: &Decision) {
        let Self { view, prices, .. } = *self;
        let mut best = (f64::NEG_INFINITY, other.at);
        let mut second_usd = f64::NEG_INFINITY;
        let known = view.known_closures();
        let is_open = |to: &VertiportIx| !known.is_closed(other.at, *to, other.time);
        let choices = prices.choices(view, other);
        for to in view.feasible(other).iter().filter(is_open) {
            let usd = choices.worth_usd(to);
            if usd > best.0 {
                second_usd = best.0;
                best = (usd, to);
            } else {
                second_usd = second_usd.max(usd);
            }
        }
        let rivals = &mut around[best.1.at()].more;
        if best.1 != other.at {
            rivals.competitors += 1;
            rivals.contention += self.units(best.0 - second_usd).min(0.5);
        }
    }
}

/// Evaluates decisions at their prices. It reuses its memory between decisions.
#[derive(Debug, Clone, Default)]
pub(crate) struct Eye {
    around: Vec<Around<Rivals>>,
}

/// A decision as `gcaps-x` observes it.
#[derive(Clone, Copy)]
pub(crate) struct Look<'a> {
    scene: PricedDecision<'a>,
    /// The choices that the network decides between, the best at the prices first.
    listed: &'a [PricedChoice],
    around: &'a [Around<Rivals>],
    queue: [u16; 3],
}

impl Eye {
    pub(crate) fn look<'a>(
        &'a mut self,
        scene: PricedDecision<'a>,
        listed: &'a [PricedChoice],
    ) -> Look<'a> {
        let PricedDecision { view, decision, .. } = scene;
        let most_competitors = (MOST_ASKED / view.vertiports()).min(MOST_COMPETITORS);
        let (mut queue, mut competitors) = ([0; 3], 0);
        let fresh = |_, _| Rivals::default();
        look_around(&mut self.around, view, decision, fresh, |around, other| {
            if other.time <= decision.time + COMPETITORS_S && competitors < most_competitors {
                competitors += 1;
                scene.count_competitor(around, &other);
            }
            if other.at == decision.at {
                for (queue, within_s) in queue.iter_mut().zip(QUEUE_S) {
                    *queue += u16::from(other.time <= decision.time + within_s);
                }
            }
        });
        Look { scene, listed, around: &self.around, queue }
    }
}

impl Look<'_> {
    /// Writes the columns of the aircraft.
    pub(crate) fn write_aircraft(&self, to: &mut [f32]) {
        let PricedDecision { view, decision, prices, .. } = self.scene;
        let Decision { time, at, .. } = *decision;
        let second_usd = self.listed.get(1).map_or(f64::NEG_INFINITY, |second| second.worth_usd);
        let more = Stake {
            rent: self.scene.units(prices.rent_usd(at, time, time + 900)),
            lead: self.scene.units(self.listed[0].worth_usd - second_usd),
        };
        let aircraft = Aircraft::of(view, decision, self.queue, self.listed.len(), more);
        column::write(&AIRCRAFT, &aircraft, to);
    }

    /// Writes the columns of the vertiports into the first columns of their rows, which have
    /// `stride` columns each.
    pub(crate) fn write_nodes(&self, stride: usize, to: &mut [f32]) {
        let PricedDecision { view, decision, prices, unit_usd } = self.scene;
        let Decision { time, at: from, .. } = *decision;
        let kind = view.kind(decision.aircraft);
        let units = |usd: f64| usd / unit_usd;
        let best_usd = self.listed[0].worth_usd;
        let choices = prices.choices(view, decision);
        let vertiports = VertiportIx::all(self.around.len()).zip(self.around);
        for ((at, around), row) in vertiports.zip(to.chunks_exact_mut(stride)) {
            let is_listed = self.listed.iter().any(|choice| choice.to == at);
            let ready = around.ready;
            let worth_usd = prices.worth_usd(kind, at, ready);
            let more = Worth {
                regret: 1.0,
                passengers: 0.0,
                rent: units(prices.rent_usd(at, time, ready)),
                rent_after: units(prices.rent_usd(at, ready, ready + 3_600)),
                beside_staying: units(worth_usd - prices.worth_usd(kind, from, ready)),
                falling: units(worth_usd - prices.worth_usd(kind, at, ready + 900)),
                rivals: around.more,
            };
            let mut node = Node::of(view, decision, (at, around), unit_usd, is_listed, more);
            if node.is_in_range {
                node.more.regret = units(best_usd - choices.worth_usd(at));
                if !node.is_own {
                    let passenger_usd = prices.passenger_usd(view.period(), from, at);
                    let boarding = f64::from(node.waiting.min(node.seats));
                    node.more.passengers = units(boarding * passenger_usd);
                }
            }
            column::write(&NODES, &node, &mut row[..NODES.len()]);
        }
    }

    /// Writes the worth of each listed choice at the prices, less that of the best, in the unit of
    /// the network's logits, over zeros.
    pub(crate) fn write_worth(&self, to: &mut [f32]) {
        for choice in self.listed {
            let less_usd = choice.worth_usd - self.listed[0].worth_usd;
            let logits = LOGITS_A_UNIT * less_usd / self.scene.addition_usd();
            // Where nothing is at stake, the unit is 0: the network adds nothing, and any
            // difference in its unit is infinite.
            to[choice.to.at()] = if less_usd == 0.0 { 0.0 } else { logits.max(LEAST_WORTH) as f32 };
        }
    }
}

/// Passengers in full flights, on a logarithmic scale.
fn flights(passengers: u32, seats: u32) -> f64 {
    (share(passengers, seats).ln_1p() / 3.0).min(1.5)
}
