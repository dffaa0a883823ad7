//! The simulated operator: plays a whole day through the public API, as the people and systems of
//! an operator would. It is the demo, the load, and the end-to-end test.

mod by_hand;
mod client;

use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use vertifleet_core::{Scenario, Stop, Stopped, Time};
use vertifleet_sim::DayTotals;
use vertifleet_sim::live::Reporter;

use self::client::Client;
use crate::calendar::Calendar;
use crate::error::Error;

/// A day to be operated.
#[derive(Debug, Clone)]
pub struct Operation {
    /// Where the service listens, for example `http://127.0.0.1:8080`.
    pub url: String,
    /// The day, with everything that will happen on it.
    pub day: Arc<Scenario>,
    /// The time zone of the day, if it has one; the date is today's there.
    pub time_zone: Option<String>,
    /// The policy that decides.
    pub policy: String,
    /// The token of the operator, if the service requires one.
    pub token: Option<String>,
    /// A PEM file with certificates to trust, in place of the public ones.
    pub trusted: Option<PathBuf>,
    /// Seconds of the day per second; `None` for full speed.
    pub speed: Option<f64>,
    /// Whether others decide, such as people at their consoles. The operator reports the time of
    /// each decision, and the day waits until it is taken.
    pub by_hand: bool,
}

impl Operation {
    /// A day on which a policy of a local service decides, at full speed.
    pub fn new(url: &str, day: Arc<Scenario>, policy: &str) -> Self {
        Self {
            url: url.to_owned(),
            day,
            time_zone: None,
            policy: policy.to_owned(),
            token: None,
            trusted: None,
            speed: None,
            by_hand: false,
        }
    }
}

/// The result of a day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OperationReport {
    /// The id of the day in the service.
    pub day: String,
    /// Its numbers, as the service has them.
    #[serde(flatten)]
    pub totals: DayTotals,
    /// Number of events, decisions among them.
    pub events: u64,
    /// Half of the decisions took at most this long from request to answer, milliseconds.
    pub decision_median_ms: f64,
    /// 99 % of the decisions took at most this long, milliseconds.
    pub decision_p99_ms: f64,
    /// Requests that were repeated because the service did not answer.
    pub sent_again: u64,
}

/// Operates a day to its end. `watch` is called with the time of each decision and its duration.
///
/// # Errors
/// Returns [`Error::NoAnswer`] if the service does not answer or refuses a request.
pub fn operate(
    operation: &Operation,
    stop: &Stop,
    mut watch: impl FnMut(Time, Duration),
) -> Result<Option<OperationReport>, Error> {
    let mut client = Client::new(operation)?;
    let made: Made = client.post("/v1/days", &new_day(operation))?;
    let mut reporter = Reporter::new(&operation.day);
    let begun = Instant::now();
    let start = operation.day.operations.start;
    let mut took = Vec::new();
    if operation.by_hand {
        let people = by_hand::People::new(operation, &made.id, &mut client, stop);
        let played = people.play(&mut reporter, |time, asked| {
            took.push(asked.as_secs_f64() * 1e3);
            watch(time, asked);
        });
        if let Err(Stopped) = played? {
            return Ok(None);
        }
    }
    while let Some(decision) = reporter.next_decision() {
        let pace = Pace { speed: operation.speed, begun, start, stop };
        if let Err(Stopped) =
            report_in_time(&mut client, &made.id, &mut reporter, pace, decision.time)?
        {
            return Ok(None);
        }
        if let Err(Stopped) = pace.wait(decision.time) {
            return Ok(None);
        }
        let asked = Instant::now();
        let aircraft = &operation.day.aircraft[decision.aircraft.at()].id;
        let taken = client.decide(&made.id, aircraft, decision.time)?;
        let asked = asked.elapsed();
        took.push(asked.as_secs_f64() * 1e3);
        let to = client.vertiport(&taken)?;
        reporter.apply(to).map_err(|refusal| client.wrong(&refusal.to_string()))?;
        watch(decision.time, asked);
    }
    let pace = Pace { speed: operation.speed, begun, start, stop };
    let end = Time::from_seconds(u32::MAX);
    if let Err(Stopped) = report_in_time(&mut client, &made.id, &mut reporter, pace, end)? {
        return Ok(None);
    }
    let state: State = client.get(&format!("/v1/days/{}/state", made.id))?;
    took.sort_by(f64::total_cmp);
    let rank = |share: f64| {
        let at = (share * took.len() as f64).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a rank")]
        let at = (at as usize).saturating_sub(1);
        took.get(at).copied().unwrap_or(0.0)
    };
    Ok(Some(OperationReport {
        day: made.id,
        totals: state.totals,
        events: state.seq,
        decision_median_ms: rank(0.5),
        decision_p99_ms: rank(0.99),
        sent_again: client.sent_again,
    }))
}

/// The day as forecast; the service receives nothing else about it in advance.
fn new_day(operation: &Operation) -> Value {
    let scenario: Value = serde_json::from_str(&operation.day.expected().to_json())
        .expect("a scenario is written as JSON");
    let mut day = json!({ "scenario": scenario, "policy": operation.policy });
    let zone = operation.time_zone.as_deref();
    if let Some((zone, date)) = zone.and_then(|zone| Some((zone, Calendar::today(zone)?))) {
        day["date"] = date.into();
        day["time_zone"] = zone.into();
    }
    day
}

/// Reports everything that becomes known up to a time: each event at its time, or all at once at
/// full speed.
fn report_in_time(
    client: &mut Client,
    day: &str,
    reporter: &mut Reporter,
    pace: Pace<'_>,
    until: Time,
) -> Result<Result<(), Stopped>, Error> {
    while pace.speed.is_some()
        && let Some(time) = reporter.next_report_time(until)
    {
        if let Err(stopped) = pace.wait(time) {
            return Ok(Err(stopped));
        }
        client.report(day, reporter, time)?;
    }
    client.report(day, reporter, until)?;
    Ok(Ok(()))
}

/// The speed of a day that began at an instant.
#[derive(Clone, Copy)]
struct Pace<'a> {
    speed: Option<f64>,
    begun: Instant,
    /// The time of the day at that instant.
    start: Time,
    stop: &'a Stop,
}

impl Pace<'_> {
    /// Waits until a time of the day has come.
    fn wait(self, time: Time) -> Result<(), Stopped> {
        loop {
            self.stop.check()?;
            let Some(speed) = self.speed else { return Ok(()) };
            let due = Duration::from_secs_f64(f64::from(time.since(self.start)) / speed);
            let Some(left) = due.checked_sub(self.begun.elapsed()) else { return Ok(()) };
            thread::sleep(left.min(Duration::from_millis(100)));
        }
    }
}

#[derive(Deserialize)]
struct Made {
    id: String,
}

#[derive(Deserialize)]
struct State {
    seq: u64,
    totals: DayTotals,
}
