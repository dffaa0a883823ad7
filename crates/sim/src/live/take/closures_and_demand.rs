//! Reports of routes that close and open, and of passengers.

use std::sync::Arc;

use vertifleet_core::{Closure, Route, Scenario, Time, VertiportIx};

use crate::live::LiveDay;
use crate::live::report::{Booking, ReportError, Routes};

/// At most this many passengers of a pair wait in a period.
const MOST_PASSENGERS: u32 = 1_000_000;

impl LiveDay {
    /// Closes routes. The report replaces the closures in force on them, so a dated closure may
    /// also end earlier than was reported before.
    pub(super) fn close(
        &mut self,
        time: Time,
        routes: Routes,
        until: Option<Time>,
    ) -> Result<(), ReportError> {
        let size = self.check_routes(routes)?;
        let pairs = routes.pairs(size);
        let Some(end) = until else {
            // A dated closure in force stays known: policies expect it, and the routes stay closed
            // after its end.
            for (from, to) in pairs {
                self.known.closures.report(from, to, true, size);
                self.closed_since.entry((from, to)).or_insert(time);
            }
            return Ok(());
        };
        let closure = |(from, to), start| {
            let route = Route { from, to, both_ways: false };
            Closure { route, start, end, known: true }
        };
        let replaced = self.end_closures(time, &pairs);
        for &pair in &pairs {
            let of_pair = |(route, _): &&(Route, Time)| (route.from, route.to) == pair;
            let begun = replaced.iter().filter(of_pair).map(|&(_, start)| start).min();
            self.closures.push(closure(pair, begun.map_or(time, |start| start.min(time))));
        }
        self.announce(time, &pairs);
        Ok(())
    }

    pub(super) fn reopen(&mut self, time: Time, routes: Routes) -> Result<(), ReportError> {
        let size = self.check_routes(routes)?;
        let pairs = routes.pairs(size);
        if !self.end_closures(time, &pairs).is_empty() {
            self.announce(time, &pairs);
            return Ok(());
        }
        for (from, to) in pairs {
            self.known.closures.report(from, to, false, size);
            self.closed_since.remove(&(from, to));
        }
        Ok(())
    }

    /// Removes the dated closures that are in force on some routes, and returns their routes and
    /// when they began.
    fn end_closures(
        &mut self,
        time: Time,
        pairs: &[(VertiportIx, VertiportIx)],
    ) -> Vec<(Route, Time)> {
        let time = time.max(self.now);
        let in_force = |closure: &mut Closure| {
            let pair = (closure.route.from, closure.route.to);
            (closure.start..closure.end).contains(&time) && pairs.contains(&pair)
        };
        let ended = self.closures.extract_if(.., in_force);
        ended.map(|closure| (closure.route, closure.start)).collect()
    }

    /// Makes all closures known whose end is.
    fn announce(&mut self, time: Time, reported: &[(VertiportIx, VertiportIx)]) {
        let (now, size) = (self.now.max(time), self.scenario().vertiports.len());
        self.known.closures.announce(&self.closures, reported, now, size);
        for pair in reported {
            self.closed_since.remove(pair);
        }
        self.known.eventful = true;
        self.forget();
    }

    /// Makes policies treat the day as a new one, because what they keep of it no longer holds:
    /// they read stands and known closures once a day.
    pub(in crate::live) fn forget(&mut self) {
        self.known.scenario = Arc::new(Scenario::clone(&self.known.scenario));
    }

    fn check_routes(&self, routes: Routes) -> Result<usize, ReportError> {
        match routes {
            Routes::Way { from, to } if from == to => return Err(ReportError::Unknown("route")),
            Routes::Way { from, to } => {
                self.check_vertiport(from)?;
                self.check_vertiport(to)?;
            }
            Routes::Of(vertiport) => self.check_vertiport(vertiport)?,
        }
        Ok(self.scenario().vertiports.len())
    }

    fn period_start(&self, period: usize) -> Result<Time, ReportError> {
        self.scenario().periods.get(period).copied().ok_or(ReportError::Unknown("period"))
    }

    fn check_period(&self, period: usize) -> Result<(), ReportError> {
        let start = self.period_start(period)?;
        if period < self.known.period && !self.known.demand.waits(period) {
            return Err(ReportError::PeriodOver { start, now: self.now });
        }
        Ok(())
    }

    pub(super) fn set_demand(
        &mut self,
        period: usize,
        pairs: &[(VertiportIx, VertiportIx, u32)],
    ) -> Result<(), ReportError> {
        self.period_start(period)?;
        for &(from, to, passengers) in pairs {
            self.check_routes(Routes::Way { from, to })?;
            if passengers > MOST_PASSENGERS {
                return Err(ReportError::TooMany { most: MOST_PASSENGERS });
            }
        }
        for &(from, to, passengers) in pairs {
            self.known.demand.set_own(period, from, to, passengers);
        }
        self.is_stale = true;
        Ok(())
    }

    pub(super) fn book(&mut self, booking: Booking) -> Result<(), ReportError> {
        let left = self.left(booking)?;
        self.set_left(booking, left.saturating_add(booking.passengers))
    }

    pub(super) fn cancel(&mut self, booking: Booking) -> Result<(), ReportError> {
        let (left, cancelled) = (self.left(booking)?, booking.passengers);
        let still =
            left.checked_sub(cancelled).ok_or(ReportError::TooFewPassengers { cancelled, left })?;
        self.set_left(booking, still)
    }

    fn left(&self, Booking { period, from, to, .. }: Booking) -> Result<u32, ReportError> {
        self.check_period(period)?;
        self.check_routes(Routes::Way { from, to })?;
        Ok(self.known.demand.own(period, from, to))
    }

    fn set_left(&mut self, booking: Booking, left: u32) -> Result<(), ReportError> {
        self.set_demand(booking.period, &[(booking.from, booking.to, left)])
    }
}
