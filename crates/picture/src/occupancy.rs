//! How many aircraft a vertiport holds or has promised a place to, over a played day (Eq. 16).
//!
//! A stand is taken at the decision to fly *towards* a vertiport and freed at the decision to fly
//! *from* it, so the number changes at decisions only, and never passes the room.

use vertifleet_core::{Scenario, Time, VertiportIx};
use vertifleet_sim::TraceRow;

use crate::map::room;

const HOUR_S: f64 = 3_600.0;

/// The aircraft of one vertiport, there or on their way there, from the start of operations on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Occupancy {
    /// Aircraft that it has room for: its stands, and its chargers where they are counted apart.
    pub room: u32,
    /// The times at which the number changes, each with the number from then on. The first is the
    /// start of operations.
    pub steps: Vec<(Time, u32)>,
    end: Time,
}

impl Occupancy {
    /// The aircraft of a vertiport. `rows` is the trace of the day so far, or of all of it.
    pub fn of(day: &Scenario, rows: &[TraceRow], at: VertiportIx) -> Self {
        let mut taken =
            day.aircraft.iter().map(|aircraft| u32::from(aircraft.at == at)).sum::<u32>();
        let mut steps = vec![(day.operations.start, taken)];
        for row in rows.iter().filter(|row| row.from != row.to) {
            if row.to == at {
                taken += 1;
            } else if row.from == at {
                // A trace of another day may have a flight from where no aircraft is.
                taken = taken.saturating_sub(1);
            } else {
                continue;
            }
            match steps.last_mut() {
                Some((time, last)) if *time == row.time => *last = taken,
                _ => steps.push((row.time, taken)),
            }
        }
        Self { room: room(&day.vertiports[at.at()]), steps, end: day.operations.end }
    }

    /// Mean share of the room that is taken, from the start to the end of operations.
    pub fn mean_share(&self) -> f64 {
        let aircraft_h: f64 = self.spans().map(|(hours, taken)| hours * f64::from(taken)).sum();
        aircraft_h / self.hours() / f64::from(self.room.max(1))
    }

    /// Share of the time from the start to the end of operations in which all of the room is taken.
    pub fn full_share(&self) -> f64 {
        let full = self.spans().filter(|&(_, taken)| taken >= self.room);
        // A sum of no numbers is -0, which would be printed.
        full.map(|(hours, _)| hours).fold(0.0, |sum, hours| sum + hours) / self.hours()
    }

    /// The numbers, each with the hours of operations that it lasts.
    fn spans(&self) -> impl Iterator<Item = (f64, u32)> {
        let until = self.steps.iter().skip(1).map(|&(time, _)| time).chain([self.end]);
        self.steps.iter().zip(until).map(|(&(since, taken), until)| {
            let until_s = until.min(self.end).seconds();
            (f64::from(until_s.saturating_sub(since.seconds())) / HOUR_S, taken)
        })
    }

    /// The hours of operations; a day without any counts as short.
    fn hours(&self) -> f64 {
        let start = self.steps[0].0;
        f64::from(self.end.since(start).max(1)) / HOUR_S
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{Network, VertiportIx};

    use super::Occupancy;

    #[test]
    fn a_vertiport_that_is_never_full_is_full_for_a_share_of_zero_without_a_sign() {
        let mut day = Network::shipped("paper").expect("shipped").mean_day().into_day();
        day.vertiports[0].stands += 1;
        day.aircraft.retain(|aircraft| aircraft.at != VertiportIx::new(0));
        let day = day.check("a day").expect("a day within the rules");
        let share = Occupancy::of(&day, &[], VertiportIx::new(0)).full_share();
        assert!(share == 0.0 && share.is_sign_positive(), "{share:?}");
    }
}
