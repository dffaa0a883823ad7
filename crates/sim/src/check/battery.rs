//! Batteries on days that charge as needed (page Model, section Energy): what each holds when its
//! aircraft decides, and when it suffices for a flight.
//!
//! A charge follows from that at the latest landing, in whole milliwatt-hours. Where its rounding
//! is in doubt, two are possible. After a row that states a wrong charge, later rows may go on from
//! that charge as well as from the right one, so that one mistake gives one finding.

use vertifleet_core::{Charging, Scenario, VertiportIx};

use super::Rule;
use super::charger::Charger;
use super::event::{Event, clock};
use super::expected::Expected;
use super::report::Findings;
use super::rounding::{both_nearest, whole_mwh};
use crate::TraceRow;

/// The most charges at landing that are kept for an aircraft.
const POSSIBLE: usize = 4;

/// The batteries of the fleet.
#[derive(Debug)]
pub(super) struct Batteries<'a> {
    scenario: &'a Scenario,
    of: Vec<Battery>,
}

/// More than the seconds that any battery takes to charge: 5,000 kWh at 1 kW.
const LONGEST_S: u64 = 20_000_000;

/// The battery of one aircraft since it landed, or since operations started.
#[derive(Debug)]
struct Battery {
    at: VertiportIx,
    landed_s: u64,
    /// The possible charges at landing in whole milliwatt-hours, the likeliest first; at least one.
    landed_mwh: Vec<u64>,
}

/// A battery that charges at a vertiport.
#[derive(Debug, Clone, Copy)]
struct Plugged<'a> {
    charger: Charger<'a>,
    battery_mwh: u64,
    since_s: u64,
}

impl<'a> Batteries<'a> {
    /// The batteries when operations start, or `None` on days that charge to full.
    pub(super) fn at_start(scenario: &'a Scenario) -> Option<Self> {
        if scenario.operations.charging == Charging::ToFull {
            return None;
        }
        let battery = |aircraft: &vertifleet_core::Aircraft| {
            let full_kwh = scenario.aircraft_types[aircraft.kind.at()].battery_kwh;
            Battery {
                at: aircraft.at,
                landed_s: scenario.operations.start.seconds().into(),
                landed_mwh: vec![whole_mwh(aircraft.start_charge_kwh.unwrap_or(full_kwh))],
            }
        };
        Some(Self { scenario, of: scenario.aircraft.iter().map(battery).collect() })
    }

    /// Judges the charge that a row states for its decision. Returns whether the battery is full
    /// then.
    pub(super) fn decides(&mut self, event: &Event<'_>, findings: &mut Findings) -> bool {
        let battery = &mut self.of[event.row.aircraft.at()];
        let plugged = battery.plugged(self.scenario, event);
        let time_s = u64::from(event.row.time.seconds());
        let stated = stated_mwh(event.row);
        let agrees =
            |mwh| stated.is_some_and(|stated| plugged.held_mwh(mwh, time_s).contains(&stated));
        if battery.keep(agrees) {
            return stated == Some(plugged.battery_mwh);
        }
        let [_, due_mwh] = plugged.held_mwh(battery.landed_mwh[0], time_s);
        findings.add_event(Rule::Charge, event, || {
            format!(
                "states {} kWh, but the battery holds {}",
                event.row.charge_kwh,
                due_mwh as f64 / 1e6
            )
        });
        let claimed = stated.and_then(|stated| plugged.landed_with(stated, time_s));
        battery.landed_mwh.truncate(POSSIBLE - 1);
        battery.landed_mwh.extend(claimed);
        due_mwh == plugged.battery_mwh
    }

    /// Judges the take-off of a flight, and determines the rest of the flight from it. If the
    /// take-off is wrong, the arrival tells whether the flight left at the due time after all.
    pub(super) fn take_off(&mut self, event: &Event<'_>, findings: &mut Findings) -> Expected {
        let (scenario, row) = (self.scenario, event.row);
        let battery = &mut self.of[row.aircraft.at()];
        let plugged = battery.plugged(scenario, event);
        let (time_s, takeoff_s) = (row.time.seconds().into(), row.takeoff.seconds().into());
        let mut expected = Expected::of(scenario, event, takeoff_s);
        if expected.within_range(event) {
            let needed_mwh = expected.needed_mwh(event);
            if battery.keep(|mwh| plugged.suffices_first(mwh, needed_mwh, time_s, takeoff_s)) {
                by_end(scenario, event, findings);
            } else {
                let due_s = plugged.first_second(battery.landed_mwh[0], needed_mwh, time_s);
                findings.add_event(Rule::TakeoffTime, event, || {
                    format!(
                        "takes off {}, but the battery holds the {} kWh that it needs at {}",
                        row.takeoff,
                        needed_mwh as f64 / 1e6,
                        clock(due_s)
                    )
                });
                let due = Expected::of(scenario, event, due_s);
                if due.arrival_s == u64::from(row.arrival.seconds()) {
                    expected = due;
                }
            }
        }
        battery.fly(&plugged, event, &expected);
        expected
    }
}

/// Judges whether a flight waits beyond the end of operations. A decision after the end is wrong
/// for itself.
fn by_end(scenario: &Scenario, event: &Event<'_>, findings: &mut Findings) {
    let (row, end) = (event.row, scenario.operations.end);
    if row.time <= end && end < row.takeoff {
        findings.add_event(Rule::TakeoffByEnd, event, || {
            format!("takes off {}, but operations end at {end}", row.takeoff)
        });
    }
}

/// What a row states as its charge, if that is a whole number of milliwatt-hours.
fn stated_mwh(row: &TraceRow) -> Option<u64> {
    let mwh = whole_mwh(row.charge_kwh.clamp(0.0, 1e9));
    ((1e6 * row.charge_kwh - mwh as f64).abs() <= 1e-3).then_some(mwh)
}

impl Battery {
    fn plugged<'e>(&self, scenario: &Scenario, event: &Event<'e>) -> Plugged<'e> {
        Plugged {
            charger: Charger::of(event.kind, &scenario.vertiports[self.at.at()]),
            battery_mwh: whole_mwh(event.kind.battery_kwh),
            since_s: self.landed_s,
        }
    }

    /// Keeps the charges at landing with which a row agrees. If it agrees with none, keeps all and
    /// returns `false`.
    fn keep(&mut self, agrees: impl Fn(u64) -> bool) -> bool {
        let found = self.landed_mwh.iter().any(|&mwh| agrees(mwh));
        if found && self.landed_mwh.len() > 1 {
            self.landed_mwh.retain(|&mwh| agrees(mwh));
        }
        found
    }

    /// Charges until the flight leaves, its delay included, and takes its energy from the battery.
    fn fly(&mut self, plugged: &Plugged<'_>, event: &Event<'_>, expected: &Expected) {
        let leaves_s = expected.takeoff_s + expected.delay_s;
        let energy_mwh = expected.energy_mwh(event);
        for at in 0..self.landed_mwh.len() {
            let [low, high] = plugged
                .held_mwh(self.landed_mwh[at], leaves_s)
                .map(|mwh| mwh.saturating_sub(energy_mwh));
            self.landed_mwh[at] = high;
            if low != high {
                self.landed_mwh.push(low);
            }
        }
        self.landed_mwh.dedup();
        self.landed_mwh.truncate(POSSIBLE);
        self.landed_s = expected.arrival_s;
        self.at = event.row.to;
    }
}

impl Plugged<'_> {
    /// The charge at a time from that at landing. Where the rounding is in doubt, both charges, the
    /// lower one first.
    fn held_mwh(&self, landed_mwh: u64, at_s: u64) -> [u64; 2] {
        let seconds = at_s.saturating_sub(self.since_s);
        if seconds == 0 || landed_mwh >= self.battery_mwh {
            return [landed_mwh; 2];
        }
        let kwh = self.charger.after(landed_mwh as f64 / 1e6, seconds as f64);
        let doubt_mwh = 1e6 * self.charger.doubt_kwh(kwh);
        both_nearest(1e6 * kwh, doubt_mwh).map(|mwh| mwh.min(self.battery_mwh))
    }

    /// Whether `takeoff_s` is the first second from `time_s` on at which the battery holds enough.
    fn suffices_first(
        &self,
        landed_mwh: u64,
        needed_mwh: u64,
        time_s: u64,
        takeoff_s: u64,
    ) -> bool {
        let [_, then_mwh] = self.held_mwh(landed_mwh, takeoff_s);
        let too_little_before = || self.held_mwh(landed_mwh, takeoff_s - 1)[0] < needed_mwh;
        takeoff_s >= time_s
            && then_mwh >= needed_mwh
            && (takeoff_s == time_s || too_little_before())
    }

    /// The first second from `time_s` on at which the battery holds enough, which is at most what
    /// it holds when it is full.
    fn first_second(&self, landed_mwh: u64, needed_mwh: u64, time_s: u64) -> u64 {
        let enough = |wait_s| self.held_mwh(landed_mwh, time_s + wait_s)[1] >= needed_mwh;
        time_s + first(LONGEST_S, enough)
    }

    /// The least charge at landing from which the battery holds this much at a time, if any.
    fn landed_with(&self, held_mwh: u64, at_s: u64) -> Option<u64> {
        let landed_mwh =
            first(self.battery_mwh, |landed_mwh| self.held_mwh(landed_mwh, at_s)[1] >= held_mwh);
        self.held_mwh(landed_mwh, at_s).contains(&held_mwh).then_some(landed_mwh)
    }
}

/// The first number up to `limit` that is enough, where larger ones are too; `limit` if none is.
fn first(limit: u64, enough: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (0, limit);
    while low < high {
        let middle = low.midpoint(high);
        if enough(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}
