//! `gcaps-x` with roll-outs: its best choices are played on with it deciding for everybody, and the one after which the fleet
//! stands best in the mean is taken. Each is played on several times, everybody's worth shaken by a little noise, the same for
//! all choices: one course says little.
//!
//! All courses go on side by side, a decision each at a time, so that the network judges them together.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_policy::{DayPrices, Shortlist, TryOut, fleet_worth_usd, noise};
use vertifleet_sim::{Decision, Imagined, View};

use crate::relative::features::Scene;
use crate::relative::judge::Judge;

/// How choices are tried out.
const TRY_OUT: TryOut = TryOut { horizon_s: 7_200, courses: COURSES, noise: 0.06, own: 0.5 };
pub(crate) const COURSES: u32 = 8;

/// Why a course that is asked has a decision.
const ASKED: &str = "courses that have come to their end are not asked";

/// What trying out needs.
#[derive(Default)]
pub(crate) struct Rollouts {
    /// Courses of all choices, choice by choice; behind `used`, room of earlier ones.
    courses: Vec<Course>,
    used: usize,
    begun: Option<Imagined>,
    shortlist: Shortlist,
    /// The courses behind the judge's rows.
    asked: Vec<usize>,
}

/// A choice played on.
struct Course {
    /// Its number among those of the same choice; the first has no noise.
    number: u32,
    simulation: Imagined,
    /// What the fleet has earned and is worth at the end, once it is reached.
    usd: Option<f64>,
    /// The decision to be taken, between the choices of a list.
    next: Option<Decision>,
    listed: Vec<(f64, VertiportIx)>,
}

impl Rollouts {
    /// The choice after which the fleet stands best, among some with what they are worth to the aircraft alone.
    pub(crate) fn best(
        &mut self,
        judge: &mut Judge,
        prices: &DayPrices,
        (view, decision): (View<'_>, &Decision),
        judged: &[(f64, VertiportIx)],
    ) -> VertiportIx {
        let until = decision.time + TRY_OUT.horizon_s;
        self.used = 0;
        for &(_, choice) in judged {
            self.begin((view, choice));
        }
        loop {
            judge.rows.clear();
            self.asked.clear();
            for (at, course) in self.courses[..self.used].iter_mut().enumerate() {
                if course.go_on(&mut self.shortlist, prices, until) {
                    course.show(judge, prices);
                    self.asked.push(at);
                }
            }
            if self.asked.is_empty() {
                break;
            }
            judge.pass();
            for (row, &at) in self.asked.iter().enumerate() {
                self.courses[at].follow(judge, prices, row);
            }
        }
        let mut best = (f64::NEG_INFINITY, decision.at);
        for (&(own_usd, choice), courses) in
            judged.iter().zip(self.courses[..self.used].chunks_exact(COURSES as usize))
        {
            let sum_usd: f64 = courses.iter().filter_map(|course| course.usd).sum();
            let usd = TRY_OUT.own * own_usd + sum_usd / f64::from(COURSES);
            if usd > best.0 {
                best = (usd, choice);
            }
        }
        best.1
    }

    /// Sets out on the courses of a choice.
    fn begin(&mut self, (view, choice): (View<'_>, VertiportIx)) {
        let begun = view.imagined_in(&mut self.begun);
        begun.apply(choice).expect("lists are of feasible choices");
        for number in 0..COURSES {
            if let Some(course) = self.courses.get_mut(self.used) {
                course.simulation.clone_from(begun);
                (course.number, course.usd, course.next) = (number, None, None);
            } else {
                let simulation = begun.clone();
                let listed = Vec::new();
                self.courses.push(Course { number, simulation, usd: None, next: None, listed });
            }
            self.used += 1;
        }
    }
}

impl Course {
    /// Goes on to the next decision between more than one choice; false at the course's end.
    fn go_on(&mut self, shortlist: &mut Shortlist, prices: &DayPrices, until: Time) -> bool {
        if self.usd.is_some() {
            return false;
        }
        let simulation = &mut self.simulation;
        let mut worth_usd = 0.0;
        while let Some(next) = simulation.next_decision() {
            if next.time > until {
                worth_usd = fleet_worth_usd(prices, simulation.view(), next.time);
                break;
            }
            let listed = shortlist.rank(prices, simulation.view(), &next);
            if let [(_, only)] = *listed {
                simulation.apply(only).expect("lists are of feasible choices");
                continue;
            }
            self.listed.clear();
            self.listed.extend(listed);
            self.next = Some(next);
            return true;
        }
        self.usd = Some(simulation.ledger().profit_usd() + worth_usd);
        self.next = None;
        false
    }

    /// Adds the decision to the judge's rows.
    fn show(&self, judge: &mut Judge, prices: &DayPrices) {
        let decision = self.next.as_ref().expect(ASKED);
        judge.rows.push(Scene::of(self.simulation.view(), decision, prices), &self.listed);
    }

    /// Takes the choice of a row.
    fn follow(&mut self, judge: &Judge, prices: &DayPrices, row: usize) {
        let decision = self.next.as_ref().expect(ASKED);
        let addition_usd = Scene::of(self.simulation.view(), decision, prices).addition_usd();
        let noise_usd = if self.number == 0 { 0.0 } else { TRY_OUT.noise * prices.stake_usd() };
        let mut best = (f64::NEG_INFINITY, decision.at);
        for &listed in &self.listed {
            let noise = noise(self.number, decision, listed.1);
            let usd = judge.worth_usd(row, addition_usd, listed) + noise_usd * noise;
            if usd > best.0 {
                best = (usd, listed.1);
            }
        }
        let choice = best.1;
        self.simulation.apply(choice).expect("lists are of feasible choices");
    }
}
