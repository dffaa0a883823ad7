//! The energy and money of a flight (Eq. 2-4, 13).

use super::Rule;
use super::event::Event;
use super::expected::Expected;
use super::report::Findings;

/// Judges the energy, revenue and costs of one flight.
pub(super) fn check(event: &Event<'_>, expected: &Expected, findings: &mut Findings) {
    let row = event.row;
    for (rule, unit, stated, due) in [
        (Rule::Energy, "kWh", row.energy_kwh, expected.energy_kwh),
        (Rule::Revenue, "dollars", row.revenue_usd, expected.revenue_usd),
        (Rule::PassengerCost, "dollars", row.passenger_cost_usd, expected.passenger_cost_usd),
        (Rule::EnergyCost, "dollars", row.energy_cost_usd, expected.energy_cost_usd),
        (Rule::FlightCost, "dollars", row.flight_cost_usd, expected.flight_cost_usd),
    ] {
        if !agree(stated, due) {
            findings.add_event(rule, event, || {
                format!("states {stated} {unit}, but it comes to {due}")
            });
        }
    }
}

/// Whether two amounts differ by no more than a millionth, so that a schedule may state amounts
/// rounded to six digits. NaN agrees with nothing.
fn agree(stated: f64, due: f64) -> bool {
    (stated - due).abs() <= (1e-6 * due).max(1e-9)
}
