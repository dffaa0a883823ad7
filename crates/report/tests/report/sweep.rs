//! The promises of a sweep: cells are the changed networks on the same days, and a sweep that was
//! interrupted ends with the same bytes as one that was not.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use bytes::Bytes;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use vertifleet_core::{Coded, DaySeed, Network, Stop};
use vertifleet_study::comparison::DrawnDays;
use vertifleet_study::competitor::Selection;
use vertifleet_study::sweep::{Design, Factor, JOURNAL, Sweep, SweepReport, SweepRequest};

const FACTORS: [&str; 2] = ["fleet.0.count=38..42/2", "vertiports.*.stands=5,6"];

fn factors(texts: &[&str]) -> Vec<Factor> {
    texts.iter().map(|text| Factor::parse(text).expect("a factor")).collect()
}

fn paper() -> Network {
    let paper = Network::shipped("paper").expect("shipped");
    let costs = serde_json::json!({
        "tariffs.aircraft_cost_usd_per_day": 200,
        "tariffs.stand_cost_usd_per_day": 100,
    });
    paper.changed(costs.as_object().expect("changes")).expect("a network with costs")
}

fn sweep(factors_of: &[&str], design: Design, days: u32) -> Result<Sweep, vertifleet_study::Error> {
    sweep_of(&paper(), factors_of, design, days)
}

fn sweep_of(
    network: &Network,
    factors_of: &[&str],
    design: Design,
    days: u32,
) -> Result<Sweep, vertifleet_study::Error> {
    let policies = ["greedy", "prices"].map(str::to_owned);
    let selection = Selection { policies: &policies, models: &[], seed: 1 };
    let request = SweepRequest {
        network,
        factors: factors(factors_of),
        design,
        selection: &selection,
        drawn: DrawnDays::of_comparison(7, days),
        bound_step: None,
    };
    Sweep::new(request, &Stop::default())
}

/// The files of a folder by name.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entry = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().expect("a plain name");
        (name, fs::read(entry.path()).expect("a file"))
    };
    fs::read_dir(folder).expect("a folder").map(|one| entry(one.expect("an entry"))).collect()
}

/// Plays what the journal of the folder lacks, and returns the files of the folder.
fn run(mut sweep: Sweep, folder: &Path) -> BTreeMap<String, Vec<u8>> {
    sweep.keep_in(&folder.join(JOURNAL), false).expect("a journal");
    sweep.run(&Stop::default(), &|| ()).expect("all cells");
    let summary = SweepReport::of(&sweep, "vertifleet sweep".to_owned()).expect("numbers");
    sweep.write_journal(folder).expect("room");
    let report = vertifleet_report::sweep(&summary, &sweep);
    vertifleet_report::folder::write_beside_journal(&report, folder).expect("room");
    files(folder)
}

#[test]
fn a_cell_is_the_changed_network_on_the_days_of_its_base() {
    let sweep = sweep(&FACTORS, Design::Grid, 3).expect("a sweep");
    assert_eq!(sweep.playable(), 5, "40 stands are too few for 42 aircraft");
    assert_eq!(sweep.missing(), [0, 1, 2, 3, 5]);
    sweep.run(&Stop::default(), &|| ()).expect("all cells");
    let record = sweep.finished().find(|record| record.cell == 3).expect("it was played");
    let changes = serde_json::json!({"fleet.0.count": 40, "vertiports.*.stands": 6});
    let network = paper().changed(changes.as_object().expect("changes")).expect("a network");
    for (at, totals) in record.totals[0].iter().enumerate() {
        let seed = DaySeed::comparison(7 + at as u64).expect("a seed");
        let day = network.draw(seed);
        assert_eq!(day.aircraft, paper().draw(seed).aircraft, "nothing about them has changed");
        let mut simulation = vertifleet_sim::Simulation::new(std::sync::Arc::new(day));
        let mut greedy = vertifleet_policy::Greedy;
        vertifleet_policy::play(&mut simulation, &mut greedy, |_| ()).expect("a whole day");
        assert_eq!(*totals, simulation.totals());
        assert_eq!((totals.aircraft_cost_usd, totals.site_cost_usd), (8_000.0, 4_800.0));
    }
    assert!(sweep.missing().is_empty());
    let comparison = sweep.comparison(3, String::new(), &Stop::default()).expect("days");
    let (records, _) = comparison.expect("it was played");
    assert_eq!(records.policies[0].days[2].day, "paper-9");
    assert_eq!(records.policies[0].days[2].totals, record.totals[0][2]);
    assert!(records.policies[0].decision_ns.is_some());
    assert!(sweep.comparison(4, String::new(), &Stop::default()).expect("no days").is_none());
}

#[test]
fn an_interrupted_sweep_ends_with_the_same_bytes() {
    let whole = tempfile::tempdir().expect("a folder");
    let sweep = || sweep(&FACTORS, Design::Grid, 2).expect("a sweep");
    let expected = run(sweep(), whole.path());
    let journal = &expected[JOURNAL];
    for kept in [0, 10, journal.len() / 3, journal.len() / 2, journal.len() - 1] {
        let folder = tempfile::tempdir().expect("a folder");
        // A journal that ends within its first line is refused, and the sweep starts again only if
        // it is empty.
        let head = journal.iter().position(|&byte| byte == b'\n').expect("a line") + 1;
        let kept = if kept == 0 { 0 } else { kept.max(head) };
        fs::write(folder.path().join(JOURNAL), &journal[..kept]).expect("room");
        assert!(run(sweep(), folder.path()) == expected, "{kept} bytes were kept");
    }
    let threads = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let folder = tempfile::tempdir().expect("a folder");
    assert!(threads.install(|| run(sweep(), folder.path())) == expected, "on one thread");
}

#[test]
fn a_stopped_sweep_keeps_its_finished_cells() {
    let folder = tempfile::tempdir().expect("a folder");
    let journal = folder.path().join(JOURNAL);
    let begin = || {
        let mut sweep = sweep(&FACTORS, Design::Grid, 1).expect("a sweep");
        let found = sweep.keep_in(&journal, false).expect("a journal");
        (sweep, found)
    };
    let (sweep, _) = begin();
    let stop = Stop::default();
    let threads = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let outcome = threads.install(|| {
        sweep.run(&stop, &|| {
            stop.request();
        })
    });
    assert_eq!(outcome.expect_err("it was stopped").code().to_string(), "V408");
    let (sweep, found) = begin();
    assert_eq!((found, sweep.missing().len()), (1, 4));
    sweep.run(&Stop::default(), &|| ()).expect("the other cells");
    assert!(sweep.missing().is_empty());
}

#[test]
fn a_damaged_cell_is_not_believed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(JOURNAL);
    let sweep = || sweep(&FACTORS, Design::Grid, 1).expect("a sweep");
    run(sweep(), folder.path());
    let text = fs::read_to_string(&path).expect("a journal");
    let damaged = text.replacen("{\"cell\":2,", "{\"cell\":1,", 1);
    assert_ne!(damaged, text);
    fs::write(&path, damaged).expect("room");
    assert_eq!(sweep().keep_in(&path, false).expect("a journal"), 2, "cell 1 is there twice");
    let days = text.find("\"totals\":[[").expect("a record");
    let end = text.find("]],").or_else(|| text.find("]]}")).expect("an end");
    let damaged = format!("{}\"totals\":[[],[{}", &text[..days], &text[end..]);
    fs::write(&path, damaged).expect("room");
    assert_eq!(sweep().keep_in(&path, false).expect("a journal"), 0, "days are missing");
}

#[test]
fn the_report_says_which_design_is_best_and_which_is_the_cheapest_good_one() {
    let factors = ["fleet.0.count=36..40/1", "vertiports.V1.stands=6,7"];
    let sweep = sweep(&factors, Design::Grid, 4).expect("a sweep");
    sweep.run(&Stop::default(), &|| ()).expect("all cells");
    let summary = SweepReport::of(&sweep, String::new()).expect("numbers");
    insta::assert_snapshot!(vertifleet_report::sweep(&summary, &sweep).text());
    let json: serde_json::Value = serde_json::from_str(&summary.to_json()).expect("JSON");
    let cells = json["cells"].as_array().expect("a list");
    let profit = |cell: &serde_json::Value| {
        cell["results"][0]["profit_usd"]["mean"].as_f64().expect("a number")
    };
    let most = cells.iter().map(profit).fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(
        profit(&cells[usize::try_from(json["best"].as_u64().expect("a cell")).expect("small")]),
        most
    );
    let cost =
        |cell: &serde_json::Value| cell["size"]["fixed_cost_usd"].as_f64().expect("a number");
    let good = cells.iter().filter(|cell| profit(cell) >= 0.99 * most);
    let least = good.map(cost).fold(f64::INFINITY, f64::min);
    let cheapest = usize::try_from(json["cheapest"].as_u64().expect("a cell")).expect("small");
    assert_eq!(cost(&cells[cheapest]), least);
}

/// A field of Parquet as the CSV files write it.
fn written(field: &Field) -> String {
    match field {
        Field::Null => String::new(),
        Field::Bool(flag) => flag.to_string(),
        Field::Long(number) => number.to_string(),
        Field::Double(number) => number.to_string(),
        Field::Str(text) => text.clone(),
        other => panic!("no column has this type: {other:?}"),
    }
}

#[test]
fn parquet_has_the_columns_and_the_rows_of_csv() {
    let factors = [
        "fleet.0.count=40,42",
        "vertiports.*.stands=5,6",
        "tariffs.fare_level=1.25",
        r#"closures=[],[{"start":"07:00:00","end":"09:00:00","vertiports":["V1"]}]"#,
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let files = run(sweep(&factors, Design::Grid, 2).expect("a sweep"), folder.path());
    for table in ["cells", "days"] {
        let mut csv = csv::Reader::from_reader(&files[&format!("{table}.csv")][..]);
        let names: Vec<String> = csv.headers().expect("names").iter().map(str::to_owned).collect();
        let rows: Vec<Vec<String>> = csv
            .records()
            .map(|row| row.expect("a row").iter().map(str::to_owned).collect())
            .collect();
        let parquet = Bytes::from(files[&format!("{table}.parquet")].clone());
        let reader = SerializedFileReader::new(parquet).expect("a Parquet file");
        let typed = reader.get_row_iter(None).expect("rows").map(|row| row.expect("a row"));
        let typed: Vec<Vec<(String, Field)>> = typed
            .map(|row| row.get_column_iter().map(|(n, f)| (n.clone(), f.clone())).collect())
            .collect();
        assert_eq!(typed.len(), rows.len(), "{table}");
        let left_out = rows.iter().filter(|row| row.last().is_some_and(|one| !one.is_empty()));
        assert!(table == "days" || left_out.count() == 2, "40 stands are too few for 42 aircraft");
        for (typed, row) in typed.iter().zip(&rows) {
            assert!(typed.iter().map(|(name, _)| name).eq(&names), "{table}");
            assert!(
                typed.iter().map(|(_, field)| written(field)).eq(row.iter().cloned()),
                "{table}"
            );
            assert!(matches!(typed[1].1, Field::Long(_)) && matches!(typed[3].1, Field::Double(_)));
        }
    }
}

#[test]
fn closures_can_be_varied() {
    let closed = r#"[{"start":"07:00:00","end":"12:00:00","vertiports":["V1"]}]"#;
    let sweep = sweep(&[&format!("closures=[],{closed}")], Design::Grid, 2).expect("a sweep");
    sweep.run(&Stop::default(), &|| ()).expect("all cells");
    let totals: Vec<_> = sweep.finished().map(|record| &record.totals).collect();
    let [open, closed] = totals[..] else { panic!("two cells, found {}", totals.len()) };
    assert_ne!(open, closed, "the closure matters");
    let (profit_usd, of_open_usd) = (closed[1][0].profit_usd, open[1][0].profit_usd);
    assert!(profit_usd < of_open_usd, "{profit_usd} {of_open_usd}");
}

#[test]
fn batteries_reserves_and_powers_can_be_varied() {
    let varied = [
        "aircraft_types.*.battery_kwh=80,110",
        "aircraft_types.*.reserve_kwh=0,20",
        "aircraft_types.*.charge_kw=60,150",
        "vertiports.*.charger_kw=40,150",
    ];
    let network = Network::shipped("paper-quick").expect("shipped");
    let sweep = sweep_of(&network, &varied, Design::Grid, 1).expect("a sweep");
    assert_eq!((sweep.playable(), sweep.missing().len()), (16, 16));
    sweep.run(&Stop::default(), &|| ()).expect("all cells");
    let profits_usd: Vec<f64> =
        sweep.finished().map(|record| record.totals[1][0].profit_usd).collect();
    // The last factor varies fastest: the first of these has more of everything but the reserve.
    let (strong, weak) = (profits_usd[11], profits_usd[4]);
    assert!(strong > 1.1 * weak, "{profits_usd:?}");
    let record = sweep.finished().find(|record| record.cell == 6).expect("it was played");
    let changes = serde_json::json!({
        "aircraft_types.*.battery_kwh": 80, "aircraft_types.*.reserve_kwh": 20,
        "aircraft_types.*.charge_kw": 150, "vertiports.*.charger_kw": 40,
    });
    let network = network.changed(changes.as_object().expect("changes")).expect("a network");
    let day = network.draw(DaySeed::comparison(7).expect("a seed"));
    let mut simulation = vertifleet_sim::Simulation::new(std::sync::Arc::new(day));
    let mut greedy = vertifleet_policy::Greedy;
    vertifleet_policy::play(&mut simulation, &mut greedy, |_| ()).expect("a whole day");
    assert_eq!(record.totals[0][0], simulation.totals());
}

#[test]
fn an_invalid_sweep_is_refused_before_any_day_is_played() {
    let codes = [
        (vec!["fleet.7.count=1,2"], Design::Grid, "V123"),
        (vec!["fleet.0.colour=1,2"], Design::Grid, "V123"),
        (vec!["fleet.0.count=-1,2"], Design::Grid, "V104"),
        (vec!["fleet.0.count=1..2"], Design::Grid, "V407"),
        (vec!["fleet.0.count=1..2"], Design::LatinHypercube { cells: 1, seed: 1 }, "V407"),
        (vec![], Design::LatinHypercube { cells: 2, seed: 1 }, "V407"),
    ];
    for (factors, design, code) in codes {
        let error = sweep(&factors, design, 1).err().expect("no sweep");
        assert_eq!(error.code().to_string(), code, "{factors:?}: {error}");
    }
    assert_eq!(sweep(&FACTORS, Design::Grid, 0).err().expect("no day").code().to_string(), "V402");
}
