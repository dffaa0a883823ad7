//! Reports of the simulator as events, for the simulated operator.

use vertifleet_core::{AircraftIx, Scenario, VertiportIx};
use vertifleet_sim::live::{Booking, Report, Routes};

use super::{EventKind, PairDemand, RouteNames};
use crate::moment::Moment;

impl EventKind {
    /// A report of the simulator as an event of its day.
    pub(crate) fn of(report: &Report, day: &Scenario) -> Self {
        let aircraft = |aircraft: AircraftIx| day.aircraft[aircraft.at()].id.clone();
        let id = |vertiport: VertiportIx| day.vertiports[vertiport.at()].id.clone();
        let start = |period: usize| Moment::from(day.periods[period]);
        let names = |routes: &Routes| match *routes {
            Routes::Way { from, to } => RouteNames::Way { from: id(from), to: id(to) },
            Routes::Of(vertiport) => RouteNames::Of { vertiport: id(vertiport) },
        };
        match report {
            Report::Clock => Self::Clock,
            Report::Decided { aircraft: of, to } => Self::Decided {
                aircraft: aircraft(*of),
                to: id(*to),
                policy: None,
                instead_of: None,
                reason: None,
            },
            Report::Undone { aircraft: of } => {
                Self::Undone { aircraft: aircraft(*of), reason: None }
            }
            Report::Departed { aircraft: of, to, passengers } => {
                Self::Departed { aircraft: aircraft(*of), to: to.map(id), passengers: *passengers }
            }
            Report::Landed { aircraft: of, at, charge_kwh } => {
                Self::Landed { aircraft: aircraft(*of), at: at.map(id), charge_kwh: *charge_kwh }
            }
            Report::Charging { aircraft: of, ready } => {
                Self::Charging { aircraft: aircraft(*of), ready: (*ready).into() }
            }
            Report::Ready { aircraft: of } => Self::Ready { aircraft: aircraft(*of) },
            Report::Delayed { aircraft: of, until } => {
                Self::Delayed { aircraft: aircraft(*of), until: (*until).into() }
            }
            Report::OutOfService { aircraft: of, until } => Self::OutOfService {
                aircraft: aircraft(*of),
                until: until.map(Moment::from),
                reason: None,
            },
            Report::BackInService { aircraft: of } => {
                Self::BackInService { aircraft: aircraft(*of) }
            }
            Report::Closed { routes, until } => {
                Self::Closed { routes: names(routes), until: until.map(Moment::from), reason: None }
            }
            Report::Reopened { routes } => Self::Reopened { routes: names(routes) },
            Report::Demand { period, pairs } => {
                let pair = |&(from, to, passengers): &(VertiportIx, VertiportIx, u32)| PairDemand {
                    from: id(from),
                    to: id(to),
                    passengers,
                };
                Self::Demand { period: start(*period), pairs: pairs.iter().map(pair).collect() }
            }
            Report::Booked { booking: Booking { period, from, to, passengers } } => Self::Booked {
                period: start(*period),
                from: id(*from),
                to: id(*to),
                passengers: *passengers,
            },
            Report::Cancelled { booking: Booking { period, from, to, passengers } } => {
                Self::Cancelled {
                    period: start(*period),
                    from: id(*from),
                    to: id(*to),
                    passengers: *passengers,
                }
            }
            Report::Acknowledged | Report::Corrected { .. } => {
                unreachable!("the simulator reports what happens, and is never mistaken")
            }
            Report::Stands { vertiport, stands } => {
                Self::Stands { vertiport: id(*vertiport), stands: *stands }
            }
        }
    }
}
