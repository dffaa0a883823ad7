//! Routes that are closed at the moment, as the day goes on, and those that are known to close later.

use std::sync::Arc;

use vertifleet_core::{ClosedTimes, Closure, Scenario, Time, VertiportIx};

use crate::VertiportSet;
use crate::room::clone_into_room;

/// The closures of a day, up to now.
#[derive(Debug)]
pub(crate) struct Closures {
    /// All that stays the same; shared by all who imagine the day from some moment on.
    day: Arc<DayClosures>,
    /// The changes before this one have happened.
    next: usize,
    /// Whether unknown closures stay as they are from now on.
    no_surprises: bool,
    /// Unknown closures that have begun or ended.
    surprises: usize,
    /// Unknown closures in force by route, `[from][to]` row by row: they may overlap.
    in_force: Vec<u16>,
    /// By vertiport: where flights from it may not go now, because of unknown closures, and of known ones.
    unexpected: Vec<VertiportSet>,
    scheduled: Vec<VertiportSet>,
}

clone_into_room!(Closures { day, next, no_surprises, surprises, in_force, unexpected, scheduled });

/// The closures of a day, laid out.
#[derive(Debug)]
struct DayClosures {
    /// Every beginning and end of an unknown closure, every closing and opening of a route by known ones, in order of time.
    changes: Vec<Change>,
    known: ClosedTimes,
}

#[derive(Debug, Clone, Copy)]
struct Change {
    time: Time,
    closes: bool,
    known: bool,
    from: VertiportIx,
    to: VertiportIx,
}

impl DayClosures {
    fn of(scenario: &Scenario) -> Self {
        let size = scenario.vertiports.len();
        let closures = &scenario.disturbances.closures;
        let known = ClosedTimes::of(closures.iter().filter(|closure| closure.known), size);
        let mut changes = Vec::new();
        let mut add = |known, (from, to), (start, end)| {
            changes.push(Change { time: start, closes: true, known, from, to });
            changes.push(Change { time: end, closes: false, known, from, to });
        };
        for &Closure { route, start, end, .. } in closures.iter().filter(|closure| !closure.known) {
            let back = route.both_ways.then_some((route.to, route.from));
            for pair in [(route.from, route.to)].into_iter().chain(back) {
                add(false, pair, (start, end));
            }
        }
        if !known.is_empty() {
            for (from, to) in pairs(size) {
                for span in known.spans(from, to) {
                    add(true, (from, to), (span.start, span.end));
                }
            }
        }
        // Closings first: a closure without duration closes before it opens, and counts never fall below 0.
        changes.sort_by_key(|change| (change.time, !change.closes));
        Self { changes, known }
    }
}

fn pairs(size: usize) -> impl Iterator<Item = (VertiportIx, VertiportIx)> {
    let all = VertiportIx::all(size);
    all.clone().flat_map(move |from| all.clone().map(move |to| (from, to)))
}

impl Closures {
    /// A day's closures before it begins; next to no memory is taken on a day without.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        let day = DayClosures::of(scenario);
        let size = if day.changes.is_empty() { 0 } else { scenario.vertiports.len() };
        Self {
            day: Arc::new(day),
            next: 0,
            no_surprises: false,
            surprises: 0,
            in_force: vec![0; size * size],
            unexpected: vec![VertiportSet::EMPTY; size],
            scheduled: vec![VertiportSet::EMPTY; size],
        }
    }

    /// Carries out what happens up to and at `time`.
    pub(crate) fn advance(&mut self, time: Time) {
        while let Some(&change) = self.day.changes.get(self.next)
            && change.time <= time
        {
            self.next += 1;
            let Change { closes, from, to, .. } = change;
            match (change.known, closes) {
                (true, true) => self.scheduled[from.at()].insert(to),
                (true, false) => self.scheduled[from.at()].remove(to),
                (false, _) if self.no_surprises => {}
                (false, _) => self.surprise(closes, from, to),
            }
        }
    }

    /// An unknown closure begins or ends.
    fn surprise(&mut self, closes: bool, from: VertiportIx, to: VertiportIx) {
        self.surprises += 1;
        let in_force = &mut self.in_force[from.at() * self.unexpected.len() + to.at()];
        if closes {
            *in_force += 1;
            self.unexpected[from.at()].insert(to);
        } else {
            *in_force -= 1;
            if *in_force == 0 {
                self.unexpected[from.at()].remove(to);
            }
        }
    }

    /// From now on unknown closures neither begin nor end.
    pub(crate) fn expect_no_surprises(&mut self) {
        self.no_surprises = true;
    }

    /// Unknown closures that have begun or ended.
    #[inline]
    pub(crate) fn surprises_so_far(&self) -> usize {
        self.surprises
    }

    /// When known closures close routes, all day.
    #[inline]
    pub(crate) fn known(&self) -> &ClosedTimes {
        &self.day.known
    }

    /// Whether the day has no closures at all.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.unexpected.is_empty()
    }

    /// Where flights from a vertiport may not go now.
    #[cold]
    pub(crate) fn from(&self, from: VertiportIx) -> VertiportSet {
        let scheduled = self.scheduled.get(from.at()).copied().unwrap_or(VertiportSet::EMPTY);
        scheduled.or(&self.unexpected_from(from))
    }

    /// The same because of unknown closures.
    #[cold]
    pub(crate) fn unexpected_from(&self, from: VertiportIx) -> VertiportSet {
        self.unexpected.get(from.at()).copied().unwrap_or(VertiportSet::EMPTY)
    }
}
