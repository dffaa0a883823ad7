//! Roll-outs: a choice is played on for a while in the simulator, with every aircraft following the
//! base rule. The value of the choice is the fleet's profit until then and its worth at that time.
//!
//! A single roll-out means little, because the next hour depends on which aircraft happens to be
//! ready a second before another. A choice is therefore rolled out several times, with the worth of
//! all choices perturbed by a little noise, which is the same for every choice that is compared.
//! The value is the mean.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::{Decision, Imagined, View};

use crate::draw::Draws;
use crate::{DayPrices, PricedChoice, Shortlist};

/// Settings of roll-outs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RolloutSettings {
    /// Duration of each roll-out, seconds; half of it on the largest days.
    pub horizon_s: u32,
    /// Number of roll-outs of each choice, whose mean is the value.
    pub rollouts: u32,
    /// Size of the noise, as a share of the [stake](DayPrices::stake_usd) of a decision.
    pub noise: f64,
    /// Weight of the choice's worth at the prices to the aircraft alone.
    pub price_weight: f64,
}

/// The approximate number of vertiports that all roll-outs of a decision may evaluate. On large
/// days there are fewer roll-outs.
const MOST_LOOKS: usize = 2_000_000;
/// The least number of vertiports that the roll-outs of a decision evaluate for which threads are
/// worth their coordination.
const LEAST_SHARED_LOOKS: usize = 500_000;
/// The approximate time from one decision of an aircraft to its next, seconds.
const DECISION_APART_S: usize = 2_400;
/// Number of standard errors by which another choice must be better than the one that is worth most
/// at the prices.
const DOUBT: f64 = 0.5;
/// More than the largest [`Noise`].
const MOST_NOISE: f64 = 3.5;

/// Memory to roll a choice out in.
#[derive(Debug, Clone, Default)]
struct RolloutMemory {
    /// An imagined day on which the choice was made, and in `rollout` one that continues from
    /// there.
    begun: Option<Imagined>,
    rollout: Option<Imagined>,
}

/// Evaluates choices by roll-outs. It reuses its memory from decision to decision.
///
/// On large days the choices of a decision are rolled out on several threads, unless the caller is
/// one of several threads that work side by side already, as where many days are compared. Every
/// roll-out writes one number, so the values do not depend on the threads.
#[derive(Debug, Clone)]
pub struct RolloutEvaluator {
    settings: RolloutSettings,
    /// Memory for the roll-outs of each choice of a list.
    rooms: Vec<RolloutMemory>,
    /// The value of each roll-out of each choice, choice by choice, dollars.
    rollouts_usd: Vec<f64>,
    values_usd: Vec<f64>,
    /// The choices that seem better than the first of the list, with the difference in dollars.
    better: Vec<PricedChoice>,
}

impl RolloutEvaluator {
    /// An evaluator that has evaluated nothing yet.
    pub fn new(settings: RolloutSettings) -> Self {
        Self {
            settings,
            rooms: Vec::new(),
            rollouts_usd: Vec::new(),
            values_usd: Vec::new(),
            better: Vec::new(),
        }
    }

    /// The value of each choice of a list if every aircraft follows the base rule, dollars, in the
    /// list's order. The list holds feasible choices with their worth at the prices.
    pub fn values_usd(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        listed: &[PricedChoice],
    ) -> &[f64] {
        let rollouts = self.roll_out(prices, view, decision, listed);
        self.values_usd.clear();
        for (choice, rollouts_usd) in listed.iter().zip(self.rollouts_usd.chunks_exact(rollouts)) {
            self.values_usd.push(self.settings.value_usd(choice.worth_usd, rollouts_usd));
        }
        &self.values_usd
    }

    /// The choice of [`best_choice`](Self::best_choice) and the values that it compares, dollars,
    /// in the list's order; the choice has the highest. The value of the first choice is that of
    /// [`values_usd`](Self::values_usd). That of another one is lower by the margin for chance. For
    /// a flight without passengers that earns no more over the rest of the day, it is below the
    /// first by that loss.
    pub fn best_choice_with_values(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        listed: &[PricedChoice],
    ) -> (VertiportIx, &[f64]) {
        let rollouts = self.roll_out(prices, view, decision, listed);
        let best = self.best_of_rollouts(prices, view, decision, listed, rollouts);
        (best, &self.values_usd)
    }

    /// The best choice of a list whose first is the best at the prices. It is the first, unless
    /// another is better beyond doubt. A flight without passengers must also earn more than the
    /// first choice when the whole rest of the day is played out, since it costs money now for a
    /// worth that prices only promise for later.
    pub fn best_choice(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        listed: &[PricedChoice],
    ) -> VertiportIx {
        if let [only] = listed {
            return only.to;
        }
        let rollouts = self.roll_out(prices, view, decision, listed);
        self.best_of_rollouts(prices, view, decision, listed, rollouts)
    }

    /// The best choice of a list by the latest [`roll_out`](Self::roll_out). Writes the values that
    /// it compares.
    fn best_of_rollouts(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        listed: &[PricedChoice],
        rollouts: usize,
    ) -> VertiportIx {
        let PricedChoice { worth_usd: first_usd, to: first } = listed[0];
        let (first_rollouts_usd, others_usd) = self.rollouts_usd.split_at(rollouts);
        let first_value_usd = self.settings.value_usd(first_usd, first_rollouts_usd);
        self.values_usd.clear();
        self.values_usd.push(first_value_usd);
        self.better.clear();
        for (&PricedChoice { worth_usd: priced_usd, to }, rollouts_usd) in
            listed[1..].iter().zip(others_usd.chunks_exact(rollouts))
        {
            let surely_usd = surely_more_usd(rollouts_usd, first_rollouts_usd);
            let better_usd = self.settings.price_weight * (priced_usd - first_usd) + surely_usd;
            self.values_usd.push(first_value_usd + better_usd);
            if better_usd > 0.0 {
                self.better.push(PricedChoice { worth_usd: better_usd, to });
            }
        }
        self.better.sort_by(|one, other| other.worth_usd.total_cmp(&one.worth_usd));
        let mut first_day_usd = None;
        for at in 0..self.better.len() {
            let to = self.better[at].to;
            if !prices.choices(view, decision).is_repositioning(to) {
                return to;
            }
            let first_day_usd =
                *first_day_usd.get_or_insert_with(|| self.day_usd(prices, view, first));
            let day_usd = self.day_usd(prices, view, to);
            if day_usd > first_day_usd {
                return to;
            }
            let listed_at = listed.iter().position(|choice| choice.to == to);
            let listed_at = listed_at.expect("the better choices are of the list");
            self.values_usd[listed_at] = first_value_usd + (day_usd - first_day_usd);
        }
        first
    }

    /// Plays the roll-outs of all choices, and returns their number for each choice.
    fn roll_out(
        &mut self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        listed: &[PricedChoice],
    ) -> usize {
        let Self { rooms, rollouts_usd, .. } = self;
        let settings = &self.settings.on_day_of(view);
        let until = decision.time + settings.horizon_s;
        let rollouts = settings.rollouts(prices, view, listed.len()) as usize;
        rollouts_usd.clear();
        rollouts_usd.resize(listed.len() * rollouts, 0.0);
        prices.rank(view, settings.horizon_s);
        let looks = settings.looks(view, listed.len()) * rollouts;
        // A thread of the pool that waits for another would take up other work of the pool
        // meanwhile, such as a whole day, and the decision would seem to take as long.
        if looks >= LEAST_SHARED_LOOKS && rayon::current_thread_index().is_none() {
            rooms.resize_with(rooms.len().max(listed.len()), RolloutMemory::default);
            let choices = rollouts_usd.par_chunks_exact_mut(rollouts).zip(listed).zip(rooms);
            choices.for_each(|((usd, choice), room)| {
                settings.roll_out(prices, view, until, choice.to, room, usd);
            });
        } else {
            rooms.resize_with(rooms.len().max(1), RolloutMemory::default);
            for (usd, choice) in rollouts_usd.chunks_exact_mut(rollouts).zip(listed) {
                settings.roll_out(prices, view, until, choice.to, &mut rooms[0], usd);
            }
        }
        rollouts
    }

    /// The profit of the day if this choice is taken and the fleet then follows the base rule to
    /// the end.
    fn day_usd(&mut self, prices: &DayPrices, view: View<'_>, to: VertiportIx) -> f64 {
        self.rooms.resize_with(self.rooms.len().max(1), RolloutMemory::default);
        let day = view.imagined_in(&mut self.rooms[0].begun);
        day.apply(to).expect("only feasible choices are tried");
        while let Some(next) = day.next_decision() {
            let choice = prices.best_choice(day.view(), &next);
            day.apply(choice).expect("every choice is from the mask");
        }
        day.ledger().profit_usd()
    }
}

/// The difference in dollars of the mean of some roll-outs to that of others with the same noise,
/// less a margin for chance.
fn surely_more_usd(rollouts_usd: &[f64], others_usd: &[f64]) -> f64 {
    let count = rollouts_usd.len() as f64;
    let differences = || rollouts_usd.iter().zip(others_usd).map(|(one, other)| one - other);
    let mean_usd = differences().sum::<f64>() / count;
    let squares: f64 = differences().map(|usd| (usd - mean_usd).powi(2)).sum();
    let error_usd = (squares / (count - 1.0).max(1.0) / count).sqrt();
    mean_usd - DOUBT * error_usd
}

/// Copies a roll-out into the memory of another.
fn copied<'room>(begun: &Imagined, room: &'room mut Option<Imagined>) -> &'room mut Imagined {
    if let Some(room) = room {
        room.clone_from(begun);
    }
    room.get_or_insert_with(|| begun.clone())
}

impl RolloutSettings {
    /// The settings for a day. On some days choices are played on for half the time. One is a day
    /// so large that one roll-out of every choice is too much: on three days of 100 vertiports and
    /// 2,000 aircraft this took half as long and earned 0.05 to 0.12 % more. The other is a day
    /// that charges as needed, on which aircraft decide more often: on 12 validation days of
    /// `new-york-quick` it took half as long and earned 0.02 % less, within chance.
    fn on_day_of(&self, view: View<'_>) -> Self {
        let is_large = self.looks(view, Shortlist::MOST) > MOST_LOOKS;
        let is_halved = is_large || view.charges_as_needed();
        let horizon_s = if is_halved { self.horizon_s / 2 } else { self.horizon_s };
        Self { horizon_s, ..self.clone() }
    }

    /// Number of roll-outs of each choice: one if nothing is at stake, so that noise would change
    /// nothing, and fewer than the settings ask for on large days.
    fn rollouts(&self, prices: &DayPrices, view: View<'_>, choices: usize) -> u32 {
        if prices.stake_usd() == 0.0 {
            return 1;
        }
        u32::try_from(MOST_LOOKS / self.looks(view, choices))
            .map_or(self.rollouts, |most| self.rollouts.min(most.max(1)))
    }

    /// The approximate number of vertiports that a roll-out of each choice looks at, all choices
    /// together.
    fn looks(&self, view: View<'_>, choices: usize) -> usize {
        let decisions = view.places().len() * (self.horizon_s as usize).div_ceil(DECISION_APART_S);
        (decisions * view.vertiports() * choices).max(1)
    }

    /// Rolls a choice out as often as there are values to be written, in dollars.
    fn roll_out(
        &self,
        prices: &DayPrices,
        view: View<'_>,
        until: Time,
        choice: VertiportIx,
        room: &mut RolloutMemory,
        values_usd: &mut [f64],
    ) {
        let begun = view.imagined_in(&mut room.begun);
        begun.apply(choice).expect("only feasible choices are tried");
        let Some((last_usd, others_usd)) = values_usd.split_last_mut() else { return };
        let mut number = 0;
        for value_usd in others_usd {
            let rollout = copied(begun, &mut room.rollout);
            *value_usd = self.played_usd(prices, rollout, until, number);
            number += 1;
        }
        *last_usd = self.played_usd(prices, begun, until, number);
    }

    /// Plays a roll-out to a time. Returns the fleet's profit until then plus its worth at that
    /// time.
    fn played_usd(
        &self,
        prices: &DayPrices,
        rollout: &mut Imagined,
        until: Time,
        number: u32,
    ) -> f64 {
        while let Some(next) = rollout.next_decision() {
            let view = rollout.view();
            if next.time > until {
                return rollout.ledger().profit_usd() + fleet_worth_usd(prices, view, next.time);
            }
            let choice = self.perturbed_choice(prices, view, &next, number);
            rollout.apply(choice).expect("every choice is from the mask");
        }
        rollout.ledger().profit_usd()
    }

    /// The choice whose worth at the prices, perturbed by noise, is highest. The first roll-out has
    /// no noise.
    fn perturbed_choice(
        &self,
        prices: &DayPrices,
        view: View<'_>,
        decision: &Decision,
        rollout: u32,
    ) -> VertiportIx {
        if rollout == 0 {
            return prices.best_with(view, decision, 0.0, |_| 0.0);
        }
        let noise_usd = self.noise * prices.stake_usd();
        let noise = Noise::of(rollout, decision);
        let added_usd = |to| noise_usd * noise.at(to);
        prices.best_with(view, decision, noise_usd * MOST_NOISE, added_usd)
    }

    /// The choice whose worth, perturbed by the noise of a roll-out, is highest. The first
    /// roll-out, number 0, has no noise. Without choices, the aircraft holds.
    pub fn perturbed_best(
        &self,
        prices: &DayPrices,
        decision: &Decision,
        rollout: u32,
        choices: impl IntoIterator<Item = PricedChoice>,
    ) -> VertiportIx {
        let noise_usd = if rollout == 0 { 0.0 } else { self.noise * prices.stake_usd() };
        let noise = Noise::of(rollout, decision);
        let perturbed = |PricedChoice { worth_usd, to }| {
            let worth_usd = worth_usd + noise_usd * noise.at(to);
            PricedChoice { worth_usd, to }
        };
        PricedChoice::best(choices.into_iter().map(perturbed)).unwrap_or(decision.at)
    }

    /// The value of a choice: the mean of its roll-outs, and with its weight its worth at the
    /// prices; dollars.
    pub fn value_usd(&self, worth_usd: f64, rollouts_usd: &[f64]) -> f64 {
        let mean_usd = rollouts_usd.iter().sum::<f64>() / rollouts_usd.len() as f64;
        self.price_weight * worth_usd + mean_usd
    }
}

/// Noise that belongs to a roll-out and the aircraft and time of a decision.
#[derive(Debug, Clone, Copy)]
struct Noise {
    draws: Draws,
}

impl Noise {
    fn of(rollout: u32, decision: &Decision) -> Self {
        let key = u64::from(decision.aircraft.0) << 32 | u64::from(decision.time.seconds());
        Self { draws: Draws::of(u64::from(rollout), key) }
    }

    /// The noise of a choice: approximately normal with mean 0 and standard deviation 1 (the sum of
    /// four uniform numbers).
    #[inline]
    fn at(self, to: VertiportIx) -> f64 {
        let bits = self.draws.bits(to.0.into());
        let sum: u32 = [0, 16, 32, 48].iter().map(|shift| (bits >> shift & 0xffff) as u32).sum();
        (f64::from(sum) / 65_536.0 - 2.0) * 3.0_f64.sqrt()
    }
}

/// The worth of the positions of all aircraft, less the rent of each stand from now until its
/// aircraft is ready, dollars.
pub fn fleet_worth_usd(prices: &DayPrices, view: View<'_>, now: Time) -> f64 {
    let worth_usd = |aircraft: AircraftIx| {
        let (place, ready) = (view.places()[aircraft.at()], view.ready_at(aircraft));
        prices.aircraft_worth_usd(view, aircraft) - prices.rent_usd(place, now, ready)
    };
    AircraftIx::all(view.places().len()).map(worth_usd).sum()
}
