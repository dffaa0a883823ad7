//! The reasons why a decision is refused. A refused decision changes nothing.

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
    #[error(
        "aircraft {aircraft:?} cannot fly to vertiport {to:?}: the flight needs {needs}, and a full battery has {battery}",
        needs = needed(*energy_mwh, *reserve_mwh),
        battery = kwh(*battery_mwh)
    )]
    OutOfRange {
        /// The aircraft that decides.
        aircraft: String,
        /// The vertiport that was chosen.
        to: String,
        /// Energy of the flight, mWh.
        energy_mwh: u64,
        /// Energy that the flight leaves in the battery, mWh.
        reserve_mwh: u64,
        /// What a full battery has, mWh.
        battery_mwh: u64,
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

/// What a battery needs for a flight and its reserve, if it has one.
fn needed(energy_mwh: u64, reserve_mwh: u64) -> String {
    match reserve_mwh {
        0 => kwh(energy_mwh),
        _ => format!("{} and a reserve of {}", kwh(energy_mwh), kwh(reserve_mwh)),
    }
}

fn kwh(mwh: u64) -> String {
    format!("{:.1} kWh", mwh as f64 / 1e6)
}

#[cfg(test)]
mod tests {
    use super::needed;

    #[test]
    fn a_reserve_is_named_where_there_is_one() {
        assert_eq!(needed(38_000_000, 0), "38.0 kWh");
        assert_eq!(needed(38_000_000, 10_000_000), "38.0 kWh and a reserve of 10.0 kWh");
    }
}
