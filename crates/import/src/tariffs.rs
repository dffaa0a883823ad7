//! Fares and costs by pair, and energy prices by period, from a planner's tables.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use vertifleet_core::{Operations, Time};

use crate::Error;
use crate::row::{Column, one_of, required};
use crate::table;
use crate::vertiports::Vertiports;

/// The greatest amount for a passenger, dollars.
const MOST_USD: f64 = 1e6;
/// The greatest price of electricity, dollars per kWh.
const MOST_ENERGY_PRICE_USD: f64 = 1e3;

const FROM: usize = 0;
const TO: usize = 1;
const FARE: usize = 2;
const PASSENGER_COST: usize = 3;
const PAIR_COLUMNS: [Column; 4] = [
    required(&["from"]),
    required(&["to"]),
    one_of(&["fare_usd"]),
    one_of(&["passenger_cost_usd"]),
];
const PRICE_COLUMNS: [Column; 2] = [required(&["period"]), required(&["price_usd_per_kwh"])];

/// What a passenger pays and costs between two vertiports, where the table says so.
#[derive(Debug)]
pub(crate) struct PairTariff {
    /// The positions of the two vertiports.
    pub(crate) ends: (usize, usize),
    pub(crate) fare_usd: Option<f64>,
    pub(crate) passenger_cost_usd: Option<f64>,
}

/// Reads the table of fares and passenger costs.
pub(crate) fn pairs(path: &Path, vertiports: &Vertiports) -> Result<Vec<PairTariff>, Error> {
    let mut pairs = Vec::new();
    let mut known: HashMap<(usize, usize), usize> = HashMap::new();
    table::rows(path, &PAIR_COLUMNS, |row| {
        let ends = row.pair(FROM, TO, vertiports)?;
        if let Some(before) = known.insert(ends, row.position) {
            let (from, to) = (&vertiports.list[ends.0].id, &vertiports.list[ends.1].id);
            return Err(row.given_twice(format!("the pair {from:?} to {to:?}"), before));
        }
        let fare_usd = row.optional_number(FARE, 0.0, MOST_USD)?;
        let passenger_cost_usd = row.optional_number(PASSENGER_COST, 0.0, MOST_USD)?;
        if fare_usd.or(passenger_cost_usd).is_none() {
            return Err(row.wrong(FARE, "given, unless passenger_cost_usd is".to_owned()));
        }
        pairs.push(PairTariff { ends, fare_usd, passenger_cost_usd });
        Ok(())
    })?;
    if pairs.is_empty() {
        let origin = path.display().to_string();
        return Err(Error::Nothing { origin, what: "fares or costs" });
    }
    Ok(pairs)
}

/// Reads the table of energy prices and returns the price of each demand period. Prices outside of operations are read
/// over.
pub(crate) fn energy_prices_usd(
    path: &Path,
    periods: &[Time],
    operations: &Operations,
) -> Result<Vec<f64>, Error> {
    let mut prices: BTreeMap<Time, (f64, usize)> = BTreeMap::new();
    table::rows(path, &PRICE_COLUMNS, |row| {
        let period = row.time(0)?;
        let price = row.number(1, 0.0, MOST_ENERGY_PRICE_USD)?;
        match prices.insert(period, (price, row.position)) {
            Some((_, before)) => Err(row.given_twice(format!("the period {period}"), before)),
            None => Ok(()),
        }
    })?;
    let unfit = |problem| Error::PricePeriods { origin: path.display().to_string(), problem };
    let price = |period: &Time| match prices.get(period) {
        Some(&(price, _)) => Ok(price),
        None => Err(unfit(format!("there is no price for the demand period {period}"))),
    };
    let by_period: Vec<f64> = periods.iter().map(price).collect::<Result<_, Error>>()?;
    let within = |time: &&Time| {
        periods.first().is_some_and(|first| *time > first) && **time < operations.end
    };
    match prices.keys().filter(within).find(|time| periods.binary_search(time).is_err()) {
        Some(time) => Err(unfit(format!("a price begins at {time}, within a demand period"))),
        None => Ok(by_period),
    }
}
