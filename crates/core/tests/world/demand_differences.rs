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
            format!("{} {} {} {}: {change}", one.path, cell.from, cell.to, cell.period)
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
            "hourly_demand.pairs.0.passengers.0 B A 06:00:00: 0 -> 1",
        ]
    );
}
