//! Demand by hour and pair: rows in the network file mean the same as a table in its folder, and a
//! network that was read with a table no longer needs it.

use std::fs;
use std::path::Path;

use vertifleet_core::{DaySeed, Network, VertiportIx};

const SMALL: &str = include_str!("../data/small.toml");
const TABLE: &str = "period,from,to,passengers\n\
    06:00:00,A,B,2.5\n\
    08:00:00,A,B,12\n\
    08:00:00,B,A,0.125\n";
const PAIRS: &str = "pairs = [\n\
    { from = \"A\", to = \"B\", passengers = [2.5, 12] },\n\
    { from = \"B\", to = \"A\", passengers = [0, 0.125] },\n]";

fn network(members: &str) -> String {
    let begin = SMALL.find("[demand]").expect("a demand model");
    let end = SMALL.find("[feature_scales]").expect("what follows it");
    let periods = "periods = [\"06:00:00\", \"08:00:00\"]";
    format!("{}[hourly_demand]\n{periods}\n{members}\n\n{}", &SMALL[..begin], &SMALL[end..])
}

fn read_with_table(folder: &Path, table: &[u8]) -> Network {
    fs::write(folder.join("net.toml"), network("table = \"demand.csv\"")).expect("a free folder");
    fs::write(folder.join("demand.csv"), table).expect("a free folder");
    Network::read(folder.join("net.toml")).expect("a network with its table")
}

fn day(network: &Network) -> vertifleet_core::Scenario {
    network.draw(DaySeed::comparison(3).expect("a small seed"))
}

#[test]
fn means_are_those_of_the_rows_and_0_where_there_is_none() {
    let network = Network::from_toml(&network(PAIRS), "net.toml").expect("a network");
    let (a, b) = (VertiportIx::new(0), VertiportIx::new(1));
    let means = network.mean_demand();
    assert_eq!((means[0][(a, b)], means[1][(a, b)]), (2.5, 12.0));
    assert_eq!((means[0][(b, a)], means[1][(b, a)]), (0.0, 0.125));
    assert_eq!((means[0][(a, a)], means[1][(b, b)]), (0.0, 0.0));
}

#[test]
fn a_table_is_what_its_rows_are_in_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let with_rows = Network::from_toml(&network(PAIRS), "net.toml").expect("a network");
    let with_table = read_with_table(folder.path(), TABLE.as_bytes());
    assert_eq!(with_table.mean_demand(), with_rows.mean_demand());
    assert_eq!(day(&with_table), day(&with_rows));
}

/// The table has the form that Excel on Windows writes: a byte order mark, CR LF, hours of one
/// digit.
#[test]
fn a_table_from_a_spreadsheet_is_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let plain = read_with_table(folder.path(), TABLE.as_bytes());
    let spreadsheet = format!("\u{feff}{}", TABLE.replace('\n', "\r\n").replace("\n0", "\n"));
    assert!(spreadsheet.contains("\r\n6:00:00,"));
    let other = read_with_table(folder.path(), spreadsheet.as_bytes());
    assert_eq!(other.toml(), plain.toml());
}

#[test]
fn a_network_keeps_the_rows_of_its_table_in_its_own_text() {
    let folder = tempfile::tempdir().expect("a folder");
    let network = read_with_table(folder.path(), TABLE.as_bytes());
    folder.close().expect("our own folder");
    let again = Network::from_toml(network.toml(), "again").expect("it needs no table");
    assert_eq!(again.toml(), network.toml());
    assert_eq!(day(&again), day(&network));
    assert!(again.draws(&day(&network)));
    let path = "hourly_demand.pairs.0.passengers".to_owned();
    let none = serde_json::json!([0, 0]);
    let changed = network.changed([(&path, &none)]).expect("a network");
    assert_eq!(changed.mean_demand()[1][(VertiportIx::new(0), VertiportIx::new(1))], 0.0);
}

#[test]
fn other_numbers_in_the_table_are_another_network() {
    let folder = tempfile::tempdir().expect("a folder");
    let network = read_with_table(folder.path(), TABLE.as_bytes());
    let other = read_with_table(folder.path(), TABLE.replace("12", "120").as_bytes());
    assert_ne!(network.toml(), other.toml());
    assert!(!network.draws(&day(&other)));
}

#[test]
fn an_error_of_a_table_does_not_name_the_network() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("net.toml");
    fs::write(&path, network("table = \"missing.csv\"")).expect("a free folder");
    let error = Network::read(&path).expect_err("no table").to_string();
    assert!(error.contains("missing.csv: cannot be read"), "{error}");
}
