//! Routes that are closed at the moment, as the day goes on.

use vertifleet_core::{Scenario, Time, VertiportIx};

use crate::VertiportSet;
use crate::room::clone_into_room;

/// The closures of a day, up to now.
#[derive(Debug)]
pub(crate) struct Closures {
    /// Every opening and closing of a route, in order of time; those before `next` have happened.
    changes: Vec<Change>,
    next: usize,
    /// Closures in force by route, `[from][to]` row by row: closures may overlap.
    in_force: Vec<u16>,
    /// By vertiport: where flights from it may not go now.
    closed: Vec<VertiportSet>,
}

clone_into_room!(Closures { changes, next, in_force, closed });

#[derive(Debug, Clone, Copy)]
struct Change {
    time: Time,
    closes: bool,
    from: VertiportIx,
    to: VertiportIx,
}

impl Closures {
    /// A day's closures before it begins; none of its memory is taken on a day without.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        let closures = &scenario.disturbances.closures;
        let mut changes = Vec::new();
        for closure in closures {
            let route = closure.route;
            let back = route.both_ways.then_some((route.to, route.from));
            for (from, to) in [(route.from, route.to)].into_iter().chain(back) {
                changes.push(Change { time: closure.start, closes: true, from, to });
                changes.push(Change { time: closure.end, closes: false, from, to });
            }
        }
        // Closings first: a closure without duration closes before it opens, and counts never fall below 0.
        changes.sort_by_key(|change| (change.time, !change.closes));
        let size = if closures.is_empty() { 0 } else { scenario.vertiports.len() };
        Self {
            changes,
            next: 0,
            in_force: vec![0; size * size],
            closed: vec![VertiportSet::EMPTY; size],
        }
    }

    /// Carries out what happens up to and at `time`.
    pub(crate) fn advance(&mut self, time: Time) {
        while let Some(change) = self.changes.get(self.next).filter(|change| change.time <= time) {
            let Change { closes, from, to, .. } = *change;
            self.next += 1;
            let in_force = &mut self.in_force[from.at() * self.closed.len() + to.at()];
            if closes {
                *in_force += 1;
                self.closed[from.at()].insert(to);
            } else {
                *in_force -= 1;
                if *in_force == 0 {
                    self.closed[from.at()].remove(to);
                }
            }
        }
    }

    /// Openings and closings that have happened.
    #[inline]
    pub(crate) fn changes_so_far(&self) -> usize {
        self.next
    }

    /// Whether the day has no closures at all.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.closed.is_empty()
    }

    /// Where flights from a vertiport may not go now.
    #[cold]
    pub(crate) fn from(&self, from: VertiportIx) -> VertiportSet {
        self.closed.get(from.at()).copied().unwrap_or(VertiportSet::EMPTY)
    }
}
