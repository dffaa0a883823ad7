//! The view of a policy at a decision: the present, the forecast, and what any flight would take.

use std::sync::Arc;

use vertifleet_core::{
    AircraftIx, AircraftType, ChargeRate, ClosedTimes, Scenario, Time, TypeIx, VertiportIx,
};

use crate::{
    Decision, Departures, Imagined, Leg, Outcome, Refusal, Simulation, Snapshot, VertiportSet,
};

/// The state of the day at the moment of a decision. It is borrowed and costs nothing to make.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    simulation: &'a Simulation,
}

/// Distinguishes a day from every other without revealing anything of it. Two keys are equal if
/// they belong to the same scenario in memory. While a key lives, no other day can take the
/// scenario's address.
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

    /// The mask: hold, and every other vertiport within range that has a free stand and to which
    /// the route is not closed. Never empty.
    #[inline]
    pub fn feasible(&self, decision: &Decision) -> VertiportSet {
        self.simulation.feasible(decision)
    }

    /// The rule that keeps the aircraft of a decision from flying to a vertiport; `None` if it is
    /// feasible.
    pub fn refusal(&self, decision: &Decision, to: VertiportIx) -> Option<Refusal> {
        let is_feasible = self.feasible(decision).contains(to);
        (!is_feasible).then(|| self.simulation.refusal(decision, to))
    }

    /// The id of an aircraft, for messages; `None` if the day has no such aircraft.
    pub fn aircraft_id(&self, aircraft: AircraftIx) -> Option<&'a str> {
        self.scenario().aircraft.get(aircraft.at()).map(|aircraft| aircraft.id.as_str())
    }

    /// The type of an aircraft.
    #[inline]
    pub fn kind(&self, aircraft: AircraftIx) -> TypeIx {
        self.scenario().aircraft[aircraft.at()].kind
    }

    /// The properties of a type of aircraft.
    #[inline]
    pub fn aircraft_type(&self, kind: TypeIx) -> &'a AircraftType {
        &self.aircraft_types()[kind.at()]
    }

    /// All types of aircraft.
    #[inline]
    pub fn aircraft_types(&self) -> &'a [AircraftType] {
        &self.scenario().aircraft_types
    }

    /// The leg of one type between two vertiports.
    #[inline]
    pub fn leg(&self, kind: TypeIx, from: VertiportIx, to: VertiportIx) -> &'a Leg {
        self.simulation.legs().leg(kind, from, to)
    }

    /// Whether aircraft decide before they are full, so that the charge of each matters.
    #[inline]
    pub fn charges_as_needed(&self) -> bool {
        self.simulation.legs().charge_as_needed()
    }

    /// What follows from a choice if it is on time. Only within range: the take-off of a flight for
    /// which no charge suffices means nothing.
    #[inline]
    pub fn outcome(&self, decision: &Decision, to: VertiportIx) -> Outcome {
        Outcome::of(self.simulation, decision, to)
    }

    /// What the battery of an aircraft holds when it decides next, as expected, kWh. On a day that
    /// charges to full this is its capacity.
    pub fn charge_kwh(&self, aircraft: AircraftIx) -> f64 {
        if self.charges_as_needed() {
            return self.charge_mwh(aircraft) as f64 / 1e6;
        }
        self.aircraft_type(self.kind(aircraft)).battery_kwh
    }

    /// What the battery of an aircraft holds when it decides next, as expected, mWh. For days that
    /// charge as needed.
    pub fn charge_mwh(&self, aircraft: AircraftIx) -> u64 {
        self.simulation.charge_mwh(aircraft, self.ready_at(aircraft))
    }

    /// What the battery of the deciding aircraft holds, mWh. For days that charge as needed.
    pub fn charge_mwh_at(&self, decision: &Decision) -> u64 {
        self.simulation.charge_mwh(decision.aircraft, decision.time)
    }

    /// The seconds from a time, at which an aircraft is on the ground, until it is full. For days
    /// that charge as needed.
    #[inline]
    pub fn to_full_s(&self, aircraft: AircraftIx, time: Time) -> f64 {
        self.simulation.to_full_s(aircraft, time)
    }

    /// How fast a type charges at a vertiport. For days that charge as needed.
    #[inline]
    pub fn charge_rate(&self, kind: TypeIx, at: VertiportIx) -> &'a ChargeRate {
        self.simulation.legs().rate(kind, at)
    }

    /// The highest power at which a type charges at a vertiport, kW, which its curve may lower.
    pub fn charging_power_kw(&self, kind: TypeIx, at: VertiportIx) -> f64 {
        let charger_kw = self.scenario().vertiports[at.at()].charger_kw.unwrap_or(f64::INFINITY);
        self.aircraft_type(kind).charge_kw.min(charger_kw)
    }

    /// The legs of one type from a vertiport to each vertiport.
    #[inline]
    pub fn legs_from(&self, kind: TypeIx, from: VertiportIx) -> &'a [Leg] {
        self.simulation.legs().legs_from(kind, from)
    }

    /// The other vertiports that a corridor leads to and a full battery reaches, including those to
    /// which the route is closed now.
    #[inline]
    pub fn within_range(&self, kind: TypeIx, from: VertiportIx) -> &'a VertiportSet {
        self.simulation.legs().within_range(kind, from)
    }

    /// The vertiports to which flights from a vertiport are closed now.
    #[inline]
    pub fn closed(&self, from: VertiportIx) -> VertiportSet {
        self.simulation.closures().from(from)
    }

    /// The vertiports closed now by closures that were not known before they began. How long these
    /// last is not known.
    #[inline]
    pub fn closed_unexpectedly(&self, from: VertiportIx) -> VertiportSet {
        self.simulation.closures().unexpected_from(from)
    }

    /// The times of known closures, over the whole day. Unknown closures are never among them, even
    /// while they are in force.
    #[inline]
    pub fn known_closures(&self) -> &'a ClosedTimes {
        self.simulation.closures().known()
    }

    /// How often routes have closed or opened so far by unknown closures. While this number stays
    /// the same, the routes that are closed are those that were expected to be.
    #[inline]
    pub fn route_changes(&self) -> usize {
        self.simulation.closures().surprises_so_far()
    }

    /// How late a flight that is decided at a time is expected to leave a vertiport, seconds: as
    /// late as the latest flight that left it in the same quarter of an hour, 0 if none has.
    /// Imagined days continue with it.
    pub fn known_delay_s(&self, decided: Time, from: VertiportIx) -> u32 {
        self.simulation.delays.known_s(decided, from)
    }

    /// The vertiport where each aircraft stands or will land.
    #[inline]
    pub fn places(&self) -> &'a [VertiportIx] {
        self.simulation.places()
    }

    /// The time at which the aircraft is expected to decide next. An outage counts once it has
    /// begun.
    #[inline]
    pub fn ready_at(&self, aircraft: AircraftIx) -> Time {
        self.simulation.expected_ready(aircraft)
    }

    /// The time at which an aircraft landed, or will land, where it stands or is flying to; the
    /// start of operations before its first flight. It is in the air until then.
    #[inline]
    pub fn arrives_at(&self, aircraft: AircraftIx) -> Time {
        self.simulation.arrival(aircraft)
    }

    /// U_i of every vertiport: the number of aircraft standing there or in the air towards it.
    /// Where chargers are counted apart, the number of those that have a charger or are on their
    /// way to one.
    #[inline]
    pub fn stands_taken(&self) -> &'a [u16] {
        self.simulation.stands().taken()
    }

    /// The current demand period.
    #[inline]
    pub fn period(&self) -> usize {
        self.simulation.period()
    }

    /// The demand period that contains a time.
    #[inline]
    pub fn period_at(&self, time: Time) -> usize {
        self.scenario().period_at(time)
    }

    /// The start of each demand period, in order.
    #[inline]
    pub fn period_starts(&self) -> &'a [Time] {
        &self.scenario().periods
    }

    /// Passengers who still want to fly from one vertiport to another in a period: actual
    /// passengers in a period that has begun, forecast passengers in a later one.
    #[inline]
    pub fn demand_left(&self, period: usize, from: VertiportIx, to: VertiportIx) -> u32 {
        self.simulation.demand().left(period, from, to)
    }

    /// The passengers of [`demand_left`](Self::demand_left) for all pairs of a period, `[from][to]`
    /// row by row.
    #[inline]
    pub fn demand_left_in(&self, period: usize) -> &'a [u32] {
        self.simulation.demand().period(period)
    }

    /// Those of [`demand_left`](Self::demand_left) in the current period who have waited since the
    /// period before. They leave when [`passenger_wait_s`](Self::passenger_wait_s) of the current
    /// period have passed.
    pub fn demand_waiting(&self, from: VertiportIx, to: VertiportIx) -> u32 {
        self.simulation.demand().waiting(from, to)
    }

    /// d_ij, miles, from one vertiport to each.
    #[inline]
    pub fn distances_mi(&self, from: VertiportIx) -> &'a [f64] {
        self.scenario().distance_mi.row(from)
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

    /// Cost of a flight without its energy, with or without passengers; dollars, from one vertiport
    /// to each.
    #[inline]
    pub fn flight_costs_usd(&self, from: VertiportIx) -> &'a [f64] {
        self.scenario().flight_cost_usd.row(from)
    }

    /// The fixed cost of the day: its fleet, and its stands and chargers; dollars.
    pub fn fixed_cost_usd(&self) -> f64 {
        self.scenario().fixed_cost_usd()
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

    /// Profit in dollars of a flight decided at `time` (not before now) if it is on time and
    /// `waiting` passengers want to fly: fares less passenger cost, less energy at the price of its
    /// arrival, less the flight cost.
    #[inline]
    pub fn flight_profit_usd(
        &self,
        time: Time,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
        waiting: u32,
    ) -> f64 {
        self.departures(time, kind, from).profit_usd(to, waiting)
    }

    /// The flights of a type from a vertiport that are decided at `time` (not before now).
    #[inline]
    pub fn departures(&self, time: Time, kind: TypeIx, from: VertiportIx) -> Departures<'a> {
        Departures::of(self.simulation, time, kind, from)
    }

    /// Start of operations.
    #[inline]
    pub fn day_start(&self) -> Time {
        self.scenario().operations.start
    }

    /// Last instant at which decisions are taken.
    #[inline]
    pub fn day_end(&self) -> Time {
        self.scenario().operations.end
    }

    /// Duration of a hold, seconds.
    #[inline]
    pub fn hold_s(&self) -> u32 {
        self.scenario().operations.hold_s
    }

    /// Seconds for which passengers who were not carried wait into the next demand period.
    pub fn passenger_wait_s(&self) -> u32 {
        self.scenario().operations.passenger_wait_s
    }

    /// U_max of a vertiport: the number of its stands, or of its chargers where they are counted
    /// apart. A flight needs one.
    #[inline]
    pub fn stands(&self, vertiport: VertiportIx) -> u16 {
        self.simulation.stands().limit()[vertiport.at()]
    }

    /// Number of aircraft that wait on stands of a vertiport where chargers are counted apart, and
    /// number of these stands; both 0 at other vertiports.
    pub fn parked(&self, vertiport: VertiportIx) -> (u16, u16) {
        self.simulation.stands().parked(vertiport)
    }

    /// Whether an aircraft waits on such a stand.
    pub fn is_parked(&self, aircraft: AircraftIx) -> bool {
        self.simulation.stands().waits(aircraft)
    }

    /// The rest of the day as it can be imagined from here, to be played out.
    pub fn imagined(&self) -> Imagined {
        Imagined::of(self.simulation)
    }

    /// Does the same in the memory of an earlier imagined day, which is overwritten. Allocates
    /// nothing if that was of the same day.
    pub fn imagined_in<'room>(&self, room: &'room mut Option<Imagined>) -> &'room mut Imagined {
        if let Some(imagined) = room {
            imagined.restart(self.simulation);
        }
        room.get_or_insert_with(|| self.imagined())
    }

    /// The day as it is now, to be read later.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot::of(self.simulation)
    }

    /// A key that distinguishes this day from every other.
    #[inline]
    pub fn day(&self) -> DayKey {
        DayKey(Arc::clone(self.simulation.scenario()))
    }

    /// The seed that the day was drawn with.
    #[inline]
    pub fn day_seed(&self) -> u64 {
        self.scenario().seed
    }

    #[inline]
    fn scenario(self) -> &'a Scenario {
        self.simulation.scenario()
    }
}
