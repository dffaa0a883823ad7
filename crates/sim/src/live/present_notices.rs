//! Notices about the present state of a live day.

use vertifleet_core::VertiportIx;

use super::notice::Notice;
use super::{AircraftNow, LiveDay, Phase};

/// An aircraft that should have departed or landed so long ago is overdue, seconds.
const LATE_S: u32 = 300;

impl LiveDay {
    /// Notices for people at present: vertiports that have more aircraft than stands, aircraft that
    /// are overdue, and aircraft that lack energy for their flight.
    pub fn notices(&self) -> impl Iterator<Item = Notice> + '_ {
        let vertiports = VertiportIx::all(self.scenario().vertiports.len());
        let crowded = vertiports.filter_map(|vertiport| self.more_than_stands(vertiport));
        let of_aircraft = |aircraft: AircraftNow| {
            self.overdue(aircraft).into_iter().chain(self.lacks_energy_now(aircraft.aircraft))
        };
        crowded.chain(self.aircraft().flat_map(of_aircraft))
    }

    fn overdue(&self, aircraft: AircraftNow) -> Option<Notice> {
        let (done, time) = match aircraft.phase {
            Phase::Standing => return None,
            Phase::SentOff { departs, .. } => ("departed", departs),
            Phase::InTheAir { .. } => ("landed", aircraft.arrival),
        };
        let aircraft = self.id(aircraft.aircraft);
        (self.now > time + LATE_S).then_some(Notice::Overdue { aircraft, done, time })
    }

    pub(super) fn more_than_stands(&self, vertiport: VertiportIx) -> Option<Notice> {
        let stands = &self.known.stands;
        let ((mut taken, mut limit), parked) = (
            (stands.taken()[vertiport.at()], stands.limit()[vertiport.at()]),
            stands.parked(vertiport),
        );
        if taken <= limit && parked.0 > parked.1 {
            (taken, limit) = parked;
        }
        (taken > limit).then(|| Notice::MoreThanStands {
            vertiport: self.vertiport_id(vertiport),
            taken,
            stands: limit,
        })
    }
}
