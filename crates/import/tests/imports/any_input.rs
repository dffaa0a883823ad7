//! Gives an import arbitrary files: it never panics, and gives an error or a network.

use crate::made;
use crate::planner::{Folder, VERTIPORTS, line, map, new_york, point, request};
use proptest::prelude::{Strategy, any, prop, prop_oneof, proptest};
use proptest::sample::Index;
use proptest::test_runner::Config;
use vertifleet_core::{DaySeed, Stop};
use vertifleet_import::{Demand, Error, Imported, Trips, import};

const TABLE: &str = "from,to,period,passengers\nJRB,JFK,7,14\nJFK,JRB,08:00:00,2.5e0\n";
const FARES: &str = "from,to,fare_usd,passenger_cost_usd\nJRB,JFK,120,\nJFK,JRB,,20\n";
const PRICES: &str = "period,price_usd_per_kwh\n6,0.1\n7,0.2\n8,0.3\n";
const ZONES: &str = "zone,latitude,longitude\n12,40.70112,-74.0088\nKennedy,40.63993,-73.77869\n";
const BY_ZONE: &str =
    "pickup_datetime,PULocationID,DOLocationID\n2015-06-01 07:30:00,12.0,Kennedy\n";

/// A change of some bytes.
#[derive(Debug, Clone)]
enum Mutation {
    Flip(Index, u8),
    Delete(Index, usize),
    Repeat(Index, usize),
    Word(Index, &'static str),
    CutOff(Index),
}

fn mutations() -> impl Strategy<Value = Vec<Mutation>> {
    const WORDS: &[&str] = &[
        "-1",
        "0",
        "1e308",
        "1e999",
        "nan",
        "inf",
        "null",
        "\"",
        ",",
        "\n",
        "\r\n",
        "\u{feff}",
        "91",
        "256",
        "48",
        "9223372036854775808",
        "2015-02-29 10:00",
        "JRB",
        "true",
        "[]",
        "{}",
        "999999999999999999999999999999",
    ];
    let at = any::<Index>;
    let one = prop_oneof![
        2 => (at(), any::<u8>()).prop_map(|(at, byte)| Mutation::Flip(at, byte)),
        1 => (at(), 1..60_usize).prop_map(|(at, len)| Mutation::Delete(at, len)),
        1 => (at(), 1..200_usize).prop_map(|(at, len)| Mutation::Repeat(at, len)),
        4 => (at(), prop::sample::select(WORDS)).prop_map(|(at, word)| Mutation::Word(at, word)),
        1 => at().prop_map(Mutation::CutOff),
    ];
    prop::collection::vec(one, 0..4)
}

fn mutated(bytes: &[u8], mutations: &[Mutation]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for mutation in mutations {
        if bytes.is_empty() {
            break;
        }
        let length = bytes.len();
        let span = |at: &Index, len: usize| at.index(length)..(at.index(length) + len).min(length);
        match mutation {
            Mutation::Flip(at, byte) => bytes[at.index(length)] = *byte,
            Mutation::Delete(at, len) => drop(bytes.drain(span(at, *len))),
            Mutation::Repeat(at, len) => {
                let copy = bytes[span(at, *len)].to_vec();
                bytes.splice(at.index(length)..at.index(length), copy);
            }
            Mutation::Word(at, word) => drop(bytes.splice(span(at, 2), word.bytes())),
            Mutation::CutOff(at) => bytes.truncate(at.index(length)),
        }
    }
    bytes
}

/// The files of an import.
struct Files {
    vertiports: (&'static str, Vec<u8>),
    demand: Vec<u8>,
    zones: (&'static str, Vec<u8>),
    /// Trips in place of the table of demand.
    trips: Option<(&'static str, Vec<u8>)>,
    corridors: Vec<u8>,
    fares: Vec<u8>,
    prices: Vec<u8>,
}

impl Files {
    fn good() -> Self {
        let corridor =
            line(r#""from":"JRB","to":"JFK""#, "[-74.0088,40.70112],[-73.77869,40.63993]");
        Self {
            vertiports: ("vertiports.csv", VERTIPORTS.into()),
            demand: TABLE.into(),
            zones: ("zones.csv", ZONES.into()),
            trips: None,
            corridors: map(&[corridor]).into(),
            fares: FARES.into(),
            prices: PRICES.into(),
        }
    }

    fn import(&self) -> Result<Imported, Error> {
        let (folder, base) = (Folder::new(), new_york());
        let vertiports = folder.file(self.vertiports.0, &self.vertiports.1);
        let (demand, zones) =
            (folder.file("demand", &self.demand), folder.file(self.zones.0, &self.zones.1));
        let trips = self.trips.as_ref().map(|(name, bytes)| folder.file(name, bytes));
        let demand = match &trips {
            Some(trips) => {
                let mut trips = Trips::new(vec![trips]);
                (trips.zones, trips.radius_mi) = (Some(zones.as_path()), 5.0);
                Demand::Trips(trips)
            }
            None => Demand::Table(&demand),
        };
        let (corridors, fares, prices) = (
            folder.file("corridors.json", &self.corridors),
            folder.file("fares.csv", &self.fares),
            folder.file("prices.csv", &self.prices),
        );
        let mut request = request(&base, &vertiports, demand);
        request.corridors = Some(&corridors);
        request.tariffs = Some(&fares);
        request.energy_prices = trips.is_none().then_some(prices.as_path());
        let imported = import(&request, &Stop::default(), &|_| ());
        match &imported {
            Ok(imported) => {
                imported.network.draw(DaySeed::comparison(1).expect("small"));
            }
            Err(error) => assert!(error.to_string().len() < 2_500, "messages stay short: {error}"),
        }
        imported
    }
}

/// Points, so that every kind of file is changed.
fn map_of_vertiports() -> String {
    map(&[
        point(r#""id":"JRB","stands":40"#, -74.0088, 40.701_12),
        point(r#""id":"JFK","name":"Kennedy\n""#, -73.778_69, 40.639_93),
    ])
}

fn map_of_zones() -> String {
    let ring = "[[[-74.02,40.70],[-74.0,40.70],[-74.0,40.71],[-74.02,40.70]]]";
    map(&[
        point(r#""zone":"Kennedy""#, -73.778_69, 40.639_93),
        point(r#""zone":12"#, 0.0, 0.0).replace("Point", "Polygon").replace("[0,0]", ring),
    ])
}

fn parquet() -> Vec<u8> {
    let mut bytes = Vec::new();
    let places = [(40.701_12, -74.0088), (40.639_93, -73.778_69)];
    made::write_parquet(&mut bytes, made::trips(&places, 400, 1), 150).expect("written");
    bytes
}

/// The good files with one of them in other bytes.
fn with(file: usize, change: impl Fn(&[u8]) -> Vec<u8>) -> Files {
    let mut files = Files::good();
    match file {
        0 => files.vertiports.1 = change(VERTIPORTS.as_bytes()),
        1 => files.vertiports = ("vertiports.geojson", change(map_of_vertiports().as_bytes())),
        2 => files.demand = change(TABLE.as_bytes()),
        3 => files.corridors = change(&files.corridors),
        4 => files.fares = change(FARES.as_bytes()),
        5 => files.prices = change(PRICES.as_bytes()),
        6 => files.trips = Some(("trips.csv", change(BY_ZONE.as_bytes()))),
        7 => files.trips = Some(("trips.parquet", change(&parquet()))),
        8 => {
            files.trips = Some(("trips.csv", BY_ZONE.into()));
            files.zones.1 = change(ZONES.as_bytes());
        }
        _ => {
            files.trips = Some(("trips.csv", BY_ZONE.into()));
            files.zones = ("zones.json", change(map_of_zones().as_bytes()));
        }
    }
    files
}

#[test]
fn the_files_that_are_changed_are_good() {
    for file in 0..10 {
        if let Err(error) = with(file, <[u8]>::to_vec).import() {
            panic!("file {file}: {error}");
        }
    }
}

proptest! {
    #![proptest_config(Config { failure_persistence: None, ..Config::with_cases(300) })]

    #[test]
    fn no_changed_file_makes_an_import_panic(file in 0..10_usize, mutations in mutations()) {
        let _ = with(file, |bytes| mutated(bytes, &mutations)).import();
    }

    #[test]
    fn no_bytes_make_an_import_panic(
        file in 0..10_usize,
        bytes in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let _ = with(file, |_| bytes.clone()).import();
    }

    #[test]
    fn no_changed_parquet_file_makes_an_import_panic(mutations in mutations()) {
        let _ = with(7, |bytes| mutated(bytes, &mutations)).import();
    }
}
