//! The fleet at its next decisions, for a search for prices.

use vertifleet_core::{AircraftIx, Time, TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::levels::{Level, Levels, ReadyAt};

/// An aircraft at its next decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Ready {
    pub(super) kind: TypeIx,
    pub(super) place: VertiportIx,
    pub(super) at_s: u32,
    pub(super) level: Level,
}

/// All aircraft, and those that are alike as groups: they take the same way, so one of each group
/// shows it. In the morning, when every aircraft is ready, there are as few groups as vertiports.
#[derive(Debug, Clone, Default)]
pub(super) struct Fleet {
    aircraft: Vec<Ready>,
    sorted: Vec<Ready>,
    groups: Vec<(Ready, u32)>,
}

impl Fleet {
    /// Takes the fleet of a view.
    pub(super) fn load(&mut self, view: View<'_>, levels: &Levels) {
        self.aircraft.clear();
        let ready = AircraftIx::all(view.places().len()).map(|aircraft| view.ready_at(aircraft));
        let now_s = ready.min().map_or(0, Time::seconds);
        self.aircraft.extend(AircraftIx::all(view.places().len()).map(|aircraft| {
            let (kind, place) = (view.kind(aircraft), view.places()[aircraft.at()]);
            let mut ready = ReadyAt { level: 0, time_s: view.ready_at(aircraft).seconds() };
            if view.charges_as_needed() {
                let to_full_s = view.to_full_s(aircraft, view.ready_at(aircraft));
                ready = levels.of_kind(kind)[place.at()].nearest(ready.time_s, to_full_s);
                ready = ready.no_sooner_than(now_s);
            }
            Ready { kind, place, at_s: ready.time_s, level: ready.level }
        }));
        self.sorted.clone_from(&self.aircraft);
        self.sorted.sort_unstable();
        self.groups.clear();
        for &ready in &self.sorted {
            match self.groups.last_mut() {
                Some((same, count)) if *same == ready => *count += 1,
                _ => self.groups.push((ready, 1)),
            }
        }
    }

    /// The time at which the first aircraft is ready, seconds; `None` without aircraft.
    pub(super) fn first_ready_s(&self) -> Option<u32> {
        self.aircraft.iter().map(|ready| ready.at_s).min()
    }

    /// Every aircraft, in the order of the day.
    pub(super) fn all(&self) -> &[Ready] {
        &self.aircraft
    }

    /// Aircraft that are alike, and their number.
    pub(super) fn groups(&self) -> &[(Ready, u32)] {
        &self.groups
    }
}
