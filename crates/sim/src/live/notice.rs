//! Notices: the parts of a report, or of the state of a live day, that people should look at.
//!
//! A report of something impossible is accepted, because it happened, with a notice that names it.

use vertifleet_core::Time;

use crate::Refusal;

/// Something that people should look at. The report was accepted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Notice {
    /// A vertiport has more aircraft than stands.
    #[error(
        "vertiport {vertiport:?} has {taken} aircraft on its {stands} stands or on their way there"
    )]
    MoreThanStands {
        /// The vertiport.
        vertiport: String,
        /// Number of aircraft that stand there or are on their way.
        taken: u16,
        /// Number of stands, or of chargers where they are counted apart.
        stands: u16,
    },
    /// An aircraft left for a vertiport that no decision could have sent it to.
    #[error("{refusal}; the departure is recorded despite the violation")]
    AgainstTheRules {
        /// The aircraft.
        aircraft: String,
        /// The rule.
        refusal: Refusal,
    },
    /// An aircraft left that was reported out of service.
    #[error(
        "aircraft {aircraft:?} is out of service; the departure is recorded despite the violation"
    )]
    DepartedOutOfService {
        /// The aircraft.
        aircraft: String,
    },
    /// An aircraft left before it was expected to be ready.
    #[error(
        "aircraft {aircraft:?} is not ready before {ready}; the departure is recorded despite the violation"
    )]
    DepartedUnready {
        /// The aircraft.
        aircraft: String,
        /// When it was expected to be ready.
        ready: Time,
    },
    /// An aircraft left before its latest landing.
    #[error("aircraft {aircraft:?} cannot have departed at {departed}: it landed at {landed}")]
    DepartedBeforeLanding {
        /// The aircraft.
        aircraft: String,
        /// When it departed, by the report.
        departed: Time,
        /// Its latest landing.
        landed: Time,
    },
    /// An aircraft flies without the energy for its flight.
    #[error(
        "aircraft {aircraft:?} has {has_kwh:.1} kWh for its flight to {to:?}, which takes {needs_kwh:.1} kWh"
    )]
    WithoutEnergy {
        /// The aircraft.
        aircraft: String,
        /// Its destination.
        to: String,
        /// Its charge at take-off, kWh.
        has_kwh: f64,
        /// The energy of the flight, kWh.
        needs_kwh: f64,
    },
    /// An aircraft flies without the energy for its flight and the reserve.
    #[error(
        "aircraft {aircraft:?} has {has_kwh:.1} kWh for its flight to {to:?}, which takes {needs_kwh:.1} kWh with the reserve"
    )]
    BelowReserve {
        /// The aircraft.
        aircraft: String,
        /// Its destination.
        to: String,
        /// Its charge at take-off, kWh.
        has_kwh: f64,
        /// The energy of the flight and the reserve, kWh.
        needs_kwh: f64,
    },
    /// A flight is faster than its aircraft.
    #[error(
        "aircraft {aircraft:?} cannot be at {at:?} {flown_s} s after its departure: the flight takes {flight_s} s"
    )]
    TooFast {
        /// The aircraft.
        aircraft: String,
        /// Where it lands.
        at: String,
        /// The duration by the reports, seconds.
        flown_s: u32,
        /// The duration of the flight, seconds.
        flight_s: u32,
    },
    /// A battery contains more than it can by then.
    #[error(
        "the battery of aircraft {aircraft:?} cannot hold {charge_kwh:.1} kWh: {expected_kwh:.1} kWh are expected"
    )]
    ChargeTooHigh {
        /// The aircraft.
        aircraft: String,
        /// The charge by the report, kWh.
        charge_kwh: f64,
        /// The charge that follows from earlier reports, kWh.
        expected_kwh: f64,
    },
    /// An aircraft is ready sooner than it can be.
    #[error(
        "aircraft {aircraft:?} cannot be ready at {ready}: it landed at {landed}, and {work} takes {takes_s} s"
    )]
    ReadyTooSoon {
        /// The aircraft.
        aircraft: String,
        /// When it is ready, by the report.
        ready: Time,
        /// Its latest landing.
        landed: Time,
        /// The longer of its turnaround and of charging.
        work: &'static str,
        /// The duration of that, seconds.
        takes_s: u32,
    },
    /// An aircraft landed somewhere else.
    #[error("aircraft {aircraft:?} landed at {at:?} instead of {to:?}")]
    Diverted {
        /// The aircraft.
        aircraft: String,
        /// Where it landed.
        at: String,
        /// Where it was flying to.
        to: String,
    },
    /// An aircraft should have departed or landed, and neither was reported.
    #[error("aircraft {aircraft:?} should have {done} at {time}, which was not reported")]
    Overdue {
        /// The aircraft.
        aircraft: String,
        /// Departed or landed.
        done: &'static str,
        /// When.
        time: Time,
    },
    /// An aircraft is somewhere else without having flown there.
    #[error("aircraft {aircraft:?} is at {at:?} although no flight to it was reported")]
    NotFlown {
        /// The aircraft.
        aircraft: String,
        /// Where it is.
        at: String,
    },
}

impl Notice {
    /// The stable code of its kind, for programs.
    pub fn code(&self) -> &'static str {
        match self {
            Self::MoreThanStands { .. } => "more_than_stands",
            Self::AgainstTheRules { .. } => "against_the_rules",
            Self::DepartedOutOfService { .. } => "departed_out_of_service",
            Self::DepartedUnready { .. } => "departed_unready",
            Self::DepartedBeforeLanding { .. } => "departed_before_landing",
            Self::WithoutEnergy { .. } => "without_energy",
            Self::BelowReserve { .. } => "below_reserve",
            Self::TooFast { .. } => "too_fast",
            Self::ChargeTooHigh { .. } => "charge_too_high",
            Self::ReadyTooSoon { .. } => "ready_too_soon",
            Self::Diverted { .. } => "diverted",
            Self::Overdue { .. } => "overdue",
            Self::NotFlown { .. } => "not_flown",
        }
    }

    /// The aircraft that it is about, if it is about one.
    pub fn aircraft(&self) -> Option<&str> {
        match self {
            Self::MoreThanStands { .. } => None,
            Self::AgainstTheRules { aircraft, .. }
            | Self::DepartedOutOfService { aircraft }
            | Self::DepartedUnready { aircraft, .. }
            | Self::DepartedBeforeLanding { aircraft, .. }
            | Self::WithoutEnergy { aircraft, .. }
            | Self::BelowReserve { aircraft, .. }
            | Self::TooFast { aircraft, .. }
            | Self::ChargeTooHigh { aircraft, .. }
            | Self::ReadyTooSoon { aircraft, .. }
            | Self::Diverted { aircraft, .. }
            | Self::Overdue { aircraft, .. }
            | Self::NotFlown { aircraft, .. } => Some(aircraft),
        }
    }

    /// The vertiport that it is about, if it is about one.
    pub fn vertiport(&self) -> Option<&str> {
        match self {
            Self::MoreThanStands { vertiport: at, .. }
            | Self::WithoutEnergy { to: at, .. }
            | Self::BelowReserve { to: at, .. }
            | Self::TooFast { at, .. }
            | Self::Diverted { at, .. }
            | Self::NotFlown { at, .. } => Some(at),
            _ => None,
        }
    }
}
