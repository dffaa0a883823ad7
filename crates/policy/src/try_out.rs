//! Trying choices out: each is played on for a while in the simulator, everybody else deciding by a rule; what the fleet has
//! earned and is worth by then tells good choices from bad ones.
//!
//! One such course says little: what happens in an hour hangs on who was ready a second earlier. So a choice is played on
//! several times, everybody's worth shaken by a little noise, the same for all choices; the mean is what it is worth.

use serde::{Deserialize, Serialize};
use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::{Decision, Imagined, View};

use crate::prices::is_empty_flight;
use crate::{DayPrices, draw};

/// The choices worth a closer look: those that are worth most at the prices.
#[derive(Debug, Clone, Default)]
pub struct Shortlist {
    /// What each is worth at the prices, dollars; the best first, among equals the vertiport listed first.
    ranked: Vec<(f64, VertiportIx)>,
}

impl Shortlist {
    /// Choices kept at most.
    pub const MOST: usize = 5;
    /// How much worse than the best a choice that is kept may be, in [units](DayPrices::unit_usd).
    const TOO_BAD: f64 = 0.5;

    /// Ranks the choices that are open at the prices and keeps those that come near the best one. Of flights without passengers
    /// only the best choice of all may be one: what another would lead to, the prices alone know, and they put it second.
    pub fn rank(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[(f64, VertiportIx)] {
        self.rank_open(prices, view, decision);
        let best = self.ranked[0].1;
        self.ranked.retain(|&(_, to)| to == best || !is_empty_flight(view, decision, to));
        self.keep_near(prices, view, decision)
    }

    /// The same with every flight without passengers, for a trial that [confirms](Trial::best_choice) them.
    pub fn rank_with_empty_flights(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[(f64, VertiportIx)] {
        self.rank_open(prices, view, decision);
        self.keep_near(prices, view, decision)
    }

    fn rank_open(&mut self, prices: &DayPrices, view: View<'_>, decision: &Decision) {
        self.ranked.clear();
        self.ranked.extend(prices.open_choices(view, decision));
        // A stable sort: among equals the vertiport listed first.
        self.ranked.sort_by(|one, other| other.0.total_cmp(&one.0));
    }

    fn keep_near(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[(f64, VertiportIx)] {
        let too_bad_usd = Self::TOO_BAD * prices.unit_usd(view.kind(decision.aircraft));
        let least_usd = self.ranked[0].0 - too_bad_usd;
        let near = self.ranked.iter().take(Self::MOST).take_while(|choice| choice.0 >= least_usd);
        let count = near.count();
        self.ranked.truncate(count);
        &self.ranked
    }
}

/// How choices are tried out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TryOut {
    /// How far each is played on, seconds.
    pub horizon_s: u32,
    /// How often; the mean over all counts.
    pub courses: u32,
    /// Size of the noise, as a share of what is [at stake](DayPrices::stake_usd) in a decision.
    pub noise: f64,
    /// Weight of what the choice is worth at the prices to the aircraft alone.
    pub own: f64,
}

/// Looks at a vertiport that all courses of a decision may take together, about; on large days there are fewer courses.
const MOST_LOOKS: usize = 2_000_000;
/// Seconds from one decision of an aircraft to its next, about.
const DECISION_APART_S: usize = 2_400;
/// By how many standard errors another choice must be better than the one that is worth most at the prices.
const DOUBT: f64 = 0.5;

/// Tries choices out; keeps its room from decision to decision.
#[derive(Debug, Clone)]
pub struct Trial {
    settings: TryOut,
    /// A choice made, and a course that goes on from there.
    begun: Option<Imagined>,
    course: Option<Imagined>,
    /// What each course of each choice comes to, choice by choice, dollars.
    courses_usd: Vec<f64>,
    values_usd: Vec<f64>,
    /// Choices that seem better than the first of the list, and by how much, dollars.
    better: Vec<(f64, VertiportIx)>,
}

impl Trial {
    /// A trial that has seen no decision yet.
    pub fn new(settings: TryOut) -> Self {
        Self {
            settings,
            begun: None,
            course: None,
            courses_usd: Vec::new(),
            values_usd: Vec::new(),
            better: Vec::new(),
        }
    }

    /// What each choice of a list is worth if everybody decides by prices, dollars, in the list's order. The list holds
    /// feasible choices with what they are worth at the prices.
    pub fn values_usd(
        &mut self,
        prices: &DayPrices,
        (view, decision): (View<'_>, &Decision),
        listed: &[(f64, VertiportIx)],
    ) -> &[f64] {
        let courses = self.play_courses(prices, (view, decision), listed);
        self.values_usd.clear();
        for (&(priced_usd, _), courses_usd) in
            listed.iter().zip(self.courses_usd.chunks_exact(courses))
        {
            let mean_usd = courses_usd.iter().sum::<f64>() / courses as f64;
            self.values_usd.push(self.settings.own * priced_usd + mean_usd);
        }
        &self.values_usd
    }

    /// The best choice of a list whose first is the best at the prices: that one, unless another is better beyond doubt. A
    /// flight without passengers must also earn more than the first choice when the whole rest of the day is played out, since
    /// it costs money now for what the prices promise later.
    pub fn best_choice(
        &mut self,
        prices: &DayPrices,
        (view, decision): (View<'_>, &Decision),
        listed: &[(f64, VertiportIx)],
    ) -> VertiportIx {
        let (first_usd, first) = listed[0];
        if listed.len() == 1 {
            return first;
        }
        let courses = self.play_courses(prices, (view, decision), listed);
        let (first_courses_usd, others_usd) = self.courses_usd.split_at(courses);
        self.better.clear();
        for (&(priced_usd, to), courses_usd) in
            listed[1..].iter().zip(others_usd.chunks_exact(courses))
        {
            let surely_usd = surely_more_usd(courses_usd, first_courses_usd);
            let better_usd = self.settings.own * (priced_usd - first_usd) + surely_usd;
            if better_usd > 0.0 {
                self.better.push((better_usd, to));
            }
        }
        self.better.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut first_day_usd = None;
        for at in 0..self.better.len() {
            let to = self.better[at].1;
            if !is_empty_flight(view, decision, to) {
                return to;
            }
            let first_day_usd =
                *first_day_usd.get_or_insert_with(|| self.day_usd(prices, view, first));
            if self.day_usd(prices, view, to) > first_day_usd {
                return to;
            }
        }
        first
    }

    /// Plays the courses of all choices; returns how many each has.
    fn play_courses(
        &mut self,
        prices: &DayPrices,
        (view, decision): (View<'_>, &Decision),
        listed: &[(f64, VertiportIx)],
    ) -> usize {
        let Self { settings, begun, course, courses_usd, .. } = self;
        let until = decision.time + settings.horizon_s;
        let courses = settings.courses(prices, view, listed.len());
        courses_usd.clear();
        for &(_, to) in listed {
            let begun = view.imagined_in(begun);
            begun.apply(to).expect("only feasible choices are tried");
            for number in 0..courses {
                let course = copied(begun, course);
                courses_usd.push(settings.played_usd(prices, course, until, number));
            }
        }
        courses as usize
    }

    /// What the day earns if this choice is taken and the fleet then decides at the prices to the end.
    fn day_usd(&mut self, prices: &DayPrices, view: View<'_>, to: VertiportIx) -> f64 {
        let day = view.imagined_in(&mut self.begun);
        day.apply(to).expect("only feasible choices are tried");
        while let Some(next) = day.next_decision() {
            let choice = prices.best_choice(day.view(), &next);
            day.apply(choice).expect("everybody chooses from the mask");
        }
        day.ledger().profit_usd()
    }
}

/// By how much the mean of some courses is above that of others with the same noise, less what chance may make of it, dollars.
fn surely_more_usd(courses_usd: &[f64], others_usd: &[f64]) -> f64 {
    let count = courses_usd.len() as f64;
    let differences = || courses_usd.iter().zip(others_usd).map(|(one, other)| one - other);
    let mean_usd = differences().sum::<f64>() / count;
    let squares: f64 = differences().map(|usd| (usd - mean_usd).powi(2)).sum();
    let error_usd = (squares / (count - 1.0).max(1.0) / count).sqrt();
    mean_usd - DOUBT * error_usd
}

/// A copy of a course, in the room of another.
fn copied<'room>(begun: &Imagined, room: &'room mut Option<Imagined>) -> &'room mut Imagined {
    if let Some(room) = room {
        room.clone_from(begun);
    }
    room.get_or_insert_with(|| begun.clone())
}

impl TryOut {
    /// Courses of each of so many choices: one where nothing is at stake, so that noise would change nothing, and fewer than
    /// asked for on large days.
    fn courses(&self, prices: &DayPrices, view: View<'_>, choices: usize) -> u32 {
        if prices.stake_usd() == 0.0 {
            return 1;
        }
        let decisions = view.places().len() * (self.horizon_s as usize).div_ceil(DECISION_APART_S);
        let looks = (decisions * view.vertiports() * choices).max(1);
        u32::try_from(MOST_LOOKS / looks).map_or(self.courses, |most| self.courses.min(most.max(1)))
    }

    /// Plays a course to a time. Returns what the fleet has earned and is worth then.
    fn played_usd(
        &self,
        prices: &DayPrices,
        course: &mut Imagined,
        until: Time,
        number: u32,
    ) -> f64 {
        while let Some(next) = course.next_decision() {
            let view = course.view();
            if next.time > until {
                return course.ledger().profit_usd() + fleet_worth_usd(prices, view, next.time);
            }
            let choice = self.shaken_choice(prices, (view, &next), number);
            course.apply(choice).expect("everybody chooses from the mask");
        }
        course.ledger().profit_usd()
    }

    /// The choice that is worth most at the prices and a noise. The first course has none.
    fn shaken_choice(
        &self,
        prices: &DayPrices,
        (view, decision): (View<'_>, &Decision),
        course: u32,
    ) -> VertiportIx {
        if course == 0 {
            return prices.best_choice(view, decision);
        }
        let noise_usd = self.noise * prices.stake_usd();
        let mut best = (f64::NEG_INFINITY, decision.at);
        for (usd, to) in prices.open_choices(view, decision) {
            let usd = usd + noise_usd * noise(course, decision, to);
            if usd > best.0 {
                best = (usd, to);
            }
        }
        best.1
    }
}

/// Noise that belongs to a course, the aircraft and time of a decision, and a vertiport: about normal, with mean 0 and
/// deviation 1 (the sum of four uniform numbers).
#[inline]
pub fn noise(course: u32, decision: &Decision, to: VertiportIx) -> f64 {
    let key = u64::from(decision.aircraft.0) << 32 | u64::from(decision.time.seconds());
    let bits = draw(u64::from(course), key, u32::from(to.0));
    let sum: u32 = [0, 16, 32, 48].iter().map(|shift| (bits >> shift & 0xffff) as u32).sum();
    (f64::from(sum) / 65_536.0 - 2.0) * 3.0_f64.sqrt()
}

/// What it is worth that every aircraft is where it is, less the rent of its stand from now until it is ready, dollars.
pub fn fleet_worth_usd(prices: &DayPrices, view: View<'_>, now: Time) -> f64 {
    let worth_usd = |aircraft: AircraftIx| {
        let (place, ready) = (view.places()[aircraft.at()], view.ready_at(aircraft));
        prices.worth_usd(view.kind(aircraft), place, ready) - prices.rent_usd(place, now, ready)
    };
    AircraftIx::all(view.places().len()).map(worth_usd).sum()
}
