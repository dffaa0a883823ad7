//! The report: findings, how often each rule is broken, and the day's totals, computed from the
//! rules.

use std::collections::BTreeMap;
use std::fmt;

use serde::ser::SerializeStruct as _;
use serde::{Serialize, Serializer};
use vertifleet_core::{Scenario, Time};

use super::Rule;
use super::event::Event;
use super::expected::Expected;

/// The most findings kept of each rule. All are counted, but a file in which everything is wrong
/// does not fill the memory.
const KEPT_OF_EACH_RULE: usize = 1_000;
/// The most findings printed in the text form.
const SHOWN: usize = 100;

/// One place where the schedule breaks a rule.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// The rule that is broken.
    pub rule: Rule,
    /// The row, counted from 1 below the header; `None` for a decision that is missing.
    pub row: Option<usize>,
    /// The row's time, or the time at which a missing decision was due.
    pub time: Time,
    /// Id of the aircraft; `None` if the scenario does not have it.
    pub aircraft: Option<String>,
    /// What the schedule states and what the rule requires.
    pub detail: String,
}

/// The day's account, computed from the schedule and the rules and not from the amounts that the
/// schedule states. Members are named as in the simulator's [`DayTotals`](crate::DayTotals), in
/// dollars, kWh and counts.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Totals {
    /// Revenue less all costs (Eq. 5).
    pub profit_usd: f64,
    /// Fares (Eq. 4).
    pub revenue_usd: f64,
    /// Cost of carrying passengers (Eq. 2).
    pub passenger_cost_usd: f64,
    /// Cost of charging (Eq. 3).
    pub energy_cost_usd: f64,
    /// Cost of flights without their energy, with or without passengers.
    pub flight_cost_usd: f64,
    /// Cost of the fleet, whether or not it flies.
    pub aircraft_cost_usd: f64,
    /// Cost of stands and chargers, whether or not they are used.
    pub site_cost_usd: f64,
    /// Energy charged.
    pub energy_kwh: f64,
    /// Flights, with passengers or without.
    pub flights: u32,
    /// Flights without passengers.
    pub repositioning_flights: u32,
    /// Decisions to stay.
    pub holds: u32,
    /// Flights and holds.
    pub decisions: u32,
    /// Passengers carried.
    pub passengers: u64,
}

impl Totals {
    pub(super) fn count_hold(&mut self) {
        self.holds += 1;
        self.decisions += 1;
    }

    pub(super) fn count_flight(&mut self, passengers: u16, flight: &Expected) {
        self.flights += 1;
        self.decisions += 1;
        self.repositioning_flights += u32::from(passengers == 0);
        self.passengers += u64::from(passengers);
        self.revenue_usd += flight.revenue_usd;
        self.passenger_cost_usd += flight.passenger_cost_usd;
        self.energy_cost_usd += flight.energy_cost_usd;
        self.flight_cost_usd += flight.flight_cost_usd;
        self.energy_kwh += flight.energy_kwh;
    }

    /// Enters the fixed cost of the day, and computes the profit.
    pub(super) fn close(&mut self, scenario: &Scenario) {
        self.aircraft_cost_usd = scenario.aircraft_cost_usd * scenario.aircraft.len() as f64;
        for vertiport in &scenario.vertiports {
            self.site_cost_usd += vertiport.stand_cost_usd * f64::from(vertiport.stands);
            let chargers = vertiport.chargers.map_or(0.0, f64::from);
            self.site_cost_usd += vertiport.charger_cost_usd * chargers;
        }
        self.profit_usd = self.revenue_usd
            - self.passenger_cost_usd
            - self.energy_cost_usd
            - self.flight_cost_usd
            - self.aircraft_cost_usd
            - self.site_cost_usd;
    }
}

/// The findings collected so far.
#[derive(Debug, Default)]
pub(super) struct Findings {
    kept: Vec<Finding>,
    broken: BTreeMap<Rule, usize>,
}

impl Findings {
    /// Records that a rule is broken. `detail` is called only if the finding is kept.
    pub(super) fn add(
        &mut self,
        rule: Rule,
        row: Option<usize>,
        time: Time,
        aircraft: Option<&str>,
        detail: impl FnOnce() -> String,
    ) {
        let times = self.broken.entry(rule).or_default();
        *times += 1;
        if *times <= KEPT_OF_EACH_RULE {
            let aircraft = aircraft.map(str::to_owned);
            self.kept.push(Finding { rule, row, time, aircraft, detail: detail() });
        }
    }

    /// Records that an event breaks a rule.
    pub(super) fn add_event(
        &mut self,
        rule: Rule,
        event: &Event<'_>,
        detail: impl FnOnce() -> String,
    ) {
        self.add(rule, Some(event.number), event.row.time, Some(&event.aircraft.id), detail);
    }

    pub(super) fn into_report(self, totals: Totals) -> Report {
        let mut findings = self.kept;
        findings
            .sort_by_key(|finding| (finding.time, finding.row.unwrap_or(usize::MAX), finding.rule));
        Report { findings, broken: self.broken, totals }
    }
}

/// The checker's report on a schedule. It prints as text and serialises for programs.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The places where rules are broken, in the order of the day; at most the first 1,000 of each
    /// rule.
    pub findings: Vec<Finding>,
    /// How often each broken rule is broken, including findings that were not kept.
    pub broken: BTreeMap<Rule, usize>,
    /// The day's account.
    pub totals: Totals,
}

impl Report {
    /// Whether the schedule is complete and keeps every rule.
    pub fn is_valid(&self) -> bool {
        self.broken.is_empty()
    }

    /// Number of places where a rule is broken, including findings that were not kept.
    pub fn broken_places(&self) -> usize {
        self.broken.values().sum()
    }
}

impl Serialize for Report {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut report = serializer.serialize_struct("Report", 4)?;
        report.serialize_field("valid", &self.is_valid())?;
        report.serialize_field("totals", &self.totals)?;
        report.serialize_field("broken", &self.broken)?;
        report.serialize_field("findings", &self.findings)?;
        report.end()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_valid() {
            writeln!(f, "the schedule keeps every rule")?;
        } else {
            let (rules, places) = (self.broken.len(), self.broken_places());
            writeln!(
                f,
                "the schedule breaks {rules} of {} rules; findings: {places}",
                Rule::ALL.len()
            )?;
        }
        for (rule, times) in &self.broken {
            writeln!(f, "  {times:>7} x {rule:<16} {}", rule.meaning())?;
        }
        for finding in self.findings.iter().take(SHOWN) {
            writeln!(f, "{finding}")?;
        }
        let hidden = self.broken_places() - self.findings.len().min(SHOWN);
        if hidden > 0 {
            writeln!(f, "and {hidden} more")?;
        }
        write!(f, "{}", self.totals)
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(row) = self.row {
            write!(f, "row {row}, ")?;
        }
        write!(f, "{}, ", self.time)?;
        match &self.aircraft {
            Some(aircraft) => write!(f, "aircraft {aircraft}: ")?,
            None => write!(f, "no such aircraft: ")?,
        }
        write!(f, "{} [{}]", self.detail, self.rule)
    }
}

impl fmt::Display for Totals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "recomputed: decisions {}, flights {} (without passengers {}), holds {}, passengers {}",
            self.decisions, self.flights, self.repositioning_flights, self.holds, self.passengers
        )?;
        write!(
            f,
            "profit ${:.2} = revenue ${:.2} - passenger cost ${:.2} - energy cost ${:.2} ({:.2} kWh)",
            self.profit_usd,
            self.revenue_usd,
            self.passenger_cost_usd,
            self.energy_cost_usd,
            self.energy_kwh
        )?;
        for (name, cost) in [
            ("flight cost", self.flight_cost_usd),
            ("aircraft cost", self.aircraft_cost_usd),
            ("site cost", self.site_cost_usd),
        ] {
            if cost != 0.0 {
                write!(f, " - {name} ${cost:.2}")?;
            }
        }
        Ok(())
    }
}
