//! Why a decision is refused. A refused decision changes nothing.

/// The rule that a decision outside the mask breaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// No aircraft has a decision left.
    #[error("the day is over: no aircraft has a decision left")]
    DayOver,
    /// The scenario has no vertiport with that index.
    #[error("there is no vertiport {0}: the scenario has fewer")]
    NoSuchVertiport(u16),
    /// A full battery does not reach the destination (Eq. 12).
    #[error("vertiport {0} is out of range: the flight takes more energy than the battery holds")]
    OutOfRange(u16),
    /// Every stand of the destination is taken or promised (Eq. 16).
    #[error(
        "vertiport {0} has no stand free: every one is taken or promised to an aircraft on its way"
    )]
    NoStandFree(u16),
}
