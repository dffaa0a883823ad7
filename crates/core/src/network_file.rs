//! The network file: TOML of format `vertifleet-network/1` to a checked [`Network`].

use serde::Deserialize;

use crate::demand_model::{DemandModel, RawDemandModel};
use crate::feature_scales::RawFeatureScales;
use crate::limits::{self, entries};
use crate::parse::shortened;
use crate::raw::{Positions, RawAircraftType, RawOperations, RawVertiport, each};
use crate::{
    Aircraft, AircraftType, Day, Error, Matrix, Network, TypeIx, Vertiport, VertiportIx, check,
    parse,
};

const FORMAT: &str = "vertifleet-network/1";

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a network")]
struct RawNetwork {
    #[serde(rename = "format")]
    _format: String,
    name: String,
    #[serde(rename = "start_positions")]
    _start_positions: StartPositions,
    operations: RawOperations,
    vertiports: Vec<RawVertiport>,
    aircraft_types: Vec<RawAircraftType>,
    fleet: Vec<RawFleet>,
    tariffs: RawTariffs,
    demand: RawDemandModel,
    feature_scales: RawFeatureScales,
}

/// Where aircraft stand when a day starts.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum StartPositions {
    /// Uniform over the vertiports that have a stand left (§V.A, "different for each episode").
    Random,
}

/// So many aircraft of one type.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a fleet entry")]
struct RawFleet {
    #[serde(rename = "type")]
    kind: String,
    count: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of tariffs")]
struct RawTariffs {
    passenger_cost_usd_per_mi: f64,
    fare_base: f64,
    fare_demand_weight: f64,
    energy_price_usd_per_kwh: f64,
}

/// Reads and checks the text of a network file.
pub(crate) fn network(text: &str, origin: &str) -> Result<Network, Error> {
    let raw: RawNetwork = parse::toml(text, FORMAT, origin)?;
    name(&raw.name, origin)?;
    let list = |member, found, most| check::entry_count(origin, member, found, most);
    list("vertiports", raw.vertiports.len(), entries::VERTIPORTS)?;
    list("aircraft_types", raw.aircraft_types.len(), entries::AIRCRAFT_TYPES)?;
    raw.tariffs.check(origin)?;
    let operations = raw.operations.check(origin)?;
    let vertiports = each(raw.vertiports, |raw, at| raw.check(at, origin))?;
    let aircraft_types = each(raw.aircraft_types, |raw, at| raw.check(at, origin))?;
    let aircraft = fleet(&raw.fleet, &aircraft_types, &vertiports, origin)?;
    let busy = vertiports.iter().map(|vertiport| vertiport.busy).collect();
    let demand = raw.demand.check(busy, origin)?;

    let distance_mi = distances_mi(&vertiports);
    let passenger_cost_usd = raw.tariffs.passenger_costs_usd(&distance_mi);
    let nobody = Matrix::from_fn(vertiports.len(), |_, _| 0);
    let idle_day = Day {
        name: raw.name.clone(),
        seed: 0,
        operations,
        aircraft_types,
        aircraft,
        distance_mi,
        fare_usd: raw.tariffs.fares_usd(&passenger_cost_usd, &demand),
        passenger_cost_usd,
        periods: demand.periods.clone(),
        demand: vec![nobody; demand.periods.len()],
        energy_price_usd: vec![raw.tariffs.energy_price_usd_per_kwh; demand.periods.len()],
        vertiports,
    };
    Ok(Network {
        name: raw.name,
        idle_day: idle_day.check(origin)?,
        demand,
        feature_scales: raw.feature_scales.check(origin)?,
    })
}

/// A network's name becomes part of names of days and files.
fn name(name: &str, origin: &str) -> Result<(), Error> {
    const RULE: &str =
        "1 to 40 letters a-z, digits, dots, dashes and underscores, the first a letter or digit";
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    if (1..=40).contains(&name.len())
        && name.chars().all(plain)
        && name.starts_with(|c: char| c.is_ascii_alphanumeric())
    {
        return Ok(());
    }
    let (member, found) = ("name".to_owned(), shortened(name, 64));
    Err(Error::BadId { origin: origin.to_owned(), member, rule: RULE, found })
}

/// The aircraft, `A01` on, each on the first stand that is free; a drawn day puts them elsewhere.
fn fleet(
    raw: &[RawFleet],
    aircraft_types: &[AircraftType],
    vertiports: &[Vertiport],
    origin: &str,
) -> Result<Vec<Aircraft>, Error> {
    check::entry_count(origin, "fleet", raw.len(), entries::AIRCRAFT)?;
    let positions = Positions::of_types(aircraft_types, origin)?;
    let mut kinds = Vec::new();
    for (at, entry) in raw.iter().enumerate() {
        let kind = positions.position(&entry.kind, origin, || format!("fleet[{at}]: type"))?;
        let count: u16 = limits::FLEET_COUNT
            .whole_number(entry.count, origin, || format!("fleet[{at}]: count"))?;
        kinds.extend(std::iter::repeat_n(TypeIx::new(kind), count.into()));
        check::entry_count(origin, "fleet, counted by aircraft,", kinds.len(), entries::AIRCRAFT)?;
    }
    let stands = vertiports.iter().enumerate().flat_map(|(at, vertiport)| {
        std::iter::repeat_n(VertiportIx::new(at), vertiport.stands.into())
    });
    let free = stands.clone().count();
    if kinds.len() > free {
        let origin = origin.to_owned();
        return Err(Error::FleetTooLarge { origin, aircraft: kinds.len(), stands: free });
    }
    let digits = kinds.len().to_string().len().max(2);
    let aircraft = kinds.into_iter().zip(stands).zip(1..);
    Ok(aircraft
        .map(|((kind, at), number)| Aircraft { id: format!("A{number:0digits$}"), kind, at })
        .collect())
}

/// d_ij in the plane, miles. Products, sum and root are exact to the last bit everywhere, which `hypot` is not.
fn distances_mi(vertiports: &[Vertiport]) -> Matrix<f64> {
    Matrix::from_fn(vertiports.len(), |from, to| {
        let (from, to) = (&vertiports[from.at()], &vertiports[to.at()]);
        let (east, north) = (to.x_mi - from.x_mi, to.y_mi - from.y_mi);
        (east * east + north * north).sqrt()
    })
}

impl RawTariffs {
    fn check(&self, origin: &str) -> Result<(), Error> {
        for (member, value, limits) in [
            ("passenger_cost_usd_per_mi", self.passenger_cost_usd_per_mi, limits::TARIFF),
            ("fare_base", self.fare_base, limits::TARIFF),
            ("fare_demand_weight", self.fare_demand_weight, limits::TARIFF),
            ("energy_price_usd_per_kwh", self.energy_price_usd_per_kwh, limits::ENERGY_PRICE_USD),
        ] {
            limits.check(value, origin, || format!("tariffs: {member}"))?;
        }
        Ok(())
    }

    /// R_ij, dollars a passenger.
    fn passenger_costs_usd(&self, distance_mi: &Matrix<f64>) -> Matrix<f64> {
        Matrix::from_fn(distance_mi.size(), |from, to| {
            self.passenger_cost_usd_per_mi * distance_mi[(from, to)]
        })
    }

    /// P_ij = R_ij (base + weight Qbar_ij / max Qbar), dollars a passenger.
    fn fares_usd(&self, passenger_cost_usd: &Matrix<f64>, demand: &DemandModel) -> Matrix<f64> {
        let mean = demand.day_means();
        let most = mean.cells().iter().copied().fold(0.0, f64::max);
        Matrix::from_fn(mean.size(), |from, to| {
            let share = if most > 0.0 { mean[(from, to)] / most } else { 0.0 };
            passenger_cost_usd[(from, to)] * (self.fare_base + self.fare_demand_weight * share)
        })
    }
}
