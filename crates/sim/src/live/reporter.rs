//! Plays a known day and reports it as a live day receives it: event by event, each when it becomes
//! known.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use vertifleet_core::{AircraftIx, Battery, Matrix, Scenario, Time, VertiportIx};

use super::report::{Report, Routes};
use crate::{DayTotals, Decision, Refusal, Simulation, TraceRow};

/// Plays a day that is known, and reports what happens on it.
///
/// A live day that receives each of these reports before any later decision shows policies, at
/// every decision, what they observe in the simulation.
#[derive(Debug, Clone)]
pub struct Reporter {
    day: Simulation,
    /// The future reports, with their times; of several with one time, the first entered comes
    /// first.
    later: BinaryHeap<Reverse<(Time, u64, usize)>>,
    reports: Vec<Option<Report>>,
    entered: u64,
    /// The latest end of outage that was reported of each aircraft.
    out_until: Vec<Time>,
    /// When each aircraft had landed before its latest decision, and with which charge.
    landings: Vec<(Time, Battery)>,
}

impl Reporter {
    /// A day before its first decision.
    pub fn new(scenario: &Arc<Scenario>) -> Self {
        let fleet = scenario.aircraft.len();
        let mut reporter = Self {
            day: Simulation::new(Arc::clone(scenario)),
            later: BinaryHeap::new(),
            reports: Vec::new(),
            entered: 0,
            out_until: vec![Time::default(); fleet],
            landings: vec![Default::default(); fleet],
        };
        if let Some(forecast) = &scenario.disturbances.forecast {
            for (period, (actual, forecast)) in scenario.demand.iter().zip(forecast).enumerate() {
                let pairs = changed_pairs(actual, forecast);
                if !pairs.is_empty() {
                    // Periods that begin after the last decision are reported right after it.
                    let (start, end) = (scenario.operations.start, scenario.operations.end);
                    let begins = scenario.periods[period].max(start).min(end + 1);
                    reporter.report(begins, Report::Demand { period, pairs });
                }
            }
        }
        let mut changes: Vec<(Time, bool, VertiportIx, VertiportIx)> = Vec::new();
        for closure in scenario.disturbances.closures.iter().filter(|closure| !closure.known) {
            let route = closure.route;
            let back = route.both_ways.then_some((route.to, route.from));
            for (from, to) in [(route.from, route.to)].into_iter().chain(back) {
                changes.push((closure.start, true, from, to));
                changes.push((closure.end, false, from, to));
            }
        }
        changes.sort_by_key(|&(time, closes, ..)| (time, !closes));
        reporter.report_closures(&changes);
        reporter
    }

    /// Closures may overlap, so a route is open again when the last of them ends. If that is one
    /// that was known, its end is reported again.
    fn report_closures(&mut self, changes: &[(Time, bool, VertiportIx, VertiportIx)]) {
        let size = self.day.scenario().vertiports.len();
        let mut in_force = vec![0_u32; size * size];
        let (start, end) =
            (self.day.scenario().operations.start, self.day.scenario().operations.end);
        for &(time, closes, from, to) in changes {
            let in_force = &mut in_force[from.at() * size + to.at()];
            *in_force = if closes { *in_force + 1 } else { *in_force - 1 };
            let routes = Routes::Way { from, to };
            let known = self.day.closures().known().spans(from, to);
            let until = known.iter().find(|span| (span.start..span.end).contains(&time));
            let report = match until {
                _ if *in_force > 0 => Report::Closed { routes, until: None },
                Some(span) => Report::Closed { routes, until: Some(span.end) },
                None => Report::Reopened { routes },
            };
            self.report(time.max(start).min(end + 1), report);
        }
    }

    fn report(&mut self, time: Time, report: Report) {
        self.later.push(Reverse((time, self.entered, self.reports.len())));
        self.reports.push(Some(report));
        self.entered += 1;
    }

    /// The next decision of the day, or `None` once it is over.
    pub fn next_decision(&mut self) -> Option<Decision> {
        self.day.next_decision()
    }

    /// The next report that becomes known up to a time.
    pub fn next_report(&mut self, until: Time) -> Option<(Time, Report)> {
        loop {
            let &Reverse((time, _, at)) = self.later.peek()?;
            if time > until {
                return None;
            }
            self.later.pop();
            // A report that was taken back is skipped.
            if let Some(report) = self.reports[at].take() {
                return Some((time, report));
            }
        }
    }

    /// When the next report becomes known that is up to a time.
    pub fn next_report_time(&mut self, until: Time) -> Option<Time> {
        while let Some(&Reverse((time, _, at))) = self.later.peek()
            && time <= until
        {
            if self.reports[at].is_some() {
                return Some(time);
            }
            // It was taken back.
            self.later.pop();
        }
        None
    }

    /// Carries the decision out that is taken now. What it leads to is reported when it becomes
    /// known.
    ///
    /// # Errors
    /// The errors of [`Simulation::apply`].
    pub fn apply(&mut self, choice: VertiportIx) -> Result<(), Refusal> {
        if let Some(decision) = self.day.next_decision() {
            self.keep_landing(decision.aircraft);
        }
        let row = self.day.apply(choice)?;
        self.enter(&row);
        Ok(())
    }

    /// Carries out what people have decided for an aircraft at a time, in any order and even
    /// against the rules of the simulated day, because people may have information that the
    /// simulation lacks. Returns where the aircraft stood.
    ///
    /// # Errors
    /// Returns [`Refusal::NoSuchVertiport`].
    pub fn decide(
        &mut self,
        time: Time,
        aircraft: AircraftIx,
        to: VertiportIx,
    ) -> Result<VertiportIx, Refusal> {
        let vertiports = self.day.scenario().vertiports.len();
        if to.at() >= vertiports {
            return Err(Refusal::NoSuchVertiport { position: to.0, vertiports });
        }
        let at = self.day.place[aircraft.at()];
        let decision = Decision { time, aircraft, at, index: self.day.ledger.decisions() };
        self.keep_landing(aircraft);
        let row = match self.day.carry_out(&decision, to) {
            Ok(row) => row,
            Err(_) => self.day.fly(&decision, to),
        };
        self.enter(&row);
        Ok(at)
    }

    /// Takes back what people have decided for an aircraft, before it has departed.
    pub fn take_back(&mut self, aircraft: AircraftIx, from: VertiportIx, ready: Time) {
        let is_of_flight = |report: &Report| match report {
            Report::Delayed { aircraft: one, .. }
            | Report::Departed { aircraft: one, .. }
            | Report::Landed { aircraft: one, .. } => *one == aircraft,
            _ => false,
        };
        for report in &mut self.reports {
            if report.as_ref().is_some_and(is_of_flight) {
                *report = None;
            }
        }
        self.day.stands.leave(aircraft, self.day.place[aircraft.at()]);
        self.day.stands.take(aircraft, from, false);
        self.day.place[aircraft.at()] = from;
        let (arrival, battery) = self.landings[aircraft.at()];
        self.day.arrival[aircraft.at()] = arrival;
        self.day.batteries.restore(aircraft, battery);
        self.set_ready(aircraft, ready);
    }

    /// Keeps the latest landing of an aircraft, in case its next decision is taken back.
    fn keep_landing(&mut self, aircraft: AircraftIx) {
        let arrival = self.day.arrival[aircraft.at()];
        self.landings[aircraft.at()] = (arrival, self.day.batteries.kept(aircraft));
    }

    /// Sets when an aircraft is ready, where people have better information.
    pub fn set_ready(&mut self, aircraft: AircraftIx, ready: Time) {
        self.day.queue.set(aircraft, ready);
    }

    /// Has what follows from a decision reported.
    fn enter(&mut self, row: &TraceRow) {
        if row.from != row.to {
            let (aircraft, time) = (row.aircraft, row.time);
            let kind = self.day.scenario().aircraft[aircraft.at()].kind;
            let flight_s = self.day.legs().leg(kind, row.from, row.to).flight_s;
            let late_s = row.arrival.since(row.takeoff + flight_s);
            if late_s > 0 {
                self.report(time, Report::Delayed { aircraft, until: row.takeoff + late_s });
            }
            let departed = Report::Departed { aircraft, to: None, passengers: None };
            self.report(row.takeoff + late_s, departed);
            self.report(row.arrival, Report::Landed { aircraft, at: None, charge_kwh: None });
            self.report_outages(aircraft, time, row.arrival);
        }
    }

    /// Reports the outages that keep an aircraft on the ground after a landing, each when it is
    /// known.
    fn report_outages(&mut self, aircraft: AircraftIx, decided: Time, arrival: Time) {
        let scenario = Arc::clone(self.day.scenario());
        let holds = scenario
            .disturbances
            .outages
            .iter()
            .filter(|outage| outage.aircraft == aircraft)
            .filter(|outage| (outage.start..outage.end).contains(&arrival));
        let mut holds: Vec<_> = holds.copied().collect();
        holds.sort_by_key(|outage| outage.start);
        for outage in holds {
            let until = &mut self.out_until[aircraft.at()];
            if outage.end > *until {
                *until = outage.end;
                let report = Report::OutOfService { aircraft, until: Some(outage.end) };
                self.report(outage.start.max(decided), report);
            }
        }
    }

    /// The day's numbers so far.
    pub fn totals(&self) -> DayTotals {
        self.day.totals()
    }

    /// The simulated day.
    pub fn day(&self) -> &Simulation {
        &self.day
    }
}

/// The pairs whose actual demand differs from the forecast.
fn changed_pairs(
    actual: &Matrix<u32>,
    forecast: &Matrix<u32>,
) -> Vec<(VertiportIx, VertiportIx, u32)> {
    let size = actual.size();
    let all =
        VertiportIx::all(size).flat_map(|from| VertiportIx::all(size).map(move |to| (from, to)));
    all.filter(|&pair| actual[pair] != forecast[pair])
        .map(|pair| (pair.0, pair.1, actual[pair]))
        .collect()
}
