//! The rest of a day, planned from any moment of it: for who decides while the day goes on.

use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::View;

use super::problem::Problem;
use super::schedule::{Flight, Schedule};
use super::search::Search;
use super::start;

/// Temperature of the search, dollars. Days that were planned anew at every decision earned more with it than with $1, and
/// as much as with one that falls in the course of each plan.
const TEMPERATURE_USD: f64 = 12.0;

/// A flight to be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlannedFlight {
    /// When to take off.
    pub take_off: Time,
    /// From where.
    pub from: VertiportIx,
    /// To where.
    pub to: VertiportIx,
}

/// The flights that each aircraft is to make from now on.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlook {
    /// What the flights earn, dollars.
    pub value_usd: f64,
    /// By aircraft, in order of take-off.
    pub flights: Vec<Vec<PlannedFlight>>,
}

impl Outlook {
    /// Where an aircraft that is ready at a vertiport at a time is to go; its own vertiport means hold.
    pub fn choice(&self, aircraft: AircraftIx, at: VertiportIx, time: Time) -> VertiportIx {
        let flights = self.flights.get(aircraft.at()).map_or(&[][..], Vec::as_slice);
        let next = flights.partition_point(|flight| flight.take_off < time);
        let now = flights.get(next).filter(|flight| flight.take_off == time && flight.from == at);
        now.map_or(at, |flight| flight.to)
    }

    fn of(problem: &Problem, schedule: &Schedule) -> Self {
        let planned = |flight: &Flight| PlannedFlight {
            take_off: Time::from_seconds(flight.take_off_s),
            from: flight.from,
            to: flight.to,
        };
        let flights = problem
            .day
            .fleet()
            .map(|aircraft| schedule.flights(aircraft).iter().map(planned).collect());
        Self { value_usd: schedule.value_usd(), flights: flights.collect() }
    }
}

/// Plans the rest of a day as a view shows it, with so many steps of search. `before`, an earlier outlook on the same day, is
/// where the search starts if it still fits. Same input, same outlook.
pub fn plan_ahead(view: View<'_>, before: Option<&Outlook>, steps: u64, seed: u64) -> Outlook {
    let problem = Problem::of(view);
    let first = before
        .and_then(|before| continued(&problem, before))
        .unwrap_or_else(|| start::one_by_one(&problem));
    let mut search = Search::new(first, seed);
    for _ in 0..steps {
        search.step(&problem, TEMPERATURE_USD);
    }
    Outlook::of(&problem, &search.best)
}

/// What is left of an earlier outlook, if the fleet stands as that outlook had it. An outlook of
/// another day does not fit, and does no harm.
fn continued(problem: &Problem, before: &Outlook) -> Option<Schedule> {
    let mut schedule = Schedule::unplanned(problem);
    for aircraft in problem.day.fleet() {
        let (mut place, mut ready_s) = schedule.open_end(&problem.day, aircraft);
        let mut flights = Vec::new();
        let from_s = ready_s;
        let ahead = before
            .flights
            .get(aircraft.at())?
            .iter()
            .filter(|flight| (from_s..=problem.day.end_s).contains(&flight.take_off.seconds()));
        for flight in ahead {
            let take_off_s = flight.take_off.seconds();
            let waited_s = take_off_s.checked_sub(ready_s)?;
            if flight.from != place || waited_s % problem.day.hold_s != 0 {
                return None;
            }
            let hops = problem.day.hops(problem.day.kind(aircraft), flight.from);
            let hop = hops.iter().find(|hop| hop.to == flight.to)?;
            (place, ready_s) = (flight.to, take_off_s + hop.block_s);
            flights.push(Flight { take_off_s, from: flight.from, to: flight.to });
        }
        schedule.complete(problem, aircraft, &flights);
    }
    schedule.stands.suffice().then_some(schedule)
}
