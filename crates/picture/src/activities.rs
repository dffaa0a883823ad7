//! What each aircraft does at every moment of a played day: it flies, charges, or is out of
//! service. All other time it stands at a vertiport without charging.
//!
//! A battery charges from a landing, or from the start of operations, until it is full or its
//! aircraft leaves (page Model, section Energy). On days that charge as needed this goes on through
//! holds and through the wait for a take-off. An aircraft leaves its stand only when its take-off
//! delay is over.

use vertifleet_core::{AircraftIx, Scenario, Time, TypeIx, VertiportIx, whole_mwh};
use vertifleet_sim::{Landed, Legs, TraceRow, first_decision, refill_s};

/// An activity of an aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Activity<'a> {
    /// It is on this flight, from leaving its stand until arrival.
    Flight(&'a TraceRow),
    /// Its battery charges.
    Charging,
    /// An outage keeps it on the ground, and its battery is full.
    OutOfService,
}

/// A time for which an aircraft has one activity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span<'a> {
    /// The aircraft.
    pub aircraft: AircraftIx,
    /// What it does.
    pub activity: Activity<'a>,
    /// When it begins.
    pub start: Time,
    /// When it ends, after the start.
    pub end: Time,
}

/// The activities of all aircraft until a time. Those of an aircraft are in the order of time and
/// do not overlap.
pub fn activities<'a>(day: &'a Scenario, rows: &'a [TraceRow], until: Time) -> Vec<Span<'a>> {
    let world = World { day, legs: Legs::of(day) };
    let mut spans = Spans { until, found: Vec::new() };
    let all = AircraftIx::all(day.aircraft.len());
    let mut fleet: Vec<OnGround> = all.map(|one| world.at_start(one)).collect();
    for row in rows {
        let one = &mut fleet[row.aircraft.at()];
        one.stand_until(row.time, &mut spans);
        world.decide(one, row);
        if row.from != row.to {
            world.fly(one, row, &mut spans);
        }
    }
    for one in &mut fleet {
        one.stand_until(until, &mut spans);
    }
    spans.found
}

/// The spans found so far, which end by `until`.
struct Spans<'a> {
    until: Time,
    found: Vec<Span<'a>>,
}

impl<'a> Spans<'a> {
    fn add(&mut self, aircraft: AircraftIx, activity: Activity<'a>, (start, end): (Time, Time)) {
        let end = end.min(self.until);
        if start < end {
            self.found.push(Span { aircraft, activity, start, end });
        }
    }
}

/// An aircraft on the ground.
struct OnGround {
    aircraft: AircraftIx,
    /// The end of the spans that have been entered.
    since: Time,
    /// When its battery is full, if it stays.
    full: Time,
    /// The time for which an outage keeps it after its turnaround, if it landed within one.
    outage: Option<(Time, Time)>,
}

impl OnGround {
    /// Enters the time on the ground until `end`. A battery charges during an outage too.
    fn stand_until(&mut self, end: Time, spans: &mut Spans<'_>) {
        let end = end.max(self.since);
        let charged = self.full.clamp(self.since, end);
        spans.add(self.aircraft, Activity::Charging, (self.since, charged));
        if let Some((from, to)) = self.outage {
            spans.add(self.aircraft, Activity::OutOfService, (from.max(charged), to.min(end)));
        }
        self.since = end;
    }
}

/// A day and its legs.
struct World<'a> {
    day: &'a Scenario,
    legs: Legs,
}

impl<'a> World<'a> {
    fn at_start(&self, aircraft: AircraftIx) -> OnGround {
        let start = self.day.operations.start;
        let one = &self.day.aircraft[aircraft.at()];
        let full = if self.legs.charge_as_needed() {
            self.full_at(one.kind, one.at, (start, whole_mwh(self.day.start_charge_kwh(one))))
        } else {
            first_decision(self.day, aircraft)
        };
        OnGround { aircraft, since: start, full, outage: None }
    }

    /// Reads the charge that the trace states at a decision. On a live day, a report may have
    /// changed it.
    fn decide(&self, one: &mut OnGround, row: &TraceRow) {
        if self.legs.charge_as_needed() {
            let kind = self.day.aircraft[row.aircraft.at()].kind;
            one.full = self.full_at(kind, row.from, (row.time, whole_mwh(row.charge_kwh)));
        }
    }

    /// Enters the wait for the take-off and the flight.
    fn fly(&self, one: &mut OnGround, row: &'a TraceRow, spans: &mut Spans<'a>) {
        let kind = self.day.aircraft[row.aircraft.at()].kind;
        let leg = self.legs.leg(kind, row.from, row.to);
        let arrival = row.arrival.max(one.since);
        let left_s = row.arrival.seconds().saturating_sub(leg.flight_s);
        let left = Time::from_seconds(left_s).max(row.takeoff).clamp(one.since, arrival);
        one.stand_until(left, spans);
        spans.add(row.aircraft, Activity::Flight(row), (left, arrival));
        one.since = arrival;
        one.full = if self.legs.charge_as_needed() {
            let battery = self.legs.battery(kind, row.from, whole_mwh(row.charge_kwh));
            let decided = Landed { arrival: row.time, battery };
            let lands = self.legs.lands_with(kind, (row.from, row.to), decided, left);
            self.full_at(kind, row.to, (arrival, lands.mwh))
        } else {
            let kind = &self.day.aircraft_types[kind.at()];
            let refill_s = refill_s(leg.energy_kwh, kind, &self.day.vertiports[row.to.at()]);
            (row.arrival + refill_s).min(row.ready)
        };
        let mut outages = self.day.disturbances.outages.iter();
        let lands_in_one = outages.any(|outage| {
            outage.aircraft == row.aircraft && (outage.start..outage.end).contains(&row.arrival)
        });
        one.outage = lands_in_one.then_some((row.arrival + leg.ground_s, row.ready));
    }

    /// When a battery is full that has a charge at a time and stays, mWh.
    fn full_at(&self, kind: TypeIx, at: VertiportIx, (time, mwh): (Time, u64)) -> Time {
        let rate = self.legs.rate(kind, at);
        time + whole_seconds(rate.to_full_s(rate.battery(mwh), 0))
    }
}

/// Rounds up to whole seconds.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "never negative, and far below 2^32"
)]
fn whole_seconds(seconds: f64) -> u32 {
    seconds.ceil().min(1e9) as u32
}
