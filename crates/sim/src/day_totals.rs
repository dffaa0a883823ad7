//! The numbers of a finished day, defined once for every place that shows them.

use serde::{Deserialize, Serialize};

use crate::Ledger;

/// The numbers of a finished day. `simulate --json`, the rows of `days.csv` and the columns in
/// Python use the same names.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct DayTotals {
    /// Revenue less all costs (Eq. 5), dollars.
    pub profit_usd: f64,
    /// Fares paid (Eq. 4), dollars.
    pub revenue_usd: f64,
    /// Cost of carrying passengers (Eq. 2), dollars.
    pub passenger_cost_usd: f64,
    /// Cost of charging (Eq. 3), dollars.
    pub energy_cost_usd: f64,
    /// Cost of flights without their energy, with or without passengers; dollars.
    #[serde(default)]
    pub flight_cost_usd: f64,
    /// Cost of the fleet, whether or not it flies, dollars.
    #[serde(default)]
    pub aircraft_cost_usd: f64,
    /// Cost of stands and chargers, whether or not they are used, dollars.
    #[serde(default)]
    pub site_cost_usd: f64,
    /// Energy charged, kWh.
    pub energy_kwh: f64,
    /// The reward's denominator: all of the day's demand at full fare, dollars (§III.H).
    pub potential_usd: f64,
    /// Profit over potential; 0 on a day without demand.
    pub reward: f64,
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
    /// Passengers who wanted to fly and were not carried.
    pub spilled_passengers: u64,
    /// Passenger-miles over seat-miles, repositioning included; 0 if nothing flew.
    pub load_factor: f64,
}

/// One of a day's numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DayNumber {
    /// Dollars, kWh, or a share.
    Amount(f64),
    /// A number of flights, decisions or passengers.
    Count(u64),
}

impl DayTotals {
    pub(crate) fn new(ledger: &Ledger, potential_usd: f64, demanded: u64) -> Self {
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        Self {
            profit_usd: ledger.profit_usd(),
            revenue_usd: ledger.revenue_usd,
            passenger_cost_usd: ledger.passenger_cost_usd,
            energy_cost_usd: ledger.energy_cost_usd,
            flight_cost_usd: ledger.flight_cost_usd,
            aircraft_cost_usd: ledger.aircraft_cost_usd,
            site_cost_usd: ledger.site_cost_usd,
            energy_kwh: ledger.energy_kwh,
            potential_usd,
            reward: share(ledger.profit_usd(), potential_usd),
            flights: ledger.flights,
            repositioning_flights: ledger.repositioning_flights,
            holds: ledger.holds,
            decisions: ledger.decisions(),
            passengers: ledger.passengers,
            spilled_passengers: demanded - ledger.passengers,
            load_factor: share(ledger.passenger_miles, ledger.seat_miles),
        }
    }

    /// The fixed cost of the fleet and its sites, dollars.
    pub fn fixed_cost_usd(&self) -> f64 {
        self.aircraft_cost_usd + self.site_cost_usd
    }

    /// Profit before the costs that no decision changes, dollars.
    pub fn operating_profit_usd(&self) -> f64 {
        self.profit_usd + self.fixed_cost_usd()
    }

    /// Every number with its name, in the order of the members.
    pub fn numbers(&self) -> [(&'static str, DayNumber); 17] {
        let Self { flights, repositioning_flights, holds, decisions, .. } = *self;
        [
            ("profit_usd", DayNumber::Amount(self.profit_usd)),
            ("revenue_usd", DayNumber::Amount(self.revenue_usd)),
            ("passenger_cost_usd", DayNumber::Amount(self.passenger_cost_usd)),
            ("energy_cost_usd", DayNumber::Amount(self.energy_cost_usd)),
            ("flight_cost_usd", DayNumber::Amount(self.flight_cost_usd)),
            ("aircraft_cost_usd", DayNumber::Amount(self.aircraft_cost_usd)),
            ("site_cost_usd", DayNumber::Amount(self.site_cost_usd)),
            ("energy_kwh", DayNumber::Amount(self.energy_kwh)),
            ("potential_usd", DayNumber::Amount(self.potential_usd)),
            ("reward", DayNumber::Amount(self.reward)),
            ("flights", DayNumber::Count(flights.into())),
            ("repositioning_flights", DayNumber::Count(repositioning_flights.into())),
            ("holds", DayNumber::Count(holds.into())),
            ("decisions", DayNumber::Count(decisions.into())),
            ("passengers", DayNumber::Count(self.passengers)),
            ("spilled_passengers", DayNumber::Count(self.spilled_passengers)),
            ("load_factor", DayNumber::Amount(self.load_factor)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::DayTotals;
    use crate::Ledger;

    #[test]
    fn the_names_of_the_numbers_are_those_of_the_members() {
        let totals = DayTotals::new(&Ledger::default(), 0.0, 0);
        let written = serde_json::to_string(&totals).expect("plain data");
        let names = totals.numbers().map(|(name, _)| name);
        let mut from = 0;
        for name in names {
            let found = written[from..].find(&format!("\"{name}\":"));
            from += found.unwrap_or_else(|| panic!("{name} is not in its place in {written}"));
        }
        assert_eq!(written.matches(':').count(), names.len());
    }
}
