//! The differences of two networks with hourly demand, by pair and period.

use vertifleet_core::Network;

const FULL: &str = include_str!("../data/full.toml");
const PAIRS: &str = r#"pairs = [{ from = "A", to = "B", passengers = [2.5, 12] }]"#;

fn differences(pairs: &str) -> Vec<String> {
    let network = |text: &str| Network::from_toml(text, "full.toml").expect("a network");
    assert!(FULL.contains(PAIRS));
    let found = network(FULL).differences(&network(&FULL.replace(PAIRS, pairs)));
    let text = |value: Option<String>| value.expect("a number of passengers");
    found
        .into_iter()
        .map(|one| {
            let cell = one.demand.expect("a cell of the demand");
            let change = format!("{} -> {}", text(one.before), text(one.after));
            let path = one.path.as_deref().unwrap_or("-");
            format!("{path} {} {} {}: {change}", cell.from, cell.to, cell.period)
        })
        .collect()
}

#[test]
fn demand_differs_by_pair_and_period() {
    assert_eq!(
        differences(r#"pairs = [{ from = "A", to = "B", passengers = [2.5, 14] }]"#),
        ["hourly_demand.pairs.0.passengers.1 A B 08:00:00: 12 -> 14"]
    );
    // Neither the order of pairs counts, nor the form of a number, nor pairs without passengers.
    assert!(
        differences(
            r#"pairs = [{ from = "B", to = "A", passengers = [0, 0] }, { from = "A", to = "B", passengers = [2.5, 12.0] }]"#
        )
        .is_empty()
    );
    assert_eq!(
        differences(r#"pairs = [{ from = "B", to = "A", passengers = [1, 0] }]"#),
        [
            "hourly_demand.pairs.0.passengers.0 A B 06:00:00: 2.5 -> 0",
            "hourly_demand.pairs.0.passengers.1 A B 08:00:00: 12 -> 0",
            "- B A 06:00:00: 0 -> 1",
        ]
    );
}

#[test]
fn the_path_of_a_difference_leads_to_it_in_the_first_network() {
    let network = |pairs: &str| {
        Network::from_toml(&FULL.replace(PAIRS, pairs), "full.toml").expect("a network")
    };
    let one = network(PAIRS);
    let other = network(r#"pairs = [{ from = "B", to = "A", passengers = [3, 4] }]"#);
    let found = one.differences(&other);
    let paths: Vec<&String> = found.iter().filter_map(|one| one.path.as_ref()).collect();
    assert_eq!((found.len(), paths.len()), (4, 2));
    let unique: std::collections::BTreeSet<_> = paths.iter().collect();
    assert_eq!(unique.len(), paths.len(), "{paths:?}");
    for difference in found.iter().filter(|one| one.path.is_some()) {
        let path = difference.path.clone().expect("just filtered");
        let value = serde_json::Value::from(7);
        let changed = one.changed([(&path, &value)]).expect("a path of the first network");
        let [only] = one.differences(&changed).try_into().expect("one difference");
        assert_eq!((only.demand, only.path), (difference.demand.clone(), Some(path)));
    }
}
