//! The times at which aircraft take and free stands (Eq. 16), for a whole schedule at once.
//!
//! Events of a day are totally ordered by time, then aircraft; a [`Moment`] is a place in that
//! order. A stand is taken at take-off towards a vertiport and freed at take-off from it, so the
//! number of stands taken is a step function over moments. One more aircraft fits wherever that
//! number stays below U_max: in the *windows*.

use vertifleet_core::{AircraftIx, VertiportIx};

/// A place in the total order of a day's events: time, then aircraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Moment(u32);

impl Moment {
    /// The moment before every event.
    pub(super) const FIRST: Self = Self(0);
    /// The moment after every event.
    pub(super) const NEVER: Self = Self(u32::MAX);
    /// Fleets have at most 10,000 aircraft, and decisions are taken before 36:00:00, which is below
    /// 2^17 seconds.
    const AIRCRAFT_BITS: u32 = 14;

    #[inline]
    pub(super) fn of(time_s: u32, aircraft: AircraftIx) -> Self {
        Self(time_s << Self::AIRCRAFT_BITS | (u32::from(aircraft.0) + 1))
    }
}

/// A time in which one more aircraft fits: from `opens` on, and it has to leave before `closes`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub(super) opens: Moment,
    pub(super) closes: Moment,
}

/// A change of the number of stands that are taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    pub(super) moment: Moment,
    /// 1 for a stand that is taken, -1 for one that is freed.
    pub(super) by: i32,
}

/// The stands of every vertiport over the day.
#[derive(Debug, Clone)]
pub(super) struct StandTimes {
    limit: Vec<i32>,
    taken_at_first: Vec<i32>,
    /// The changes of each vertiport, in order.
    changes: Vec<Vec<Change>>,
    /// The vertiports whose changes are only [replaced](Self::replace), all at once.
    replaced: Vec<bool>,
}

impl Window {
    /// The whole day.
    pub(super) const ALWAYS: Self = Self { opens: Moment::FIRST, closes: Moment::NEVER };
}

impl StandTimes {
    /// The stands without any aircraft.
    pub(super) fn empty(limit: &[u16]) -> Self {
        Self {
            limit: limit.iter().map(|&stands| i32::from(stands)).collect(),
            taken_at_first: vec![0; limit.len()],
            changes: vec![Vec::new(); limit.len()],
            replaced: vec![false; limit.len()],
        }
    }

    /// U_max of a vertiport.
    pub(super) fn limit(&self, vertiport: VertiportIx) -> i32 {
        self.limit[vertiport.at()]
    }

    /// Replaces all changes of a vertiport. From then on, what is entered for it one by one is
    /// ignored.
    pub(super) fn replace(&mut self, vertiport: VertiportIx, at_first: i32, changes: Vec<Change>) {
        self.replaced[vertiport.at()] = true;
        self.taken_at_first[vertiport.at()] = at_first;
        self.changes[vertiport.at()] = changes;
    }

    /// Records that an aircraft is at `vertiport`, or on its way there, before the first event.
    pub(super) fn take_at_first(&mut self, vertiport: VertiportIx) {
        self.taken_at_first[vertiport.at()] += 1;
    }

    #[inline]
    pub(super) fn take(&mut self, vertiport: VertiportIx, moment: Moment) {
        self.enter(vertiport, Change { moment, by: 1 });
    }

    #[inline]
    pub(super) fn free(&mut self, vertiport: VertiportIx, moment: Moment) {
        self.enter(vertiport, Change { moment, by: -1 });
    }

    fn enter(&mut self, vertiport: VertiportIx, change: Change) {
        if self.replaced[vertiport.at()] {
            return;
        }
        let changes = &mut self.changes[vertiport.at()];
        let at = changes.partition_point(|other| other.moment < change.moment);
        changes.insert(at, change);
    }

    /// Removes the change that was entered for this moment. No two changes of a vertiport share a
    /// moment.
    pub(super) fn take_back(&mut self, vertiport: VertiportIx, moment: Moment) {
        if self.replaced[vertiport.at()] {
            return;
        }
        let changes = &mut self.changes[vertiport.at()];
        let at = changes.partition_point(|other| other.moment < moment);
        debug_assert!(changes[at].moment == moment, "only what was entered is taken back");
        changes.remove(at);
    }

    /// Appends the windows of a vertiport in order. No window touches the next.
    pub(super) fn append_windows(&self, vertiport: VertiportIx, windows: &mut Vec<Window>) {
        let limit = self.limit[vertiport.at()];
        let mut taken = self.taken_at_first[vertiport.at()];
        let mut opens = (taken < limit).then_some(Moment::FIRST);
        for change in &self.changes[vertiport.at()] {
            taken += change.by;
            if taken >= limit {
                if let Some(opens) = opens.take() {
                    windows.push(Window { opens, closes: change.moment });
                }
            } else if opens.is_none() {
                opens = Some(change.moment);
            }
        }
        if let Some(opens) = opens {
            windows.push(Window { opens, closes: Moment::NEVER });
        }
    }

    /// Whether the stands suffice at every moment.
    #[cfg(test)]
    pub(super) fn suffice(&self) -> bool {
        self.changes.iter().enumerate().all(|(vertiport, changes)| {
            let mut taken = self.taken_at_first[vertiport];
            taken <= self.limit[vertiport]
                && changes.iter().all(|change| {
                    taken += change.by;
                    taken <= self.limit[vertiport]
                })
        })
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{AircraftIx, VertiportIx};

    use super::{Moment, StandTimes};

    #[test]
    fn windows_are_where_one_more_aircraft_fits() {
        let port = VertiportIx(0);
        let at = |time_s| Moment::of(time_s, AircraftIx(1));
        let mut stands = StandTimes::empty(&[2]);
        stands.take_at_first(port);
        stands.take(port, at(100));
        stands.free(port, at(300));
        stands.take(port, at(500));
        let windows = |stands: &StandTimes| {
            let mut windows = Vec::new();
            stands.append_windows(port, &mut windows);
            windows.iter().map(|window| (window.opens, window.closes)).collect::<Vec<_>>()
        };
        assert_eq!(windows(&stands), [(Moment::FIRST, at(100)), (at(300), at(500))]);
        stands.take_back(port, at(500));
        assert_eq!(windows(&stands), [(Moment::FIRST, at(100)), (at(300), Moment::NEVER)]);
        assert!(stands.suffice());
        stands.take(port, at(200));
        assert!(!stands.suffice());
    }

    #[test]
    fn moments_follow_time_then_aircraft() {
        let latest = Moment::of(36 * 3600, AircraftIx(9_999));
        assert!(Moment::of(5, AircraftIx(7)) < Moment::of(5, AircraftIx(8)));
        assert!(Moment::of(5, AircraftIx(8)) < Moment::of(6, AircraftIx(0)));
        assert!(Moment::FIRST < Moment::of(0, AircraftIx(0)) && latest < Moment::NEVER);
    }
}
