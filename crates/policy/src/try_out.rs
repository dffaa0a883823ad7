//! Trying choices out: each is played on for a while in the simulator, everybody else deciding by a rule; what the fleet has
//! earned and is worth by then tells good choices from bad ones.
//!
//! One such course says little: what happens in an hour hangs on who was ready a second earlier. So a choice is played on
//! several times, everybody's worth shaken by a little noise, the same for all choices; the mean is what it is worth.

use serde::{Deserialize, Serialize};
use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::{Decision, Imagined, View};

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

    /// Ranks the feasible choices and keeps those that come near the best one.
    pub fn rank(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
    ) -> &[(f64, VertiportIx)] {
        self.ranked.clear();
        let choices = view.feasible(decision).iter();
        self.ranked.extend(choices.map(|to| (prices.choice_usd(view, decision, to), to)));
        // A stable sort: among equals the vertiport listed first.
        self.ranked.sort_by(|one, other| other.0.total_cmp(&one.0));
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
    /// Size of the noise, in [units](DayPrices::unit_usd).
    pub noise: f64,
    /// Weight of what the choice is worth at the prices to the aircraft alone.
    pub own: f64,
}

/// Tries choices out; keeps its room from decision to decision.
#[derive(Debug, Clone)]
pub struct Trial {
    settings: TryOut,
    /// A choice made, and a course that goes on from there.
    begun: Option<Imagined>,
    course: Option<Imagined>,
    values_usd: Vec<f64>,
}

impl Trial {
    /// A trial that has seen no decision yet.
    pub fn new(settings: TryOut) -> Self {
        Self { settings, begun: None, course: None, values_usd: Vec::new() }
    }

    /// What each choice of a list is worth if everybody decides by prices, dollars, in the list's order. The list holds
    /// feasible choices with what they are worth at the prices.
    pub fn values_usd(
        &mut self,
        prices: &DayPrices,
        (view, decision): (View<'_>, &Decision),
        listed: &[(f64, VertiportIx)],
    ) -> &[f64] {
        let Self { settings, begun, course, values_usd } = self;
        let until = decision.time + settings.horizon_s;
        values_usd.clear();
        for &(priced_usd, to) in listed {
            let begun = view.imagined_in(begun);
            begun.apply(to).expect("only feasible choices are tried");
            let mut sum_usd = 0.0;
            for number in 0..settings.courses {
                let course = copied(begun, course);
                sum_usd += settings.played_usd(prices, course, until, number);
            }
            values_usd.push(settings.own * priced_usd + sum_usd / f64::from(settings.courses));
        }
        values_usd
    }
}

/// A copy of a course, in the room of another.
fn copied<'room>(begun: &Imagined, room: &'room mut Option<Imagined>) -> &'room mut Imagined {
    if let Some(room) = room {
        room.clone_from(begun);
    }
    room.get_or_insert_with(|| begun.clone())
}

impl TryOut {
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
        let noise_usd = self.noise * prices.unit_usd(view.kind(decision.aircraft));
        let mut best = (f64::NEG_INFINITY, decision.at);
        for to in view.feasible(decision).iter() {
            let usd =
                prices.choice_usd(view, decision, to) + noise_usd * noise(course, decision, to);
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
