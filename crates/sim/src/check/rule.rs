//! The rules by name. Names are stable, because `--json` prints them and the documentation lists
//! them.

use std::fmt;

use serde::{Serialize, Serializer};

macro_rules! rules {
    ($($variant:ident = $name:literal: $meaning:literal,)*) => {
        /// A rule that a complete schedule keeps.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Rule { $(#[doc = $meaning] $variant,)* }

        impl Rule {
            /// Every rule, in the order in which the documentation lists them.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// The stable name, for example `stand-bound`.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The requirement of the rule, in a sentence.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

rules! {
    KnownIds = "known-ids":
        "Every row is about an aircraft and vertiports of the scenario.",
    Order = "order":
        "Rows are in the order of time, then of the scenario's aircraft; an aircraft decides once an instant.",
    OperatingHours = "operating-hours":
        "Decisions are taken from the start to the end of operations, both inclusive.",
    FirstDecision = "first-decision":
        "Every aircraft first decides when operations start, or on days that charge to full when its battery is full.",
    DecisionTime = "decision-time":
        "An aircraft decides again exactly when it is ready.",
    MissingDecision = "missing-decision":
        "An aircraft that is ready no later than the end of operations decides.",
    Place = "place":
        "An aircraft decides where it starts the day or where its decision before took it.",
    HoldEmpty = "hold-empty":
        "A hold carries no passengers, earns and costs nothing, and takes no energy.",
    HoldTime = "hold-time":
        "A hold arrives when it is decided and is ready after the scenario's hold time (Eq. 8).",
    ArrivalTime = "arrival-time":
        "A flight arrives after take-off, cruise to the nearest second, and landing (Eq. 7).",
    ReadyTime = "ready-time":
        "An aircraft is ready after its turnaround and, on days that charge to full, when what the flight took is charged again, to the nearest second (Eq. 9, 14, 15).",
    TakeoffDelay = "takeoff-delay":
        "A flight arrives later by the delay of the vertiport and slot of the day in which it is decided.",
    OutOfService = "out-of-service":
        "An aircraft that lands while it is out of service is not ready before that is over.",
    Charge = "charge":
        "On days that charge as needed, the battery holds at each decision what was left at landing and charged since.",
    TakeoffTime = "takeoff-time":
        "On days that charge as needed, a flight takes off at the first second at which the battery suffices.",
    TakeoffByEnd = "takeoff-by-end":
        "No flight waits for its battery beyond the end of operations.",
    Corridor = "corridor":
        "A flight follows a corridor, if the scenario has any.",
    Closure = "closure":
        "No flight is decided while its route is closed.",
    Energy = "energy":
        "A flight takes the energy of its distance and what the battery loses on the way (Eq. 13).",
    Range = "range":
        "A flight takes no more energy than the battery holds besides the reserve (Eq. 12).",
    Seats = "seats":
        "A flight carries no more passengers than its aircraft has seats (Eq. 11).",
    Demand = "demand":
        "A flight carries no more passengers than still want to fly when it is decided.",
    Boarding = "boarding":
        "A flight leaves no passenger behind for whom it has a seat.",
    Revenue = "revenue":
        "A flight's revenue is its passengers times the fare of the period of its decision (Eq. 4).",
    PassengerCost = "passenger-cost":
        "A flight's passenger cost is its passengers times the pair's cost a passenger (Eq. 2).",
    EnergyCost = "energy-cost":
        "A flight's energy cost is its energy times the price in the period of arrival (Eq. 3).",
    FlightCost = "flight-cost":
        "A flight's own cost is that of its pair, with or without passengers.",
    StandBound = "stand-bound":
        "At every instant the aircraft standing at a vertiport and in the air towards it are 0 to its stands (Eq. 16).",
    ChargerBound = "charger-bound":
        "At every instant the aircraft on chargers of a vertiport and in the air towards it are 0 to its chargers.",
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Serialize for Rule {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
