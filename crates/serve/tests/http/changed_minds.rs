//! Decisions that are cancelled.

use serde_json::{Value, json};

use crate::api::{service, text};

/// A state without the number of its event.
fn without_seq(mut state: Value) -> Value {
    state.as_object_mut().expect("an object").remove("seq");
    state
}

#[test]
fn a_person_decides_and_changes_their_mind() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let before = service.state(&day);
    let place = before["aircraft"].as_array().expect("a list")[0]["place"].clone();
    let held = json!({"aircraft": "A01", "to": place, "reason": "the crew is late"});
    assert_eq!(service.decide(&day, &held).status, 201);
    let undone = json!({"type": "undone", "aircraft": "A01", "reason": "the crew is here"});
    assert_eq!(service.event(&day, &undone).status, 201);
    let after = service.state(&day);
    assert_eq!(after["seq"], 2);
    assert_eq!(without_seq(after), without_seq(before));
    let events = service.get(&format!("{day}/events?limit=1")).json;
    assert_eq!(text(&events["events"][0]["event"], "reason"), "the crew is late");
    assert_eq!(events["next"], 1);
}

#[test]
fn a_hold_cannot_be_cancelled_after_the_last_decision() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let state = service.state(&day);
    let place = state["aircraft"].as_array().expect("a list")[0]["place"].clone();
    let happened = |event: Value| service.event(&day, &event);
    assert_eq!(happened(json!({"type": "clock", "time": "18:00:00"})).status, 201);
    let held = json!({"aircraft": "A01", "to": place, "reason": "the day ends"});
    assert_eq!(service.decide(&day, &held).status, 201);
    assert_eq!(happened(json!({"type": "clock", "time": "18:00:01"})).status, 201);
    let refused = happened(json!({"type": "undone", "aircraft": "A01"}));
    assert_eq!(refused.problem(), (422, "V604"), "{refused:?}");
}
