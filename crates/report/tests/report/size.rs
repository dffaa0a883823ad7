//! The promises of a search for a design: no design exceeds the proven bound, a search that was
//! interrupted ends with the same bytes, and the network file of the best design is that design.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use vertifleet_core::{Coded, Network, Stop};
use vertifleet_optimize::Step;
use vertifleet_study::comparison::{Comparison, DrawnDays};
use vertifleet_study::competitor::Selection;
use vertifleet_study::size::{Certificate, Goal, JOURNAL, SizeRecords, SizeRequest, Sizing};
use vertifleet_study::sweep::Factor;
use vertifleet_study::{Error, Unwatched};

const DAYS: u32 = 2;
const FACTORS: [&str; 2] = ["fleet.0.count=20..40/10", "vertiports.*.stands=5..6"];

/// `paper` with costs.
fn paper() -> Network {
    let paper = Network::shipped("paper").expect("shipped");
    let changes = serde_json::json!({
        "tariffs.aircraft_cost_usd_per_day": 300,
        "tariffs.stand_cost_usd_per_day": 40,
    });
    paper.changed(changes.as_object().expect("changes")).expect("a network with costs")
}

fn sizing(goal: Goal, factors: &[&str]) -> Result<Sizing, Error> {
    sizing_of(&paper(), goal, factors)
}

fn sizing_of(network: &Network, goal: Goal, factors: &[&str]) -> Result<Sizing, Error> {
    let policies = ["prices".to_owned()];
    Sizing::new(SizeRequest {
        network,
        factors: factors.iter().map(|text| Factor::parse(text).expect("a factor")).collect(),
        goal,
        selection: &Selection { policies: &policies, models: &[], seed: 1 },
        drawn: DrawnDays::of_comparison(3, DAYS),
        bound_step: Step::from_minutes(60).expect("a step"),
        designs: 12,
    })
}

fn run(sizing: &Sizing, folder: &Path) -> (SizeRecords, BTreeMap<String, Vec<u8>>) {
    let stop = Stop::default();
    let records = sizing.run(folder, "vertifleet size".to_owned(), false, &stop, &mut || ());
    let records = records.expect("a search");
    let shown = vertifleet_report::size(&records.report, &records.best);
    vertifleet_report::folder::write_beside_journal(&shown, folder).expect("room");
    drop(shown);
    let entry = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().expect("a plain name");
        (name, fs::read(entry.path()).expect("a file"))
    };
    let files = fs::read_dir(folder).expect("a folder").map(|one| entry(one.expect("an entry")));
    let files = files.collect();
    (records, files)
}

/// Mean profit and passengers of a network on the days of the search.
fn played(network: &Network, policies: &[&str]) -> Vec<(f64, f64)> {
    let policies: Vec<String> = policies.iter().map(|&name| name.to_owned()).collect();
    let selection = Selection { policies: &policies, models: &[], seed: 1 };
    let drawn = DrawnDays::of_comparison(3, DAYS);
    let stop = Stop::default();
    let comparison =
        Comparison::new(network, &selection, drawn, None, &stop).expect("a comparison");
    let records = comparison.run("test".to_owned(), &stop, &Unwatched).expect("days");
    let means = |policy: &vertifleet_study::PolicyRecord| {
        let days = policy.days.iter().map(|day| day.totals);
        let (profit_usd, carried) = days
            .fold((0.0, 0.0), |sum, day| (sum.0 + day.profit_usd, sum.1 + day.passengers as f64));
        (profit_usd / f64::from(DAYS), carried / f64::from(DAYS))
    };
    records.policies.iter().map(means).collect()
}

#[test]
fn no_design_with_any_policy_exceeds_the_proven_bound() {
    let folder = tempfile::tempdir().expect("a folder");
    let (records, files) =
        run(&sizing(Goal::MostProfit, &FACTORS).expect("a search"), folder.path());
    let report = &records.report;
    let Certificate::MostProfit { no_design_earns_more_than_usd: most, gap } = report.certificate
    else {
        panic!("{:?}", report.certificate)
    };
    let found = report.found();
    assert!((gap - (most - found.profit_usd.mean) / most).abs() < 1e-12);
    for aircraft in [20, 30, 40] {
        for stands in [5, 6] {
            let changes =
                serde_json::json!({"fleet.0.count": aircraft, "vertiports.*.stands": stands});
            let network = paper().changed(changes.as_object().expect("changes")).expect("a design");
            for (profit_usd, _) in played(&network, &["greedy", "prices", "rolling"]) {
                assert!(profit_usd <= most, "{aircraft}, {stands}: {profit_usd} of {most}");
                assert!(aircraft > 20 || profit_usd <= found.profit_usd.mean * 1.05);
            }
        }
    }
    // The network file is the design, and earns what the report says.
    let text = std::str::from_utf8(&files["best.toml"]).expect("a text");
    let best = Network::from_toml(text, "best.toml").expect("a network");
    assert_eq!(best.fleet_size(), found.size.aircraft);
    let (profit_usd, carried) = played(&best, &["prices"])[0];
    assert!((profit_usd - found.profit_usd.mean).abs() < 1e-6);
    assert!((carried - found.passengers).abs() < 1e-9);
}

#[test]
fn a_search_under_another_battery_and_power_keeps_them_and_bounds_every_design() {
    let quick = Network::shipped("paper-quick").expect("shipped");
    let costs = serde_json::json!({
        "tariffs.aircraft_cost_usd_per_day": 300,
        "aircraft_types.0.battery_kwh": 80,
        "aircraft_types.0.reserve_kwh": 15,
        "vertiports.*.charger_kw": 50,
    });
    let factors: Vec<String> = costs
        .as_object()
        .expect("settings")
        .iter()
        .map(|(path, value)| format!("{path}={value}"))
        .chain(["fleet.0.count=20..40/20".to_owned()])
        .collect();
    let factors: Vec<&str> = factors.iter().map(String::as_str).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let search = sizing_of(&quick, Goal::MostProfit, &factors).expect("a search");
    let (records, files) = run(&search, folder.path());
    let Certificate::MostProfit { no_design_earns_more_than_usd: most, .. } =
        records.report.certificate
    else {
        panic!("{:?}", records.report.certificate)
    };
    let text = std::str::from_utf8(&files["best.toml"]).expect("a text");
    let best = Network::from_toml(text, "best.toml").expect("a network");
    assert_eq!(best.aircraft_types()[0].battery_kwh, 80.0);
    assert_eq!(best.aircraft_types()[0].reserve_kwh, 15.0);
    assert!(best.vertiports().iter().all(|vertiport| vertiport.charger_kw == Some(50.0)));
    for aircraft in [20, 40] {
        let mut changes = costs.as_object().expect("changes").clone();
        changes.insert("fleet.0.count".to_owned(), aircraft.into());
        let design = quick.changed(&changes).expect("a design");
        for (profit_usd, _) in played(&design, &["greedy", "prices", "rolling"]) {
            assert!(profit_usd <= most, "{aircraft}: {profit_usd} of {most}");
            let found = records.report.found().profit_usd.mean;
            assert!(profit_usd <= 1.05 * found, "{aircraft}: {profit_usd}, found {found}");
        }
    }
}

#[test]
fn an_interrupted_search_ends_with_the_same_bytes_and_another_is_refused() {
    let whole = tempfile::tempdir().expect("a folder");
    let search = sizing(Goal::MostProfit, &FACTORS).expect("a search");
    let (_, files) = run(&search, whole.path());
    let journal = String::from_utf8(files[JOURNAL].clone()).expect("a text");
    let lines = journal.lines().count();
    let part = tempfile::tempdir().expect("a folder");
    for kept in [1, lines / 2, lines - 1] {
        let torn: String = journal.split_inclusive('\n').take(kept).collect();
        fs::write(part.path().join(JOURNAL), torn + "{\"design\":[1,").expect("room");
        let (_, again) = run(&search, part.path());
        assert!(again == files, "after {kept} lines");
    }
    let other = sizing(Goal::LeastSpill, &FACTORS).expect("a search");
    let stop = Stop::default();
    let refused = other.run(part.path(), String::new(), false, &stop, &mut || ());
    assert_eq!(refused.err().expect("another search").code().to_string(), "V414");
}

#[test]
fn no_design_a_step_away_is_better_and_threads_change_nothing() {
    let factors =
        ["fleet.0.count=20..44/8", "vertiports.V1.stands=5..7", "vertiports.V2.stands=5..7"];
    let in_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let folder = tempfile::tempdir().expect("a folder");
        let search = sizing(Goal::MostProfit, &factors).expect("a search");
        pool.install(|| run(&search, folder.path()))
    };
    let ((records, files), (_, again)) = (in_threads(1), in_threads(3));
    assert!(files == again, "on one thread and on three");
    let report = &records.report;
    let found = report.found();
    let mut compared = 0;
    for (at, dimension) in report.dimensions.iter().enumerate() {
        for by in [-1, 1] {
            let number = i64::from(found.numbers[at]) + by * i64::from(dimension.step);
            if !(dimension.lowest.into()..=dimension.highest.into()).contains(&number) {
                continue;
            }
            let numbers = report.dimensions.iter().zip(&found.numbers);
            let mut changes: serde_json::Map<String, serde_json::Value> =
                numbers.map(|(one, &number)| (one.member.clone(), number.into())).collect();
            changes.insert(dimension.member.clone(), number.into());
            let network = paper().changed(&changes).expect("a design");
            let (profit_usd, _) = played(&network, &["prices"])[0];
            assert!(profit_usd <= found.profit_usd.mean, "{changes:?} earns {profit_usd}");
            compared += 1;
        }
    }
    assert_eq!(compared, report.neighbours);
}

#[test]
fn the_fleet_that_carries_a_share_is_no_smaller_than_the_proven_minimum() {
    let folder = tempfile::tempdir().expect("a folder");
    let factors = ["fleet.0.count=10..40/2", "tariffs.aircraft_cost_usd_per_day=0"];
    let (records, _) = run(&sizing(Goal::Served(0.04), &factors).expect("a search"), folder.path());
    let report = &records.report;
    assert!(report.goal_is_reached && report.found().served_share >= 0.04);
    let Certificate::FewestAircraft { no_design_has_fewer_than: fewest } = report.certificate
    else {
        panic!("{:?}", report.certificate)
    };
    assert!(fewest as usize <= report.found().size.aircraft, "{fewest}");
    for aircraft in (10..40).filter(|&aircraft| aircraft < fewest) {
        let changes = serde_json::json!({"fleet.0.count": aircraft});
        let network = paper().changed(changes.as_object().expect("changes")).expect("a design");
        for (_, carried) in played(&network, &["greedy", "prices"]) {
            assert!(carried < 0.04 * report.wanted_passengers, "{aircraft}: {carried}");
        }
    }
}

#[test]
fn the_spill_of_a_given_fleet_keeps_the_fleet() {
    let folder = tempfile::tempdir().expect("a folder");
    let factors = ["vertiports.V1.stands=5..8", "vertiports.V2.stands=5..8"];
    let (records, _) = run(&sizing(Goal::LeastSpill, &factors).expect("a search"), folder.path());
    let report = &records.report;
    assert!(report.designs.iter().all(|design| design.size.aircraft == 40));
    let Certificate::MostPassengers { no_design_carries_more_than: most, .. } = report.certificate
    else {
        panic!("{:?}", report.certificate)
    };
    assert!(report.designs.iter().all(|design| design.passengers <= most));
    assert!(report.found().passengers >= report.as_it_is().passengers);
}

#[test]
fn a_grid_without_the_current_network_reports_whether_that_is_better() {
    let folder = tempfile::tempdir().expect("a folder");
    // The fleet has 40 aircraft.
    let few = sizing(Goal::MostProfit, &["fleet.0.count=2..6/2"]).expect("a search");
    let (records, _) = run(&few, folder.path());
    let report = &records.report;
    let file = report.left_out.as_ref().expect("no design has 40 aircraft");
    let (profit_usd, _) = played(&paper(), &["prices"])[0];
    assert_eq!((file.profit_usd.mean, file.is_better), (profit_usd, true));
    let text = vertifleet_report::size(&records.report, &records.best).text();
    assert!(text.contains("The network as it is is better than every design"), "{text}");
    let folder = tempfile::tempdir().expect("a folder");
    let with_it = sizing(Goal::MostProfit, &["fleet.0.count=30..40/10"]).expect("a search");
    let (records, _) = run(&with_it, folder.path());
    assert_eq!(records.report.left_out, None);
    let folder = tempfile::tempdir().expect("a folder");
    let near = sizing(Goal::MostProfit, &["fleet.0.count=29..39/10"]).expect("a search");
    let (records, _) = run(&near, folder.path());
    let file = records.report.left_out.as_ref().expect("no design has 40 aircraft");
    assert_eq!(file.is_better, file.profit_usd.mean > records.report.found().profit_usd.mean);
}
