//! Imports of every kind of file, and the resulting network file.

use crate::planner::{Folder, VERTIPORTS, line, map, new_york, point, request, run, run_table};
use vertifleet_core::{Network, Time, VertiportIx};
use vertifleet_import::{Demand, Imported};

const TABLE: &str = "\
from,to,period,passengers
JRB,JFK,7,14
JRB,JFK,08:00:00,22.5
JFK,JRB,7,9
";

/// The network without its text.
fn numbers(network: &Network) -> String {
    format!("{:?} {:?} {:?}", network.vertiports(), network.period_starts(), network.mean_demand())
}

#[test]
fn a_table_of_demand_becomes_periods_and_pairs_with_an_empty_period_before_it() {
    let folder = Folder::new();
    let imported = run_table(&folder, TABLE).expect("a network");
    let network = &imported.network;
    assert_eq!((network.name(), network.vertiports().len()), ("imported", 3));
    let starts: Vec<String> = network.period_starts().iter().map(ToString::to_string).collect();
    assert_eq!(starts, ["06:00:00", "07:00:00", "08:00:00"]);
    let means = network.mean_demand();
    let of =
        |period: usize, from, to| means[period][(VertiportIx::new(from), VertiportIx::new(to))];
    assert_eq!([of(0, 0, 1), of(1, 0, 1), of(2, 0, 1)], [0.0, 14.0, 22.5]);
    assert_eq!([of(1, 1, 0), of(2, 1, 0), of(1, 0, 2)], [9.0, 0.0, 0.0]);
    assert_eq!(network.vertiports()[1].chargers, Some(6));
    assert!(imported.account.is_none());
    assert_eq!(network.toml(), imported.toml, "what is returned is what was read");
    assert_eq!(network.fleet_size(), new_york().fleet_size());
}

#[test]
fn marks_line_ends_order_of_columns_and_further_columns_change_nothing() {
    let folder = Folder::new();
    let plain = run_table(&folder, TABLE).expect("a network");
    let odd = "\u{feff}passengers,remark,TO,from,period\r\n14,\"a, b\",JFK,JRB,7\r\n\r\n22.5,,JFK, JRB ,8\r\n9.0,,JRB,JFK,7:00:00\r\n";
    let odd = run_table(&folder, odd).expect("a network");
    assert_eq!(numbers(&plain.network), numbers(&odd.network));
    assert_eq!(plain.toml, odd.toml);
}

#[test]
fn times_without_seconds_and_empty_cells_of_spreadsheets_change_nothing() {
    let folder = Folder::new();
    let plain = run_table(&folder, TABLE).expect("a network");
    let of_spreadsheet = "from,to,period,passengers,,\nJRB,JFK,07:00,14,,\nJRB,JFK,8:00,22.5,,\nJFK,JRB,07:00,9,,\n,,,,,\n , ,\n";
    let of_spreadsheet = run_table(&folder, of_spreadsheet).expect("a network");
    assert_eq!(plain.toml, of_spreadsheet.toml);
    let rows = VERTIPORTS.replace('\n', ",,\n");
    folder.file("vertiports.csv", format!("{rows},,,,,,,,\r\n"));
    assert_eq!(run_table(&folder, TABLE).expect("a network").toml, plain.toml);
}

#[test]
fn points_of_a_map_and_rows_of_a_table_give_the_same_vertiports() {
    let folder = Folder::new();
    let table = run_table(&folder, TABLE).expect("a network");
    let of = |text: &str, longitude, latitude| point(text, longitude, latitude);
    let features = [
        of(
            r#""id":"JRB","stands":12,"busy":true,"name":"Downtown Manhattan""#,
            -74.008_80,
            40.701_12,
        ),
        of(
            r#""id":"JFK","stands":"20","chargers":6,"busy":false,"name":"Kennedy""#,
            -73.778_69,
            40.639_93,
        ),
        of(r#""stands":8,"name":"Newark""#, -74.168_69, 40.692_48).replacen(
            r#""type":"Feature""#,
            r#""type":"Feature","id":"EWR""#,
            1,
        ),
    ];
    let (base, places) = (new_york(), folder.file("places.geojson", map(&features)));
    let demand = folder.path("demand.csv");
    let from_map = run(&request(&base, &places, Demand::Table(&demand))).expect("a network");
    assert_eq!(numbers(&table.network), numbers(&from_map.network));
    // The kind of a file whose name does not show it is recognised by its text.
    let unnamed = folder.file("places", map(&features));
    let unnamed = run(&request(&base, &unnamed, Demand::Table(&demand))).expect("a network");
    assert_eq!(numbers(&table.network), numbers(&unnamed.network));
}

#[test]
fn powers_of_chargers_are_taken_where_the_file_gives_them() {
    let folder = Folder::new();
    let rows = "JRB,40.70112,-74.00880,12,62.5\nJFK,40.63993,-73.77869,20,\nEWR,40.69248,-74.16869,8,150\n";
    folder.file("vertiports.csv", format!("id,latitude,longitude,stands,charger_kw\n{rows}"));
    let powers = |network: &Network| {
        network.vertiports().iter().map(|vertiport| vertiport.charger_kw).collect::<Vec<_>>()
    };
    let from_table = run_table(&folder, TABLE).expect("a network");
    assert_eq!(powers(&from_table.network), [Some(62.5), None, Some(150.0)]);
    assert!(from_table.toml.contains("charger_kw = 150\n"), "{}", from_table.toml);
    let features = [
        point(r#""id":"JRB","charger_kw":62.5"#, -74.008_80, 40.701_12),
        point(r#""id":"JFK","charger_kw":null"#, -73.778_69, 40.639_93),
    ];
    let (base, places) = (new_york(), folder.file("places.geojson", map(&features)));
    let demand = folder.path("demand.csv");
    let mut request = request(&base, &places, Demand::Table(&demand));
    request.aircraft = Some(2);
    let from_map = run(&request).expect("a network");
    assert_eq!(powers(&from_map.network), [Some(62.5), None]);
}

#[test]
fn stands_that_no_file_gives_are_assumed_with_a_comment() {
    let folder = Folder::new();
    let rows = (0..10).map(|n| format!("V{n},40.{n},-74\n")).collect::<Vec<_>>().concat();
    folder.file("vertiports.csv", format!("id,latitude,longitude\n{rows}"));
    let imported = run_table(&folder, "from,to,period,passengers\nV0,V1,6,1\n").expect("a network");
    assert!(imported.network.vertiports().iter().all(|vertiport| vertiport.stands == 4));
    assert!(imported.toml.contains("# assumption: 4 stands at each of the 10 vertiports"));
}

#[test]
fn a_fleet_of_another_size_and_a_time_zone_are_taken_and_the_file_says_so() {
    let folder = Folder::new();
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    let demand = folder.file("demand.csv", TABLE);
    let in_one_line = include_str!("data/in-one-line.toml");
    let in_one_line = Network::from_toml(in_one_line, "in-one-line.toml").expect("a network");
    for (base, fleet, entry) in [
        (&base, "new-york has 32", "type = \"midnight\"\ncount = 4\n"),
        (&in_one_line, "in-one-line has 3", "fleet = [{ type = \"small\", count = 7 }]"),
    ] {
        let mut request = request(base, &vertiports, Demand::Table(&demand));
        (request.aircraft, request.time_zone) = (Some(7), Some("America/New_York"));
        let Imported { network, toml, .. } = run(&request).expect("a network");
        assert_eq!((network.fleet_size(), network.time_zone()), (7, Some("America/New_York")));
        let comment =
            format!("# The import was asked for 7 aircraft; {fleet}, and each type keeps");
        assert!(toml.contains(&comment) && toml.contains(entry), "{toml}");
        assert!(
            toml.contains("# The time zone that the import was given.\ntime_zone = "),
            "{toml}"
        );
    }
}

/// Everything at once, to be read by people.
#[test]
fn the_network_file_says_where_everything_is_from() {
    let folder = Folder::new();
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    let demand = folder.file("demand.csv", TABLE);
    let corridors = folder.file(
        "corridors.geojson",
        map(&[
            line(
                r#""from":"JRB","to":"JFK""#,
                "[-74.0088,40.70112],[-73.9,40.6],[-73.77869,40.63993]",
            ),
            line(r#""from":"EWR","to":"JRB","both_ways":false"#, "[-74.16,40.69],[-74.0088,40.7]"),
        ]),
    );
    let tariffs = folder.file(
        "fares.csv",
        "from,to,fare_usd,passenger_cost_usd\nJRB,JFK,120,\nJFK,JRB,110.5,20\nEWR,JRB,,31\n",
    );
    let prices = folder
        .file("prices.csv", "period,price_usd_per_kwh\n0,0.1\n6,0.15\n7,0.2\n8,0.25\n23,0.1\n");
    let mut request = request(&base, &vertiports, Demand::Table(&demand));
    request.corridors = Some(&corridors);
    request.tariffs = Some(&tariffs);
    request.energy_prices = Some(&prices);
    let imported = run(&request).expect("a network");
    insta::assert_snapshot!("network_file", imported.toml);
}

#[test]
fn without_prices_of_their_own_periods_have_those_of_the_base_at_their_start() {
    let folder = Folder::new();
    let table = "from,to,period,passengers\nJRB,JFK,5,1\nJRB,JFK,11:30:00,1\nJRB,JFK,12,1\nJRB,JFK,22:30:00,1\n";
    let imported = run_table(&folder, table).expect("a network");
    assert!(
        imported.toml.contains("energy_price_usd_per_kwh = [0.18, 0.18, 0.30, 0.18]"),
        "{}",
        imported.toml
    );
    assert!(imported.toml.contains("fare_factors = [1.0, 1.0, 1.0, 1.0]"));
    assert!(imported.toml.contains("is the one that new-york has when the period starts"));
}

#[test]
fn a_price_holds_until_the_next_and_a_period_in_which_it_changes_has_the_mean() {
    let folder = Folder::new();
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    let prices = folder.file("prices.csv", "period,price_usd_per_kwh\n0,0.1\n14,0.3\n19,0.2\n");
    let of_hours = (6..22).map(|hour| format!("JRB,JFK,{hour},1\n")).collect::<Vec<_>>().concat();
    let cheap_and_dear = [vec!["0.1"; 8], vec!["0.3"; 5], vec!["0.2"; 3]].concat().join(", ");
    // From 10:00 to 18:00 half of the time is dear, and from 18:00 to 22:00 a fourth.
    for (rows, found, changes) in [
        (of_hours.as_str(), cheap_and_dear.as_str(), ""),
        ("JRB,JFK,6,1\nJRB,JFK,10,1\nJRB,JFK,18,1\n", "0.1, 0.2, 0.225", "14:00:00, 19:00:00"),
    ] {
        let demand = folder.file("demand.csv", format!("from,to,period,passengers\n{rows}"));
        let mut request = request(&base, &vertiports, Demand::Table(&demand));
        request.energy_prices = Some(&prices);
        let imported = run(&request).expect("a network");
        let member = format!("energy_price_usd_per_kwh = [{found}]");
        assert!(imported.toml.contains(&member), "{}", imported.toml);
        assert_eq!(imported.toml.contains("has the mean over its time"), !changes.is_empty());
        let warned = imported.warnings.iter().find(|warning| warning.code().0 == 720);
        assert_eq!(warned.is_some(), !changes.is_empty());
        assert!(warned.is_none_or(|warning| warning.to_string().ends_with(changes)), "{warned:?}");
    }
}

#[test]
fn a_network_can_be_imported_with_every_shipped_network_as_its_base_and_with_an_import() {
    let folder = Folder::new();
    let roomy = VERTIPORTS.replace(",12,", ",200,").replace(",20,", ",200,");
    let vertiports = folder.file("roomy.csv", roomy);
    let demand = folder.file("demand.csv", TABLE);
    let mut bases: Vec<Network> = Network::shipped_names().filter_map(Network::shipped).collect();
    let again = run(&request(&bases[0], &vertiports, Demand::Table(&demand))).expect("a network");
    let means = again.network.mean_demand();
    bases.push(again.network);
    for base in &bases {
        let request = request(base, &vertiports, Demand::Table(&demand));
        let (one, other) = (run(&request).expect("a network"), run(&request).expect("a network"));
        assert_eq!(one.toml, other.toml, "{}", base.name());
        // `paris` opens at 7:00, when the table begins, and has no empty period before.
        let found = one.network.mean_demand();
        let empty = usize::from(base.operations().start < Time::from_seconds(7 * 3_600));
        assert_eq!((found.len(), means.ends_with(&found)), (2 + empty, true), "{}", base.name());
        assert_eq!(one.network.aircraft_types(), base.aircraft_types());
    }
}

#[test]
fn members_of_a_base_in_one_line_are_edited_too() {
    let folder = Folder::new();
    let text = include_str!("data/in-one-line.toml");
    let base = Network::from_toml(text, "in-one-line.toml").expect("a network");
    let vertiports = folder.path("vertiports.csv");
    let demand = folder.file("demand.csv", TABLE);
    let tariffs = folder.file("fares.csv", "from,to,fare_usd\nJRB,JFK,120\n");
    let mut request = request(&base, &vertiports, Demand::Table(&demand));
    request.tariffs = Some(&tariffs);
    let imported = run(&request).expect("a network");
    insta::assert_snapshot!("in_one_line", imported.toml);
}
