//! Gives the readers arbitrary input: they never panic, and everything that they accept obeys every
//! rule.

use proptest::prelude::{Just, Strategy, any, prop, prop_oneof, proptest};
use proptest::test_runner::Config;
use vertifleet_core::{DaySeed, Network, Scenario};

const SCENARIO: &str = include_str!("../data/small.json");
const NETWORK: &str = include_str!("../data/small.toml");
/// The same files with costs, positions on the globe, and demand by hour and pair.
const FULL_SCENARIO: &str = include_str!("../data/full.json");
const FULL_NETWORK: &str = include_str!("../data/full.toml");
const TABLE: &str =
    "period,from,to,passengers\n06:00:00,A,B,2.5\n08:00:00,B,A,12\n8:00:00,A,B,1e-3\n";

/// Numbers and other words that readers stumble over.
const WORDS: &[&str] = &[
    "-1",
    "-0",
    "0",
    "0.0",
    "1",
    "0.5",
    "1e-320",
    "1e308",
    "1e999",
    "-1e999",
    "255",
    "256",
    "65535",
    "65536",
    "4294967295",
    "4294967296",
    "9007199254740991",
    "9007199254740993",
    "18446744073709551616",
    "nan",
    "inf",
    "NaN",
    "null",
    "true",
    "\"\"",
    "\"A\"",
    "\"25:61:00\"",
    "\"9999:59:59\"",
    "[]",
    "{}",
    "[[]]",
    "1e5",
    "1e6",
];

/// A change to a text, by position.
#[derive(Debug, Clone)]
enum Mutation {
    Flip { at: prop::sample::Index, byte: u8 },
    Delete { at: prop::sample::Index, len: usize },
    Repeat { at: prop::sample::Index, len: usize },
    Number { which: prop::sample::Index, word: &'static str },
    CutOff { at: prop::sample::Index },
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let at = any::<prop::sample::Index>;
    let number = (at(), prop::sample::select(WORDS));
    prop_oneof![
        1 => (at(), any::<u8>()).prop_map(|(at, byte)| Mutation::Flip { at, byte }),
        1 => (at(), 1..60_usize).prop_map(|(at, len)| Mutation::Delete { at, len }),
        1 => (at(), 1..200_usize).prop_map(|(at, len)| Mutation::Repeat { at, len }),
        6 => number.prop_map(|(which, word)| Mutation::Number { which, word }),
        1 => at().prop_map(|at| Mutation::CutOff { at }),
    ]
}

/// The runs of digits, dots and signs in a text.
fn numbers(text: &[u8]) -> Vec<std::ops::Range<usize>> {
    let part = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for at in (0..text.len()).filter(|&at| part(text[at])) {
        match found.last_mut() {
            Some(last) if last.end == at => last.end = at + 1,
            _ => found.push(at..at + 1),
        }
    }
    found
}

fn mutated(text: &str, mutations: &[Mutation]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    for mutation in mutations {
        if text.is_empty() {
            break;
        }
        let span = |at: &prop::sample::Index, len: usize| {
            let start = at.index(text.len());
            start..(start + len).min(text.len())
        };
        match mutation {
            Mutation::Flip { at, byte } => {
                let at = at.index(text.len());
                text[at] = *byte;
            }
            Mutation::Delete { at, len } => {
                let span = span(at, *len);
                text.drain(span);
            }
            Mutation::Repeat { at, len } => {
                let copy = text[span(at, *len)].to_vec();
                let at = at.index(text.len());
                text.splice(at..at, copy);
            }
            Mutation::Number { which, word } => {
                let numbers = numbers(&text);
                if !numbers.is_empty() {
                    text.splice(numbers[which.index(numbers.len())].clone(), word.bytes());
                }
            }
            Mutation::CutOff { at } => text.truncate(at.index(text.len())),
        }
    }
    text
}

/// Checks that an accepted scenario passes the checks again and reads back as it was written.
fn obeys_every_rule(scenario: &Scenario) {
    let checked = scenario.clone().into_day().check("again").expect("it was accepted before");
    let text = checked.to_json();
    let again = Scenario::from_json(text.as_bytes(), "again").expect("our own text");
    assert_eq!(&again, scenario);
    assert_eq!(again.to_json(), text, "to the last bit");
    let _ = scenario.warnings();
}

fn read_scenario(text: &[u8]) {
    match Scenario::from_json(text, "any.json") {
        Ok(scenario) => obeys_every_rule(&scenario),
        Err(error) => assert!(error.to_string().len() < 2_000, "messages stay short: {error}"),
    }
}

fn read_network(text: &[u8]) {
    let Ok(text) = str::from_utf8(text) else { return };
    match Network::from_toml(text, "any.toml") {
        Ok(network) => obeys_every_rule(&network.draw(DaySeed::comparison(1).expect("small"))),
        Err(error) => assert!(error.to_string().len() < 2_000, "messages stay short: {error}"),
    }
}

/// Checks that the readers accept the files that the mutations start from.
#[test]
fn the_full_files_are_read() {
    let scenario = Scenario::from_json(FULL_SCENARIO.as_bytes(), "full.json").expect("a scenario");
    assert_eq!(scenario.to_json(), FULL_SCENARIO);
    Network::from_toml(FULL_NETWORK, "full.toml").expect("a network");
}

proptest! {
    #![proptest_config(Config { failure_persistence: None, ..Config::with_cases(200) })]

    #[test]
    fn no_changed_table_makes_the_reader_panic(
        mutations in prop::collection::vec(mutation(), 1..4),
    ) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("net.toml");
        let pairs = FULL_NETWORK;
        let begin = pairs.find("pairs = ").expect("rows");
        let end = begin + pairs[begin..].find('\n').expect("the end of their line");
        let text = format!("{}table = \"demand.csv\"{}", &pairs[..begin], &pairs[end..]);
        std::fs::write(&path, text).expect("a free folder");
        std::fs::write(folder.path().join("demand.csv"), mutated(TABLE, &mutations)).expect("a free folder");
        match Network::read(&path) {
            Ok(network) => {
                let again = Network::from_toml(network.toml(), "again").expect("its own text");
                assert_eq!(again.toml(), network.toml());
                obeys_every_rule(&network.draw(DaySeed::comparison(1).expect("small")));
            }
            Err(error) => assert!(error.to_string().len() < 2_000, "messages stay short: {error}"),
        }
    }
}

proptest! {
    #![proptest_config(Config { failure_persistence: None, ..Config::with_cases(2_000) })]

    #[test]
    fn no_bytes_make_a_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        read_scenario(&bytes);
        read_network(&bytes);
    }

    #[test]
    fn no_changed_scenario_makes_the_reader_panic(
        mutations in prop::collection::vec(mutation(), 1..4),
    ) {
        read_scenario(&mutated(SCENARIO, &mutations));
        read_scenario(&mutated(FULL_SCENARIO, &mutations));
    }

    #[test]
    fn no_changed_network_makes_the_reader_panic(
        mutations in prop::collection::vec(mutation(), 1..4),
    ) {
        read_network(&mutated(NETWORK, &mutations));
        read_network(&mutated(FULL_NETWORK, &mutations));
    }

    #[test]
    fn no_list_of_brackets_overflows_the_stack(
        open in prop_oneof![Just("["), Just("{\"format\":"), Just("a=["), Just("a={b=")],
        depth in 1..50_000_usize,
    ) {
        let text = open.repeat(depth);
        read_scenario(text.as_bytes());
        read_network(text.as_bytes());
    }
}
