//! The take-off delays that are known at present, with which imagined days continue.
//!
//! A cause that delays one flight at a vertiport delays others too, so a flight is expected to be
//! as late as the latest one that left the same vertiport in the same quarter of an hour. Nothing
//! is expected of the quarters after that: on 160 days of `disrupted`, days on which every later
//! flight was expected to be as late as the mean earned no more, whether or not the prices expected
//! it too.

use vertifleet_core::{Scenario, Time, VertiportIx};

use crate::room::clone_into_room;

/// Flights are expected to be as late as each other for so long, seconds of the clock.
const TOGETHER_S: u32 = 900;
/// A flight that is later than this has a reason that no other flight shares, seconds.
const MOST_S: u32 = 3_600;

/// The delay of the flight that was decided last, for each vertiport.
#[derive(Debug)]
pub(crate) struct Delays {
    /// Empty on a day without delays, and on one that happens until a flight is late.
    latest: Vec<Option<Delay>>,
    /// Whether others are expected to be as late, as on imagined days.
    are_expected: bool,
}

clone_into_room!(Delays { latest, are_expected });

#[derive(Debug, Clone, Copy)]
struct Delay {
    decided: Time,
    late_s: u32,
}

impl Delays {
    /// The delays of a day before it begins.
    pub(crate) fn before(scenario: &Scenario) -> Self {
        let delays = scenario.disturbances.takeoff_delays.as_ref();
        Self {
            latest: vec![None; delays.map_or(0, |_| scenario.vertiports.len())],
            are_expected: false,
        }
    }

    /// Records how late a flight is, on a day with this number of vertiports. It may be known
    /// before it leaves, and corrected when it does.
    pub(crate) fn note(
        &mut self,
        decided: Time,
        from: VertiportIx,
        late_s: u32,
        vertiports: usize,
    ) {
        if late_s > MOST_S || (late_s == 0 && self.latest.is_empty()) {
            return;
        }
        self.latest.resize(vertiports, None);
        let latest = &mut self.latest[from.at()];
        if latest.is_none_or(|latest| latest.decided <= decided) {
            *latest = Some(Delay { decided, late_s });
        }
    }

    /// Has flights expected to be as late as others from now on.
    pub(crate) fn expect(&mut self) {
        self.are_expected = true;
    }

    /// How late a flight is expected to be, seconds; 0 unless delays are
    /// [expected](Self::expect).
    #[inline]
    pub(crate) fn expected_s(&self, decided: Time, from: VertiportIx) -> u32 {
        if self.are_expected { self.known_s(decided, from) } else { 0 }
    }

    /// How late the latest flight was that left a vertiport in the quarter of an hour of a time,
    /// seconds; 0 if none has left.
    #[inline]
    pub(crate) fn known_s(&self, decided: Time, from: VertiportIx) -> u32 {
        let latest = self.latest.get(from.at()).copied().flatten();
        let quarter = |time: Time| time.seconds() / TOGETHER_S;
        latest
            .filter(|latest| quarter(latest.decided) == quarter(decided))
            .map_or(0, |latest| latest.late_s)
    }
}
