//! Vertiports that have chargers and also waiting stands, which are stands without a charger: when
//! their places are taken.
//!
//! A flight needs a charger, from its take-off until the aircraft leaves. An aircraft that holds
//! moves to a stand if one is free, and keeps its charger if not. Which aircraft finds a stand free
//! depends on all others, so the places of such vertiports are counted again after every change of
//! a schedule. A change of one aircraft may keep another on its charger for longer. If there are
//! then more aircraft than chargers, the change has to be undone.

use vertifleet_core::{AircraftIx, VertiportIx};

use super::day::Day;
use super::stand_times::{Change, Moment, StandTimes};

/// The stay of an aircraft at a vertiport, from its take-off towards it until it leaves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stay {
    pub(super) aircraft: AircraftIx,
    pub(super) at: VertiportIx,
    /// [`Moment::FIRST`] for an aircraft that starts here, which is on a stand.
    pub(super) comes: Moment,
    /// The second of its first decision here.
    pub(super) ready_s: u32,
    /// The second from which a hold may move it to a stand, because its battery is full.
    pub(super) full_s: u32,
    pub(super) leaves: Moment,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    Comes,
    Holds,
    Leaves,
}

/// The waiting stands of all vertiports that have chargers.
#[derive(Debug, Clone)]
pub(super) struct WaitingStands {
    /// The times at which these stands are taken. A vertiport without chargers has none.
    pub(super) stands: StandTimes,
    /// A vertiport with more aircraft than chargers, if there is one.
    pub(super) overfull: Option<VertiportIx>,
}

impl WaitingStands {
    /// The stands of a day without flights; `None` if no vertiport has both chargers and waiting
    /// stands.
    pub(super) fn of(day: &Day) -> Option<Self> {
        let limits: Vec<Option<u16>> = VertiportIx::all(day.vertiports)
            .map(|vertiport| day.waiting_stands(vertiport))
            .collect();
        let any = limits.iter().any(Option::is_some);
        let limits: Vec<u16> = limits.into_iter().map(Option::unwrap_or_default).collect();
        any.then(|| Self { stands: StandTimes::empty(&limits), overfull: None })
    }

    /// Counts the places of all vertiports with chargers: their stands here, and their chargers in
    /// `chargers`. The stays may be in any order.
    pub(super) fn count(&mut self, day: &Day, stays: &[Stay], chargers: &mut StandTimes) {
        self.overfull = None;
        let mut by_vertiport = vec![Vec::new(); day.vertiports];
        for stay in stays {
            by_vertiport[stay.at.at()].push(*stay);
        }
        for (vertiport, stays) in VertiportIx::all(day.vertiports).zip(&by_vertiport) {
            if let Some(stands) = day.waiting_stands(vertiport) {
                let limits = (chargers.limit(vertiport), i32::from(stands));
                let counted = Counted::of(day, stays, limits);
                if counted.is_overfull {
                    self.overfull = Some(vertiport);
                }
                chargers.replace(vertiport, 0, counted.chargers);
                self.stands.replace(vertiport, counted.stands_at_first, counted.stands);
            }
        }
    }
}

/// The changes of the places of one vertiport.
#[derive(Default)]
struct Counted {
    chargers: Vec<Change>,
    stands: Vec<Change>,
    stands_at_first: i32,
    is_overfull: bool,
}

impl Counted {
    fn of(day: &Day, stays: &[Stay], (chargers, stands): (i32, i32)) -> Self {
        let mut counted = Self::default();
        let mut has_stand: Vec<bool> =
            stays.iter().map(|stay| stay.comes == Moment::FIRST).collect();
        let (mut on_chargers, mut on_stands) = (0, 0);
        for &has_stand in &has_stand {
            on_stands += i32::from(has_stand);
        }
        counted.stands_at_first = on_stands;
        for (moment, stay, event) in events(day, stays) {
            match event {
                Event::Comes => {
                    counted.is_overfull |= on_chargers >= chargers;
                    on_chargers += 1;
                    counted.chargers.push(Change { moment, by: 1 });
                }
                Event::Holds if has_stand[stay] || on_stands >= stands => {}
                Event::Holds => {
                    has_stand[stay] = true;
                    on_chargers -= 1;
                    on_stands += 1;
                    counted.chargers.push(Change { moment, by: -1 });
                    counted.stands.push(Change { moment, by: 1 });
                }
                Event::Leaves if has_stand[stay] => {
                    on_stands -= 1;
                    counted.stands.push(Change { moment, by: -1 });
                }
                Event::Leaves => {
                    on_chargers -= 1;
                    counted.chargers.push(Change { moment, by: -1 });
                }
            }
        }
        counted
    }
}

/// The events at a vertiport in the course of the day, each with the number of its stay.
fn events(day: &Day, stays: &[Stay]) -> Vec<(Moment, usize, Event)> {
    let mut events = Vec::new();
    for (number, stay) in stays.iter().enumerate() {
        if stay.comes > Moment::FIRST {
            events.push((stay.comes, number, Event::Comes));
        }
        let decisions_s = (stay.ready_s..=day.end_s).step_by(day.hold_s as usize);
        let holds = decisions_s.filter(|&time_s| time_s >= stay.full_s);
        let holds = holds.map(|time_s| Moment::of(time_s, stay.aircraft));
        let holds = holds.take_while(|&moment| moment < stay.leaves);
        events.extend(holds.map(|moment| (moment, number, Event::Holds)));
        if stay.leaves < Moment::NEVER {
            events.push((stay.leaves, number, Event::Leaves));
        }
    }
    events.sort_unstable();
    events
}
