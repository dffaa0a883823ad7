//! Requests that make no sense: each gets an answer with a code, and the day stays as it is.

use vertifleet_testkit::{draw, spoilt};

use crate::api::service;

const REQUESTS: u32 = 1_000;

#[test]
fn malformed_requests_are_refused_with_a_code() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let good = [
        (
            "/events",
            r#"{"type":"departed","aircraft":"A01","time":"07:00:00","to":"V3","passengers":2}"#,
        ),
        (
            "/events",
            r#"[{"type":"closed","routes":{"from":"V1","to":"V2"},"until":30000,"reason":"wind"}]"#,
        ),
        (
            "/events",
            r#"{"type":"demand","period":"07:00:00","pairs":[{"from":"V1","to":"V2","passengers":3}]}"#,
        ),
        (
            "/decisions",
            r#"{"aircraft":"A01","policy":"greedy","time":"06:30:00","deadline_ms":50}"#,
        ),
        ("/what-if", r#"{"events":[],"stands":{"V1":3},"aircraft":[{"id":"A99","at":"V2"}]}"#),
    ];
    let mut refused = 0;
    for seed in 0..REQUESTS {
        let (path, body) = good[draw(seed, 1) % good.len()];
        let body = spoilt(body.as_bytes(), seed);
        let answer = service.send("POST", &format!("{day}{path}"), &[], &body);
        let sent = String::from_utf8_lossy(&body);
        assert!((200..500).contains(&answer.status), "{sent}: {answer:?}");
        if answer.status >= 400 {
            refused += 1;
            assert!(
                answer.json["code"].as_str().is_some_and(|code| code.starts_with('V')),
                "{sent}: {answer:?}"
            );
        }
    }
    assert!(refused > REQUESTS / 2, "{refused} were refused");
    assert_eq!(service.get(&format!("{day}/state")).status, 200);
}

#[test]
fn deep_and_huge_requests_are_refused() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let deep = "[".repeat(100_000);
    let huge = format!(r#"{{"type":"ready","aircraft":"{}"}}"#, "A".repeat(1_000_000));
    for body in [deep, huge] {
        let answer = service.send("POST", &format!("{day}/events"), &[], body.as_bytes());
        assert!((400..500).contains(&answer.status), "{}", answer.status);
        assert!(answer.json.to_string().len() < 1_000, "the answer does not repeat the request");
    }
}
