//! The day's account (Eq. 2-5): revenue, costs, and the flights behind them.

use vertifleet_core::Scenario;

use crate::TraceRow;

/// Running totals of a day, in dollars, kWh and counts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// R^T (Eq. 4).
    pub revenue_usd: f64,
    /// C^O (Eq. 2).
    pub passenger_cost_usd: f64,
    /// C^C (Eq. 3).
    pub energy_cost_usd: f64,
    /// Cost of flights without their energy, with or without passengers.
    pub flight_cost_usd: f64,
    /// Cost of the fleet, whether or not it flies, entered when the day begins.
    pub aircraft_cost_usd: f64,
    /// Cost of stands and chargers, whether or not they are used, entered when the day begins.
    pub site_cost_usd: f64,
    /// Energy flown, which is the energy charged.
    pub energy_kwh: f64,
    /// Flights, with passengers or without.
    pub flights: u32,
    /// Flights without passengers.
    pub repositioning_flights: u32,
    /// Decisions to stay.
    pub holds: u32,
    /// Passengers carried.
    pub passengers: u64,
    /// Distance flown times passengers on board.
    pub passenger_miles: f64,
    /// Distance flown times seats on board.
    pub seat_miles: f64,
}

impl Ledger {
    /// The account before the first decision.
    pub(crate) fn at_start(scenario: &Scenario) -> Self {
        Self {
            aircraft_cost_usd: scenario.fleet_cost_usd(),
            site_cost_usd: scenario.site_cost_usd(),
            ..Self::default()
        }
    }

    /// z (Eq. 5): revenue less passenger cost and energy cost, and less the other costs of flights,
    /// aircraft, stands and chargers; dollars.
    #[inline]
    pub fn profit_usd(&self) -> f64 {
        self.revenue_usd
            - self.passenger_cost_usd
            - self.energy_cost_usd
            - self.flight_cost_usd
            - self.aircraft_cost_usd
            - self.site_cost_usd
    }

    /// The fixed cost of the day, dollars.
    pub fn fixed_cost_usd(&self) -> f64 {
        self.aircraft_cost_usd + self.site_cost_usd
    }

    /// Flights and holds.
    #[inline]
    pub fn decisions(&self) -> u32 {
        self.flights + self.holds
    }

    /// Enters a flight over `distance_mi` with `seats` on board.
    #[inline]
    pub(crate) fn enter_flight(&mut self, row: &TraceRow, distance_mi: f64, seats: u16) {
        self.revenue_usd += row.revenue_usd;
        self.passenger_cost_usd += row.passenger_cost_usd;
        self.energy_cost_usd += row.energy_cost_usd;
        self.flight_cost_usd += row.flight_cost_usd;
        self.energy_kwh += row.energy_kwh;
        self.flights += 1;
        self.repositioning_flights += u32::from(row.passengers == 0);
        self.passengers += u64::from(row.passengers);
        self.passenger_miles += distance_mi * f64::from(row.passengers);
        self.seat_miles += distance_mi * f64::from(seats);
    }
}
