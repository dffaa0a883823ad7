//! Stands (Eq. 16): U_i, the number of aircraft standing at i or in the air towards it, is between
//! 0 and U_max at every instant. The same holds for chargers, where a vertiport also has stands
//! without chargers.
//!
//! U_i only changes at a take-off, from the vertiport that an aircraft leaves to the one that it
//! flies to, so checking each take-off checks every instant. At one instant the aircraft listed
//! first moves first, and the stand that it leaves is free for the next. With chargers, a hold
//! moves an aircraft from its charger to a stand, if one is free and the battery is full.

use vertifleet_core::Scenario;

use super::Rule;
use super::event::Event;
use super::report::Findings;

/// The kind of place that an aircraft occupies while it waits.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pool {
    /// On a stand, as all aircraft are at vertiports without chargers.
    Stand,
    /// On a charger, or in the air towards one.
    Charger,
}

/// The aircraft of every vertiport.
#[derive(Debug)]
pub(super) struct Stands {
    /// On stands of each vertiport.
    standing: Vec<i64>,
    /// On chargers of each vertiport, where these are counted apart, or in the air towards them.
    charging: Vec<i64>,
    pools: Vec<Pool>,
}

impl Stands {
    pub(super) fn at_start(scenario: &Scenario) -> Self {
        let mut standing = vec![0; scenario.vertiports.len()];
        let charging = standing.clone();
        for aircraft in &scenario.aircraft {
            standing[aircraft.at.at()] += 1;
        }
        Self { standing, charging, pools: vec![Pool::Stand; scenario.aircraft.len()] }
    }

    /// Moves the aircraft of an event, the next one in order, and judges both its places.
    /// `is_full` says whether its battery is full.
    pub(super) fn decides(&mut self, event: &Event<'_>, is_full: bool, findings: &mut Findings) {
        if event.is_hold() {
            self.holds(event, is_full);
        } else {
            self.flies(event, findings);
        }
    }

    fn holds(&mut self, event: &Event<'_>, is_full: bool) {
        let at = event.row.from.at();
        let pool = &mut self.pools[event.row.aircraft.at()];
        if is_full && *pool == Pool::Charger && self.standing[at] < i64::from(event.from.stands) {
            *pool = Pool::Stand;
            self.charging[at] -= 1;
            self.standing[at] += 1;
        }
    }

    fn flies(&mut self, event: &Event<'_>, findings: &mut Findings) {
        let Self { standing, charging, pools } = self;
        let (from, to) = (event.row.from.at(), event.row.to.at());
        let pool = &mut pools[event.row.aircraft.at()];
        let (left, rule) = match pool {
            Pool::Stand => (&mut standing[from], Rule::StandBound),
            Pool::Charger => (&mut charging[from], Rule::ChargerBound),
        };
        *left -= 1;
        if *left < 0 {
            let left = *left;
            findings
                .add_event(rule, event, || format!("leaves {left} aircraft at {}", event.from.id));
        }
        let (there, limit, places, rule) = match event.to.chargers {
            None => (&mut standing[to], event.to.stands, "stands", Rule::StandBound),
            Some(chargers) => (&mut charging[to], chargers, "chargers", Rule::ChargerBound),
        };
        *pool = if event.to.chargers.is_none() { Pool::Stand } else { Pool::Charger };
        *there += 1;
        if *there > i64::from(limit) {
            let there = *there;
            findings.add_event(rule, event, || {
                format!(
                    "makes {there} aircraft at {} or on their way there, but its {places} are {limit}",
                    event.to.id
                )
            });
        }
    }
}
