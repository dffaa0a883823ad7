//! The schedule checker: an independent report on a complete schedule, which names every broken
//! rule.
//!
//! The checker is written from the rules alone (paper §III, Eq. 2-16). It shares no code with the
//! simulator, not even the rounding of durations, so that a mistake in one of the two shows as a
//! disagreement. Each row is judged against the *stated* row before it, so that one mistake gives
//! one finding and not a hundred.
//!
//! Each file checks one family of rules; [`Rule`] lists them all.

mod amounts;
mod battery;
mod charger;
mod decisions;
mod event;
mod expected;
mod holds;
mod order;
mod passengers;
mod reach;
mod report;
mod rounding;
mod rule;
mod stands;
mod times;

use vertifleet_core::Scenario;

use crate::Trace;
use battery::Batteries;
use expected::Expected;
use stands::Stands;

pub use report::{Finding, Report, Totals};
pub use rule::Rule;

/// Judges a complete schedule of a day. It accepts any trace, even one of another scenario, and
/// never panics.
pub fn check(scenario: &Scenario, trace: &Trace) -> Report {
    let mut findings = report::Findings::default();
    order::check(scenario, trace, &mut findings);
    let events = event::in_order(scenario, trace, &mut findings);

    decisions::check(scenario, &events, &mut findings);
    passengers::check(scenario, &events, &mut findings);
    let mut totals = Totals::default();
    let mut stands = Stands::at_start(scenario);
    let mut batteries = Batteries::at_start(scenario);
    for event in &events {
        let is_full = match &mut batteries {
            None => true,
            Some(batteries) => batteries.decides(event, &mut findings),
        };
        stands.decides(event, is_full, &mut findings);
        if event.is_hold() {
            holds::check(scenario, event, &mut findings);
            totals.count_hold();
        } else {
            reach::check(scenario, event, &mut findings);
            let expected = match &mut batteries {
                None => Expected::of(scenario, event, event.row.time.seconds().into()),
                Some(batteries) => batteries.take_off(event, &mut findings),
            };
            times::check(scenario, event, &expected, &mut findings);
            amounts::check(event, &expected, &mut findings);
            totals.count_flight(event.row.passengers, &expected);
        }
    }
    totals.close(scenario);
    findings.into_report(totals)
}
