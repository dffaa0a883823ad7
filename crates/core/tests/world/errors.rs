//! Every expected error is provoked by the smallest change to a good file, with its code, message
//! and hint.

use std::collections::BTreeSet;
use std::fmt::Write;

use vertifleet_core::{Code, Coded, Day, DaySeed, Error, Network, Scenario};

const SCENARIO: &str = include_str!("../data/small.json");
const NETWORK: &str = include_str!("../data/small.toml");

/// A change to one of the good files: the first occurrence of one text becomes another.
type Change = (&'static str, &'static str);

const SCENARIO_CHANGES: &[Change] = &[
    // Numbers.
    (r#""stands": 1"#, r#""stands": 0"#),
    (r#""stands": 1"#, r#""stands": 1.5"#),
    (r#""stands": 1"#, r#""stands": -1"#),
    (r#""stands": 1"#, r#""stands": 70000"#),
    (r#""x_mi": 30"#, r#""x_mi": 1e300"#),
    (r#""seats": 4"#, r#""seats": 0"#),
    (r#""speed_mph": 74.5"#, r#""speed_mph": 0.5"#),
    (r#""battery_kwh": 110"#, r#""battery_kwh": 0"#),
    (r#""energy_kwh_per_mi": 2.2"#, r#""energy_kwh_per_mi": -2.2"#),
    (r#""charge_kw": 150"#, r#""charge_kw": 0"#),
    (r#""self_discharge_per_h": 0"#, r#""self_discharge_per_h": 1.01"#),
    (r#""takeoff_s": 900"#, r#""takeoff_s": -900"#),
    (r#""takeoff_s": 900, "landing_s": 600"#, r#""takeoff_s": 30, "landing_s": 29"#),
    (r#""hold_s": 900"#, r#""hold_s": 0"#),
    (r#""hold_s": 900"#, r#""hold_s": 900, "passenger_wait_s": 0.5"#),
    (r#""hold_s": 900"#, r#""hold_s": 900, "passenger_wait_s": 7201"#),
    (r#""end": "09:30:00""#, r#""end": "36:00:01""#),
    ("[0, 30, 40]", "[0, -30, 40]"),
    ("[0, 30, 40]", "[1, 30, 40]"),
    ("[0, 48.1, 60]", "[0, 48.1, 6e6]"),
    ("[25.6, 32, 0]", "[25.6, 32, -1]"),
    ("[0, 7, 3]", "[0, -7, 3]"),
    ("[0, 7, 3]", "[0, 7.5, 3]"),
    ("[0.2, 0.31]", "[0.2, -0.31]"),
    (r#""seed": 1"#, r#""seed": 9007199254740992"#),
    (r#""seed": 1"#, r#""seed": -1"#),
    // Text that is not JSON, and members.
    ("[0, 7, 3]", "[0, 7, 3"),
    ("[0, 7, 3]", "[0, 7, 1e999]"),
    ("[0.2, 0.31]\n}", "[0.2, 0.31]\n} again"),
    (r#""busy": false"#, r#""busy": false, "colour": "red""#),
    (r#", "busy": false"#, ""),
    (r#""stands": 1"#, r#""stands": "one""#),
    (r#""seed": 1"#, r#""seed": 1, "seed": 1"#),
    (r#""start": "06:00:00""#, r#""start": "6 o'clock""#),
    ("vertifleet-scenario/1", "vertifleet-scenario/2"),
    (r#""format": "vertifleet-scenario/1","#, ""),
    // Shapes.
    (r#""periods": ["06:00:00", "08:00:00"]"#, r#""periods": []"#),
    (",\n    [40, 50, 0]", ""),
    ("[48.1, 0, 80.5]", "[48.1, 0]"),
    ("[4, 0, 6]", "[4, 0, 6, 0]"),
    ("[0.2, 0.31]", "[0.2]"),
    // Ids, and members that must agree.
    (r#""id": "B""#, r#""id": "A""#),
    (r#""id": "A02""#, r#""id": "A01""#),
    (r#""at": "B""#, r#""at": "D""#),
    (r#""type": "glider""#, r#""type": "Glider""#),
    (r#""id": "B""#, r#""id": """#),
    (r#""name": "small-1""#, r#""name": "small\n1""#),
    (r#""at": "A""#, r#""at": "B""#),
    (r#""end": "09:30:00""#, r#""end": "05:30:00""#),
    (r#"["06:00:00", "08:00:00"]"#, r#"["06:00:01", "08:00:00"]"#),
    (r#"["06:00:00", "08:00:00"]"#, r#"["06:00:00", "06:00:00"]"#),
    ("[8, 0, 0]", "[8, 0, 1]"),
    // Costs beyond those of the paper, and positions on the globe.
    ("[0.2, 0.31]", "[0.2, 0.31],\n  \"aircraft_cost\": -1"),
    (r#""stands": 1"#, r#""stands": 1, "stand_cost": -1"#),
    (r#""stands": 1"#, r#""stands": 1, "charger_cost": 1e7"#),
    ("[0.2, 0.31]", "[0.2, 0.31],\n  \"flight_cost\": [[0, 1], [1, 0]]"),
    ("[0.2, 0.31]", "[0.2, 0.31],\n  \"flight_cost\": [[0, 1, 2], [1, 0, -3], [2, 3, 0]]"),
    (r#""stands": 1"#, r#""stands": 1, "latitude": 40"#),
    (r#""stands": 1"#, r#""stands": 1, "latitude": 40, "longitude": 181"#),
    // Beyond the paper.
    ("[0, 48.1, 60]", "[[0, 48.1, 60]]"),
    (r#""stands": 1"#, r#""stands": 1, "chargers": 0"#),
    (r#""energy_price""#, r#""forecast": [], "energy_price""#),
    (r#""energy_price""#, r#""corridors": [], "energy_price""#),
    (r#""energy_price""#, r#""corridors": [{"from": "A", "to": "A"}], "energy_price""#),
    (r#""energy_price""#, r#""corridors": [{"from": "A", "to": "Z"}], "energy_price""#),
    (r#""energy_price""#, r#""takeoff_delays": {"slot_s": 59, "delay_s": []}, "energy_price""#),
    (
        r#""energy_price""#,
        r#""takeoff_delays": {"slot_s": 86400, "delay_s": [[0, 0]]}, "energy_price""#,
    ),
    (
        r#""energy_price""#,
        r#""takeoff_delays": {"slot_s": 12600, "delay_s": [[0, 0, 0]]}, "energy_price""#,
    ),
    (
        r#""energy_price""#,
        r#""closures": [{"from": "A", "to": "B", "start": "08:00:00", "end": "07:00:00"}], "energy_price""#,
    ),
    (
        r#""energy_price""#,
        r#""outages": [{"aircraft": "A09", "start": "08:00:00", "end": "09:00:00"}], "energy_price""#,
    ),
    (
        r#""energy_price""#,
        r#""outages": [{"aircraft": "A01", "start": "08:00:00", "end": "37:00:00"}], "energy_price""#,
    ),
];

const NETWORK_CHANGES: &[Change] = &[
    ("stands = 1", "stands = 0"),
    ("stands = 1", "stands = nan"),
    ("count = 2", "count = 0"),
    ("count = 2", "count = 10000\n[[fleet]]\ntype = \"cityairbus\"\ncount = 1"),
    ("fare_base = 2", "fare_base = -2"),
    ("x_mi = 30.5", "x_mi = 20000"),
    ("sd = 1 ", "sd = inf "),
    ("power_kw = 65", "power_kw = 0"),
    ("name = \"small\"", "name = small"),
    ("fare_base = 2", "fare_bases = 2"),
    ("hold_s = 900", "hold_s = 900\npassenger_wait_s = 7201"),
    ("count = 2", "count = \"two\""),
    ("\"random\"", "\"alphabetical\""),
    ("vertifleet-network/1", "vertifleet-scenario/1"),
    ("\"06:00:00\", \"08:00:00\"", ""),
    ("type = \"cityairbus\"", "type = \"volocity\""),
    ("evening_peak = \"08:00:00\"", "evening_peak = \"08:30:00\""),
    ("name = \"small\"", "name = \"../small\""),
    ("name = \"small\"", "name = \"small\"\ntime_zone = \"UTC-5\""),
    ("id = \"B\"", "id = \"A\""),
    ("count = 2", "count = 4"),
    ("start = \"06:00:00\"", "start = \"05:59:59\""),
    ("fare_base = 2", "fare_base = 2\nflight_cost_usd = -1"),
    ("fare_base = 2", "fare_base = 2\nflight_cost_usd_per_mi = 1e4"),
    ("fare_base = 2", "fare_base = 2\nflight_cost_usd = 1e6\nflight_cost_usd_per_mi = 1"),
    ("fare_base = 2", "fare_base = 2\naircraft_cost_usd_per_day = inf"),
    ("fare_base = 2", "fare_base = 2\nboarding_fee_usd = -5"),
    ("fare_base = 2", "fare_base = 2\nstand_cost_usd_per_day = -1"),
    ("fare_base = 2", "fare_base = 2\ncharger_cost_usd_per_day = nan"),
    ("fare_base = 2", "fare_base = 2\nfare_level = 101"),
    ("stands = 1", "stands = 1\nstand_cost_usd_per_day = -1"),
    ("[operations]", "start_stands = [1]\n[operations]"),
    ("[operations]", "start_stands = [1, 0]\n[operations]"),
    ("fare_base = 2", "fare_base = 2\npairs = [{ from = \"A\", to = \"B\" }]"),
    ("fare_base = 2", "fare_base = 2\npairs = [{ from = \"A\", to = \"A\", fare_usd = 1 }]"),
    ("fare_base = 2", "fare_base = 2\npairs = [{ from = \"A\", to = \"B\", fare_usd = -1 }]"),
    (
        "fare_base = 2",
        "fare_base = 2\npairs = [{ from = \"A\", to = \"B\", fare_usd = 1 }, { from = \"A\", to = \"B\", fare_usd = 2 }]",
    ),
    ("[demand]", "[market]\nelasticity = -1\n[demand]"),
    ("[demand]", "[market]\ndemand_factor = 1000\n[demand]"),
    ("[demand]", "[market]\nreference = { fare_base = -1 }\n[demand]"),
    ("[demand]", "[market]\nreference = { fare_factors = [1] }\n[demand]"),
    (
        "[demand]",
        "[market]\nelasticities = [{ from = \"A\", to = \"C\", elasticity = 1 }]\n[demand]",
    ),
    (
        "[demand]",
        "[market]\nelasticities = [{ from = \"A\", to = \"B\", elasticity = 1 }, { from = \"A\", to = \"B\", elasticity = 2 }]\n[demand]",
    ),
    (
        "[demand]",
        "[market]\nelasticities = [{ from = \"A\", to = \"B\", elasticity = 21 }]\n[demand]",
    ),
    (
        "[[aircraft_types]]",
        "[[corridors]]\nfrom = \"A\"\nto = \"B\"\nlength_mi = 30\n\n[[aircraft_types]]",
    ),
    (
        "[[aircraft_types]]",
        "[[corridors]]\nfrom = \"A\"\nto = \"B\"\nlength_mi = 2e4\n\n[[aircraft_types]]",
    ),
    // Beyond the paper.
    ("y_mi = 0", "latitude = 0"),
    ("x_mi = 0\ny_mi = 0", "latitude = 40\nlongitude = -74"),
    ("x_mi = 0\ny_mi = 0", "latitude = 95\nlongitude = -74"),
    ("[demand]", "[uniform_demand]\nperiods = [\"06:00:00\"]\nleast = 1\nmost = 2\n[demand]"),
    ("energy_price_usd_per_kwh = 0.2", "energy_price_usd_per_kwh = [0.2]"),
    ("energy_price_usd_per_kwh = 0.2", "energy_price_usd_per_kwh = 0.2\nfare_factors = [1, -1]"),
    ("[feature_scales]", "[disturbances]\nfog = 1\n[feature_scales]"),
    (
        "[feature_scales]",
        "[disturbances]\noutages = { probability = 2, least_s = 0, most_s = 9 }\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[disturbances]\noutages = { probability = 1, least_s = 10, most_s = 9 }\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[[disturbances.closures]]\nprobability = 1\nleast_s = 1\nmost_s = 9\n\
         routes = [{ from = \"A\", to = \"C\" }]\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[[closures]]\nstart = \"22:00:00\"\nend = \"06:00:00\"\nvertiports = [\"A\"]\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[[closures]]\nstart = \"22:00:00\"\nend = \"36:00:01\"\nvertiports = [\"A\"]\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[[closures]]\nstart = \"22:00:00\"\nend = \"30:00:00\"\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[[closures]]\nstart = \"06:00:00\"\nend = \"07:00:00\"\nvertiports = [\"A\", \"C\"]\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[[closures]]\nstart = \"06:00:00\"\nend = \"07:00:00\"\n\
         routes = [{ from = \"A\", to = \"B\" }, { from = \"B\", to = \"B\" }]\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[[closures]]\nstart = \"06:00:00\"\nend = \"07:00:00\"\nvertiports = [\"A\"]\n\
         announced = true\n[feature_scales]",
    ),
    (
        "[feature_scales]",
        "[disturbances.takeoff_delays]\nslot_s = 900\nvertiports = [{ at = \"A\", probability = 0.1, \
         mean_s = -1, most_s = 9 }]\n[feature_scales]",
    ),
];

/// Replacements for the good network's `[demand]`.
const HOURLY_DEMANDS: &[&str] = &[
    "pairs = []\ntable = \"demand.csv\"",
    "",
    "table = \"demand.csv\"",
    "pairs = [{ from = \"A\", to = \"Z\", passengers = [1, 2] }]",
    "pairs = [{ from = \"A\", to = \"A\", passengers = [1, 2] }]",
    "pairs = [{ from = \"A\", to = \"B\", passengers = [1] }]",
    "pairs = [{ from = \"A\", to = \"B\", passengers = [1, -2] }]",
    "pairs = [{ from = \"A\", to = \"B\", passengers = [1, 2] }, { from = \"A\", to = \"B\", passengers = [1, 2] }]",
    "pairs = []\ndistribution = \"gaussian\"",
    "pairs = []\ndistribution = \"poisson\"\nnoise = 0.1",
    "pairs = []\ndispersion = 0.1",
    "pairs = []\ndistribution = \"negative-binomial\"",
    "pairs = []\ndistribution = \"negative-binomial\"\ndispersion = 0",
    "pairs = []\ndistribution = \"negative-binomial\"\ndispersion = 1\nnoise = 0.1",
    "pairs = []\ndistribution = \"normal\"",
    "pairs = []\nnoise = 0.5",
];

/// Tables in the folder of the network file.
const TABLES: &[&str] = &[
    "",
    "period;from;to;passengers\n06:00:00;A;B;1",
    "period,from,to\n",
    "period,from,to,passengers\n06:00:00,A,B",
    "period,from,to,passengers\nsix,A,B,1",
    "period,from,to,passengers\n06:30:00,A,B,1",
    "period,from,to,passengers\n\n06:00:00,A,B,1\n08:00:00,A,\"Z\"\"\",1",
    "period,from,to,passengers\r\n06:00:00,A,B,1\r\n08:00:00,B,B,1",
    "period,from,to,passengers\n06:00:00,A,B,many",
    "period,from,to,passengers\n06:00:00,A,B,\"1,5\"",
    "period,from,to,passengers\n06:00:00,A,B,-1",
    "period,from,to,passengers\n06:00:00,A,B,NaN",
    "period,from,to,passengers\n06:00:00,A,B,1\n8:00:00,A,B,1\n6:00:00,A,B,2",
];

/// The good network with hourly demand in place of its demand model.
fn hourly(members: &str) -> String {
    let begin = NETWORK.find("[demand]").expect("a demand model");
    let end = NETWORK.find("[feature_scales]").expect("what follows it");
    let periods = "periods = [\"06:00:00\", \"08:00:00\"]";
    format!("{}[hourly_demand]\n{periods}\n{members}\n\n{}", &NETWORK[..begin], &NETWORK[end..])
}

/// The error of a table next to the good network, with the path of the temporary folder removed.
fn error_of_table(folder: &std::path::Path, table: &[u8]) -> Option<Error> {
    std::fs::write(folder.join("demand.csv"), table).expect("a free folder");
    std::fs::write(folder.join("net.toml"), hourly("table = \"demand.csv\""))
        .expect("a free folder");
    let mut error = Network::read(folder.join("net.toml")).err()?;
    if let Error::InFile { origin, .. } = &mut error {
        assert_eq!(*origin, folder.join("demand.csv").display().to_string());
        "demand.csv".clone_into(origin);
    }
    Some(error)
}

fn changed(text: &str, (from, to): Change) -> String {
    assert!(text.contains(from), "the good file has {from}");
    text.replacen(from, to, 1)
}

/// Every provoked error with what provoked it.
fn provoked() -> Vec<(String, Error)> {
    let mut errors = Vec::new();
    let mut add = |how: String, error: Option<Error>| {
        let error = error.unwrap_or_else(|| panic!("accepted: {how}"));
        errors.push((how, error));
    };
    for &change in SCENARIO_CHANGES {
        let text = changed(SCENARIO, change);
        let error = Scenario::from_json(text.as_bytes(), "day.json").err();
        add(format!("scenario: {} -> {}", change.0, change.1), error);
    }
    for &change in NETWORK_CHANGES {
        let error = Network::from_toml(&changed(NETWORK, change), "net.toml").err();
        add(format!("network: {} -> {}", change.0, change.1), error);
    }
    add("a scenario that is a list".into(), Scenario::from_json(b"[]", "day.json").err());
    add("an empty scenario".into(), Scenario::from_json(b"", "day.json").err());
    let long = " ".repeat((32 << 20) + 1);
    add("a network of 32 MiB and a byte".into(), Network::from_toml(&long, "net.toml").err());
    for members in HOURLY_DEMANDS {
        let error = Network::from_toml(&hourly(members), "net.toml").err();
        add(format!("hourly demand: {members}"), error);
    }
    let folder = tempfile::tempdir().expect("a folder");
    for table in TABLES {
        add(format!("table: {table}"), error_of_table(folder.path(), table.as_bytes()));
    }
    let long = vec![b' '; (16 << 20) + 1];
    add("a table of 16 MiB and a byte".into(), error_of_table(folder.path(), &long));
    add(
        "a network for a scenario".into(),
        Scenario::from_json(NETWORK.as_bytes(), "net.toml").err(),
    );
    add("a scenario for a network".into(), Network::from_toml(SCENARIO, "day.json").err());
    add("JSON for a network".into(), Network::from_toml("\n {}", "any.json").err());
    add("no such file".into(), Scenario::read("no/such/day.json").err());
    add("no such folder".into(), small().write("no/such/folder/day.json").err());
    add("no such network".into(), Network::find("paepr").err());
    add("no such network file".into(), Network::find("paepr.toml").err());
    add("bytes that are no text".into(), Scenario::from_json(b"\"\xff\"", "day.json").err());
    add("a seed of 2^40".into(), DaySeed::comparison(1 << 40).err());
    add("a training seed of 2^24".into(), DaySeed::training(1 << 24, 0).err());
    errors
}

fn small() -> Scenario {
    Scenario::from_json(SCENARIO.as_bytes(), "day.json").expect("the good scenario")
}

#[test]
fn every_error_names_file_member_value_and_rule() {
    let mut list = String::new();
    for (how, error) in provoked() {
        let how = how.replace('\r', "\\r").replace('\n', "\\n");
        writeln!(list, "{how}\n    error[{}]: {error}", error.code()).expect("a String");
        if let Some(hint) = error.hint() {
            writeln!(list, "    hint: {hint}").expect("a String");
        }
    }
    insta::assert_snapshot!(list);
}

#[test]
fn every_code_can_be_provoked() {
    let mut codes: BTreeSet<Code> = provoked().iter().map(|(_, error)| error.code()).collect();
    let mut stranded = small().into_day();
    stranded.aircraft_types[1].battery_kwh = 10.0;
    let warnings = stranded.check("day.json").expect("a valid day").warnings();
    codes.extend(warnings.iter().map(vertifleet_core::Warning::code));
    let far = changed(NETWORK, ("x_mi = 30.5", "x_mi = 3050"));
    let warnings = Network::from_toml(&far, "net.toml").expect("a network").warnings();
    codes.extend(warnings.iter().map(vertifleet_core::Warning::code));
    let mut empty = small().into_day();
    empty.aircraft[0].start_charge_kwh = Some(0.0);
    empty.vertiports[empty.aircraft[0].at.at()].charger_kw = Some(1.0);
    let warnings = empty.check("day.json").expect("a valid day").warnings();
    codes.extend(warnings.iter().map(vertifleet_core::Warning::code));
    assert_eq!(codes, (101..=122).chain([125]).chain(130..=135).map(Code).collect());
}

#[test]
fn messages_are_one_line_without_a_full_stop() {
    for (how, error) in provoked() {
        let message = error.to_string();
        assert!(!message.contains('\n'), "{how}: {message}");
        assert!(!message.ends_with('.'), "{how}: {message}");
    }
}

#[test]
fn a_day_with_an_index_outside_its_lists_is_refused() {
    let with = |change: fn(&mut Day)| {
        let mut day = small().into_day();
        change(&mut day);
        day.check("day").expect_err("an unknown index").to_string()
    };
    insta::assert_snapshot!(
        with(|day| day.aircraft[0].kind.0 = 2),
        @r##"day: aircraft "A01": type names "#2", which is not among the aircraft types"##
    );
    insta::assert_snapshot!(
        with(|day| day.aircraft[0].at.0 = 3),
        @r##"day: aircraft "A01": at names "#3", which is not among the vertiports"##
    );
}

#[test]
fn numbers_that_no_file_can_hold_are_refused_in_a_day() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut day = small().into_day();
        day.passenger_cost_usd.cells_mut()[1] = value;
        assert_eq!(day.check("day").expect_err("not finite").code(), Code(104));
    }
}
