//! Stands: how many aircraft each vertiport holds or has promised a place to (Eq. 16).
//!
//! A stand is taken at take-off *towards* a vertiport and freed at take-off *from* it, so the bound holds at every
//! instant and two aircraft can never race for the last place.

use vertifleet_core::{Scenario, VertiportIx};

use crate::VertiportSet;

/// U_i and U_max of every vertiport, and which of them have a stand free.
#[derive(Debug, Clone)]
pub(crate) struct Stands {
    taken: Vec<u16>,
    limit: Vec<u16>,
    open: VertiportSet,
}

impl Stands {
    /// The stands as the fleet's start positions take them.
    pub(crate) fn at_start(scenario: &Scenario) -> Self {
        let limit: Vec<u16> =
            scenario.vertiports.iter().map(|vertiport| vertiport.stands).collect();
        let mut taken = vec![0; limit.len()];
        for aircraft in &scenario.aircraft {
            taken[aircraft.at.at()] += 1;
        }
        let open =
            VertiportIx::all(limit.len()).filter(|v| taken[v.at()] < limit[v.at()]).collect();
        Self { taken, limit, open }
    }

    /// U_i: aircraft standing at each vertiport or in the air towards it.
    #[inline]
    pub(crate) fn taken(&self) -> &[u16] {
        &self.taken
    }

    /// The vertiports that can promise a place.
    #[inline]
    pub(crate) fn open(&self) -> &VertiportSet {
        &self.open
    }

    /// Moves one aircraft's stand from one vertiport to another that is [open](Self::open).
    #[inline]
    pub(crate) fn transfer(&mut self, from: VertiportIx, to: VertiportIx) {
        debug_assert!(self.open.contains(to), "the mask admits only vertiports with a stand free");
        self.taken[to.at()] += 1;
        if self.taken[to.at()] == self.limit[to.at()] {
            self.open.remove(to);
        }
        self.taken[from.at()] -= 1;
        self.open.insert(from);
    }
}
