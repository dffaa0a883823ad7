//! The members that say what batteries hold and when aircraft may leave.

use vertifleet_core::{Charging, Coded, Day, DaySeed, Network, Scenario};

const SMALL: &str = include_str!("../data/small.json");
const PAPER: &str = include_str!("../../../../networks/paper.toml");
const QUICK: &str = include_str!("../../../../networks/new-york-quick.toml");

/// The error of the network with a line in place of another, as it is printed.
fn refused(line: &str, other: &str) -> String {
    assert!(QUICK.contains(line), "{line}");
    let error = Network::from_toml(&QUICK.replacen(line, other, 1), "quick.toml");
    let error = error.expect_err("a network against the rules");
    format!("{}: {error}", error.code())
}

#[test]
fn members_against_the_rules_are_refused_with_the_rule() {
    let curve = "charge_curve = [[0, 170], [0.8, 170], [1, 42.5]]";
    let kind = "aircraft type \"midnight\":";
    for (line, other, rule) in [
        ("charging = \"as_needed\"", "charging = \"now\"", "V112: quick.toml: operations: charging must be \"to_full\" or \"as_needed\", found \"now\"".to_owned()),
        ("reserve_kwh = 28.4", "reserve_kwh = 142", format!("V104: quick.toml: {kind} reserve_kwh must be less than battery_kwh, 142, found 142")),
        ("turnaround_s = 300", "turnaround_s = 1.5", format!("V104: quick.toml: {kind} turnaround_s must be a whole number, found 1.5")),
        (curve, "charge_curve = [[0, 170], [1, -5]]", format!("V104: quick.toml: {kind} charge_curve: point 2: power must be at least 1, found -5")),
        (curve, "charge_curve = [[0, 170], [0.8, 90], [0.7, 60], [1, 5]]", format!("V104: quick.toml: {kind} charge_curve: point 3: charge must be more than that of the point before it, found 0.7")),
        (curve, "charge_curve = [[0.1, 170], [1, 5]]", format!("V104: quick.toml: {kind} charge_curve: point 1: charge must be 0, an empty battery, found 0.1")),
        (curve, "charge_curve = [[0, 170], [0.9, 5]]", format!("V104: quick.toml: {kind} charge_curve: point 2: charge must be 1, a full battery, found 0.9")),
        ("start_positions = \"random\"", "start_charge = [0.9, 0.5]\nstart_positions = \"random\"", "V104: quick.toml: start_charge[1] must be at least start_charge[0], 0.9, found 0.5".to_owned()),
    ] {
        assert_eq!(refused(line, other), rule);
    }
}

#[test]
fn a_day_with_these_members_reads_back_as_it_was_written() {
    let with_start = "start_charge = [0.3, 0.6]\nstart_positions = \"random\"";
    let text = QUICK.replacen("start_positions = \"random\"", with_start, 1);
    let network = Network::from_toml(&text, "quick.toml").expect("a network");
    let seed = DaySeed::validation(4).expect("a seed");
    let mut day = network.draw(seed).into_day();
    assert_eq!(day.operations.charging, Charging::AsNeeded);
    for aircraft in &day.aircraft {
        let battery_kwh = day.aircraft_types[aircraft.kind.at()].battery_kwh;
        let share = aircraft.start_charge_kwh.expect("it is drawn") / battery_kwh;
        assert!((0.3 - 1e-5..=0.6 + 1e-5).contains(&share), "{share}");
    }
    day.vertiports[2].charger_kw = Some(75.5);
    let mut beyond = day.clone();
    let day = day.check("a day").expect("a day within the rules");
    let read = Scenario::from_json(day.to_json().as_bytes(), "day.json");
    assert_eq!(read.expect("what was written"), day);
    beyond.aircraft[0].start_charge_kwh = Some(1_000.0);
    let error = beyond.check("a day").expect_err("more than the battery holds");
    assert_eq!(error.code().to_string(), "V104", "{error}");
    // Start charges have a separate stream: all else is as with full batteries.
    let full = Network::from_toml(QUICK, "quick.toml").expect("a network").draw(seed);
    assert_eq!((&full.demand, full.aircraft[0].at), (&day.demand, day.aircraft[0].at));
}

#[test]
fn a_network_knows_whether_each_of_its_days_has_a_decision() {
    let has_decisions = |charging: &str, start_charge: &str| {
        let operations = format!("{start_charge}\n[operations]\n{charging}");
        let text = PAPER.replacen("[operations]", &operations, 1);
        let text = text.replacen("charge_kw = 150", "charge_kw = 6", 1);
        Network::from_toml(&text, "slow.toml").expect("a network").always_has_decisions()
    };
    // In the 12 hours of operations 72 of 110 kWh are charged.
    assert!(has_decisions("", ""));
    assert!(has_decisions("", "start_charge = [0.35, 0.5]"));
    assert!(!has_decisions("", "start_charge = [0.34, 0.5]"));
    assert!(has_decisions("charging = \"as_needed\"", "start_charge = [0, 0.5]"));
}

/// The warnings of the small day after a change to it.
fn warnings(change: impl Fn(&mut Day)) -> Vec<String> {
    let day = Scenario::from_json(SMALL.as_bytes(), "small.json").expect("the good scenario");
    let mut day = day.into_day();
    change(&mut day);
    let warnings = day.check("day").expect("a valid day").warnings();
    warnings.iter().map(|warning| format!("{}: {warning}", warning.code())).collect()
}

/// The glider has 20 kWh, takes 19.5 kWh from C to A, and reaches nothing else. Operations last for
/// 3.5 h.
#[test]
fn an_aircraft_that_is_charged_after_operations_end_is_warned_about() {
    let with = |charging, start_kwh, charger_kw, reserve_kwh| {
        warnings(|day| {
            day.operations.charging = charging;
            day.aircraft[2].start_charge_kwh = Some(start_kwh);
            day.vertiports[2].charger_kw = Some(charger_kw);
            day.aircraft_types[1].reserve_kwh = reserve_kwh;
        })
    };
    let never = |rest: &str| {
        vec![format!(
            r#"V125: aircraft "A03" of type "glider" never leaves "C": its battery has {rest}"#
        )]
    };
    assert_eq!(with(Charging::ToFull, 3.0, 5.0, 0.0), [""; 0]);
    assert_eq!(
        with(Charging::ToFull, 2.0, 5.0, 0.0),
        never("the 20.0 kWh that it needs only at 09:36:00, and operations end at 09:30:00")
    );
    assert_eq!(with(Charging::AsNeeded, 0.0, 5.6, 0.0), [""; 0]);
    assert_eq!(
        with(Charging::AsNeeded, 0.0, 5.6, 0.5),
        never("the 20.0 kWh that it needs only at 09:34:18, and operations end at 09:30:00")
    );
    assert_eq!(
        with(Charging::AsNeeded, 0.0, 5.0, 0.0),
        never("the 19.5 kWh that it needs only at 09:54:00, and operations end at 09:30:00")
    );
}
