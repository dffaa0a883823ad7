//! How days are expected to go on, from now and from moments that have passed.

use serde_json::json;

use crate::api::service;

#[test]
fn an_outlook_is_the_simulated_day_and_what_if_leaves_the_day_alone() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let outlook = service.get(&format!("{day}/outlook")).json;
    let asked = json!({
        "events": [{"type": "closed", "routes": {"vertiport": "V1"}, "until": "20:00:00"}],
    });
    let compared = service.post(&format!("{day}/what-if"), &asked).json;
    assert_eq!(compared["as_it_is"]["totals"], outlook["totals"]);
    assert!(compared["difference_usd"].as_f64().is_some_and(|usd| usd < -1_000.0), "{compared}");
    let legs = compared["what_if"]["legs"].as_array().expect("a list");
    assert!(
        legs.iter()
            .all(|leg| leg["from"] == leg["to"] || (leg["from"] != "V1" && leg["to"] != "V1"))
    );
    let more =
        json!({"aircraft": [{"id": "A99", "at": "V2"}], "stands": {"V2": 12}, "policy": "gcaps-x"});
    let compared = service.post(&format!("{day}/what-if"), &more).json;
    assert!(compared["difference_usd"].as_f64().is_some_and(|usd| usd > 0.0), "{compared}");
    assert!(
        compared["what_if"]["legs"]
            .as_array()
            .expect("a list")
            .iter()
            .any(|leg| leg["aircraft"] == "A99")
    );
    assert_eq!(service.get(&day).json["seq"], 0);
}

#[test]
fn an_outlook_from_a_moment_that_has_passed_is_the_one_of_then() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let asked = |query: &str| service.get(&format!("{day}/outlook?{query}"));
    let mut outlooks = vec![service.get(&format!("{day}/outlook")).json];
    let closed = json!({"type": "closed", "routes": {"vertiport": "V1"}, "until": "20:00:00"});
    assert_eq!(service.post(&format!("{day}/events"), &closed).status, 201);
    outlooks.push(service.get(&format!("{day}/outlook")).json);
    assert_eq!(service.post(&format!("{day}/decisions"), &json!({"aircraft": "A01"})).status, 201);
    assert!(outlooks[1]["totals"]["profit_usd"] != outlooks[0]["totals"]["profit_usd"]);
    for (seq, outlook) in outlooks.iter().enumerate() {
        assert_eq!(&asked(&format!("seq={seq}")).json, outlook);
    }
    let by_another = asked("seq=0&policy=prices").json;
    assert_eq!(by_another["policy"], "prices");
    assert!(
        by_another["legs"]
            .as_array()
            .is_some_and(|legs| legs.iter().all(|leg| leg["is_taken"] == false))
    );
    assert_eq!(asked("seq=3").status, 404);
}
