//! The reports of a live day, and the reasons to refuse one.

use vertifleet_core::{AircraftIx, Time, VertiportIx};

use crate::Refusal;

/// Something that happened, was decided or became known.
#[derive(Debug, Clone, PartialEq)]
pub enum Report {
    /// The day is at this time; nothing else is known.
    Clock,
    /// An aircraft that is ready is to fly to a vertiport; its own means hold. It must be feasible.
    Decided {
        /// The aircraft.
        aircraft: AircraftIx,
        /// The vertiport.
        to: VertiportIx,
    },
    /// The latest decision of an aircraft is taken back. The aircraft must not have departed.
    Undone {
        /// The aircraft.
        aircraft: AircraftIx,
    },
    /// An aircraft has left its stand.
    Departed {
        /// The aircraft.
        aircraft: AircraftIx,
        /// The vertiport that it flies to, if that is not the decided one.
        to: Option<VertiportIx>,
        /// Passengers on board, if not as many as expected.
        passengers: Option<u16>,
    },
    /// An aircraft is on the ground.
    Landed {
        /// The aircraft.
        aircraft: AircraftIx,
        /// The vertiport where it is, if that is not the one that it was flying to.
        at: Option<VertiportIx>,
        /// What its battery holds, kWh, if that is not what was expected. Days that charge to full
        /// keep no charge, and refuse it.
        charge_kwh: Option<f64>,
    },
    /// An aircraft on the ground is expected to be ready at a time.
    Charging {
        /// The aircraft.
        aircraft: AircraftIx,
        /// That time.
        ready: Time,
    },
    /// An aircraft is ready.
    Ready {
        /// The aircraft.
        aircraft: AircraftIx,
    },
    /// The next event of an aircraft is expected at another time: its departure if it has been sent
    /// off, its landing if it is in the air, the time at which it is ready if it stands.
    Delayed {
        /// The aircraft.
        aircraft: AircraftIx,
        /// That time.
        until: Time,
    },
    /// An aircraft cannot fly again before a time, or until it is back in service. If it is in the
    /// air, it still lands.
    OutOfService {
        /// The aircraft.
        aircraft: AircraftIx,
        /// That time, if it is known.
        until: Option<Time>,
    },
    /// An aircraft can fly again.
    BackInService {
        /// The aircraft.
        aircraft: AircraftIx,
    },
    /// Routes are closed to new flights until a time, or until they are reported open.
    Closed {
        /// The routes.
        routes: Routes,
        /// First instant at which they are open again, if it is known.
        until: Option<Time>,
    },
    /// Routes are open again.
    Reopened {
        /// The routes.
        routes: Routes,
    },
    /// This many passengers of a period still want to fly, actual or forecast. Those who wait in it
    /// since the period before are not among them, and go on waiting.
    Demand {
        /// Position of the period.
        period: usize,
        /// From, to, and passengers, of the pairs that change.
        pairs: Vec<(VertiportIx, VertiportIx, u32)>,
    },
    /// More passengers want to fly.
    Booked {
        /// The seats.
        booking: Booking,
    },
    /// Passengers no longer want to fly. Their period may be over, if they wait in the next one.
    Cancelled {
        /// The seats.
        booking: Booking,
    },
    /// People have seen an alert; nothing else is known.
    Acknowledged,
    /// An earlier report is taken back: the day is as if it had never been made.
    Corrected {
        /// The number of the report, from 1.
        event: u64,
    },
    /// A vertiport has another number of stands, or of chargers where they are counted apart.
    Stands {
        /// The vertiport.
        vertiport: VertiportIx,
        /// The number.
        stands: u16,
    },
}

impl Report {
    /// The aircraft that it is about, if it is about one.
    pub fn aircraft(&self) -> Option<AircraftIx> {
        match *self {
            Self::Decided { aircraft, .. }
            | Self::Undone { aircraft }
            | Self::Departed { aircraft, .. }
            | Self::Landed { aircraft, .. }
            | Self::Charging { aircraft, .. }
            | Self::Ready { aircraft }
            | Self::Delayed { aircraft, .. }
            | Self::OutOfService { aircraft, .. }
            | Self::BackInService { aircraft } => Some(aircraft),
            Self::Clock
            | Self::Closed { .. }
            | Self::Reopened { .. }
            | Self::Demand { .. }
            | Self::Booked { .. }
            | Self::Cancelled { .. }
            | Self::Acknowledged
            | Self::Corrected { .. }
            | Self::Stands { .. } => None,
        }
    }
}

/// Seats of a period from one vertiport to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Booking {
    /// Position of the period.
    pub period: usize,
    /// Where the passengers are.
    pub from: VertiportIx,
    /// Where they want to go.
    pub to: VertiportIx,
    /// Their number.
    pub passengers: u32,
}

/// Routes that close and open together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Routes {
    /// From one vertiport to another.
    Way {
        /// Vertiport that flights leave.
        from: VertiportIx,
        /// Vertiport that flights fly to.
        to: VertiportIx,
    },
    /// All routes that lead to a vertiport or away from it.
    Of(VertiportIx),
}

impl Routes {
    /// The pairs of these routes on a day with this many vertiports.
    pub(super) fn pairs(self, vertiports: usize) -> Vec<(VertiportIx, VertiportIx)> {
        match self {
            Self::Way { from, to } => vec![(from, to)],
            Self::Of(vertiport) => VertiportIx::all(vertiports)
                .filter(|&other| other != vertiport)
                .flat_map(|other| [(vertiport, other), (other, vertiport)])
                .collect(),
        }
    }
}

/// The reason why a report is refused. Nothing has changed then.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReportError {
    /// The decision breaks a rule.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The aircraft cannot decide now.
    #[error("aircraft {aircraft:?} is not ready before {ready}; the decision is for {time}")]
    NotReady {
        /// The aircraft.
        aircraft: String,
        /// When it is expected to be ready.
        ready: Time,
        /// The time of the decision.
        time: Time,
    },
    /// The decision lies before what has been reported.
    #[error("a decision for {time} comes too late: the day is at {now}")]
    Past {
        /// The time of the decision.
        time: Time,
        /// The latest time that was reported.
        now: Time,
    },
    /// The report is far ahead of all others.
    #[error(
        "{time} is more than 4 h after {now}, the latest time of the day; if the time is correct, send a `clock` event first"
    )]
    TooFarAhead {
        /// The time of the report.
        time: Time,
        /// The latest time that was reported.
        now: Time,
    },
    /// A clock that shows a time at which the day has long been over.
    #[error("{time} is more than 4 h after {latest}, when the day is over at the latest")]
    AfterTheDay {
        /// The time of the clock.
        time: Time,
        /// The end of operations, or the latest time that was reported if it is later.
        latest: Time,
    },
    /// Something that was over before it became known.
    #[error("what ends at {until} cannot be reported for {time}, when it is over")]
    Backwards {
        /// The time of the report.
        time: Time,
        /// The end of what is reported.
        until: Time,
    },
    /// A landing before the departure.
    #[error(
        "aircraft {aircraft:?} cannot have landed at {time}: it departed at {departed}, or later"
    )]
    BeforeDeparture {
        /// The aircraft.
        aircraft: String,
        /// The time of the report.
        time: Time,
        /// When it departed, or was sent off.
        departed: Time,
    },
    /// The aircraft is on its way, by the latest report.
    #[error("aircraft {aircraft:?} cannot decide: it {is}")]
    OnItsWay {
        /// The aircraft.
        aircraft: String,
        /// What it does.
        is: &'static str,
    },
    /// The aircraft is out of service.
    #[error("aircraft {aircraft:?} is out of service{}", until.map(|until| format!(" until {until}")).unwrap_or_default())]
    OutOfService {
        /// The aircraft.
        aircraft: String,
        /// Until when, if that is known.
        until: Option<Time>,
    },
    /// No decisions are taken so late.
    #[error("no decision is taken after {end}, the end of operations")]
    Over {
        /// The end of operations.
        end: Time,
    },
    /// The report does not go together with where the aircraft is.
    #[error("aircraft {aircraft:?} {is}, so it cannot {report}")]
    WrongPlace {
        /// The aircraft.
        aircraft: String,
        /// What it does.
        is: &'static str,
        /// What is reported.
        report: &'static str,
    },
    /// The aircraft has decided nothing that could be undone.
    #[error(
        "aircraft {aircraft:?} has no decision that can be undone: it has departed, or something else was reported since"
    )]
    NothingToUndo {
        /// The aircraft.
        aircraft: String,
    },
    /// The aircraft has not been out of service.
    #[error("aircraft {aircraft:?} is in service")]
    InService {
        /// The aircraft.
        aircraft: String,
    },
    /// More passengers than an aircraft has seats.
    #[error("{passengers} passengers do not fit on the {seats} seats of aircraft {aircraft:?}")]
    NoSeats {
        /// The aircraft.
        aircraft: String,
        /// The passengers.
        passengers: u16,
        /// The seats.
        seats: u16,
    },
    /// A charge on a day that does not keep charges.
    #[error("the charge of a battery cannot be reported on a day that charges to full")]
    NoCharge,
    /// More charge than the battery holds, or less than none.
    #[error("the battery of aircraft {aircraft:?} holds 0 to {battery_kwh} kWh, not {charge_kwh}")]
    ChargeOutOfRange {
        /// The aircraft.
        aircraft: String,
        /// The charge that is reported, kWh.
        charge_kwh: f64,
        /// Capacity of the battery, kWh.
        battery_kwh: f64,
    },
    /// The period is over.
    #[error("the period from {start} on is over: the day is at {now}")]
    PeriodOver {
        /// The start of the period.
        start: Time,
        /// The latest time that was reported.
        now: Time,
    },
    /// More passengers than there are.
    #[error("{cancelled} passengers cannot be cancelled: {left} want to fly")]
    TooFewPassengers {
        /// Passengers to be cancelled.
        cancelled: u32,
        /// Passengers who want to fly.
        left: u32,
    },
    /// More passengers than can be counted.
    #[error("at most {most} passengers of a pair can wait in a period")]
    TooMany {
        /// The limit.
        most: u32,
    },
    /// A period, an aircraft or a vertiport that the day does not have, or a route from a vertiport
    /// to itself.
    #[error("the day has no such {0}")]
    Unknown(&'static str),
    /// A report that cannot be taken back.
    #[error("event {event} cannot be corrected: {why}")]
    CannotCorrect {
        /// Its number.
        event: u64,
        /// The reason.
        why: &'static str,
    },
    /// A report that a later one depends on.
    #[error(
        "event {event} cannot be corrected: event {later} is not possible without it ({cause}); correct event {later} first"
    )]
    NeededLater {
        /// Its number.
        event: u64,
        /// The number of the later one.
        later: u64,
        /// The reason why that one would be refused.
        cause: Box<ReportError>,
    },
}
