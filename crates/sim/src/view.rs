//! What a policy may look at when it decides: the present, the forecast, and what any flight would take.

use std::sync::Arc;

use vertifleet_core::{AircraftIx, AircraftType, ClosedTimes, Scenario, Time, TypeIx, VertiportIx};

use crate::{Decision, Imagined, Leg, Simulation, VertiportSet};

/// The state of the network at the moment of a decision. Borrowed; costs nothing to make.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    simulation: &'a Simulation,
}

/// Tells one day from every other, and shows nothing of it. Two keys are equal if they are of the same scenario in memory;
/// while a key lives, no other day can take its place.
#[derive(Debug, Clone)]
pub struct DayKey(Arc<Scenario>);

impl PartialEq for DayKey {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for DayKey {}

impl<'a> View<'a> {
    pub(crate) fn of(simulation: &'a Simulation) -> Self {
        Self { simulation }
    }

    /// Number of vertiports (N).
    #[inline]
    pub fn vertiports(&self) -> usize {
        self.scenario().vertiports.len()
    }

    /// The mask: hold, and every other vertiport within range that has a stand free. Never empty.
    #[inline]
    pub fn feasible(&self, decision: &Decision) -> VertiportSet {
        self.simulation.feasible(decision)
    }

    /// The id of an aircraft, for people; none if the day has no such aircraft.
    pub fn aircraft_id(&self, aircraft: AircraftIx) -> Option<&'a str> {
        self.scenario().aircraft.get(aircraft.at()).map(|aircraft| aircraft.id.as_str())
    }

    /// The type of an aircraft.
    #[inline]
    pub fn kind(&self, aircraft: AircraftIx) -> TypeIx {
        self.scenario().aircraft[aircraft.at()].kind
    }

    /// What aircraft of a type can do.
    #[inline]
    pub fn aircraft_type(&self, kind: TypeIx) -> &'a AircraftType {
        &self.aircraft_types()[kind.at()]
    }

    /// The types of aircraft there are.
    #[inline]
    pub fn aircraft_types(&self) -> &'a [AircraftType] {
        &self.scenario().aircraft_types
    }

    /// What a flight takes.
    #[inline]
    pub fn leg(&self, kind: TypeIx, from: VertiportIx, to: VertiportIx) -> &'a Leg {
        self.simulation.legs().leg(kind, from, to)
    }

    /// What flights from a vertiport to each take.
    #[inline]
    pub fn legs_from(&self, kind: TypeIx, from: VertiportIx) -> &'a [Leg] {
        self.simulation.legs().legs_from(kind, from)
    }

    /// The other vertiports that a corridor leads to and a full battery reaches, routes that are closed now included.
    #[inline]
    pub fn within_range(&self, kind: TypeIx, from: VertiportIx) -> &'a VertiportSet {
        self.simulation.legs().within_range(kind, from)
    }

    /// Where flights from a vertiport may not go now, because the route is closed.
    #[inline]
    pub fn closed(&self, from: VertiportIx) -> VertiportSet {
        self.simulation.closures().from(from)
    }

    /// The same because of closures that were not known before they began. How long they last is not known.
    #[inline]
    pub fn closed_unexpectedly(&self, from: VertiportIx) -> VertiportSet {
        self.simulation.closures().unexpected_from(from)
    }

    /// When routes are closed that are known to be, all day. Unknown closures are not among these, also while they
    /// are in force.
    #[inline]
    pub fn known_closures(&self) -> &'a ClosedTimes {
        self.simulation.closures().known()
    }

    /// How often routes have closed or opened so far without anybody knowing beforehand: while it stays the same, what is closed
    /// is what was to be expected.
    #[inline]
    pub fn route_changes(&self) -> usize {
        self.simulation.closures().surprises_so_far()
    }

    /// Where each aircraft stands or will land.
    #[inline]
    pub fn places(&self) -> &'a [VertiportIx] {
        self.simulation.places()
    }

    /// When the aircraft can be expected to decide next. An outage counts once it has begun.
    #[inline]
    pub fn ready_at(&self, aircraft: AircraftIx) -> Time {
        self.simulation.expected_ready(aircraft)
    }

    /// U_i of every vertiport: aircraft standing there or in the air towards it. Where chargers are a pool of their own, those
    /// who have one or are on their way to one.
    #[inline]
    pub fn stands_taken(&self) -> &'a [u16] {
        self.simulation.stands().taken()
    }

    /// The demand period of now.
    #[inline]
    pub fn period(&self) -> usize {
        self.simulation.period()
    }

    /// The demand period that contains a time.
    #[inline]
    pub fn period_at(&self, time: Time) -> usize {
        self.scenario().period_at(time)
    }

    /// When each demand period begins, in order.
    #[inline]
    pub fn period_starts(&self) -> &'a [Time] {
        &self.scenario().periods
    }

    /// Passengers who still want to fly from one vertiport to another in a period: of those who are there in a period that has
    /// begun, of those who are forecast in a later one.
    #[inline]
    pub fn demand_left(&self, period: usize, from: VertiportIx, to: VertiportIx) -> u32 {
        self.simulation.demand().left(period, from, to)
    }

    /// The same for all pairs of a period, `[from][to]` row by row.
    #[inline]
    pub fn demand_left_in(&self, period: usize) -> &'a [u32] {
        self.simulation.demand().period(period)
    }

    /// P_ij of flights decided in a period, dollars a passenger, from one vertiport to each.
    #[inline]
    pub fn fares_usd(&self, period: usize, from: VertiportIx) -> &'a [f64] {
        self.scenario().fare_usd.in_period(period).row(from)
    }

    /// R_ij, dollars a passenger, from one vertiport to each.
    #[inline]
    pub fn passenger_costs_usd(&self, from: VertiportIx) -> &'a [f64] {
        self.scenario().passenger_cost_usd.row(from)
    }

    /// What a flight costs with or without passengers, beside its energy; dollars, from one vertiport to each.
    #[inline]
    pub fn flight_costs_usd(&self, from: VertiportIx) -> &'a [f64] {
        self.scenario().flight_cost_usd.row(from)
    }

    /// What the fleet costs whatever it does, dollars a day.
    pub fn fleet_cost_usd(&self) -> f64 {
        self.scenario().fleet_cost_usd()
    }

    /// E now, dollars per kWh.
    #[inline]
    pub fn energy_price_usd(&self) -> f64 {
        self.scenario().energy_price_usd[self.period()]
    }

    /// E in every demand period, dollars per kWh.
    #[inline]
    pub fn energy_prices_usd(&self) -> &'a [f64] {
        &self.scenario().energy_price_usd
    }

    /// What a flight decided at `time` (not before now) would earn with `waiting` passengers there if it is on time: dollars,
    /// fares less passenger cost less energy at the price of its arrival less what any flight costs.
    #[inline]
    pub fn flight_profit_usd(
        &self,
        time: Time,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
        waiting: u32,
    ) -> f64 {
        let seats = u32::from(self.aircraft_type(kind).seats);
        let leg = self.leg(kind, from, to);
        let fares_usd = self.fares_usd(self.period_at(time), from);
        let margin_usd = fares_usd[to.at()] - self.passenger_costs_usd(from)[to.at()];
        let energy_price_usd = self.simulation.energy_price_at(time + leg.flight_s);
        f64::from(waiting.min(seats)) * margin_usd
            - leg.energy_kwh * energy_price_usd
            - self.flight_costs_usd(from)[to.at()]
    }

    /// Start of operations.
    #[inline]
    pub fn day_start(&self) -> Time {
        self.scenario().operations.start
    }

    /// Last instant of decisions.
    #[inline]
    pub fn day_end(&self) -> Time {
        self.scenario().operations.end
    }

    /// Seconds a hold lasts.
    #[inline]
    pub fn hold_s(&self) -> u32 {
        self.scenario().operations.hold_s
    }

    /// U_max of a vertiport: its stands, or its chargers where they are a pool of their own. A flight needs one of them.
    #[inline]
    pub fn stands(&self, vertiport: VertiportIx) -> u16 {
        self.simulation.stands().limit()[vertiport.at()]
    }

    /// Aircraft that wait on stands of a vertiport where chargers are a pool of their own, and how many such stands there are;
    /// both 0 everywhere else.
    pub fn parked(&self, vertiport: VertiportIx) -> (u16, u16) {
        self.simulation.stands().parked(vertiport)
    }

    /// The rest of the day as it can be imagined from here, to be played out.
    pub fn imagined(&self) -> Imagined {
        Imagined::of(self.simulation)
    }

    /// The same in the room of an earlier course, which is written over; takes no memory if that was of the same day.
    pub fn imagined_in<'room>(&self, room: &'room mut Option<Imagined>) -> &'room mut Imagined {
        if let Some(imagined) = room {
            imagined.restart(self.simulation);
        }
        room.get_or_insert_with(|| self.imagined())
    }

    /// The day itself, to be told from every other.
    #[inline]
    pub fn day(&self) -> DayKey {
        DayKey(Arc::clone(self.simulation.scenario()))
    }

    /// The seed the day was drawn with.
    #[inline]
    pub fn day_seed(&self) -> u64 {
        self.scenario().seed
    }

    #[inline]
    fn scenario(self) -> &'a Scenario {
        self.simulation.scenario()
    }
}
