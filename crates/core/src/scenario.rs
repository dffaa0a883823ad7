//! One operating day: everything exogenous, nothing left to be drawn.
//!
//! [`Day`] is the open form that readers and draws fill in. [`Scenario`] is a day that passed
//! [`Day::check`] and can no longer be changed, so code may rely on every rule that `check.rs`
//! states.

use std::ops::Deref;

use crate::{
    ChargeCurve, Charging, Disturbances, Fares, Matrix, Purpose, Route, Time, TypeIx, VertiportIx,
    drawn_for, purpose_of, whole_mwh,
};

/// When decisions are taken, and how long each part of a flight takes apart from cruise and
/// charging.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operations {
    /// First instant at which an aircraft may decide.
    pub start: Time,
    /// Last instant at which an aircraft may decide, inclusive.
    pub end: Time,
    /// Seconds from the decision to cruise (δT_TO).
    pub takeoff_s: u32,
    /// Seconds from the end of cruise to arrival (δT_L).
    pub landing_s: u32,
    /// Seconds until an aircraft that holds is asked again (t_wait).
    pub hold_s: u32,
    /// Seconds for which passengers who were not carried wait into the next demand period; 0 in the
    /// paper.
    pub passenger_wait_s: u32,
    /// When an aircraft that has landed may decide again.
    pub charging: Charging,
}

/// A place where aircraft land, charge and stand.
#[derive(Debug, Clone, PartialEq)]
pub struct Vertiport {
    /// Unique name.
    pub id: String,
    /// Position east, miles.
    pub x_mi: f64,
    /// Position north, miles.
    pub y_mi: f64,
    /// U_max: the number of aircraft that may stand here or be on their way here (Eq. 16). Where
    /// `chargers` are counted apart, the number of aircraft that may wait here without a charger.
    pub stands: u16,
    /// Number of chargers, where they are counted apart from stands. A flight here needs a charger
    /// from take-off on; the aircraft frees it when it leaves, or when it holds and finds a stand.
    pub chargers: Option<u16>,
    /// The most power that a charger here delivers, kW; `None` if only the aircraft limits it.
    pub charger_kw: Option<f64>,
    /// Whether the vertiport belongs to V_B, the vertiports with high demand (Eq. 1).
    pub busy: bool,
    /// Position on the globe, if it is known, for maps and warnings. The day contains the
    /// distances.
    pub degrees: Option<Degrees>,
    /// Cost of each stand, whether or not it is used; dollars a day, 0 in the paper.
    pub stand_cost_usd: f64,
    /// Cost of each charger that is counted apart from stands, whether or not it is used; dollars a
    /// day.
    pub charger_cost_usd: f64,
}

impl Vertiport {
    /// Cost of all stands and chargers, whether or not they are used, dollars a day.
    pub fn site_cost_usd(&self) -> f64 {
        let chargers = f64::from(self.chargers.unwrap_or(0));
        f64::from(self.stands) * self.stand_cost_usd + chargers * self.charger_cost_usd
    }
}

/// A place on the globe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Degrees {
    /// Latitude in degrees; north is above 0.
    pub latitude: f64,
    /// Longitude in degrees; east is above 0.
    pub longitude: f64,
}

/// The performance of one type of aircraft.
#[derive(Debug, Clone, PartialEq)]
pub struct AircraftType {
    /// Unique name.
    pub id: String,
    /// C: number of passengers that a flight may carry.
    pub seats: u16,
    /// Cruise speed, miles per hour.
    pub speed_mph: f64,
    /// B_max: battery capacity, kWh.
    pub battery_kwh: f64,
    /// e: energy that a mile of flight takes, kWh.
    pub energy_kwh_per_mi: f64,
    /// P_max: charging power, kW.
    pub charge_kw: f64,
    /// γ: share of the battery's capacity lost in an hour of flight, besides the energy that flying
    /// takes. On a stand the charger makes up for it.
    pub self_discharge_per_h: f64,
    /// Energy that a flight leaves in the battery, kWh; 0 in the paper.
    pub reserve_kwh: f64,
    /// Seconds after a landing before which the aircraft is not ready; 0 in the paper.
    pub turnaround_s: u32,
    /// Charging power by charge, which `charge_kw` limits; `None` for `charge_kw` throughout.
    pub charge_curve: Option<ChargeCurve>,
}

impl AircraftType {
    /// Whether a full battery lasts for a flight of this energy and the reserve (Eq. 12). All are
    /// rounded to whole milliwatt-hours, so that a pair exactly at the end of the range can be
    /// flown whichever way a product rounds.
    pub fn lasts_for(&self, energy_kwh: f64) -> bool {
        self.needed_mwh(energy_kwh) <= whole_mwh(self.battery_kwh)
    }

    /// What a battery holds at least when a flight of this energy takes off, mWh: the energy and
    /// the reserve.
    pub fn needed_mwh(&self, energy_kwh: f64) -> u64 {
        whole_mwh(energy_kwh) + whole_mwh(self.reserve_kwh)
    }
}

/// One aircraft of the fleet.
#[derive(Debug, Clone, PartialEq)]
pub struct Aircraft {
    /// Unique name.
    pub id: String,
    /// Its type.
    pub kind: TypeIx,
    /// The vertiport where it stands when operations start.
    pub at: VertiportIx,
    /// Its charge when operations start, kWh; `None` if its battery is full.
    pub start_charge_kwh: Option<f64>,
}

/// One operating day in its open form, with the members of the scenario file; see [`Scenario`] for
/// the checked form.
#[derive(Debug, Clone, PartialEq)]
pub struct Day {
    /// Name of the day, for example `paper-7`.
    pub name: String,
    /// The seed that the day was drawn with. Policies that draw at random mix it into their own.
    pub seed: u64,
    /// Times of operations.
    pub operations: Operations,
    /// The vertiports, in file order.
    pub vertiports: Vec<Vertiport>,
    /// The aircraft types, in file order.
    pub aircraft_types: Vec<AircraftType>,
    /// The fleet, in file order, which also breaks ties in time.
    pub aircraft: Vec<Aircraft>,
    /// d_ij, miles.
    pub distance_mi: Matrix<f64>,
    /// The pairs that may be flown; `None` if all may be.
    pub corridors: Option<Vec<Route>>,
    /// P_ij, dollars a passenger, by the period in which a flight is decided.
    pub fare_usd: Fares,
    /// R_ij, dollars a passenger.
    pub passenger_cost_usd: Matrix<f64>,
    /// Cost of a flight without its energy, with or without passengers; dollars a flight, all 0 in
    /// the paper.
    pub flight_cost_usd: Matrix<f64>,
    /// Cost of each aircraft of the fleet, whether or not it flies; dollars a day, 0 in the paper.
    pub aircraft_cost_usd: f64,
    /// Start of each demand period; the last one lasts for the rest of the day.
    pub periods: Vec<Time>,
    /// Q(i, j, t): passengers who want to fly, per period.
    pub demand: Vec<Matrix<u32>>,
    /// E: price of electricity per period, dollars per kWh.
    pub energy_price_usd: Vec<f64>,
    /// The disturbances of the day.
    pub disturbances: Disturbances,
}

impl Day {
    /// The purpose of the day: that of its seed, or that of its network if the network was drawn
    /// for a stricter one. A training seed gives a comparison day on a comparison network.
    pub fn purpose(&self) -> Purpose {
        let of_seed = purpose_of(self.seed);
        let network = self.name.strip_suffix(&format!("-{}", self.seed));
        let of_network = network.and_then(drawn_for);
        of_network.map_or(of_seed, |purpose| purpose.stricter(of_seed))
    }
}

/// A checked day: shapes agree, numbers are finite and within bounds, ids are unique, no vertiport
/// has more aircraft than stands.
///
/// A scenario can be read like a [`Day`]. To change one, take it apart with [`Scenario::into_day`]
/// and check it again.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario(Day);

impl Scenario {
    /// Wraps a day that [`Day::check`] has just passed.
    pub(crate) fn checked(day: Day) -> Self {
        Self(day)
    }

    /// Returns the open form, to change it.
    pub fn into_day(self) -> Day {
        self.0
    }

    /// The day as it is expected before it begins: its demand is the forecast, and closures that
    /// are not known, delays and outages do not happen.
    #[must_use]
    pub fn expected(&self) -> Self {
        let Disturbances { forecast, closures, .. } = &self.disturbances;
        let known = closures.iter().filter(|closure| closure.known).copied().collect();
        Self(Day {
            demand: forecast.as_ref().unwrap_or(&self.demand).clone(),
            disturbances: Disturbances { closures: known, ..Disturbances::default() },
            ..self.0.clone()
        })
    }

    /// The demand period that contains `time`, which is the last one that has started.
    #[inline]
    pub fn period_at(&self, time: Time) -> usize {
        // `Day::check` guarantees that the first period starts no later than operations.
        self.periods.iter().rposition(|&start| start <= time).unwrap_or(0)
    }

    /// Whether a pair may be flown, because there are no corridors or because one of them leads
    /// that way.
    pub fn is_corridor(&self, from: VertiportIx, to: VertiportIx) -> bool {
        let corridors = self.corridors.as_ref();
        corridors.is_none_or(|routes| routes.iter().any(|route| route.covers(from, to)))
    }

    /// The charge with which an aircraft of this day starts, kWh.
    pub fn start_charge_kwh(&self, aircraft: &Aircraft) -> f64 {
        let full_kwh = self.aircraft_types[aircraft.kind.at()].battery_kwh;
        aircraft.start_charge_kwh.unwrap_or(full_kwh)
    }

    /// Whether any flight has a cost without its energy, with or without passengers.
    pub fn has_flight_costs(&self) -> bool {
        self.flight_cost_usd.cells().iter().any(|&cost_usd| cost_usd != 0.0)
    }

    /// Cost of the whole fleet, whether or not it flies, dollars.
    pub fn fleet_cost_usd(&self) -> f64 {
        self.aircraft.len() as f64 * self.aircraft_cost_usd
    }

    /// Cost of the stands and chargers of all vertiports, whether or not they are used, dollars.
    pub fn site_cost_usd(&self) -> f64 {
        self.vertiports.iter().map(Vertiport::site_cost_usd).sum()
    }

    /// The fixed cost of the day: its fleet, and its stands and chargers; dollars.
    pub fn fixed_cost_usd(&self) -> f64 {
        self.fleet_cost_usd() + self.site_cost_usd()
    }

    /// The reward's denominator (§III.H): every passenger of the day at full fare, dollars.
    pub fn potential_usd(&self) -> f64 {
        self.demand
            .iter()
            .enumerate()
            .flat_map(|(period, table)| {
                table.cells().iter().zip(self.fare_usd.in_period(period).cells())
            })
            .map(|(&passengers, &fare)| f64::from(passengers) * fare)
            .sum()
    }
}

impl Deref for Scenario {
    type Target = Day;

    fn deref(&self) -> &Day {
        &self.0
    }
}
