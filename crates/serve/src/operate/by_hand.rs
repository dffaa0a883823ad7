//! A day on which people decide: the operator reports events, and time stops until all waiting
//! aircraft have a decision.
//!
//! People decide in their own order, cancel decisions before the aircraft has departed, and report
//! events. The simulated day follows them.

use std::collections::HashMap;
use std::thread;
use std::time::{Duration, Instant};

use serde::Deserialize;
use vertifleet_core::{AircraftIx, Stop, Stopped, Time, VertiportIx};
use vertifleet_sim::live::Reporter;

use super::Operation;
use super::client::{Client, Heard};
use crate::error::Error;
use crate::moment::Moment;

/// Interval at which the operator checks for actions of others.
const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// The people who decide, and the day that follows them.
pub(super) struct People<'a> {
    operation: &'a Operation,
    day: &'a str,
    client: &'a mut Client,
    stop: &'a Stop,
    /// Where each aircraft stood before the latest decision that people took for it.
    stood: HashMap<AircraftIx, VertiportIx>,
}

/// An aircraft in the service's state.
#[derive(Deserialize)]
struct Known {
    id: String,
    phase: String,
    ready: Moment,
    needs_decision: bool,
}

#[derive(Deserialize)]
struct Fleet {
    aircraft: Vec<Known>,
}

impl<'a> People<'a> {
    pub(super) fn new(
        operation: &'a Operation,
        day: &'a str,
        client: &'a mut Client,
        stop: &'a Stop,
    ) -> Self {
        Self { operation, day, client, stop, stood: HashMap::new() }
    }

    /// Plays the day until its last decision. `watch` is called with the time of each decision and
    /// the time that people took.
    ///
    /// # Errors
    /// Returns [`Error::NoAnswer`] if the service does not answer.
    pub(super) fn play(
        mut self,
        reporter: &mut Reporter,
        mut watch: impl FnMut(Time, Duration),
    ) -> Result<Result<(), Stopped>, Error> {
        let start = self.operation.day.operations.start;
        let mut now = None;
        // The clock of the day if it did not wait for decisions.
        let mut begun = Instant::now();
        let mut asked = begun;
        while let Some(decision) = reporter.next_decision() {
            if self.stop.is_requested() {
                return Ok(Err(Stopped));
            }
            let at = now.unwrap_or(start);
            if now == Some(decision.time) {
                let look = Instant::now();
                thread::sleep(POLL_INTERVAL);
                if self.follow(reporter, at)? {
                    watch(at, asked.elapsed());
                    asked = Instant::now();
                }
                begun += look.elapsed();
                continue;
            }
            // Each event is reported at its time.
            let next = match self.operation.speed {
                Some(_) => reporter.next_report_time(decision.time).unwrap_or(decision.time),
                None => decision.time,
            };
            // Until the next decision is due, earlier ones can still be cancelled.
            if !self.is_due(begun, next.since(start)) {
                thread::sleep(POLL_INTERVAL);
                if now.is_some() {
                    self.follow(reporter, at)?;
                }
                continue;
            }
            // The next event depends on the actions of people so far.
            let before = reporter.clone();
            if !self.client.report_as_heard(self.day, reporter, next)? {
                *reporter = before;
                self.follow(reporter, at)?;
                continue;
            }
            now = Some(next.max(at));
            asked = Instant::now();
        }
        Ok(Ok(()))
    }

    fn is_due(&self, begun: Instant, day_s: u32) -> bool {
        let speed = self.operation.speed;
        speed.is_none_or(|speed| begun.elapsed().as_secs_f64() >= f64::from(day_s) / speed)
    }

    /// Applies the actions of people since the last check to the day. Returns whether they have
    /// decided anything.
    fn follow(&mut self, reporter: &mut Reporter, now: Time) -> Result<bool, Error> {
        let heard = self.client.heard(self.day)?;
        let (mut decides, mut is_otherwise) = (false, false);
        for heard in heard {
            match heard {
                Heard::Decided { aircraft, to } => {
                    let aircraft = self.client.aircraft(&aircraft)?;
                    let to = self.client.vertiport(&to)?;
                    let stood = reporter.decide(now, aircraft, to);
                    let stood = stood.map_err(|refusal| self.client.wrong(&refusal.to_string()))?;
                    self.stood.insert(aircraft, stood);
                    decides = true;
                }
                Heard::Undone { aircraft } => {
                    let aircraft = self.client.aircraft(&aircraft)?;
                    if let Some(stood) = self.stood.remove(&aircraft) {
                        reporter.take_back(aircraft, stood, now);
                    }
                    is_otherwise = true;
                }
                Heard::Other => is_otherwise = true,
            }
        }
        if is_otherwise {
            self.ask_who_is_ready(reporter, now)?;
        }
        Ok(decides)
    }

    /// Reads from the service which aircraft is ready when, since people report events that the
    /// simulated day does not contain.
    fn ask_who_is_ready(&mut self, reporter: &mut Reporter, now: Time) -> Result<(), Error> {
        let fleet: Fleet = self.client.get(&format!("/v1/days/{}/state", self.day))?;
        for known in fleet.aircraft.iter().filter(|known| known.phase == "standing") {
            let aircraft = self.client.aircraft(&known.id)?;
            let ready = if known.needs_decision { now } else { known.ready.time() };
            reporter.set_ready(aircraft, ready);
        }
        Ok(())
    }
}
