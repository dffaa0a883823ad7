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
    /// A full battery does not reach the destination (Eq. 12).
    #[error(
        "aircraft {aircraft:?} cannot fly to vertiport {to:?}: the flight takes more energy than the battery holds"
    )]
    OutOfRange {
        /// The aircraft that decides.
        aircraft: String,
        /// The vertiport that was chosen.
        to: String,
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
