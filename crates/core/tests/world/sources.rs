//! The networks of cities agree with their sources: positions are those of OurAirports
//! (`networks/sources`), and every pair with demand is within range.

use std::collections::BTreeMap;
use std::fs;

use vertifleet_core::{Matrix, Network, great_circle_mi};

/// The networks whose sites are in `networks/sources/sites.csv`.
const CITIES: [&str; 5] = ["san-francisco", "los-angeles", "dallas", "paris", "new-york"];
/// 100 m, in miles. Positions in network files are rounded to about 1 m, those of `new-york` are
/// from several places.
const CLOSE_MI: f64 = 0.1 / 1.609_344;

/// The rows of a table of `networks/sources`, without its head. No text in these tables has a comma
/// but the last of a row.
fn rows(table: &str, columns: usize) -> Vec<Vec<String>> {
    let path = format!("{}/../../networks/sources/{table}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).expect("a table of the project");
    let row = |line: &str| line.splitn(columns, ',').map(str::to_owned).collect();
    text.lines().skip(1).map(row).collect()
}

/// Latitude and longitude, in degrees.
fn place(latitude: &str, longitude: &str) -> (f64, f64) {
    let degrees = |text: &str| text.parse().expect("degrees");
    (degrees(latitude), degrees(longitude))
}

fn shipped(name: &str) -> Network {
    Network::shipped(name).expect("a shipped network")
}

#[test]
fn every_site_of_a_city_is_within_100_m_of_where_its_source_has_it() {
    let airports: BTreeMap<String, (f64, f64)> = rows("airports.csv", 7)
        .iter()
        .map(|row| (row[0].clone(), place(&row[3], &row[4])))
        .collect();
    let sites = rows("sites.csv", 9);
    for city in CITIES {
        let network = shipped(city);
        let of_city: Vec<_> = sites.iter().filter(|row| row[0] == city).collect();
        assert_eq!(network.vertiports().len(), of_city.len(), "{city}");
        for (vertiport, row) in network.vertiports().iter().zip(of_city) {
            assert_eq!(vertiport.id, row[1], "{city}");
            let found = vertiport.degrees.expect("a vertiport of a city has degrees");
            let due = match row[2].as_str() {
                "" => place(&row[3], &row[4]),
                ident => airports[ident],
            };
            let apart = great_circle_mi((found.latitude, found.longitude), due);
            assert!(apart < CLOSE_MI, "{city}: {} is {apart} miles from its source", row[1]);
        }
    }
}

#[test]
fn every_aircraft_can_fly_every_pair_of_a_city() {
    for city in CITIES {
        let network = shipped(city);
        let miles = network.mean_day().distance_mi.cells().iter().copied().fold(0.0, f64::max);
        for kind in network.aircraft_types() {
            assert!(miles * kind.energy_kwh_per_mi < kind.battery_kwh, "{city}: {}", kind.id);
        }
    }
}

/// 25 trips of each aircraft with its four seats taken, which is what `networks/sources/README.md`
/// scales demand to. Means in the files are rounded to hundredths.
#[test]
fn a_hundred_passengers_a_day_want_to_fly_for_each_aircraft_of_a_made_network() {
    for city in &CITIES[..4] {
        let network = shipped(city);
        let means = network.mean_demand();
        let passengers: f64 = means.iter().flat_map(Matrix::cells).sum();
        let due = 100.0 * f64::from(u32::try_from(network.fleet_size()).expect("a small fleet"));
        assert!((passengers - due).abs() < 0.002 * due, "{city}: {passengers} and not {due}");
    }
}
