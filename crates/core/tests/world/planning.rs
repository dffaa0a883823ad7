//! Changes that planners make: fares to which passengers respond, costs of stands, corridors that
//! are not straight, and days that stay comparable under such changes.

use proptest::prelude::{prop_assert, prop_assert_eq, proptest};
use serde_json::{Value, json};
use vertifleet_core::{Coded, DaySeed, Matrix, Network, Scenario, VertiportIx};

const PAPER: &str = include_str!("../../../../networks/paper.toml");
const NEW_YORK: &str = include_str!("../../../../networks/new-york.toml");

fn seed(seed: u64) -> DaySeed {
    DaySeed::comparison(seed).expect("a small seed")
}

fn network(text: &str) -> Network {
    Network::from_toml(text, "network").unwrap_or_else(|error| panic!("{error}"))
}

fn changed(network: &Network, changes: &Value) -> Network {
    let changes = changes.as_object().expect("changes by their paths");
    network.changed(changes).unwrap_or_else(|error| panic!("{error}"))
}

fn passengers(day: &Scenario) -> u64 {
    day.demand.iter().flat_map(Matrix::cells).map(|&one| u64::from(one)).sum()
}

#[test]
fn every_time_zone_of_the_database_may_be_given() {
    for zone in ["UTC", "America/New_York", "Etc/GMT+5", "Asia/Kathmandu"] {
        let text = format!("time_zone = \"{zone}\"\n{PAPER}");
        assert_eq!(network(&text).time_zone(), Some(zone));
    }
}

#[test]
fn a_market_without_response_changes_no_day() {
    for text in [PAPER, NEW_YORK] {
        let plain = network(text);
        let market = changed(&plain, &json!({"market": {"elasticity": 1.4}}));
        for number in 0..5 {
            assert_eq!(market.draw(seed(number)), plain.draw(seed(number)));
        }
    }
}

#[test]
fn on_the_same_day_a_higher_fare_never_has_more_passengers() {
    let plain = changed(&network(NEW_YORK), &json!({"market": {"elasticity": 1.4}}));
    for number in 0..10 {
        let day =
            |level: f64| changed(&plain, &json!({"tariffs.fare_level": level})).draw(seed(number));
        let days = [0.7, 0.9, 1.0, 1.01, 1.05, 1.3, 2.0].map(day);
        for pair in days.windows(2) {
            assert_none_more(&pair[1].demand, &pair[0].demand);
            let [low, high] = [0, 1].map(|at: usize| pair[at].expected().demand.clone());
            assert_none_more(&high, &low);
        }
        assert!(passengers(&days[0]) > passengers(&days[2]) && passengers(&days[6]) > 0);
        let unchanged = plain.draw(seed(number));
        assert_eq!(days[2].demand, unchanged.demand, "at the reference nothing changes");
    }
}

/// Checks that no pair has more passengers in `one` than in `other`.
fn assert_none_more(one: &[Matrix<u32>], other: &[Matrix<u32>]) {
    for (one, other) in one.iter().zip(other) {
        assert!(one.cells().iter().zip(other.cells()).all(|(one, other)| one <= other));
    }
}

/// The factor between the tables of the two networks' mean demand.
fn assert_mean_is(now: &Network, before: &Network, factor: impl Fn(f64) -> f64) {
    let fares = |network: &Network| network.draw(seed(1)).fare_usd.in_period(0).cells().to_vec();
    let ratios: Vec<f64> =
        fares(now).iter().zip(fares(before)).map(|(now, before)| now / before).collect();
    for (now, before) in now.mean_demand().iter().zip(before.mean_demand()) {
        for ((now, before), ratio) in now.cells().iter().zip(before.cells()).zip(&ratios) {
            let expected = if *before > 0.0 { before * factor(*ratio) } else { 0.0 };
            assert!((now - expected).abs() < 1e-9 * (1.0 + before), "{now} for {expected}");
        }
    }
}

#[test]
fn demand_responds_whichever_member_changes_the_fares() {
    let elastic = changed(&network(PAPER), &json!({"market.elasticity": 0.8}));
    let response = |ratio: f64| (0.8 * (1.0 - ratio)).exp();
    for changes in [
        json!({"tariffs.fare_usd_per_mi": 1.5}),
        json!({"tariffs.boarding_fee_usd": 20.0}),
        json!({"tariffs.fare_base": 1.9, "tariffs.fare_level": 1.2}),
        json!({"tariffs.fare_factors": vec![1.25; elastic.periods()]}),
        json!({"tariffs.pairs": [{"from": "V1", "to": "V2", "fare_usd": 400.0}]}),
    ] {
        let dear = changed(&elastic, &changes);
        assert!(total(&dear) < total(&elastic), "{changes}");
        assert_mean_is(&dear, &elastic, response);
        // A change of a changed network keeps the same reference.
        let again = changed(&dear, &json!({"tariffs.fare_level": 1.1, "fleet.0.count": 41}));
        assert_mean_is(&again, &elastic, response);
    }
    let both = json!({"market.elasticity": 0.8, "tariffs.fare_usd_per_mi": 1.5});
    assert!(total(&changed(&network(PAPER), &both)) < total(&elastic), "together, too");
}

#[test]
fn a_reference_that_is_given_is_kept() {
    let given = json!({"market": {"elasticity": 0.8, "reference": {"boarding_fee_usd": 50.0}}});
    let given = changed(&network(PAPER), &given);
    let same = changed(&given, &json!({"tariffs.boarding_fee_usd": 50.0}));
    assert_mean_is(&same, &network(PAPER), |_| 1.0);
    let moved = json!({"tariffs.fare_usd_per_mi": 2.0, "market.reference.fare_usd_per_mi": 2.0});
    let elastic =
        changed(&network(PAPER), &json!({"market": {"elasticity": 0.8, "reference": {}}}));
    assert_mean_is(&changed(&elastic, &moved), &elastic, |_| 1.0);
    // Without elasticity nothing is written.
    let dull = changed(&network(PAPER), &json!({"tariffs.fare_usd_per_mi": 1.5}));
    assert!(!dull.toml().contains("reference"));
}

fn total(network: &Network) -> f64 {
    network.mean_demand().iter().flat_map(Matrix::cells).sum()
}

#[test]
fn the_mean_of_the_draws_follows_the_market() {
    let plain = network(PAPER);
    let level = 1.25_f64;
    let market = changed(
        &plain,
        &json!({"market": {"elasticity": 0.8, "demand_factor": 1.5}, "tariffs.fare_level": level}),
    );
    let factor = 1.5 * (0.8 * (1.0 - level)).exp();
    for (now, before) in market.mean_demand().iter().zip(plain.mean_demand()) {
        for (now, before) in now.cells().iter().zip(before.cells()) {
            assert!((now - factor * before).abs() < 1e-9 * (1.0 + before), "{now}, {before}");
        }
    }
    let drawn = |network: &Network| -> f64 {
        (0..40).map(|number| passengers(&network.draw(seed(number))) as f64).sum()
    };
    let share = drawn(&market) / drawn(&plain);
    assert!((share / factor - 1.0).abs() < 2e-3, "{share} instead of {factor}");
}

#[test]
fn a_reference_states_at_which_fares_the_demand_was_measured() {
    let plain = network(NEW_YORK);
    let market = changed(
        &plain,
        &json!({
            "market": {"elasticity": 2, "reference": {"fare_usd_per_mi": 5}},
            "tariffs.fare_usd_per_mi": 6,
        }),
    );
    let level = changed(&plain, &json!({"market": {"elasticity": 2}, "tariffs.fare_level": 1.2}));
    for (one, other) in market.mean_demand().iter().zip(level.mean_demand()) {
        for (one, other) in one.cells().iter().zip(other.cells()) {
            assert!((one - other).abs() < 1e-9 * (1.0 + other), "{one}, {other}");
        }
    }
    let single = changed(
        &plain,
        &json!({
            "market": {"elasticity": 2, "elasticities": [{"from": "JFK", "to": "JRB", "elasticity": 0}]},
            "tariffs.fare_level": 1.2,
        }),
    );
    let at = |id: &str| {
        let position = plain.vertiports().iter().position(|vertiport| vertiport.id == id);
        VertiportIx::new(position.expect("a vertiport"))
    };
    let mean = |network: &Network, from, to| network.mean_demand()[2][(at(from), at(to))];
    assert_eq!(mean(&single, "JFK", "JRB"), mean(&plain, "JFK", "JRB"));
    assert!(mean(&single, "JRB", "JFK") < mean(&plain, "JRB", "JFK"));
}

#[test]
fn tariffs_of_single_pairs_take_the_place_of_formulas() {
    let pairs = json!({"tariffs.pairs": [
        {"from": "V1", "to": "V2", "fare_usd": 99.5},
        {"from": "V2", "to": "V1", "passenger_cost_usd": 3},
    ]});
    let (plain, day) = (network(PAPER), changed(&network(PAPER), &pairs).draw(seed(1)));
    let before = plain.draw(seed(1));
    let (there, back) = ((VertiportIx(0), VertiportIx(1)), (VertiportIx(1), VertiportIx(0)));
    assert_eq!(day.fare_usd.in_period(0)[there], 99.5);
    assert_eq!(day.passenger_cost_usd[back], 3.0);
    assert_eq!(day.passenger_cost_usd[there], before.passenger_cost_usd[there]);
    let other = (VertiportIx(2), VertiportIx(1));
    assert_eq!(day.fare_usd.in_period(0)[other], before.fare_usd.in_period(0)[other]);
    assert_eq!(day.demand, before.demand);
}

#[test]
fn a_corridor_may_be_longer_than_the_straight_line_and_no_shorter() {
    let corridor = |length_mi: f64| {
        let text = PAPER.replace(
            "[[aircraft_types]]",
            &format!(
                "[[corridors]]\nfrom = \"V1\"\nto = \"V3\"\nboth_ways = true\nlength_mi = {length_mi}\n\n\
                 [[corridors]]\nfrom = \"V1\"\nto = \"V4\"\n\n[[aircraft_types]]"
            ),
        );
        Network::from_toml(&text, "network")
    };
    let day = corridor(25.5).expect("a way that bends").draw(seed(1));
    let (one, three, four) = (VertiportIx(0), VertiportIx(2), VertiportIx(3));
    assert_eq!((day.distance_mi[(one, three)], day.distance_mi[(three, one)]), (25.5, 25.5));
    assert_eq!(day.distance_mi[(one, four)], network(PAPER).draw(seed(1)).distance_mi[(one, four)]);
    assert!(!day.is_corridor(four, one));
    let error = corridor(20.0).expect_err("shorter than the straight line");
    assert_eq!(error.code().to_string(), "V104");
    assert!(error.to_string().contains("at least 21.47, the straight line"), "{error}");
}

#[test]
fn stands_and_chargers_have_the_cost_of_their_vertiport_or_of_the_tariffs() {
    let costs = json!({
        "tariffs.stand_cost_usd_per_day": 50,
        "tariffs.charger_cost_usd_per_day": 200,
        "vertiports.V2.stand_cost_usd_per_day": 0,
        "vertiports.V3.chargers": 2,
        "vertiports.V4.charger_cost_usd_per_day": 7,
    });
    let day = changed(&network(PAPER), &costs).draw(seed(1));
    assert_eq!(day.site_cost_usd(), 7.0 * 6.0 * 50.0 + 2.0 * 200.0);
    assert_eq!(day.fixed_cost_usd(), day.fleet_cost_usd() + day.site_cost_usd());
    let again = Scenario::from_json(day.to_json().as_bytes(), "again").expect("our own text");
    assert_eq!(again, day);
}

#[test]
fn a_change_of_stands_is_undone_by_its_reverse() {
    let paper = network(PAPER);
    let more = changed(&paper, &json!({"vertiports.*.stands": 9}));
    assert_eq!(starts(&more.draw(seed(5))), starts(&paper.draw(seed(5))));
    let text = Network::from_toml(more.toml(), "again").expect("a changed network");
    assert_eq!(text.draw(seed(5)), more.draw(seed(5)), "the text is complete");
    let back = changed(&more, &json!({"vertiports.*.stands": 6}));
    assert_eq!(back.draw(seed(5)), paper.draw(seed(5)));
    let other_fares = changed(&paper, &json!({"tariffs.fare_level": 2}));
    assert!(!other_fares.toml().contains("start_stands"));
    let by_hand = network(&PAPER.replace("stands = 6", "stands = 9"));
    assert_ne!(starts(&by_hand.draw(seed(5))), starts(&paper.draw(seed(5))));
}

/// The vertiports at which aircraft start.
fn starts(day: &Scenario) -> Vec<VertiportIx> {
    day.aircraft.iter().map(|aircraft| aircraft.at).collect()
}

proptest! {
    #[test]
    fn changed_stands_and_fleets_move_no_more_aircraft_than_they_must(
        number in 0..10_000_u64, stands in proptest::collection::vec(1..12_u16, 8), fleet in 1..60_usize,
    ) {
        let base = network(PAPER);
        let total: usize = stands.iter().map(|&one| usize::from(one)).sum();
        let fleet = fleet.min(total);
        let mut changes = serde_json::Map::new();
        changes.insert("fleet.0.count".to_owned(), json!(fleet));
        for (at, stands) in stands.iter().enumerate() {
            changes.insert(format!("vertiports.{at}.stands"), json!(stands));
        }
        let other = changed(&base, &Value::Object(changes));
        let day = other.draw(seed(number));
        let day = day.into_day().check("drawn").expect("a valid day");
        let before = base.draw(seed(number));
        let mut there = [0_u16; 8];
        for (at, now) in starts(&before).into_iter().zip(starts(&day)) {
            there[at.at()] += 1;
            if there[at.at()] <= stands[at.at()] {
                prop_assert_eq!(at, now, "there is a stand for it where it was");
            }
        }
        prop_assert_eq!(&day.demand, &before.demand);
        prop_assert!(starts(&day).len() == fleet);
    }
}
