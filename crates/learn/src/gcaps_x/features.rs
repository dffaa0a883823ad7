//! The observation of `gcaps-x`: every vertiport as it looks from the deciding aircraft, in numbers
//! that mean the same on every network.
//!
//! Dollars are measured in the profit of a typical full flight of the network, times in hours, and
//! passengers in flights; every number is bounded. Writing a row takes one pass over the vertiports
//! and one over the fleet, and for up to 48 of the aircraft that are ready soon it also computes
//! which choice they would prefer.

use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_policy::{Choices, DayPrices, PricedChoice};
use vertifleet_sim::{Decision, View};

use crate::nn::Shape;
use crate::rows::Rows;

/// F, the number of node features.
pub(crate) const NODE_FEATURES: usize = 24;
/// G, the number of aircraft features.
pub(crate) const AIRCRAFT_FEATURES: usize = 10;
/// The node features in their order; docs/src/concepts/policies.md says what each means.
#[cfg(test)]
pub(crate) const NODE_FEATURE_NAMES: [&str; NODE_FEATURES] = [
    "listed",
    "regret",
    "regret_sharp",
    "is_own",
    "is_possible",
    "block_h",
    "profit",
    "profit_per_h",
    "seats_filled",
    "next_seats_filled",
    "demand_left",
    "demand_next",
    "passenger_price",
    "rent",
    "rent_after",
    "worth_beside_staying",
    "worth_falling",
    "stands_free",
    "stands_taken",
    "ready_before",
    "ready_about",
    "competitors",
    "contention",
    "day_left",
];
/// The aircraft features in their order.
#[cfg(test)]
pub(crate) const AIRCRAFT_FEATURE_NAMES: [&str; AIRCRAFT_FEATURES] = [
    "day_left",
    "period_left",
    "queue_15",
    "queue_30",
    "queue_60",
    "rent",
    "lead",
    "choices",
    "aircraft_a_vertiport",
    "aircraft_a_stand",
];
/// A factor for differences in worth, which makes the small ones that matter visible to the
/// network.
const SHARPER: f64 = 8.0;
/// Other aircraft that are ready this long before or after the deciding one want the same flights,
/// seconds.
const NEAR_S: u32 = 900;
/// For other aircraft that are ready within this time, seconds, the preferred choice is computed;
/// for at most `MOST_COMPETITORS` of them, and for fewer if there are more than 30 vertiports to
/// choose from.
const COMPETITORS_S: u32 = 1_800;
const MOST_COMPETITORS: usize = 48;
const MOST_ASKED: usize = 30 * MOST_COMPETITORS;
/// How soon other aircraft at the same vertiport are ready, seconds; the aircraft features count
/// them for each of these times.
const QUEUE_S: [u32; 3] = [900, 1_800, 3_600];

/// The shape of the features for this many vertiports.
pub(crate) fn shape(vertiports: usize) -> Shape {
    Shape { vertiports, node_features: NODE_FEATURES, aircraft_features: AIRCRAFT_FEATURES }
}

/// A decision together with what its choices are valued by: the state of the day and its prices.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) view: View<'a>,
    pub(crate) decision: &'a Decision,
    pub(crate) prices: &'a DayPrices,
    /// The profit of a typical full flight, dollars.
    pub(crate) unit_usd: f64,
}

impl<'a> Scene<'a> {
    pub(crate) fn of(view: View<'a>, decision: &'a Decision, prices: &'a DayPrices) -> Self {
        Self { view, decision, prices, unit_usd: prices.unit_usd(view.kind(decision.aircraft)) }
    }

    /// The unit of the network's additions, dollars: the profit of a typical full flight, reduced
    /// where a decision has less than that at stake. The network learns where most flights are
    /// full. Where most seats stay empty, the prices are the better guide, and an addition of a
    /// share of a full flight would drown them out.
    pub(crate) fn addition_usd(&self) -> f64 {
        let fullness = (self.prices.stake_usd() / self.unit_usd).min(1.0);
        self.unit_usd * fullness * fullness
    }
}

/// Writes rows. It keeps its memory from row to row.
#[derive(Debug, Clone, Default)]
pub(crate) struct Writer {
    /// The other aircraft as the row being written counts them, by vertiport.
    seen: Vec<Seen>,
}

/// The other aircraft that stand at a vertiport or are on their way there.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    /// The time at which the deciding aircraft would be ready there.
    ready: Time,
    /// The number of aircraft that are ready before that time, and the number that are ready at
    /// about that time.
    before: u16,
    near: u16,
    /// The number of aircraft that are ready soon and are best off here, and the sum of what they
    /// would lose by going elsewhere, in units.
    competitors: u16,
    contention: f64,
}

impl Writer {
    /// Adds the row of a decision between the choices of a list, which starts with the best and has
    /// the worth of each at the prices.
    pub(crate) fn push(&mut self, scene: Scene<'_>, listed: &[PricedChoice], rows: &mut Rows) {
        let queue = self.write_vertiport_features(scene);
        let best_usd = listed[0].worth_usd;
        let second_usd = listed.get(1).map_or(f64::NEG_INFINITY, |second| second.worth_usd);
        let lead = (best_usd - second_usd) / scene.unit_usd;
        // Only the value head reads the clock, and `gcaps-x` does not use the value head.
        rows.push(|row| {
            for (to, value) in
                row.aircraft.iter_mut().zip(aircraft(scene, queue, lead, listed.len()))
            {
                *to = value as f32;
            }
            for &PricedChoice { to, .. } in listed {
                row.nodes[to.at() * NODE_FEATURES] = 1.0;
            }
            let choices = scene.prices.choices(scene.view, scene.decision);
            for (at, to) in row.nodes.chunks_exact_mut(NODE_FEATURES).enumerate() {
                let at = VertiportIx::new(at);
                let node = node(scene, &choices, at, best_usd, self.seen[at.at()]);
                for (to, value) in to[1..].iter_mut().zip(node) {
                    *to = value as f32;
                }
            }
        });
    }

    /// Counts the other aircraft at each vertiport. Returns how many of them are ready at the
    /// deciding aircraft's own vertiport within each time of [`QUEUE_S`].
    fn write_vertiport_features(&mut self, scene: Scene<'_>) -> [u16; 3] {
        let Scene { view, decision, .. } = scene;
        let kind = view.kind(decision.aircraft);
        let legs = view.legs_from(kind, decision.at);
        self.seen.resize(legs.len(), Seen::default());
        for (to, (seen, leg)) in self.seen.iter_mut().zip(legs).enumerate() {
            let stays = to == decision.at.at();
            let block_s = if stays { view.hold_s() } else { leg.block_s() };
            *seen = Seen { ready: decision.time + block_s, ..Seen::default() };
        }
        let most_competitors = (MOST_ASKED / legs.len()).min(MOST_COMPETITORS);
        let (mut queue, mut competitors) = ([0; 3], 0);
        for (other, place) in AircraftIx::all(view.places().len()).zip(view.places()) {
            if other == decision.aircraft {
                continue;
            }
            let ready = view.ready_at(other);
            let seen = &mut self.seen[place.at()];
            seen.before += u16::from(ready < seen.ready);
            let apart_s = ready.since(seen.ready).max(seen.ready.since(ready));
            seen.near += u16::from(apart_s <= NEAR_S);
            if ready <= decision.time + COMPETITORS_S && competitors < most_competitors {
                competitors += 1;
                self.count_competitor(
                    scene,
                    &Decision { time: ready, aircraft: other, at: *place, ..*decision },
                );
            }
            if *place == decision.at {
                for (queue, within_s) in queue.iter_mut().zip(QUEUE_S) {
                    *queue += u16::from(ready <= decision.time + within_s);
                }
            }
        }
        queue
    }

    /// Records which choice another aircraft would prefer, among those that are open now and not
    /// known to be closed when it is ready.
    fn count_competitor(
        &mut self,
        Scene { view, prices, unit_usd, .. }: Scene<'_>,
        other: &Decision,
    ) {
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
        let seen = &mut self.seen[best.1.at()];
        if best.1 != other.at {
            seen.competitors += 1;
            seen.contention += ((best.0 - second_usd) / unit_usd).min(0.5);
        }
    }
}

/// The aircraft features; `lead` is by how much the best choice is worth more than the second, in
/// units.
fn aircraft(
    scene: Scene<'_>,
    queue: [u16; 3],
    lead: f64,
    listed: usize,
) -> [f64; AIRCRAFT_FEATURES] {
    let Scene { view, decision, prices, unit_usd } = scene;
    let Decision { time, at, .. } = *decision;
    let day_s = view.day_end().since(view.day_start()).max(1);
    let next_period = view.period_starts().get(view.period() + 1).copied();
    let period_left_s = next_period.map_or(3_600, |next| next.since(time));
    let stands: u32 =
        VertiportIx::all(view.vertiports()).map(|at| u32::from(view.stands(at))).sum();
    let fleet = view.places().len() as f64;
    let per_vertiport = fleet / view.vertiports() as f64;
    [
        f64::from(view.day_end().since(time)) / f64::from(day_s),
        (f64::from(period_left_s) / 3_600.0).min(1.0),
        saturating_count(queue[0], 4.0),
        saturating_count(queue[1], 4.0),
        saturating_count(queue[2], 4.0),
        (prices.rent_usd(at, time, time + 900) / unit_usd).min(2.0),
        (SHARPER * lead).min(1.0),
        listed as f64 / 4.0,
        (per_vertiport / 8.0).min(2.0),
        fleet / f64::from(stands),
    ]
}

/// The features of a vertiport, except for whether it is on the list.
fn node(
    scene: Scene<'_>,
    choices: &Choices<'_>,
    to: VertiportIx,
    best_usd: f64,
    seen: Seen,
) -> [f64; NODE_FEATURES - 1] {
    let Scene { view, decision, prices, unit_usd } = scene;
    let Decision { time, at: from, .. } = *decision;
    let kind = view.kind(decision.aircraft);
    let stays = to == from;
    let possible = stays || view.within_range(kind, from).contains(to);
    let units = |usd: f64| usd / unit_usd;
    let ready = seen.ready;
    let regret = if possible { units(best_usd - choices.worth_usd(to)) } else { 1.0 };
    let (profit, waiting, passenger_usd) = if stays || !possible {
        (0.0, 0, 0.0)
    } else {
        let waiting = view.demand_left(view.period(), from, to);
        let profit_usd = view.flight_profit_usd(time, kind, (from, to), waiting);
        (units(profit_usd), waiting, prices.passenger_usd(view.period(), from, to))
    };
    let seats = u32::from(view.aircraft_type(kind).seats);
    let flights = |passengers: u32| (f64::from(passengers) / f64::from(seats)).ln_1p() / 3.0;
    let next_period = (view.period() + 1).min(view.period_starts().len() - 1);
    let later = if stays { 0 } else { view.demand_left(next_period, from, to) };
    let block_h = f64::from(ready.since(time)) / 3_600.0;
    let worth_usd = prices.worth_usd(kind, to, ready);
    let stands = view.stands(to);
    let taken = view.stands_taken()[to.at()];
    let day_s = view.day_end().since(view.day_start()).max(1);
    [
        -regret.clamp(0.0, 1.0),
        -(SHARPER * regret).clamp(0.0, 1.0),
        f64::from(u8::from(stays)),
        f64::from(u8::from(possible)),
        block_h.min(3.0),
        profit.clamp(-1.0, 3.0),
        (profit / block_h.max(0.1)).clamp(-1.0, 3.0),
        f64::from(waiting.min(seats)) / f64::from(seats),
        f64::from(waiting.saturating_sub(seats).min(seats)) / f64::from(seats),
        flights(waiting).min(1.5),
        flights(later).min(1.5),
        units(f64::from(waiting.min(seats)) * passenger_usd).min(2.0),
        units(prices.rent_usd(to, time, ready)).min(2.0),
        units(prices.rent_usd(to, ready, ready + 3_600)).min(2.0),
        units(worth_usd - prices.worth_usd(kind, from, ready)).clamp(-2.0, 2.0),
        units(worth_usd - prices.worth_usd(kind, to, ready + 900)).clamp(-1.0, 1.0),
        saturating_count(stands.saturating_sub(taken), 4.0),
        f64::from(taken) / f64::from(stands),
        saturating_count(seen.before, 4.0),
        saturating_count(seen.near, 4.0),
        saturating_count(seen.competitors, 4.0),
        (2.0 * seen.contention).min(2.0),
        f64::from(view.day_end().since(ready)) / f64::from(day_s),
    ]
}

/// A small count as a multiple of its usual value, at most 2.
pub(crate) fn saturating_count(count: u16, usual: f64) -> f64 {
    (f64::from(count) / usual).min(2.0)
}
