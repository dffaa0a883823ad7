//! The routes that are closed at the moment, as the day goes on, and those that are known to close
//! later.

use std::sync::Arc;

use vertifleet_core::{ClosedTimes, Closure, Scenario, Time, VertiportIx};

use crate::VertiportSet;
use crate::room::clone_into_room;

/// The closures of a day up to the present.
#[derive(Debug)]
pub(crate) struct Closures {
    /// Everything that stays the same, shared by all imagined days.
    day: Arc<DayClosures>,
    /// Index of the next change; the changes before it have happened.
    next: usize,
    /// Whether unknown closures stay as they are from now on.
    no_surprises: bool,
    /// How often an unknown closure has begun or ended.
    surprises: usize,
    /// Number of unknown closures in force on each route, `[from][to]` row by row; closures may
    /// overlap.
    in_force: Vec<u16>,
    /// By vertiport, the destinations that are closed now because of unknown closures, and in
    /// `scheduled` those closed by known ones.
    unexpected: Vec<VertiportSet>,
    scheduled: Vec<VertiportSet>,
}

clone_into_room!(Closures { day, next, no_surprises, surprises, in_force, unexpected, scheduled });

/// The closures of a day as changes in order of time.
#[derive(Debug)]
struct DayClosures {
    /// Every beginning and end of an unknown closure, and every closing and opening of a route by
    /// known ones, in order of time.
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
    fn of(closures: &[Closure], size: usize) -> Self {
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
        // Beginnings come first, so that a closure without duration closes before it opens and
        // counts never fall below 0.
        changes.sort_by_key(|change| (change.time, !change.closes));
        Self { changes, known }
    }
}

fn pairs(size: usize) -> impl Iterator<Item = (VertiportIx, VertiportIx)> {
    let all = VertiportIx::all(size);
    all.clone().flat_map(move |from| all.clone().map(move |to| (from, to)))
}

impl Closures {
    /// The closures of a day before it begins. On a day without closures this takes almost no
    /// memory.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        let day = DayClosures::of(&scenario.disturbances.closures, scenario.vertiports.len());
        let size = if day.changes.is_empty() { 0 } else { scenario.vertiports.len() };
        Self::before(day, size)
    }

    /// The closures before any has begun; `size` is the number of vertiports, or 0 if there are no
    /// closures.
    fn before(day: DayClosures, size: usize) -> Self {
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

    /// Carries out the changes up to and at `time`.
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

    /// Carries out the beginning or end of an unknown closure.
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

    /// Takes the report that a route is closed or open from now on, for as long as nothing else is
    /// reported.
    pub(crate) fn report(
        &mut self,
        from: VertiportIx,
        to: VertiportIx,
        is_closed: bool,
        size: usize,
    ) {
        if self.is_empty() {
            let surprises = self.surprises;
            *self = Self { surprises, ..Self::before(DayClosures::of(&[], size), size) };
        }
        self.surprises += 1;
        if is_closed {
            self.unexpected[from.at()].insert(to);
        } else {
            self.unexpected[from.at()].remove(to);
        }
    }

    /// Replaces the known closures. On the `reported` routes no other closure is in force any more.
    /// The report counts as a change of routes; `now` is the time of the day.
    pub(crate) fn announce(
        &mut self,
        known: &[Closure],
        reported: &[(VertiportIx, VertiportIx)],
        now: Time,
        size: usize,
    ) {
        let mut announced = Self::before(DayClosures::of(known, size), size);
        announced.advance(now);
        if !self.is_empty() {
            announced.unexpected.clone_from(&self.unexpected);
        }
        for &(from, to) in reported {
            announced.unexpected[from.at()].remove(to);
        }
        announced.surprises = self.surprises + 1;
        *self = announced;
    }

    /// Stops unknown closures from beginning or ending from now on.
    pub(crate) fn expect_no_surprises(&mut self) {
        self.no_surprises = true;
    }

    /// How often an unknown closure has begun or ended so far.
    #[inline]
    pub(crate) fn surprises_so_far(&self) -> usize {
        self.surprises
    }

    /// The times at which known closures close routes, over the whole day.
    #[inline]
    pub(crate) fn known(&self) -> &ClosedTimes {
        &self.day.known
    }

    /// Whether the day has no closures at all.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.unexpected.is_empty()
    }

    /// The destinations to which flights from a vertiport are closed now.
    #[cold]
    pub(crate) fn from(&self, from: VertiportIx) -> VertiportSet {
        let scheduled = self.scheduled.get(from.at()).copied().unwrap_or(VertiportSet::EMPTY);
        scheduled.or(&self.unexpected_from(from))
    }

    /// The destinations that are closed now because of unknown closures.
    #[cold]
    pub(crate) fn unexpected_from(&self, from: VertiportIx) -> VertiportSet {
        self.unexpected.get(from.at()).copied().unwrap_or(VertiportSet::EMPTY)
    }
}
