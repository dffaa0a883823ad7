//! Requests that make no sense: each gets an answer with a code, and the day stays as it is.

use std::hash::{BuildHasher as _, BuildHasherDefault, DefaultHasher};

use crate::api::service;

const REQUESTS: u32 = 1_000;

/// A number that looks random and is the same every time.
fn draw(seed: u32, at: u32) -> usize {
    let hash = BuildHasherDefault::<DefaultHasher>::default().hash_one((seed, at));
    usize::try_from(hash >> 33).expect("31 bits")
}

/// A body that is cut, changed or repeated somewhere.
fn spoilt(good: &str, seed: u32) -> Vec<u8> {
    let mut body = good.as_bytes().to_vec();
    for change in 0..=u32::try_from(draw(seed, 0) % 3).expect("few") {
        let at = draw(seed, 10 + change) % body.len();
        match draw(seed, 20 + change) % 4 {
            0 => body[at] = u8::try_from(draw(seed, 30 + change) % 256).expect("a byte"),
            1 => {
                body.remove(at);
            }
            2 => body.insert(at, b"{}[]\",:0-9e"[draw(seed, 40 + change) % 11]),
            _ => body.truncate(at.max(1)),
        }
        if body.is_empty() {
            body.push(b'?');
        }
    }
    body
}

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
        let body = spoilt(body, seed);
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
