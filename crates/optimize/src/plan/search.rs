//! Large-neighbourhood search with annealing: remove the rest of the day from the itineraries of a
//! few aircraft, complete the itineraries one by one in the best way, and keep the result if it is
//! better, or only a little worse.
//!
//! P. Shaw, *Using constraint programming and local search methods to solve vehicle routing
//! problems* (1998), for the neighbourhood; S. Ropke and D. Pisinger, *An adaptive large
//! neighborhood search heuristic for the pickup and delivery problem with time windows* (2006), for
//! acceptance by annealing.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use vertifleet_core::AircraftIx;

use super::guiding_prices::GuidingPrices;
use super::itinerary_search::{Bias, Guided, ItinerarySearch};
use super::problem::Problem;
use super::schedule::{Flight, Schedule};

/// Most aircraft whose itineraries are changed at once.
const MOST_TAKEN_OUT: usize = 4;
/// How often aircraft are chosen that leave one vertiport at about the same time; otherwise any
/// are. Without such choices, days of `paper` earned 0.1 % less after 50,000 steps.
const TOGETHER: f64 = 0.5;
/// Two take-offs are at about the same time if they are this many seconds apart, or less.
const SAME_TIME_S: u32 = 1_800;
/// How often itineraries are changed from the start of the day on; otherwise from a random moment
/// of the day.
const WHOLE_DAYS: f64 = 0.1;
/// Most by which the assumed profit of a flight is off in a noisy step, in full flights. The noise
/// is Ropke and Pisinger's: without it no aircraft leaves a flight to another that earns more with
/// it, or flies empty to make room. Of 2,680 days that are small enough to be searched
/// exhaustively, 2,000 steps without noise missed the optimum of 30; with noise, of 4.
const MOST_NOISE: f64 = 3.0;

/// One search: its current schedule, the best one it has found, and its memory.
#[derive(Debug)]
pub(super) struct Search {
    pub(super) current: Schedule,
    pub(super) best: Schedule,
    random: Xoshiro256PlusPlus,
    itineraries: ItinerarySearch,
    taken_out: TakenOut,
    way_on: Vec<Flight>,
    /// The aircraft that may be changed together with the one chosen first.
    others: Vec<AircraftIx>,
}

/// The flights that have been removed from the schedule and may have to be put back.
#[derive(Debug, Default)]
struct TakenOut {
    aircraft: Vec<AircraftIx>,
    /// Number of flights that each aircraft keeps.
    kept: Vec<usize>,
    /// The removed flights, one aircraft's after another's, and in `ends` the position after the
    /// last of each aircraft.
    flights: Vec<Flight>,
    ends: Vec<usize>,
}

impl Search {
    /// A search that starts from a schedule whose itineraries are all whole.
    pub(super) fn new(problem: &Problem, schedule: Schedule, seed: u64) -> Self {
        Self {
            best: schedule.clone(),
            current: schedule,
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
            itineraries: ItinerarySearch::quick(&problem.day),
            taken_out: TakenOut::default(),
            way_on: Vec::new(),
            others: Vec::new(),
        }
    }

    /// Tries one neighbour; a loss is accepted with probability exp(-loss / `temperature_usd`).
    pub(super) fn step(&mut self, problem: &Problem, prices: &GuidingPrices, temperature_usd: f64) {
        let profit_usd = self.current.value_usd();
        self.choose(problem);
        self.take_out(problem);
        let whole = self.put_back(problem, prices);
        // 1 - u is never 0, so the logarithm is finite.
        let luck = (1.0 - self.random.random::<f64>()).ln();
        if whole && self.current.value_usd() - profit_usd >= temperature_usd * luck {
            if self.current.value_usd() > self.best.value_usd() {
                self.best.clone_from(&self.current);
            }
        } else {
            self.undo(problem);
            self.current.set_value_usd(profit_usd);
        }
    }

    /// Chooses aircraft and a moment. Flights that take off before it stay.
    fn choose(&mut self, problem: &Problem) {
        let from_s = if self.random.random_bool(WHOLE_DAYS) {
            problem.day.first_s
        } else {
            self.random.random_range(problem.day.first_s..=problem.day.end_s)
        };
        let fleet = problem.day.fleet();
        let one = AircraftIx::new(self.random.random_range(0..fleet.len()));
        let leaves = self.next_flight(one, from_s);
        let mut others = std::mem::take(&mut self.others);
        others.clear();
        others.extend(fleet.filter(|&other| other != one));
        if self.random.random_bool(TOGETHER) {
            others.retain(|&other| leave_together(leaves, self.next_flight(other, from_s)));
        }
        let count = self.random.random_range(0..MOST_TAKEN_OUT).min(others.len());
        let (chosen, _) = others.partial_shuffle(&mut self.random, count);

        let TakenOut { aircraft, kept, .. } = &mut self.taken_out;
        aircraft.clear();
        kept.clear();
        aircraft.push(one);
        aircraft.extend_from_slice(chosen);
        let flights = aircraft.iter().map(|&one| self.current.flights(one));
        kept.extend(flights.map(|all| all.partition_point(|flight| flight.take_off_s < from_s)));
        self.others = others;
    }

    /// The first flight of an aircraft that takes off at or after a time.
    fn next_flight(&self, aircraft: AircraftIx, from_s: u32) -> Option<Flight> {
        let flights = self.current.flights(aircraft);
        flights.get(flights.partition_point(|flight| flight.take_off_s < from_s)).copied()
    }

    fn take_out(&mut self, problem: &Problem) {
        let TakenOut { aircraft, kept, flights, ends } = &mut self.taken_out;
        flights.clear();
        ends.clear();
        for (&aircraft, &kept) in aircraft.iter().zip(kept.iter()) {
            self.current.cut(problem, aircraft, kept, flights);
            ends.push(flights.len());
        }
    }

    /// Completes the itineraries in the order in which they were chosen. Returns whether all of
    /// them could be completed, and every vertiport has enough chargers.
    fn put_back(&mut self, problem: &Problem, prices: &GuidingPrices) -> bool {
        let rent_share = self.random.random::<f64>();
        let flight_share = if prices.are_of_flights() { self.random.random::<f64>() } else { 0.0 };
        let noise_usd = self.draw_noise_usd(problem);
        for &aircraft in &self.taken_out.aircraft {
            // Its last flight stays, and the aircraft is not ready again before the plan's end.
            if self.current.is_whole(aircraft) {
                continue;
            }
            let bias = Bias {
                shift_s: self.random.random_range(0..self.itineraries.slot_s()),
                rent_share,
                flight_share,
                noise_usd,
                noise_seed: self.random.random(),
            };
            let guided = Guided { prices, bias };
            let found = self.itineraries.complete(
                problem,
                guided,
                &self.current,
                aircraft,
                &mut self.way_on,
            );
            if !found {
                return false;
            }
            self.current.complete(problem, aircraft, &self.way_on);
        }
        self.current.overfull().is_none()
    }

    /// The noise of this step. Most steps have none, and in larger fleets even fewer, because there
    /// are other ways to make room.
    fn draw_noise_usd(&mut self, problem: &Problem) -> f64 {
        if self.random.random_range(0..problem.day.fleet().len()) > 0 {
            return 0.0;
        }
        MOST_NOISE * problem.full_flight_usd * self.random.random::<f64>()
    }

    /// Gives every chosen aircraft its flights back. Aircraft that have others by now lose them
    /// first.
    fn undo(&mut self, problem: &Problem) {
        let TakenOut { aircraft, kept, flights, ends } = &self.taken_out;
        for (&aircraft, &kept) in aircraft.iter().zip(kept) {
            if self.current.is_whole(aircraft) {
                self.way_on.clear();
                self.current.cut(problem, aircraft, kept, &mut self.way_on);
            }
        }
        let mut begin = 0;
        for (&aircraft, &end) in aircraft.iter().zip(ends) {
            self.current.complete(problem, aircraft, &flights[begin..end]);
            begin = end;
        }
    }
}

/// Whether two flights leave one vertiport at about the same time.
fn leave_together(one: Option<Flight>, other: Option<Flight>) -> bool {
    one.zip(other).is_some_and(|(one, other)| {
        one.from == other.from && one.take_off_s.abs_diff(other.take_off_s) <= SAME_TIME_S
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use vertifleet_core::{DaySeed, Network, Scenario, Time};

    use super::Search;
    use crate::plan::BestPlan;
    use crate::plan::guiding_prices::GuidingPrices;
    use crate::plan::problem::Problem;
    use crate::plan::start;

    #[test]
    fn the_account_of_many_changes_is_the_simulators() {
        let network = Network::shipped("paper").expect("a shipped network");
        let mut day = network.draw(DaySeed::validation(9).expect("a seed")).into_day();
        for passenger_wait_s in [0, 1_200] {
            day.operations.passenger_wait_s = passenger_wait_s;
            account_is_the_simulators(&Arc::new(day.clone().check("a day").expect("a day")));
        }
        let with_chargers = Network::shipped("as-coded").expect("a shipped network");
        let seed = DaySeed::validation(9).expect("a seed");
        let mut day = with_chargers.draw(seed).into_day();
        account_is_the_simulators(&Arc::new(day.clone().check("a day").expect("a day")));
        // The first moment of a day that begins at midnight is another than that of an aircraft
        // that starts there.
        day.operations.start = Time::from_seconds(0);
        day.periods[0] = day.operations.start;
        account_is_the_simulators(&Arc::new(day.check("a day").expect("a day")));
    }

    fn account_is_the_simulators(day: &Arc<Scenario>) {
        let problem = Problem::of(day);
        let prices = GuidingPrices::of_policies(day, &problem.day);
        let start = start::best_policy(day, Vec::new(), &BestPlan::default(), &mut |_, _| true);
        let mut search = Search::new(&problem, start::schedule_of(&problem, &start.trace), 3);
        for step in 0..300 {
            // The temperature alternates between hot and cold, so that steps are kept as well as
            // undone.
            search.step(&problem, &prices, f64::from(step % 5) * 20.0 + 0.1);
            assert!(search.current.stands.suffice(), "step {step}");
            assert_eq!(search.current.overfull(), None, "step {step}");
        }
        for schedule in [&search.current, &search.best] {
            let (_, profit_usd) = start::flown(day, schedule);
            assert!((schedule.value_usd() - profit_usd).abs() < 1e-6);
        }
    }
}
