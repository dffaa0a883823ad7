//! The rest of a live day as a scenario, for a bound on what it can still earn.

use vertifleet_core::{AircraftIx, Closure, Error, Matrix, Route, Scenario, Time, VertiportIx};

use super::LiveDay;

/// The known rest of a day. A schedule of it earns what the flights earn that are still to be
/// decided.
#[derive(Debug, Clone)]
pub struct RemainingDay {
    /// The day from now on: who still wants to fly, and every aircraft at the vertiport where it
    /// stands or will land. Where more aircraft are than there are stands, there are as many
    /// stands. The fleet itself costs nothing.
    pub day: Scenario,
    /// When each aircraft is expected to be ready.
    pub ready: Vec<Time>,
}

impl LiveDay {
    /// The rest of the day; `None` if no decision can be taken any more.
    ///
    /// # Errors
    /// Returns an error if what has been reported does not make a day, such as closures beyond the
    /// bounds of the format.
    pub fn remaining_day(&mut self) -> Result<Option<RemainingDay>, Error> {
        let now = self.now;
        if now >= self.scenario().operations.end {
            return Ok(None);
        }
        let mut expected = self.known.clone();
        self.expect_from(&mut expected, now, None);
        let mut day = Scenario::clone(self.scenario()).into_day();
        let size = day.vertiports.len();
        day.operations.start = now;
        day.aircraft_cost_usd = 0.0;
        for vertiport in &mut day.vertiports {
            (vertiport.stand_cost_usd, vertiport.charger_cost_usd) = (0.0, 0.0);
        }
        // Those who wait are passengers of the period before, as on the day itself.
        let demand = &expected.demand;
        let period = demand.waiting_in().map_or(expected.period, |period| period - 1);
        let own = demand.all_own();
        for (at, table) in day.demand.iter_mut().enumerate() {
            let left = |from: VertiportIx, to: VertiportIx| own[demand.at(at, from, to)];
            *table = Matrix::from_fn(size, |from, to| if at < period { 0 } else { left(from, to) });
        }
        let mut there = vec![0_u16; size];
        for (at, aircraft) in day.aircraft.iter_mut().enumerate() {
            aircraft.at = self.known.place[at];
            // `ready` contains what charging to full takes.
            aircraft.start_charge_kwh = expected.charge_when_ready_kwh(AircraftIx::new(at));
            there[aircraft.at.at()] += 1;
        }
        for (vertiport, there) in VertiportIx::all(size).zip(there) {
            let limit = self.known.stands.limit()[vertiport.at()];
            let parked = self.known.stands.parked(vertiport).1;
            let vertiport = &mut day.vertiports[vertiport.at()];
            let all = limit + parked;
            vertiport.stands = all.max(there);
            if let Some(chargers) = &mut vertiport.chargers {
                // A day begins with its aircraft on stands. What counts for a bound is the sum of
                // both.
                vertiport.stands = parked.max(there);
                *chargers = all.saturating_sub(vertiport.stands).max(1);
            }
        }
        day.disturbances.closures = self.closures_left();
        let ready = AircraftIx::all(day.aircraft.len())
            .map(|aircraft| expected.queue.ready_at(aircraft))
            .collect();
        Ok(Some(RemainingDay { day: day.check("what is left of the day")?, ready }))
    }

    /// The closures from now on. One that only a report ends is taken to last.
    fn closures_left(&mut self) -> Vec<Closure> {
        let (now, last) = (self.now, self.scenario().operations.end + 1);
        let later = self.closures.iter().filter(|closure| closure.end > now);
        let mut closures: Vec<Closure> = later.copied().collect();
        let size = self.scenario().vertiports.len();
        for from in VertiportIx::all(size) {
            let closed = self.view().closed(from);
            for to in closed.iter().filter(|&to| self.opens(from, to).is_none()) {
                let route = Route { from, to, both_ways: false };
                closures.push(Closure { route, start: now, end: last, known: true });
            }
        }
        closures
    }
}
