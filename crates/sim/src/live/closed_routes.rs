//! The closed routes of a live day: those in force, and those that are known to close later.
//!
//! The latest report about a route, in the order of the reports, replaces every closure that is in
//! force on it. Closures known in advance that begin later still begin.

use vertifleet_core::{Time, VertiportIx};

use super::LiveDay;

/// A time in which a route is closed, in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClosedRoute {
    /// The vertiport of departure.
    pub from: VertiportIx,
    /// The vertiport of destination.
    pub to: VertiportIx,
    /// Since when it is closed, or when it will close.
    pub start: Time,
    /// When it opens; `None` if only a report opens it.
    pub until: Option<Time>,
}

impl LiveDay {
    /// Every closed route in force or known for later, by vertiport of departure, destination and
    /// time.
    pub fn closed_routes(&self) -> impl Iterator<Item = ClosedRoute> + '_ {
        let all = VertiportIx::all(self.scenario().vertiports.len());
        let pairs = all.clone().flat_map(move |from| all.clone().map(move |to| (from, to)));
        pairs.flat_map(|(from, to)| self.closed_times(from, to))
    }

    fn closed_times(&self, from: VertiportIx, to: VertiportIx) -> Vec<ClosedRoute> {
        let spans = self.known.closures.known().spans(from, to);
        let mut routes: Vec<ClosedRoute> = spans
            .iter()
            .filter(|span| span.end > self.now)
            .map(|span| ClosedRoute { from, to, start: span.start, until: Some(span.end) })
            .collect();
        let Some(&since) = self.closed_since.get(&(from, to)) else { return routes };
        match routes.first_mut() {
            Some(first) if first.start <= self.now => first.until = None,
            _ => routes.insert(0, ClosedRoute { from, to, start: since, until: None }),
        }
        routes
    }

    /// When a route opens that is closed now, if that is known.
    pub fn opens(&self, from: VertiportIx, to: VertiportIx) -> Option<Time> {
        let in_force = |route: &ClosedRoute| route.start <= self.now;
        self.closed_times(from, to).into_iter().find(in_force)?.until
    }
}
