//! The reasons why a decision is refused. A refused decision changes nothing.

use std::fmt;

/// The rule that a decision outside the mask breaks. Aircraft and vertiports are named by their
/// ids.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// No aircraft has a decision left.
    #[error("the day is over: no aircraft has a decision left")]
    DayOver,
    /// The scenario has no vertiport at that position.
    #[error("there is no vertiport at position {position}: the scenario has {vertiports}")]
    NoSuchVertiport {
        /// The position that was chosen, from 0.
        position: u16,
        /// Number of vertiports of the scenario.
        vertiports: usize,
    },
    /// A full battery does not last for the flight (Eq. 12), or for the flight and the reserve.
    #[error("aircraft {aircraft:?} cannot fly to vertiport {to:?}: {shortfall}")]
    OutOfRange {
        /// The aircraft that decides.
        aircraft: String,
        /// The vertiport that was chosen.
        to: String,
        /// What the flight needs, and what there is. Boxed, so that results stay small.
        shortfall: Box<Shortfall>,
    },
    /// The scenario has corridors, and none of them leads to the destination.
    #[error("aircraft {aircraft:?} cannot fly to vertiport {to:?}: no corridor leads there")]
    NoCorridor {
        /// The aircraft that decides.
        aircraft: String,
        /// The vertiport that was chosen.
        to: String,
    },
    /// The route is closed at the moment.
    #[error("aircraft {aircraft:?} cannot fly to vertiport {to:?}: the route is closed")]
    Closed {
        /// The aircraft that decides.
        aircraft: String,
        /// The vertiport that was chosen.
        to: String,
    },
    /// The charge suffices for the flight only after the end of operations.
    #[error(
        "aircraft {aircraft:?} cannot fly to vertiport {to:?}: its battery has the energy of the flight and the reserve only after the end of operations"
    )]
    ChargedTooLate {
        /// The aircraft that decides.
        aircraft: String,
        /// The vertiport that was chosen.
        to: String,
    },
    /// Every stand of the destination is taken or promised (Eq. 16), or every charger where
    /// chargers are counted apart.
    #[error(
        "aircraft {aircraft:?} cannot fly to vertiport {to:?}: every stand or charger is taken or promised to an aircraft on its way"
    )]
    NoStandFree {
        /// The aircraft that decides.
        aircraft: String,
        /// The vertiport that was chosen.
        to: String,
    },
}

/// A flight that needs more than a full battery has, in milliwatt-hours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shortfall {
    /// Energy of the flight.
    pub energy_mwh: u64,
    /// Energy that the flight leaves in the battery.
    pub reserve_mwh: u64,
    /// What a full battery has.
    pub battery_mwh: u64,
}

impl fmt::Display for Shortfall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the flight needs {}", kwh(self.energy_mwh))?;
        if self.reserve_mwh > 0 {
            write!(f, " and a reserve of {}", kwh(self.reserve_mwh))?;
        }
        write!(f, ", and a full battery has {}", kwh(self.battery_mwh))
    }
}

fn kwh(mwh: u64) -> String {
    format!("{:.1} kWh", mwh as f64 / 1e6)
}

#[cfg(test)]
mod tests {
    use super::Shortfall;

    #[test]
    fn a_reserve_is_named_where_there_is_one() {
        let mut flight =
            Shortfall { energy_mwh: 48_000_000, reserve_mwh: 0, battery_mwh: 45_000_000 };
        assert_eq!(
            flight.to_string(),
            "the flight needs 48.0 kWh, and a full battery has 45.0 kWh"
        );
        (flight.energy_mwh, flight.reserve_mwh) = (38_000_000, 10_000_000);
        assert_eq!(
            flight.to_string(),
            "the flight needs 38.0 kWh and a reserve of 10.0 kWh, and a full battery has 45.0 kWh"
        );
    }
}
