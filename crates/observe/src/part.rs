//! The parts of observations. A test compares the table of `docs/src/reference/observations.md`
//! with this one.

use crate::{Observation, Shape, Sizes};

/// An axis of a part's array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// N: the vertiports, in file order.
    Vertiports,
    /// A: the aircraft, in file order.
    Aircraft,
    /// T: the types of aircraft, in file order.
    Types,
    /// P: the demand periods, in order.
    Periods,
    /// This many entries, which the part's meaning names.
    Of(usize),
    /// The features of a node in the paper's observation, 2N + 4.
    PaperNode,
    /// The features of the aircraft in the paper's observation, 2N + 2.
    PaperAircraft,
}

/// One part of an observation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the meaning of each part is in its `Info`")]
pub enum Part {
    ActionMask,
    VertiportMask,
    FleetMask,
    Time,
    Place,
    Type,
    Types,
    ChoiceProfit,
    ChoicePassengers,
    ChoiceFlightTime,
    ChoiceBlockTime,
    ChoiceWait,
    ChoiceCharge,
    DemandLeft,
    DemandWaiting,
    DemandNext,
    Forecast,
    Fare,
    FareNext,
    Fares,
    PassengerCost,
    FlightCost,
    Distance,
    FlightTime,
    BlockTime,
    Energy,
    Reachable,
    TypeFlightTime,
    TypeBlockTime,
    TypeEnergy,
    TypeReachable,
    Closed,
    ClosedUnexpectedly,
    ClosedAhead,
    Delay,
    Stands,
    StandsTaken,
    Parking,
    Parked,
    ChargerPower,
    Period,
    EnergyPrice,
    FleetPlace,
    FleetType,
    FleetReady,
    FleetFlying,
    FleetLanding,
    FleetParked,
    FleetCharge,
    FleetDeciding,
    Nodes,
    Aircraft,
    Clock,
    Adjacency,
    PricedNodes,
    PricedAircraft,
    PricedWorth,
    PricedChargeNodes,
    PricedChargeAircraft,
    FullNodes,
    FullAircraft,
    FullChargeNodes,
    FullChargeAircraft,
    DistanceEdges,
    ProfitEdges,
}

/// The properties of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Info {
    /// The part itself.
    pub part: Part,
    /// Its name in observations, where its numbers are divided by the scale.
    pub name: &'static str,
    /// Its name in views, where its numbers are in the unit; `None` if views do not have it.
    pub in_views: Option<&'static str>,
    /// The axes of its array.
    pub axes: &'static [Axis],
    /// The unit of its numbers, empty for numbers without one.
    pub unit: &'static str,
    /// What its numbers are divided by in observations.
    pub scale: f64,
    /// The range of its numbers in observations.
    pub bounds: (f32, f32),
    /// Its meaning.
    pub meaning: &'static str,
}

/// The range of numbers that are 0 or 1, or shares.
const SHARE: (f32, f32) = (0.0, 1.0);
/// The range of numbers that are never negative.
const POSITIVE: (f32, f32) = (0.0, f32::MAX);
/// The range of all numbers.
const ANY: (f32, f32) = (f32::MIN, f32::MAX);

/// The units of measurement, with the scale of each.
const NONE: (&str, f64) = ("", 1.0);
const PASSENGERS: (&str, f64) = ("passengers", 10.0);
const USD: (&str, f64) = ("$", 100.0);
const HOURS: (&str, f64) = ("h", 1.0);
const MILES: (&str, f64) = ("mi", 10.0);
const KWH: (&str, f64) = ("kWh", 100.0);
const KW: (&str, f64) = ("kW", 100.0);
const STANDS: (&str, f64) = ("stands", 10.0);

const fn info(
    part: Part,
    (name, in_views): (&'static str, Option<&'static str>),
    axes: &'static [Axis],
    (unit, scale): (&'static str, f64),
    bounds: (f32, f32),
    meaning: &'static str,
) -> Info {
    Info { part, name, in_views, axes, unit, scale, bounds, meaning }
}

const V: &[Axis] = &[Axis::Vertiports];
const PAIR: &[Axis] = &[Axis::Vertiports, Axis::Vertiports];
const FLEET: &[Axis] = &[Axis::Aircraft];
const PERIOD_PAIR: &[Axis] = &[Axis::Periods, Axis::Vertiports, Axis::Vertiports];
const TYPE_PAIR: &[Axis] = &[Axis::Types, Axis::Vertiports, Axis::Vertiports];
/// The features of learned policies, whose length does not depend on the number of vertiports.
const PRICED: Shape = Observation::Priced { charge: false }.shape(0);
const PRICED_CHARGE: Shape = Observation::Priced { charge: true }.shape(0);
const FULL: Shape = Observation::Full { charge: false }.shape(0);
const FULL_CHARGE: Shape = Observation::Full { charge: true }.shape(0);

/// All parts, in the order of [`Part`].
#[rustfmt::skip]
const INFOS: [Info; 65] = [
    info(Part::ActionMask, ("action_mask", Some("action_mask")), V, NONE, SHARE,
        "1 for each feasible choice; the deciding aircraft's own vertiport is hold"),
    info(Part::VertiportMask, ("vertiport_mask", None), V, NONE, SHARE,
        "1 for each vertiport of the day, 0 for padding"),
    info(Part::FleetMask, ("fleet_mask", None), FLEET, NONE, SHARE,
        "1 for each aircraft of the day, 0 for padding"),
    info(Part::Time, ("time", None), &[Axis::Of(3)], NONE, SHARE,
        "share of the day that is left, share of the demand period that is left, time of day as a share of 24 hours"),
    info(Part::Place, ("place", None), V, NONE, SHARE,
        "the deciding aircraft's vertiport, one-hot"),
    info(Part::Type, ("aircraft_type", None), &[Axis::Types], NONE, SHARE,
        "the deciding aircraft's type, one-hot"),
    info(Part::Types, ("types", None), &[Axis::Types, Axis::Of(6)], NONE, POSITIVE,
        "of each type: seats / 10, speed / 100 mph, battery / 100 kWh, energy a mile / 10 kWh, charging power / 100 kW, self-discharge an hour"),
    info(Part::ChoiceProfit, ("choice_profit", Some("choice_profit_usd")), V, USD, ANY,
        "profit of the flight to each vertiport if it begins now, without its consequences; 0 for hold and out of range"),
    info(Part::ChoicePassengers, ("choice_passengers", Some("choice_passengers")), V, PASSENGERS, POSITIVE,
        "passengers who would board that flight; 0 for hold and out of range"),
    info(Part::ChoiceFlightTime, ("choice_flight_time", Some("choice_flight_time_h")), V, HOURS, POSITIVE,
        "time from the decision to the landing of that flight; 0 for hold and out of range"),
    info(Part::ChoiceBlockTime, ("choice_block_time", Some("choice_block_time_h")), V, HOURS, POSITIVE,
        "time from the decision until the aircraft decides again; the hold time for hold, 0 out of range"),
    info(Part::ChoiceWait, ("choice_wait", Some("choice_wait_h")), V, HOURS, POSITIVE,
        "time from the decision until the battery has enough for that flight, which takes off then; 0 for hold and out of range"),
    info(Part::ChoiceCharge, ("choice_charge", Some("choice_charge_kwh")), V, KWH, POSITIVE,
        "charge of the battery when the aircraft decides again after that flight or hold; 0 out of range"),
    info(Part::DemandLeft, ("demand_left", Some("demand_left")), PAIR, PASSENGERS, POSITIVE,
        "passengers of this period who still want to fly"),
    info(Part::DemandWaiting, ("demand_waiting", Some("demand_waiting")), PAIR, PASSENGERS, POSITIVE,
        "those of `demand_left` who have waited since the period before, and leave when the day's patience ends"),
    info(Part::DemandNext, ("demand_next", Some("demand_next")), PAIR, PASSENGERS, POSITIVE,
        "forecast of the next period's passengers; 0 in the last period"),
    info(Part::Forecast, ("forecast", Some("forecast")), PERIOD_PAIR, PASSENGERS, POSITIVE,
        "passengers of each period who still want to fly: 0 in passed periods, `demand_left` in this one, the forecast in later ones"),
    info(Part::Fare, ("fare", Some("fare_usd")), PAIR, USD, POSITIVE,
        "fare of a passenger in this period"),
    info(Part::FareNext, ("fare_next", Some("fare_next_usd")), PAIR, USD, POSITIVE,
        "fare of a passenger in the next period; 0 in the last period"),
    info(Part::Fares, ("fares", Some("fares_usd")), PERIOD_PAIR, USD, POSITIVE,
        "fare of a passenger in each period"),
    info(Part::PassengerCost, ("passenger_cost", Some("passenger_cost_usd")), PAIR, USD, POSITIVE,
        "cost of a passenger"),
    info(Part::FlightCost, ("flight_cost", Some("flight_cost_usd")), PAIR, USD, POSITIVE,
        "cost of a flight, without its energy"),
    info(Part::Distance, ("distance", Some("distance_mi")), PAIR, MILES, POSITIVE,
        "distance"),
    info(Part::FlightTime, ("flight_time", Some("flight_time_h")), PAIR, HOURS, POSITIVE,
        "time from decision to landing, for the deciding aircraft's type; 0 out of range"),
    info(Part::BlockTime, ("block_time", Some("block_time_h")), PAIR, HOURS, POSITIVE,
        "time from decision to the next, charging included, for the deciding aircraft's type; 0 out of range"),
    info(Part::Energy, ("energy", Some("energy_kwh")), PAIR, KWH, POSITIVE,
        "energy of the flight, for the deciding aircraft's type; 0 out of range"),
    info(Part::Reachable, ("reachable", Some("reachable")), PAIR, NONE, SHARE,
        "1 where a corridor leads and a full battery of the deciding aircraft's type lasts"),
    info(Part::TypeFlightTime, ("type_flight_time", Some("type_flight_time_h")), TYPE_PAIR, HOURS, POSITIVE,
        "`flight_time` for each type"),
    info(Part::TypeBlockTime, ("type_block_time", Some("type_block_time_h")), TYPE_PAIR, HOURS, POSITIVE,
        "`block_time` for each type"),
    info(Part::TypeEnergy, ("type_energy", Some("type_energy_kwh")), TYPE_PAIR, KWH, POSITIVE,
        "`energy` for each type"),
    info(Part::TypeReachable, ("type_reachable", Some("type_reachable")), TYPE_PAIR, NONE, SHARE,
        "`reachable` for each type"),
    info(Part::Closed, ("closed", Some("closed")), PAIR, NONE, SHARE,
        "1 where the route is closed now"),
    info(Part::ClosedUnexpectedly, ("closed_unexpectedly", Some("closed_unexpectedly")), PAIR, NONE, SHARE,
        "1 where the route is closed now by a closure that was not known before; how long it lasts is not known"),
    info(Part::ClosedAhead, ("closed_ahead", Some("closed_ahead")), &[Axis::Vertiports, Axis::Vertiports, Axis::Of(4)], NONE, SHARE,
        "1 where the route is known to be closed in 15, 30, 45 and 60 minutes"),
    info(Part::Delay, ("delay", Some("delay_h")), V, HOURS, POSITIVE,
        "how late a flight that is decided now is expected to leave: as late as the latest that left there in this quarter of an hour"),
    info(Part::Stands, ("stands", Some("stands")), V, STANDS, POSITIVE,
        "stands, or chargers where they are counted apart"),
    info(Part::StandsTaken, ("stands_taken", Some("stands_taken")), V, STANDS, POSITIVE,
        "aircraft at these stands or in the air towards them"),
    info(Part::Parking, ("parking", Some("parking")), V, STANDS, POSITIVE,
        "stands without chargers, where chargers are counted apart"),
    info(Part::Parked, ("parked", Some("parked")), V, STANDS, POSITIVE,
        "aircraft at these"),
    info(Part::ChargerPower, ("charger_power", Some("charger_power_kw")), &[Axis::Types, Axis::Vertiports], KW, POSITIVE,
        "the highest power at which each type charges at each vertiport"),
    info(Part::Period, ("period", None), &[Axis::Periods], NONE, SHARE,
        "the demand period, one-hot"),
    info(Part::EnergyPrice, ("energy_price", Some("energy_price_usd")), &[Axis::Periods], ("$ a kWh", 1.0), POSITIVE,
        "price of energy in each demand period"),
    info(Part::FleetPlace, ("fleet_place", None), &[Axis::Aircraft, Axis::Vertiports], NONE, SHARE,
        "where each aircraft stands or will land, one-hot"),
    info(Part::FleetType, ("fleet_type", None), &[Axis::Aircraft, Axis::Types], NONE, SHARE,
        "the type of each aircraft, one-hot"),
    info(Part::FleetReady, ("fleet_ready", Some("fleet_ready_h")), FLEET, HOURS, POSITIVE,
        "time until each aircraft is expected to decide; an outage counts once it has begun"),
    info(Part::FleetFlying, ("fleet_flying", Some("fleet_flying")), FLEET, NONE, SHARE,
        "1 for each aircraft in the air"),
    info(Part::FleetLanding, ("fleet_landing", Some("fleet_landing_h")), FLEET, HOURS, POSITIVE,
        "time until each aircraft lands; 0 on the ground"),
    info(Part::FleetParked, ("fleet_parked", Some("fleet_parked")), FLEET, NONE, SHARE,
        "1 for each aircraft that waits on a stand without a charger"),
    info(Part::FleetCharge, ("fleet_charge", Some("fleet_charge_kwh")), FLEET, KWH, POSITIVE,
        "charge of each battery when its aircraft is expected to decide"),
    info(Part::FleetDeciding, ("fleet_deciding", None), FLEET, NONE, SHARE,
        "the deciding aircraft, one-hot"),
    info(Part::Nodes, ("nodes", None), &[Axis::Vertiports, Axis::PaperNode], NONE, POSITIVE,
        "the paper's node features (§IV.A), by the scales of the network file"),
    info(Part::Aircraft, ("aircraft", None), &[Axis::PaperAircraft], NONE, POSITIVE,
        "the paper's aircraft state (§IV.A), by the scales of the network file"),
    info(Part::Clock, ("clock", None), &[Axis::Of(1)], NONE, SHARE,
        "share of the day that is left"),
    info(Part::Adjacency, ("adjacency", None), PAIR, NONE, SHARE,
        "1 where the deciding aircraft's type can fly now"),
    info(Part::PricedNodes, ("priced_nodes", None), &[Axis::Vertiports, Axis::Of(PRICED.node_features)], NONE, ANY,
        "the node features of gcaps-x; the first is 1 for each choice of the shortlist"),
    info(Part::PricedAircraft, ("priced_aircraft", None), &[Axis::Of(PRICED.aircraft_features)], NONE, ANY,
        "the aircraft features of gcaps-x"),
    info(Part::PricedWorth, ("priced_worth", None), V, NONE, ANY,
        "worth of each choice of the shortlist at the bid prices, less that of the best, in the unit of gcaps-x's logits; 0 elsewhere"),
    info(Part::PricedChargeNodes, ("priced_charge_nodes", None), &[Axis::Vertiports, Axis::Of(PRICED_CHARGE.node_features)], NONE, ANY,
        "`priced_nodes`, and then the features of charge"),
    info(Part::PricedChargeAircraft, ("priced_charge_aircraft", None), &[Axis::Of(PRICED_CHARGE.aircraft_features)], NONE, ANY,
        "`priced_aircraft`, and then the features of charge"),
    info(Part::FullNodes, ("full_nodes", None), &[Axis::Vertiports, Axis::Of(FULL.node_features)], NONE, ANY,
        "the node features of gcaps-full and mlp-full; the first is 1 for each feasible choice"),
    info(Part::FullAircraft, ("full_aircraft", None), &[Axis::Of(FULL.aircraft_features)], NONE, ANY,
        "the aircraft features of gcaps-full and mlp-full"),
    info(Part::FullChargeNodes, ("full_charge_nodes", None), &[Axis::Vertiports, Axis::Of(FULL_CHARGE.node_features)], NONE, ANY,
        "`full_nodes`, and then the features of charge"),
    info(Part::FullChargeAircraft, ("full_charge_aircraft", None), &[Axis::Of(FULL_CHARGE.aircraft_features)], NONE, ANY,
        "`full_aircraft`, and then the features of charge"),
    info(Part::DistanceEdges, ("distance_edges", None), PAIR, NONE, SHARE,
        "1 / (1 + hours of flight), for the deciding aircraft's type; 0 out of range"),
    info(Part::ProfitEdges, ("profit_edges", None), PAIR, NONE, (0.0, 3.0),
        "profit per hour of a flight that begins now, in typical full flights, at most 3; 0 where it costs, or cannot be flown now"),
];

impl Part {
    /// All parts, in the order of the documentation.
    pub fn all() -> impl Iterator<Item = Self> {
        INFOS.iter().map(|info| info.part)
    }

    /// The part with a name.
    pub fn named(name: &str) -> Option<Self> {
        INFOS.iter().find(|info| info.name == name).map(|info| info.part)
    }

    /// The part with a name in views.
    pub fn of_view(name: &str) -> Option<Self> {
        INFOS.iter().find(|info| info.in_views == Some(name)).map(|info| info.part)
    }

    /// The properties of the part.
    pub fn info(self) -> &'static Info {
        &INFOS[self as usize]
    }

    /// The shape of the part's array.
    pub fn shape(self, sizes: Sizes) -> Vec<usize> {
        self.info().axes.iter().map(|axis| axis.len(sizes)).collect()
    }

    /// Number of entries of the part's array.
    pub fn len(self, sizes: Sizes) -> usize {
        self.info().axes.iter().map(|axis| axis.len(sizes)).product()
    }

    /// Number of entries along the last axis of a part of features.
    pub(crate) fn columns(self) -> usize {
        match self.info().axes.last() {
            Some(&Axis::Of(columns)) => columns,
            _ => unreachable!("features have an axis of known length"),
        }
    }

    /// Whether the part contains bid prices, which take time to find.
    pub fn is_priced(self) -> bool {
        matches!(
            self,
            Self::PricedNodes
                | Self::PricedAircraft
                | Self::PricedWorth
                | Self::PricedChargeNodes
                | Self::PricedChargeAircraft
        )
    }

    /// Whether the part is observed by policies of the full observation.
    pub fn is_of_the_full(self) -> bool {
        matches!(
            self,
            Self::FullNodes
                | Self::FullAircraft
                | Self::FullChargeNodes
                | Self::FullChargeAircraft
                | Self::DistanceEdges
                | Self::ProfitEdges
        )
    }

    /// Whether the part is a feature that a learned policy derives from other parts.
    pub fn is_of_a_policy(self) -> bool {
        let of_the_paper =
            matches!(self, Self::Nodes | Self::Aircraft | Self::Clock | Self::Adjacency);
        of_the_paper || self.is_priced() || self.is_of_the_full()
    }

    /// Whether the part concerns what batteries hold, which matters only on days that charge as
    /// needed.
    pub fn is_of_charge(self) -> bool {
        matches!(self, Self::ChoiceWait | Self::ChoiceCharge | Self::FleetCharge)
    }

    /// Whether version 1 of the full observation has the part and version 0 does not.
    pub fn is_new_in_full_v1(self) -> bool {
        self.is_of_charge()
            || matches!(
                self,
                Self::DemandWaiting
                    | Self::Forecast
                    | Self::Fares
                    | Self::TypeFlightTime
                    | Self::TypeBlockTime
                    | Self::TypeEnergy
                    | Self::TypeReachable
                    | Self::ClosedUnexpectedly
                    | Self::Delay
                    | Self::ChargerPower
                    | Self::FleetLanding
                    | Self::FleetParked
            )
    }

    /// Whether the part's array has the shape of one network, and cannot be padded to that of a
    /// larger one.
    pub fn is_of_one_size(self) -> bool {
        matches!(self, Self::Nodes | Self::Aircraft)
    }

    /// Whether the part concerns the future: a forecast, or an event that is announced.
    pub fn is_ahead(self) -> bool {
        self.is_priced()
            || matches!(
                self,
                Self::DemandNext
                    | Self::Forecast
                    | Self::FareNext
                    | Self::Fares
                    | Self::ClosedAhead
                    | Self::EnergyPrice
                    | Self::FullNodes
                    | Self::FullChargeNodes
            )
    }
}

impl Axis {
    /// Number of entries along the axis.
    pub fn len(self, sizes: Sizes) -> usize {
        match self {
            Self::Vertiports => sizes.vertiports,
            Self::Aircraft => sizes.aircraft,
            Self::Types => sizes.types,
            Self::Periods => sizes.periods,
            Self::Of(entries) => entries,
            Self::PaperNode => Observation::Paper.shape(sizes.vertiports).node_features,
            Self::PaperAircraft => Observation::Paper.shape(sizes.vertiports).aircraft_features,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{INFOS, Part};

    #[test]
    fn the_table_is_in_the_order_of_the_parts() {
        for (at, info) in INFOS.iter().enumerate() {
            assert_eq!(info.part as usize, at, "{}", info.name);
            assert_eq!(Part::named(info.name), Some(info.part));
        }
    }
}
