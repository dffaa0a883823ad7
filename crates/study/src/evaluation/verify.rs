//! Verifies a result: its days are drawn again, its choices are played, the schedules are judged by
//! the independent checker, and everything that is claimed is computed again.

use std::fmt::{self, Write as _};
use std::str::FromStr;
use std::sync::Arc;

use rayon::prelude::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use vertifleet_core::{Stop, VertiportIx};
use vertifleet_picture::numbers::{counted, grouped};
use vertifleet_sim::check::check;
use vertifleet_sim::{DayTotals, Simulation, Trace};

use super::result::{ResultDay, ResultFile, choices_text, shares};
use crate::error::Error;
use crate::record::{DayRecord, mean_profit_usd};
use crate::share::share;
use crate::statistics::Estimate;
use crate::suite::{Suite, SuiteDay};

/// Two numbers agree if they differ by no more than this share of them. Sums in another order
/// differ by less.
const TOLERANCE: f64 = 1e-9;
/// The most findings that are shown as text.
const SHOWN: usize = 20;

/// The outcome of a verification. It prints as text and serialises for programs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verification {
    /// The name of the suite.
    pub suite: String,
    /// The name of the policy, as the file has it.
    pub policy: String,
    /// Number of days.
    pub days: usize,
    /// Whether every claim holds that can be verified.
    pub valid: bool,
    /// The share of the bounds as recomputed; `None` if a day cannot be played.
    pub bound_share: Option<Estimate>,
    /// The profit as recomputed, in dollars; `None` if a day cannot be played.
    pub profit_usd: Option<Estimate>,
    /// What does not hold.
    pub findings: Vec<String>,
}

/// Verifies a result.
///
/// # Errors
/// Returns [`Error::UnknownSuite`] for a result of an unknown suite, [`Error::SuiteChanged`] if the
/// suite's days are not the ones that were frozen, and [`Error::Stopped`] soon after `stop` is
/// requested.
pub fn verify(result: &ResultFile, stop: &Stop) -> Result<Verification, Error> {
    let suite = Suite::find(&result.suite)?;
    let days =
        if can_be_drawn(result, &suite) { suite.draw_with_bounds(stop)? } else { Vec::new() };
    Ok(verify_on(result, &suite, &days).0)
}

/// Whether the days of the suite may be drawn for this file. A short file must not make the program
/// draw and bound a million random networks.
pub(crate) fn can_be_drawn(result: &ResultFile, suite: &Suite) -> bool {
    suite.is_frozen() || result.days.len() == suite.days
}

/// Verifies a result on the days of its suite, and returns the share of the bound of each day that
/// could be played.
pub(crate) fn verify_on(
    result: &ResultFile,
    suite: &Suite,
    days: &[SuiteDay],
) -> (Verification, Vec<f64>) {
    let mut findings = Vec::new();
    if result.days.len() != suite.days {
        let (found, expected) = (result.days.len(), suite.days);
        findings.push(format!("days: {found} in the file, {expected} in the suite"));
    }
    let verified: Vec<Result<DayRecord, String>> =
        days.par_iter().zip(&result.days).map(|(day, claim)| verified_day(day, claim)).collect();
    let mut records = Vec::with_capacity(verified.len());
    for day in verified {
        match day {
            Ok(record) => records.push(record),
            Err(finding) => findings.push(finding),
        }
    }
    let whole = records.len() == suite.days;
    let (bound_share, lowest) = shares(&records);
    let profit_usd = mean_profit_usd(&records);
    if whole {
        if !agree(result.lowest_bound_share, lowest) {
            let claimed = result.lowest_bound_share;
            findings.push(format!("lowest_bound_share: {claimed} is claimed, {lowest} is found"));
        }
        findings.extend(differences("bound_share", &result.bound_share, &bound_share));
        findings.extend(differences("profit_usd", &result.profit_usd, &profit_usd));
    }
    let verification = Verification {
        suite: result.suite.clone(),
        policy: result.policy.name.clone(),
        days: suite.days,
        valid: findings.is_empty(),
        bound_share: whole.then_some(bound_share),
        profit_usd: whole.then_some(profit_usd),
        findings,
    };
    (verification, records.iter().map(share).collect())
}

/// What is claimed of an estimate otherwise than it is found.
fn differences(member: &str, claimed: &Estimate, found: &Estimate) -> Vec<String> {
    let parts = |estimate: &Estimate| {
        [
            ("mean", Some(estimate.mean)),
            ("standard_deviation", estimate.standard_deviation),
            ("half_width_95", estimate.half_width_95),
        ]
    };
    let difference = |((part, claimed), (_, found)): ((&str, _), (_, _))| {
        let agrees = match (claimed, found) {
            (Some(claimed), Some(found)) => agree(claimed, found),
            (claimed, found) => claimed == found,
        };
        let text = |value: Option<f64>| value.map_or("null".to_owned(), |value| value.to_string());
        (!agrees).then(|| {
            format!("{member}.{part}: {} is claimed, {} is found", text(claimed), text(found))
        })
    };
    parts(claimed).into_iter().zip(parts(found)).filter_map(difference).collect()
}

fn agree(claimed: f64, found: f64) -> bool {
    (claimed - found).abs() <= TOLERANCE * found.abs().max(1.0)
}

/// Plays the choices of a day. The record has what the day earns; the error says what does not
/// hold.
fn verified_day(day: &SuiteDay, claim: &ResultDay) -> Result<DayRecord, String> {
    let name = &day.scenario.name;
    if (&claim.day, &claim.hash) != (name, &day.hash) {
        return Err(format!("{name}: the file has {:?} in its place, or another hash", claim.day));
    }
    let (trace, totals) =
        played(day, &claim.choices).map_err(|finding| format!("{name}: {finding}"))?;
    let choices: Vec<VertiportIx> = trace.rows.iter().map(|row| row.to).collect();
    if claim.choices != choices_text(&choices) {
        return Err(format!("{name}: choices must be whole numbers with a blank between them"));
    }
    let report = check(&day.scenario, &trace);
    if let Some(finding) = report.findings.first() {
        return Err(format!("{name}: the checker finds {}: {}", finding.rule, finding.detail));
    }
    for (who, found) in [("simulator", totals.profit_usd), ("checker", report.totals.profit_usd)] {
        if !agree(claim.profit_usd, found) {
            let claimed = claim.profit_usd;
            return Err(format!(
                "{name}: a profit of {claimed} $ is claimed, the {who} finds {found}"
            ));
        }
    }
    let upper_bound_usd = day.upper_bound_usd.expect("every day was bounded");
    if !agree(claim.upper_bound_usd, upper_bound_usd) {
        let (claimed, found) = (claim.upper_bound_usd, upper_bound_usd);
        return Err(format!("{name}: a bound of {claimed} $ is claimed, the suite has {found}"));
    }
    Ok(DayRecord {
        day: name.clone(),
        seed: day.scenario.seed,
        totals,
        upper_bound_usd: day.upper_bound_usd,
        choices: Vec::new(),
    })
}

/// The schedule of the choices, which must be those of the whole day, and what the simulator
/// counted.
fn played(day: &SuiteDay, choices: &str) -> Result<(Trace, DayTotals), String> {
    let mut choices = choices.split_ascii_whitespace().enumerate();
    let mut simulation = Simulation::new(Arc::clone(&day.scenario));
    let mut trace = Trace::default();
    while let Some(decision) = simulation.next_decision() {
        let (at, choice) = choices
            .next()
            .ok_or_else(|| format!("there is no choice for the decision at {}", decision.time))?;
        let vertiport = u16::from_str(choice)
            .map_err(|_| format!("choice {} is not a vertiport's position", at + 1))?;
        let row = simulation
            .apply(VertiportIx(vertiport))
            .map_err(|refusal| format!("choice {} is refused: {refusal}", at + 1))?;
        trace.rows.push(row);
    }
    match choices.count() {
        0 => Ok((trace, simulation.totals())),
        more => Err(format!("{more} choices are left when the day is over")),
    }
}

impl fmt::Display for Verification {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { suite, policy, days, findings, .. } = self;
        // A name may hold anything, and must not pass for a line of this report.
        let policy = policy.escape_debug();
        let days = counted(*days, "day", "days");
        if let (true, Some(bound_share), Some(profit_usd)) =
            (self.valid, &self.bound_share, &self.profit_usd)
        {
            let share = bound_share.written(|value| grouped(100.0 * value, 2));
            let profit = profit_usd.written(|value| grouped(value, 0));
            return write!(
                f,
                "verified: {policy} on {suite}, {days}: {share} % of the certified bound, $ {profit} a day (not verified: who it is, what it saw, its times, what it says of itself)"
            );
        }
        let found = counted(findings.len(), "claim does", "claims do");
        write!(f, "not verified: {policy} on {suite}, {days}: {found} not hold")?;
        let mut text = String::new();
        for finding in findings.iter().take(SHOWN) {
            write!(text, "\n  {finding}")?;
        }
        if findings.len() > SHOWN {
            write!(text, "\n  and {} more", findings.len() - SHOWN)?;
        }
        f.write_str(&text)
    }
}
