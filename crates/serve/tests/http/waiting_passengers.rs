//! Passengers who wait and who are expected, as a console shows them.

use serde_json::{Value, json};

use crate::api::service;

/// The passengers of a pair.
fn passengers(demand: &Value, from: &str, to: &str) -> u64 {
    let pairs = demand["pairs"].as_array().expect("a list");
    let found = pairs.iter().find(|pair| pair["from"] == from && pair["to"] == to);
    found.map_or(0, |pair| pair["passengers"].as_u64().expect("a number"))
}

#[test]
fn booked_passengers_wait_until_they_depart() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let waiting = || service.get(&format!("{day}/demand"));
    let before = waiting();
    assert_eq!((before.status, before.tag.as_str()), (200, "\"0\""));
    assert_eq!(before.json["has_begun"], true);

    let state = service.state(&day);
    let from = state["aircraft"][0]["place"].as_str().expect("it stands at a vertiport");
    let to = if from == "V1" { "V2" } else { "V1" };
    let booked =
        json!({"type": "booked", "period": "06:00:00", "from": from, "to": to, "passengers": 9});
    assert_eq!(service.event(&day, &booked).status, 201);
    let booked = waiting().json;
    let more = passengers(&before.json, from, to) + 9;
    assert_eq!((passengers(&booked, from, to), &booked["seq"]), (more, &json!(1)));

    let decided = json!({"aircraft": "A01", "to": to, "reason": "they wait"});
    assert_eq!(service.decide(&day, &decided).status, 201);
    let left = passengers(&waiting().json, from, to);
    let seats = 4;
    assert_eq!(left, more - seats, "a full aircraft takes as many as it has seats");
}

#[test]
fn a_later_period_is_asked_for_by_any_time_in_it() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let at = |period: &str| service.get(&format!("{day}/demand?period={period}"));
    let evening = at("17:30:00");
    assert_eq!((evening.status, &evening.json["has_begun"]), (200, &json!(false)));
    assert!(!evening.json["pairs"].as_array().expect("a list").is_empty());
    let start = evening.json["period"].as_str().expect("a time").to_owned();
    assert_eq!(at(&start).json, evening.json);
    for (wrong, status) in [("soon", 400), ("03:00:00", 422)] {
        assert_eq!(at(wrong).status, status, "{wrong}");
    }
}
