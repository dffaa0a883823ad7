//! Many readers of one day's stream, and the delay of events to them.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tokio::io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader};
use tokio::net::TcpStream;

/// Time from one event to the next.
const PACE: Duration = Duration::from_millis(2);
/// Clients that send events, in turn.
const SENDERS: u64 = 16;
/// Deliveries are counted by their time in milliseconds; the last count is of longer ones.
const COUNTS: usize = 1_000;

type Counts = Arc<Vec<AtomicU64>>;

/// Lets this many clients read a day, to which events are sent for some time.
pub(crate) fn load(url: &str, clients: u64, time: Duration) -> Value {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()
        .expect("a runtime");
    let post = |path: &str, body: &Value| -> Value {
        let answer = ureq::post(format!("{url}{path}")).send(body.to_string().as_bytes());
        let text = answer.expect("the service answers").body_mut().read_to_vec().expect("a body");
        serde_json::from_slice(&text).expect("JSON")
    };
    let made = post("/v1/days", &json!({"network": "paper", "policy": "greedy"}));
    let day = format!("/v1/days/{}", made["id"].as_str().expect("an id"));
    let counts: Counts = Arc::new((0..COUNTS).map(|_| AtomicU64::new(0)).collect());
    let begun = Instant::now();
    let address = url.strip_prefix("http://").expect("an address").to_owned();
    for _ in 0..clients {
        let reader = read(address.clone(), day.clone(), begun, Arc::clone(&counts));
        runtime.spawn(reader);
    }
    std::thread::sleep(Duration::from_secs(2));
    let started = Instant::now();
    let send_events = |sender: u64| {
        let (agent, mut sent) = (ureq::agent(), 0_u64);
        while started.elapsed() < time {
            let due = PACE.mul_f64((sender + SENDERS * sent) as f64);
            if let Some(early) = due.checked_sub(started.elapsed()) {
                std::thread::sleep(early);
            }
            let mark = begun.elapsed().as_micros().to_string();
            let event = json!({"type": "out_of_service", "aircraft": "A01", "reason": mark});
            let answer =
                agent.post(format!("{url}{day}/events")).send(event.to_string().as_bytes());
            answer.expect("the service answers").body_mut().read_to_vec().expect("a body");
            sent += 1;
        }
        sent
    };
    let sent: u64 = std::thread::scope(|scope| {
        let send_events = &send_events;
        let senders: Vec<_> =
            (0..SENDERS).map(|sender| scope.spawn(move || send_events(sender))).collect();
        senders.into_iter().map(|sender| sender.join().expect("it sends")).sum()
    });
    let took = started.elapsed();
    std::thread::sleep(Duration::from_secs(2));
    let counts: Vec<u64> = counts.iter().map(|count| count.load(Ordering::Relaxed)).collect();
    let delivered: u64 = counts.iter().sum();
    let within_ms = |share: f64| {
        let mut left = share * delivered as f64;
        counts.iter().position(|&count| {
            left -= count as f64;
            left <= 0.0
        })
    };
    json!({
        "readers": clients,
        "events_per_s": (sent as f64 / took.as_secs_f64()).round(),
        "delivered": delivered,
        "missing": clients * sent - delivered,
        "median_ms": within_ms(0.5),
        "p99_ms": within_ms(0.99),
        "p999_ms": within_ms(0.999),
    })
}

async fn read(address: String, day: String, begun: Instant, counts: Counts) {
    let mut socket = TcpStream::connect(address).await.expect("it listens");
    let head = format!("GET {day}/stream HTTP/1.1\r\nhost: localhost\r\n\r\n");
    socket.write_all(head.as_bytes()).await.expect("it is sent");
    let mut lines = BufReader::new(socket).lines();
    while let Ok(Some(line)) = lines.next_line().await {
        let mark = line.split_once("\"reason\":\"").and_then(|(_, rest)| rest.split('"').next());
        if let Some(sent_us) = mark.and_then(|mark| mark.parse::<u64>().ok()) {
            let now_us = u64::try_from(begun.elapsed().as_micros()).unwrap_or(u64::MAX);
            let ms = usize::try_from((now_us - sent_us) / 1_000).unwrap_or(COUNTS);
            counts[ms.min(COUNTS - 1)].fetch_add(1, Ordering::Relaxed);
        }
    }
}
