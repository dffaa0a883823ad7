//! Stands: how many aircraft each vertiport holds or has promised a stand to (Eq. 16).
//!
//! A stand is taken at take-off *towards* a vertiport and freed at take-off *from* it, so the bound
//! holds at every instant, and two aircraft can never compete for the last stand.
//!
//! A vertiport may have two pools: *chargers*, which flights need, and *stands* to wait on. A hold
//! moves an aircraft from its charger to a stand if one is free. Everywhere else stands are the
//! only pool, and flights need them. In this file, *place* means a charger in the former case and a
//! stand in the latter.

use vertifleet_core::{AircraftIx, Scenario, VertiportIx};

use crate::VertiportSet;
use crate::room::clone_into_room;

/// U_i and U_max of every vertiport, and the vertiports that can promise a place.
#[derive(Debug)]
pub(crate) struct Stands {
    /// Number of aircraft on places that flights need, or in the air towards one.
    taken: Vec<u16>,
    limit: Vec<u16>,
    open: VertiportSet,
    parking: Option<Parking>,
}

clone_into_room!(Stands { taken, limit, open, parking });

/// The stands of vertiports that also have chargers.
#[derive(Debug)]
struct Parking {
    taken: Vec<u16>,
    /// Number of such stands; 0 where stands are the only pool.
    limit: Vec<u16>,
    /// Whether each aircraft waits on a stand without a charger.
    waits: Vec<bool>,
}

clone_into_room!(Parking { taken, limit, waits });

impl Stands {
    /// The places at the start of the day: every aircraft is on a stand.
    pub(crate) fn at_start(scenario: &Scenario) -> Self {
        let vertiports = &scenario.vertiports;
        let limit: Vec<u16> = vertiports
            .iter()
            .map(|vertiport| vertiport.chargers.unwrap_or(vertiport.stands))
            .collect();
        let mut taken = vec![0; limit.len()];
        let mut parking =
            vertiports.iter().any(|vertiport| vertiport.chargers.is_some()).then(|| {
                let stands = |vertiport: &vertifleet_core::Vertiport| {
                    vertiport.chargers.map_or(0, |_| vertiport.stands)
                };
                Parking {
                    taken: vec![0; limit.len()],
                    limit: vertiports.iter().map(stands).collect(),
                    waits: vec![false; scenario.aircraft.len()],
                }
            });
        for (number, aircraft) in scenario.aircraft.iter().enumerate() {
            match &mut parking {
                Some(parking) if vertiports[aircraft.at.at()].chargers.is_some() => {
                    parking.taken[aircraft.at.at()] += 1;
                    parking.waits[number] = true;
                }
                _ => taken[aircraft.at.at()] += 1,
            }
        }
        let open =
            VertiportIx::all(limit.len()).filter(|v| taken[v.at()] < limit[v.at()]).collect();
        Self { taken, limit, open, parking }
    }

    /// Number of aircraft on places that flights need, or in the air towards one, by vertiport.
    #[inline]
    pub(crate) fn taken(&self) -> &[u16] {
        &self.taken
    }

    /// Number of places that flights need, by vertiport.
    #[inline]
    pub(crate) fn limit(&self) -> &[u16] {
        &self.limit
    }

    /// Number of aircraft that wait on stands without a charger, and number of such stands; both 0
    /// where stands are the only pool.
    pub(crate) fn parked(&self, vertiport: VertiportIx) -> (u16, u16) {
        let parking = self.parking.as_ref();
        parking.map_or((0, 0), |parking| {
            (parking.taken[vertiport.at()], parking.limit[vertiport.at()])
        })
    }

    /// The vertiports that can promise a place.
    #[inline]
    pub(crate) fn open(&self) -> &VertiportSet {
        &self.open
    }

    /// Moves an aircraft's place from one vertiport to another. The mask admits only
    /// [open](Self::open) ones; a report may force the move to any.
    #[inline]
    pub(crate) fn transfer(&mut self, aircraft: AircraftIx, from: VertiportIx, to: VertiportIx) {
        self.taken[to.at()] += 1;
        if self.taken[to.at()] >= self.limit[to.at()] {
            self.open.remove(to);
        }
        if self.parking.is_some() && self.leave_stand(aircraft, from) {
            return;
        }
        self.free(from);
    }

    /// Frees a place. A vertiport that holds more aircraft than it has places stays closed until it
    /// has one again.
    #[inline]
    fn free(&mut self, at: VertiportIx) {
        self.taken[at.at()] -= 1;
        if self.taken[at.at()] < self.limit[at.at()] {
            self.open.insert(at);
        }
    }

    /// Frees the stand of an aircraft that waits on one without a charger. Returns `false` if it
    /// does not wait on one.
    #[cold]
    fn leave_stand(&mut self, aircraft: AircraftIx, from: VertiportIx) -> bool {
        let Some(parking) = &mut self.parking else { return false };
        let waits = std::mem::take(&mut parking.waits[aircraft.at()]);
        parking.taken[from.at()] -= u16::from(waits);
        waits
    }

    /// Lets an aircraft hold: it moves from a charger to a stand, if one is free.
    #[inline]
    pub(crate) fn hold(&mut self, aircraft: AircraftIx, at: VertiportIx) {
        if self.parking.is_some() {
            self.park(aircraft, at);
        }
    }

    #[cold]
    fn park(&mut self, aircraft: AircraftIx, at: VertiportIx) {
        let Some(parking) = &mut self.parking else { return };
        if parking.waits[aircraft.at()] || parking.taken[at.at()] >= parking.limit[at.at()] {
            return;
        }
        parking.waits[aircraft.at()] = true;
        parking.taken[at.at()] += 1;
        self.free(at);
    }

    /// Whether an aircraft waits on a stand without a charger.
    pub(crate) fn waits(&self, aircraft: AircraftIx) -> bool {
        self.parking.as_ref().is_some_and(|parking| parking.waits[aircraft.at()])
    }

    /// Frees the stand or charger that an aircraft takes at a vertiport.
    pub(crate) fn leave(&mut self, aircraft: AircraftIx, at: VertiportIx) {
        if self.parking.is_none() || !self.leave_stand(aircraft, at) {
            self.free(at);
        }
    }

    /// Takes a place at a vertiport, even if there is none free: it was reported there, or on its
    /// way. With `waits` it is a stand without a charger.
    pub(crate) fn take(&mut self, aircraft: AircraftIx, at: VertiportIx, waits: bool) {
        if waits && let Some(parking) = &mut self.parking {
            parking.waits[aircraft.at()] = true;
            parking.taken[at.at()] += 1;
            return;
        }
        self.taken[at.at()] += 1;
        if self.taken[at.at()] >= self.limit[at.at()] {
            self.open.remove(at);
        }
    }

    /// Changes the number of places that flights need at a vertiport.
    pub(crate) fn set_limit(&mut self, at: VertiportIx, limit: u16) {
        self.limit[at.at()] = limit;
        if self.taken[at.at()] < limit {
            self.open.insert(at);
        } else {
            self.open.remove(at);
        }
    }
}
