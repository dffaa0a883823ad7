//! The order of decisions: a tournament over all aircraft by (time, aircraft index), the total
//! order of events.
//!
//! Each inner node holds the earlier of its two children, so the winner stands at the root, and a
//! new time for one aircraft costs one branch-free walk to the top.

use vertifleet_core::{AircraftIx, Time};

use crate::room::clone_into_room;

/// The time at which each aircraft of a fleet will be ready, earliest first.
#[derive(Debug)]
pub(crate) struct ReadyQueue {
    /// The root is at 1, the children of `n` are at `2n` and `2n + 1`, and the aircraft begin at
    /// `first_leaf`.
    nodes: Vec<u64>,
    first_leaf: usize,
}

clone_into_room!(ReadyQueue { nodes, first_leaf });

/// A key that orders by time, then by aircraft index.
#[inline]
fn key(aircraft: AircraftIx, ready_at: Time) -> u64 {
    u64::from(ready_at.seconds()) << 16 | u64::from(aircraft.0)
}

impl ReadyQueue {
    /// A queue of `aircraft_count` aircraft that are all ready at the same time.
    pub(crate) fn new(aircraft_count: usize, ready_at: Time) -> Self {
        let first_leaf = aircraft_count.next_power_of_two().max(2);
        let mut queue = Self { nodes: vec![u64::MAX; 2 * first_leaf], first_leaf };
        queue.set_all(aircraft_count, |_| ready_at);
        queue
    }

    /// Gives every aircraft of a fleet a new time.
    pub(crate) fn set_all(&mut self, aircraft_count: usize, ready_at: impl Fn(AircraftIx) -> Time) {
        for aircraft in AircraftIx::all(aircraft_count) {
            self.nodes[self.first_leaf + aircraft.at()] = key(aircraft, ready_at(aircraft));
        }
        for node in (1..self.first_leaf).rev() {
            self.nodes[node] = self.nodes[2 * node].min(self.nodes[2 * node + 1]);
        }
    }

    /// The aircraft that is ready first, with its time. Of several, it is the one with the lowest
    /// index.
    #[inline]
    pub(crate) fn earliest(&self) -> (AircraftIx, Time) {
        let winner = self.nodes[1];
        // Both casts keep exactly the bits that `key` put there.
        #[expect(clippy::cast_possible_truncation, reason = "undoes `key`")]
        (AircraftIx(winner as u16), Time::from_seconds((winner >> 16) as u32))
    }

    /// The time at which the aircraft will be ready.
    #[inline]
    pub(crate) fn ready_at(&self, aircraft: AircraftIx) -> Time {
        #[expect(clippy::cast_possible_truncation, reason = "undoes `key`")]
        Time::from_seconds((self.nodes[self.first_leaf + aircraft.at()] >> 16) as u32)
    }

    /// Gives the aircraft a new time.
    #[inline]
    pub(crate) fn set(&mut self, aircraft: AircraftIx, ready_at: Time) {
        let mut node = self.first_leaf + aircraft.at();
        let mut winner = key(aircraft, ready_at);
        self.nodes[node] = winner;
        while node > 1 {
            winner = winner.min(self.nodes[node ^ 1]);
            node /= 2;
            self.nodes[node] = winner;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{prop_assert_eq, proptest};
    use vertifleet_core::{AircraftIx, Time};

    use super::ReadyQueue;

    proptest! {
        #[test]
        fn the_earliest_is_the_minimum_by_time_then_index(
            fleet in 1_usize..70, changes in proptest::collection::vec((0_usize..70, 0_u32..50), 0..200)
        ) {
            let mut queue = ReadyQueue::new(fleet, Time::from_seconds(20));
            let mut plain = vec![20; fleet];
            for (aircraft, time) in changes {
                let aircraft = aircraft % fleet;
                queue.set(AircraftIx::new(aircraft), Time::from_seconds(time));
                plain[aircraft] = time;
                let (time, first) =
                    plain.iter().enumerate().map(|(at, &time)| (time, at)).min().expect("a fleet");
                prop_assert_eq!(queue.earliest(), (AircraftIx::new(first), Time::from_seconds(time)));
                prop_assert_eq!(queue.ready_at(AircraftIx::new(aircraft)).seconds(), plain[aircraft]);
            }
        }
    }
}
