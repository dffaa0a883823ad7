//! Tests of the parts of days that go beyond the paper: files hold them, networks draw them, and
//! everything else stays as it was.

use vertifleet_core::{
    AircraftIx, ClosedTimes, Closure, Coded, Day, DaySeed, Disturbances, Fares, Network, Outage,
    Route, Scenario, TakeoffDelays, Time, VertiportIx,
};

const SCENARIO: &str = include_str!("../data/small.json");
const PAPER: &str = include_str!("../../../../networks/paper.toml");
const NEW_YORK: &str = include_str!("../../../../networks/new-york.toml");

const DISTURBANCES: &str = r#"
[disturbances]
forecast_error = { noise = 0.2, surge_probability = 0.1, surge_factor = 2 }
takeoff_delays = { slot_s = 900, vertiports = [{ at = "V2", probability = 0.3, mean_s = 300, most_s = 900 }] }
closures = [
    { probability = 0.5, least_s = 1800, most_s = 7200, routes = [{ from = "V1", to = "V2", both_ways = true }] },
]
outages = { probability = 0.2, least_s = 3600, most_s = 14400 }
"#;

/// A curfew at two vertiports, before and after the hours in which they may be used, and a fog that
/// is not known in advance.
const CLOSURES: &str = r#"
[[closures]]
start = "00:00:00"
end = "07:00:00"
vertiports = ["V3", "V5", "V3"]

[[closures]]
start = "16:30:00"
end = "30:00:00"
routes = [{ from = "V1", to = "V2" }]
vertiports = ["V3"]
known = true

[[closures]]
start = "06:30:00"
end = "08:30:00"
routes = [{ from = "V1", to = "V3", both_ways = true }]
known = false
"#;

fn seed(seed: u64) -> DaySeed {
    DaySeed::comparison(seed).expect("a small seed")
}

fn network(text: &str) -> Network {
    Network::from_toml(text, "network").unwrap_or_else(|error| panic!("{error}"))
}

fn with(addition: &str) -> Network {
    network(&PAPER.replace("[feature_scales]", &format!("{addition}\n[feature_scales]")))
}

/// A small day with everything in it.
fn everything() -> Day {
    let mut day = Scenario::from_json(SCENARIO.as_bytes(), "small").expect("a good day").into_day();
    let time = |text: &str| text.parse::<Time>().expect("a time");
    let route =
        |from, to, both_ways| Route { from: VertiportIx(from), to: VertiportIx(to), both_ways };
    let fares = day.fare_usd.in_period(0).clone();
    let mut late = fares.clone();
    late.cells_mut().iter_mut().for_each(|fare| *fare *= 1.25);
    day.fare_usd = Fares::by_period(vec![fares, late]);
    day.vertiports[2].chargers = Some(2);
    day.operations.passenger_wait_s = 1800;
    day.corridors = Some(vec![route(0, 1, true), route(2, 0, false)]);
    let mut forecast = day.demand.clone();
    forecast[1][(VertiportIx(0), VertiportIx(1))] = 12;
    day.disturbances = Disturbances {
        forecast: Some(forecast),
        takeoff_delays: Some(TakeoffDelays {
            slot_s: 7200,
            delay_s: vec![vec![0, 60, 5], vec![1, 0, 0]],
        }),
        closures: vec![
            Closure {
                route: route(0, 1, true),
                start: time("07:00:00"),
                end: time("08:00:00"),
                known: false,
            },
            Closure {
                route: route(2, 0, false),
                start: time("07:30:00"),
                end: time("07:30:00"),
                known: false,
            },
            Closure {
                route: route(1, 2, true),
                start: time("00:00:00"),
                end: time("06:30:00"),
                known: true,
            },
        ],
        outages: vec![Outage {
            aircraft: AircraftIx(2),
            start: time("06:30:00"),
            end: time("09:00:00"),
        }],
    };
    day
}

#[test]
fn a_day_with_everything_reads_back_as_it_was_written() {
    let scenario = everything().check("everything").expect("a good day");
    let text = scenario.to_json();
    assert_eq!(Scenario::from_json(text.as_bytes(), "again").expect("our own text"), scenario);
    insta::assert_snapshot!(text);
}

#[test]
fn passengers_of_a_network_wait_as_long_as_its_file_states_and_of_a_shipped_one_not_at_all() {
    let text = PAPER.replace("hold_s = 900", "hold_s = 900\npassenger_wait_s = 600");
    let (paper, waiting) = (with("").draw(seed(1)).into_day(), network(&text).draw(seed(1)));
    assert_eq!(waiting.operations.passenger_wait_s, 600);
    let mut same = waiting.into_day();
    same.operations.passenger_wait_s = 0;
    assert_eq!(same, paper, "they change nothing else that is drawn");
    for name in Network::shipped_names() {
        assert_eq!(shipped(name).operations().passenger_wait_s, 0, "{name}");
    }
}

#[test]
fn passengers_may_wait_as_long_as_the_shortest_period_that_another_one_follows() {
    let of = |periods: &[&str], wait_s: u32| {
        let mut day = everything();
        let count = periods.len();
        day.periods = periods.iter().map(|text| text.parse().expect("a time")).collect();
        day.fare_usd = day.fare_usd.in_period(0).clone().into();
        day.disturbances = Disturbances::default();
        day.demand = vec![day.demand[0].clone(); count];
        day.energy_price_usd = vec![0.2; count];
        day.operations.passenger_wait_s = wait_s;
        day.check("day").map(|_| ()).map_err(|error| error.code().to_string())
    };
    let three = ["06:00:00", "06:50:00", "08:00:00"];
    assert_eq!(of(&three, 3_000), Ok(()));
    assert_eq!(of(&three, 3_001), Err("V104".to_owned()));
    // No period follows the last one, even if it is over early.
    assert_eq!(of(&["06:00:00", "09:29:00"], 3_600), Ok(()));
    assert_eq!(of(&["06:00:00"], 86_400), Ok(()));
    assert_eq!(of(&["06:00:00"], 86_401), Err("V104".to_owned()));
}

#[test]
fn corridors_lead_the_ways_they_name() {
    let scenario = everything().check("everything").expect("a good day");
    let may = |from, to| scenario.is_corridor(VertiportIx(from), VertiportIx(to));
    assert!(may(0, 1) && may(1, 0) && may(2, 0));
    assert!(!may(0, 2) && !may(1, 2));
}

#[test]
fn the_potential_counts_the_fares_of_each_period() {
    let mut day = everything();
    let base: f64 = {
        let fares = day.fare_usd.in_period(0).clone();
        day.demand[1].cells().iter().zip(fares.cells()).map(|(&q, fare)| f64::from(q) * fare).sum()
    };
    let raised = day.clone().check("day").expect("a good day").potential_usd();
    day.fare_usd = day.fare_usd.in_period(0).clone().into();
    let flat = day.check("day").expect("a good day").potential_usd();
    assert!((raised - flat - 0.25 * base).abs() < 1e-9);
}

#[test]
fn disturbances_leave_demand_and_start_positions_as_they_would_be_without() {
    let (quiet, disturbed) = (with(""), with(DISTURBANCES));
    for number in 0..20 {
        let plain = quiet.draw(seed(number)).into_day();
        let mut day = disturbed.draw(seed(number)).into_day();
        let disturbances = std::mem::take(&mut day.disturbances);
        assert_ne!(day.demand, plain.demand, "the actual demand is not the forecast");
        day.demand = disturbances.forecast.expect("a forecast");
        assert_eq!(day, plain);
    }
}

#[test]
fn each_disturbance_has_a_stream_of_its_own() {
    let all = with(DISTURBANCES).draw(seed(3)).into_day().disturbances;
    for line in ["forecast_error", "takeoff_delays", "outages"] {
        let without: Vec<&str> =
            DISTURBANCES.lines().filter(|text| !text.starts_with(line)).collect();
        let some = with(&without.join("\n")).draw(seed(3)).into_day().disturbances;
        assert!(line == "takeoff_delays" || some.takeoff_delays == all.takeoff_delays);
        assert!(line == "outages" || some.outages == all.outages);
        assert_eq!(some.closures, all.closures);
        assert!(line == "forecast_error" || some.forecast == all.forecast);
    }
}

#[test]
fn disturbances_are_as_frequent_and_as_large_as_in_the_network_file() {
    const DAYS: u64 = 400;
    let network = with(DISTURBANCES);
    let (mut closed, mut out, mut late, mut count, mut late_s) =
        (0_u32, 0_u32, 0_u32, 0_u32, 0_u64);
    let (mut forecast, mut actual) = (0.0, 0.0);
    for number in 0..DAYS {
        let day = network.draw(seed(number));
        let disturbances = &day.disturbances;
        assert!(disturbances.closures.len() <= 1);
        for closure in &disturbances.closures {
            closed += 1;
            assert!((1800..=7200).contains(&closure.end.since(closure.start)));
        }
        out += u32::try_from(disturbances.outages.len()).expect("few");
        let delays = disturbances.takeoff_delays.as_ref().expect("delays");
        assert_eq!(delays.delay_s.len(), 12 * 4 + 1);
        for slot in &delays.delay_s {
            assert!(slot.iter().enumerate().all(|(at, &delay)| at == 1 || delay == 0));
            count += 1;
            late += u32::from(slot[1] > 0);
            late_s += u64::from(slot[1]);
            assert!(slot[1] <= 900);
        }
        for (drawn, expected) in day.demand.iter().zip(disturbances.forecast.as_ref().expect("one"))
        {
            actual += drawn.cells().iter().map(|&q| f64::from(q)).sum::<f64>();
            forecast += expected.cells().iter().map(|&q| f64::from(q)).sum::<f64>();
        }
    }
    let share = |count: u32, of: f64| f64::from(count) / of;
    assert!((share(closed, DAYS as f64) - 0.5).abs() < 5.0 * 0.025, "{closed}");
    assert!((share(out, DAYS as f64 * 40.0) - 0.2).abs() < 5.0 * 0.0032, "{out}");
    assert!((share(late, f64::from(count)) - 0.3).abs() < 5.0 * 0.0033, "{late}");
    // The mean of an exponential draw of mean 300 cut off at 900 is 300 (1 - e^-3).
    let mean_s = late_s as f64 / f64::from(late);
    assert!((mean_s - 300.0 * (1.0 - (-3.0_f64).exp())).abs() < 15.0, "{mean_s}");
    // One vertiport in ten has double demand.
    assert!((actual / forecast - 1.1).abs() < 0.01, "{}", actual / forecast);
}

#[test]
fn a_day_can_be_one_period_and_demand_uniform() {
    let text = PAPER.replace(
        "[demand]",
        "[uniform_demand]\nperiods = [\"06:00:00\"]\nleast = 0\nmost = 99\n[gone]",
    );
    let cut = text.find("[gone]").expect("just put there");
    let scales = text.find("[feature_scales]").expect("a member");
    let network = network(&format!("{}{}", &text[..cut], &text[scales..]));
    let (mut count, mut sum) = (0.0, 0.0);
    for number in 0..200 {
        let day = network.draw(seed(number));
        assert_eq!(day.demand.len(), 1);
        for &passengers in day.demand[0].cells() {
            assert!(passengers <= 99);
            sum += f64::from(passengers);
        }
        count += 56.0;
    }
    assert!((sum / count - 49.5_f64).abs() < 5.0 * 28.9 / f64::sqrt(count), "{}", sum / count);
}

#[test]
fn a_days_total_is_spread_by_weights_and_shares() {
    let text = format!(
        "{}[daily_demand]\nperiods = [\"06:00:00\", \"12:00:00\"]\nshares_percent = [60, 30]\nnoise = 0.1\n\
         gravity = {{ passengers = 56000, weights = [1, 1, 1, 1, 1, 1, 1, 1] }}\n{}",
        &PAPER[..PAPER.find("[demand]").expect("a member")],
        &PAPER[PAPER.find("[feature_scales]").expect("a member")..]
    );
    let means = network(&text).mean_demand();
    let pair = (VertiportIx(2), VertiportIx(5));
    assert!((means[0][pair] - 600.0).abs() < 1e-9 && (means[1][pair] - 300.0).abs() < 1e-9);
}

#[test]
fn fares_and_energy_prices_follow_the_periods_of_the_network() {
    let factors = "[1, 1, 1.5, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]";
    let prices = "[0.1, 0.2, 0.3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1]";
    let text = PAPER.replace(
        "energy_price_usd_per_kwh = 0.20",
        &format!("fare_factors = {factors}\nenergy_price_usd_per_kwh = {prices}"),
    );
    let day = network(&text).draw(seed(1));
    let pair = (VertiportIx(0), VertiportIx(1));
    let fare = |period| day.fare_usd.in_period(period)[pair];
    assert!((fare(2) - 1.5 * fare(1)).abs() < 1e-12);
    assert!((day.energy_price_usd[2] - 0.3).abs() < 1e-12);
}

fn shipped(name: &str) -> Network {
    Network::shipped(name).expect("a shipped network")
}

#[test]
fn every_shipped_network_draws_days_that_obey_every_rule() {
    for name in Network::shipped_names() {
        for number in 0..20 {
            let day = shipped(name).draw(seed(number));
            assert_eq!(day.warnings(), [], "{name}");
            let again = day.clone().into_day().check(name).expect("a drawn day is a good day");
            assert_eq!(again, day);
        }
    }
}

#[test]
fn disrupted_is_paper_with_disturbances() {
    let (paper, disrupted) = (shipped("paper").draw(seed(5)), shipped("disrupted").draw(seed(5)));
    let (paper, mut disrupted) = (paper.into_day(), disrupted.into_day());
    let disturbances = std::mem::take(&mut disrupted.disturbances);
    disrupted.demand = disturbances.forecast.expect("a forecast");
    disrupted.name.clone_from(&paper.name);
    disrupted.fare_usd.clone_from(&paper.fare_usd);
    disrupted.energy_price_usd.clone_from(&paper.energy_price_usd);
    assert_eq!(disrupted, paper);
}

/// Source: FHWA, Highway Statistics 2006, table NT-3: vehicle trips of a Wednesday by the hour in
/// which they start, from midnight on.
const NT_3_WEDNESDAY: [u32; 24] = [
    147, 82, 83, 36, 249, 639, 1607, 3893, 2994, 2294, 2600, 2967, 3166, 3032, 3321, 3888, 3959,
    4377, 3746, 2819, 2061, 1559, 783, 381,
];

#[test]
fn the_hours_of_new_york_have_the_shares_of_a_wednesday() {
    let file: toml::Table = NEW_YORK.parse().expect("TOML");
    let demand = &file["daily_demand"];
    let all: u32 = NT_3_WEDNESDAY.iter().sum();
    let due = NT_3_WEDNESDAY[6..=22].iter().map(|&trips| f64::from(trips) / f64::from(all));
    let found = demand["shares_percent"].as_array().expect("a list");
    let starts = demand["periods"].as_array().expect("a list");
    assert_eq!((found.len(), starts.len()), (17, 17));
    for ((hour, due), (found, start)) in (6..).zip(due).zip(found.iter().zip(starts)) {
        let found = found.as_float().expect("a number");
        assert!((found - 100.0 * due).abs() < 0.051, "{hour}: {found} and not {due}");
        assert_eq!(start.as_str(), Some(format!("{hour:02}:00:00").as_str()));
    }
}

/// The numbers are those that `networks/new-york.toml` states.
#[test]
fn the_pairs_of_new_york_are_2_to_40_miles_apart_and_18_on_the_mean() {
    let day = shipped("new-york").draw(seed(1));
    let between: Vec<f64> =
        day.distance_mi.cells().iter().copied().filter(|&miles| miles > 0.0).collect();
    assert_eq!(between.len(), 72);
    let shortest = between.iter().copied().fold(f64::INFINITY, f64::min);
    let longest = between.iter().copied().fold(0.0, f64::max);
    let mean = between.iter().sum::<f64>() / 72.0;
    for (found, due) in [(shortest, 2.0), (longest, 39.6), (mean, 18.0)] {
        assert!((found - due).abs() < 0.06, "{found} and not {due}");
    }
}

#[test]
fn scheduled_closures_are_at_the_same_times_every_day() {
    let (open, closed) = (with(""), with(CLOSURES));
    for number in 0..20 {
        let mut day = closed.draw(seed(number)).into_day();
        let closures = std::mem::take(&mut day.disturbances.closures);
        assert_eq!(day, open.draw(seed(number)).into_day(), "closures change nothing else");
        // 7 routes lead to V3, and 7 to V5; one route joins the two.
        assert_eq!(closures.len(), 13 + 1 + 7 + 1);
        let all = ClosedTimes::of(&closures, 8);
        let known = ClosedTimes::of(closures.iter().filter(|closure| closure.known), 8);
        let time = |text: &str| text.parse::<Time>().expect("a time");
        for (from, to, at, is_closed, is_known) in [
            (2, 4, "06:59:59", true, true),
            (4, 2, "06:59:59", true, true),
            (7, 4, "06:00:00", true, true),
            (4, 7, "07:00:00", false, false),
            (0, 2, "07:00:00", true, false),
            (2, 0, "08:30:00", false, false),
            (2, 7, "16:30:00", true, true),
            (4, 7, "16:30:00", false, false),
            (0, 1, "25:00:00", true, true),
            (1, 0, "25:00:00", false, false),
        ] {
            let (from, to) = (VertiportIx(from), VertiportIx(to));
            assert_eq!(all.is_closed(from, to, time(at)), is_closed, "{from:?} {to:?} {at}");
            assert_eq!(known.is_closed(from, to, time(at)), is_known, "{from:?} {to:?} {at}");
        }
    }
}

#[test]
fn scheduled_closures_add_to_those_that_are_drawn() {
    let (drawn, both) = (with(DISTURBANCES), with(&format!("{CLOSURES}{DISTURBANCES}")));
    for number in 0..20 {
        let drawn = drawn.draw(seed(number)).into_day().disturbances.closures;
        let both = both.draw(seed(number)).into_day().disturbances.closures;
        assert_eq!(both[22..], drawn);
        assert!(
            drawn.iter().all(|closure| !closure.known),
            "drawn closures are not known in advance"
        );
    }
}

#[test]
fn a_network_closes_no_more_routes_than_a_day_may() {
    let closure = "[[closures]]\nstart = \"06:00:00\"\nend = \"07:00:00\"\n\
                   vertiports = [\"V1\", \"V2\", \"V3\", \"V4\", \"V5\", \"V6\", \"V7\"]\n";
    let text =
        |count| PAPER.replace("[feature_scales]", &(closure.repeat(count) + "[feature_scales]"));
    // Each closure has 28 routes.
    assert_eq!(network(&text(357)).draw(seed(1)).disturbances.closures.len(), 9_996);
    let error = Network::from_toml(&text(358), "net.toml").expect_err("10,024 routes");
    assert_eq!(error.code().to_string(), "V108");
    let random = format!("{}{DISTURBANCES}", text(357)).replace(
        "closures = [",
        "closures = [\n\
        { probability = 0.5, least_s = 1, most_s = 2, routes = [\n\
            { from = \"V1\", to = \"V2\" }, { from = \"V1\", to = \"V3\" },\n\
            { from = \"V1\", to = \"V4\" }, { from = \"V1\", to = \"V5\" },\n\
        ] },",
    );
    let error = Network::from_toml(&random, "net.toml").expect_err("10,001 routes");
    assert_eq!(error.code().to_string(), "V108");
    assert!(error.to_string().contains("found 10001"), "{error}");
}

#[test]
fn the_closures_on_the_page_of_files_are_good_ones() {
    let page = include_str!("../../../../docs/src/reference/files.md");
    let examples = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let closures: Vec<&str> = examples.filter(|text| text.contains("[[closures]]")).collect();
    assert_eq!(closures.len(), 1);
    let text = NEW_YORK.replace("[feature_scales]", &format!("{}[feature_scales]", closures[0]));
    let day = network(&text).draw(seed(1));
    let lists = day.disturbances.closures.iter().filter(|closure| closure.known).count();
    assert_eq!(lists, 8 + 8, "JRB is closed twice a day");
}
