//! Fares and costs by pair from a planner's table.

use std::collections::HashMap;

use crate::input_file::InputFile;
use crate::row::{Column, one_of, required};
use crate::table;
use crate::vertiports::Vertiports;
use crate::{Error, Warning};

/// The greatest amount for a passenger, dollars.
const MOST_USD: f64 = 1e6;

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

/// The fare and the cost of a passenger between two vertiports, where the table states them.
#[derive(Debug)]
pub(crate) struct PairTariff {
    /// The positions of the two vertiports.
    pub(crate) ends: (usize, usize),
    pub(crate) fare_usd: Option<f64>,
    pub(crate) passenger_cost_usd: Option<f64>,
}

/// Reads the table of fares and passenger costs.
pub(crate) fn pairs(
    file: &InputFile<'_>,
    vertiports: &Vertiports,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<PairTariff>, Error> {
    let mut pairs = Vec::new();
    let mut known: HashMap<(usize, usize), usize> = HashMap::new();
    table::rows(file, &PAIR_COLUMNS, warnings, |row| {
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
        let origin = file.origin();
        return Err(Error::Nothing { origin, what: "fares or costs" });
    }
    Ok(pairs)
}
