//! The sizes that the shapes of observations depend on.

use vertifleet_core::{Network, Scenario};

/// Numbers of vertiports, aircraft, types of aircraft and demand periods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// N.
    pub vertiports: usize,
    /// A.
    pub aircraft: usize,
    /// T.
    pub types: usize,
    /// P.
    pub periods: usize,
}

impl Sizes {
    /// The sizes of a network, which all of its days have.
    pub fn of(network: &Network) -> Self {
        Self {
            vertiports: network.vertiports().len(),
            aircraft: network.fleet_size(),
            types: network.aircraft_types().len(),
            periods: network.periods(),
        }
    }

    /// The sizes of a day.
    pub fn of_day(day: &Scenario) -> Self {
        Self {
            vertiports: day.vertiports.len(),
            aircraft: day.aircraft.len(),
            types: day.aircraft_types.len(),
            periods: day.periods.len(),
        }
    }

    /// The larger of two, size by size.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self {
            vertiports: self.vertiports.max(other.vertiports),
            aircraft: self.aircraft.max(other.aircraft),
            types: self.types.max(other.types),
            periods: self.periods.max(other.periods),
        }
    }

    /// Whether a day of these sizes can be shown in arrays of `other`.
    pub fn fits(self, other: Self) -> bool {
        self.max(other) == other
    }
}
