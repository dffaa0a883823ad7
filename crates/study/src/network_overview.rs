//! What a network holds, in numbers.

use serde::Serialize;
use vertifleet_core::{AircraftType, Matrix, Network, VertiportIx, Warning};

use crate::sweep::Size;

/// What a network holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NetworkOverview {
    /// Its name.
    pub name: String,
    /// The time zone of its clocks.
    pub time_zone: Option<String>,
    /// Start and end of operations.
    pub operations: [String; 2],
    /// Seconds for which passengers who are not carried wait into the next period.
    pub passenger_wait_s: u32,
    /// The vertiports.
    pub vertiports: Vec<VertiportOverview>,
    /// The aircraft types with the number of aircraft of each.
    pub aircraft_types: Vec<TypeOverview>,
    /// Aircraft, stands, chargers, and what they cost a day.
    pub size: Size,
    /// Shortest, mean and longest distance between two vertiports, miles.
    pub distance_mi: [f64; 3],
    /// Lowest, mean and highest fare of a pair that has passengers, over all periods, dollars.
    pub fare_usd: [f64; 3],
    /// The starts of the demand periods.
    pub periods: Vec<String>,
    /// Mean passengers, `[period][from][to]`.
    pub passengers: Vec<Vec<Vec<f64>>>,
    /// Mean passengers of a day.
    pub passengers_a_day: f64,
    /// What is allowed in the network but hardly meant.
    pub warnings: Vec<String>,
}

/// A vertiport of a network.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VertiportOverview {
    /// Its id.
    pub id: String,
    /// Latitude and longitude in degrees, if they are known.
    pub degrees: Option<[f64; 2]>,
    /// Miles east and north.
    pub position_mi: [f64; 2],
    /// Stands.
    pub stands: u16,
    /// Chargers that are counted apart from stands.
    pub chargers: Option<u16>,
    /// Mean passengers a day who leave from it.
    pub departing: f64,
    /// Mean passengers a day who want to reach it.
    pub arriving: f64,
}

/// An aircraft type of a network.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TypeOverview {
    /// Its id.
    pub id: String,
    /// Aircraft of this type.
    pub aircraft: usize,
    /// Seats.
    pub seats: u16,
    /// Cruise speed, miles per hour.
    pub speed_mph: f64,
    /// How far a full battery lasts without self-discharge, miles.
    pub range_mi: f64,
}

impl NetworkOverview {
    /// The overview of a network.
    pub fn of(network: &Network) -> Self {
        let day = network.mean_day();
        let means = network.mean_demand();
        let all = total(&means);
        let pairs = || {
            VertiportIx::all(all.size())
                .flat_map(|from| VertiportIx::all(all.size()).map(move |to| (from, to)))
                .filter(|(from, to)| from != to)
        };
        let fares = day.fare_usd.tables().flat_map(|table| {
            pairs().filter(|&pair| all[pair] > 0.0).map(|pair| table[pair]).collect::<Vec<f64>>()
        });
        let vertiport = |(at, one): (VertiportIx, &vertifleet_core::Vertiport)| VertiportOverview {
            id: one.id.clone(),
            degrees: one.degrees.map(|place| [place.latitude, place.longitude]),
            position_mi: [one.x_mi, one.y_mi],
            stands: one.stands,
            chargers: one.chargers,
            departing: all.row(at).iter().sum(),
            arriving: VertiportIx::all(all.size()).map(|from| all[(from, at)]).sum(),
        };
        let kind = |(at, one): (usize, &AircraftType)| TypeOverview {
            id: one.id.clone(),
            aircraft: day.aircraft.iter().filter(|aircraft| aircraft.kind.at() == at).count(),
            seats: one.seats,
            speed_mph: one.speed_mph,
            range_mi: one.battery_kwh / one.energy_kwh_per_mi,
        };
        let rows = |table: &Matrix<f64>| table.rows().map(<[f64]>::to_vec).collect();
        let ixs = VertiportIx::all(day.vertiports.len());
        Self {
            name: network.name().to_owned(),
            time_zone: network.time_zone().map(str::to_owned),
            operations: [day.operations.start.to_string(), day.operations.end.to_string()],
            passenger_wait_s: day.operations.passenger_wait_s,
            vertiports: ixs.zip(&day.vertiports).map(vertiport).collect(),
            aircraft_types: day.aircraft_types.iter().enumerate().map(kind).collect(),
            size: Size::of(network),
            distance_mi: spread(&pairs().map(|pair| day.distance_mi[pair]).collect::<Vec<f64>>()),
            fare_usd: spread(&fares.collect::<Vec<f64>>()),
            periods: network.period_starts().iter().map(ToString::to_string).collect(),
            passengers: means.iter().map(rows).collect(),
            passengers_a_day: all.cells().iter().sum(),
            warnings: network.warnings().iter().map(Warning::to_string).collect(),
        }
    }
}

/// The sum over all periods.
fn total(means: &[Matrix<f64>]) -> Matrix<f64> {
    let size = means.first().map_or(0, Matrix::size);
    Matrix::from_fn(size, |from, to| means.iter().map(|table| table[(from, to)]).sum())
}

/// The least, the mean and the greatest of some numbers; 0 if there are none.
fn spread(numbers: &[f64]) -> [f64; 3] {
    if numbers.is_empty() {
        return [0.0; 3];
    }
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least, crate::statistics::mean(numbers), most]
}

#[cfg(test)]
mod tests {
    use vertifleet_core::Network;

    use super::NetworkOverview;

    #[test]
    fn an_overview_adds_up() {
        for name in Network::shipped_names() {
            let overview = NetworkOverview::of(&Network::shipped(name).expect("listed"));
            let departing: f64 = overview.vertiports.iter().map(|one| one.departing).sum();
            let arriving: f64 = overview.vertiports.iter().map(|one| one.arriving).sum();
            let all = overview.passengers_a_day;
            assert!((departing - all).abs() < 1e-6 * all && (arriving - all).abs() < 1e-6 * all);
            let aircraft: usize = overview.aircraft_types.iter().map(|one| one.aircraft).sum();
            assert_eq!(aircraft, overview.size.aircraft, "{name}");
        }
    }
}
