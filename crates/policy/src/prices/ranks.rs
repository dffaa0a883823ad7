//! Destinations in the order of the most that a flight to each can be worth, so that only a few of
//! them are evaluated to find the best.
//!
//! Roll-outs look at all destinations of every decision, and on a day of 100 vertiports this takes
//! nearly all of their time. While prices stay as they are, the worth of a flight that is decided
//! in a slot has a bound: all seats are full, the energy is as cheap and the worth of being ready
//! as high as at any time in the slot. The destinations are sorted by this bound once. A decision
//! then looks at them from the highest bound on, and stops where the bound of the next is below the
//! worth of the best that it has seen. The result is the same as if all of them were evaluated.

use std::ops::Range;

use vertifleet_core::{Time, TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::Choices;
use super::bands::{Arrivals, Bands};
use super::charged_flights::ChargedFlights;
use super::clock::{Clock, SLOT_S};
use super::levels::Levels;
use super::values::ValueTable;

/// More than the error of a sum of a few floating-point numbers, dollars.
const ROUNDING_USD: f64 = 1e-6;

/// A destination with the most dollars that a flight to it can be worth, and by how much less at
/// least for each seat that stays empty. Single precision halves the memory that is read.
#[derive(Debug, Clone, Copy)]
struct Most {
    usd: f32,
    less_usd: f32,
    to: VertiportIx,
}

impl Most {
    #[expect(clippy::cast_possible_truncation, reason = "rounded to the safe side afterwards")]
    fn of(
        (fares, values): (&Fares<'_>, &ValueTable),
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
        slot: usize,
        Arrivals { takeoff_s, ready }: &Arrivals,
    ) -> Self {
        let (profit_usd, margin_usd) = fares.most_usd(kind, (from, to), slot, *takeoff_s);
        let follows = ready.iter().map(|&ready| values.most_usd(kind, to, slot, ready));
        let usd = profit_usd + follows.fold(f64::NEG_INFINITY, f64::max) + ROUNDING_USD;
        Self { usd: (usd as f32).next_up(), less_usd: (margin_usd as f32).next_down().max(0.0), to }
    }
}

/// The destinations within range, for each type, vertiport, slot and band of charge, from the
/// highest bound on.
#[derive(Debug, Clone)]
pub(super) struct Ranks {
    clock: Clock,
    vertiports: usize,
    bands: usize,
    slots: Range<usize>,
    /// For each type and vertiport, and at the end: the number of destinations of all before it, in
    /// one slot and band.
    begins: Vec<usize>,
    all: Vec<Most>,
}

impl Ranks {
    /// Ranks the destinations of decisions from one time to another.
    pub(super) fn of(
        view: View<'_>,
        clock: &Clock,
        values: &ValueTable,
        charging: (&Levels, &ChargedFlights),
        (from, until): (Time, Time),
    ) -> Self {
        let vertiports = view.vertiports();
        let last = clock.slot(until.seconds()).min(clock.slots - 1);
        let slots = clock.slot(from.seconds())..last + 1;
        let fares = Fares::of(view, clock);
        let bands = Bands::of(view, charging);
        let (mut begins, mut all) = (vec![0], Vec::new());
        let mut within_range = 0;
        for kind in TypeIx::all(view.aircraft_types().len()) {
            for from in VertiportIx::all(vertiports) {
                let neighbours = view.within_range(kind, from);
                let arrivals = |to| (to, bands.arrivals(kind, (from, to)));
                let arrivals: Vec<_> = neighbours.iter().map(arrivals).collect();
                for slot in slots.clone() {
                    for band in 0..charging.0.bands() {
                        let begin = all.len();
                        all.extend(arrivals.iter().map(|(to, arrivals)| {
                            Most::of((&fares, values), kind, (from, *to), slot, &arrivals[band])
                        }));
                        all[begin..].sort_unstable_by(|one, other| other.usd.total_cmp(&one.usd));
                    }
                }
                within_range += neighbours.len() as usize;
                begins.push(within_range);
            }
        }
        let bands = charging.0.bands();
        Self { clock: *clock, vertiports, bands, slots, begins, all }
    }

    /// The destinations of a decision in a band of charge; `None` if they are not ranked for its
    /// time.
    #[inline]
    pub(super) fn from(
        &self,
        (kind, from): (TypeIx, VertiportIx),
        time: Time,
        band: usize,
    ) -> Option<Ranked<'_>> {
        let slot = self.clock.slot(time.seconds());
        if !self.slots.contains(&slot) {
            return None;
        }
        let at = kind.at() * self.vertiports + from.at();
        let (begin, end) = (self.begins[at], self.begins[at + 1]);
        let row = (slot - self.slots.start) * self.bands + band;
        let before = begin * self.slots.len() * self.bands + row * (end - begin);
        Some(Ranked(&self.all[before..before + end - begin]))
    }
}

/// The destinations of one decision, from the highest bound on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ranked<'a>(&'a [Most]);

impl Ranked<'_> {
    /// The choice that is worth most, of equals the vertiport listed first, if something is added
    /// to the worth of each: `added_usd`, which is at most `most_added_usd`. `open` are the choices
    /// to be looked at.
    #[inline]
    pub(super) fn best(
        self,
        choices: &Choices<'_>,
        own: VertiportIx,
        open: impl Fn(VertiportIx) -> bool,
        most_added_usd: f64,
        added_usd: impl Fn(VertiportIx) -> f64,
    ) -> VertiportIx {
        let mut best = (choices.worth_usd(own) + added_usd(own), own);
        for &Most { usd, less_usd, to } in self.0 {
            let most_usd = f64::from(usd) + most_added_usd;
            if most_usd < best.0 {
                break;
            }
            let most_usd = most_usd - f64::from(less_usd) * choices.empty_seats(to);
            if most_usd >= best.0 && open(to) {
                let usd = choices.worth_usd(to) + added_usd(to);
                if usd > best.0 || (usd == best.0 && to < best.1) {
                    best = (usd, to);
                }
            }
        }
        best.1
    }
}

/// The most that flights earn, over all seconds of a slot in which they may be decided.
struct Fares<'a> {
    view: View<'a>,
    clock: &'a Clock,
    /// By slot: the demand periods that it has a part in, and the lowest price of energy in them.
    periods: Vec<Range<usize>>,
    energy_usd: Vec<f64>,
}

impl<'a> Fares<'a> {
    fn of(view: View<'a>, clock: &'a Clock) -> Self {
        let periods = |slot| {
            let begin = Time::from_seconds(clock.begin_s(slot));
            view.period_at(begin)..view.period_at(begin + (SLOT_S - 1)) + 1
        };
        let periods: Vec<Range<usize>> = (0..=clock.slots).map(periods).collect();
        let energy_usd = periods.iter().map(|periods| {
            let prices_usd = &view.energy_prices_usd()[periods.clone()];
            prices_usd.iter().copied().fold(f64::INFINITY, f64::min)
        });
        let energy_usd = energy_usd.collect();
        Self { view, clock, periods, energy_usd }
    }

    /// The profit of a flight with all seats taken that takes off between two times after its
    /// decision, and what each passenger adds to it at most.
    fn most_usd(
        &self,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
        slot: usize,
        (first_s, last_s): (u32, u32),
    ) -> (f64, f64) {
        let Self { view, clock, .. } = *self;
        let leg = view.leg(kind, from, to);
        let seats = f64::from(view.aircraft_type(kind).seats);
        let fare_of = |period: usize| view.fares_usd(period, from)[to.at()];
        let most = |most: f64, period| most.max(fare_of(period));
        let fare_usd = self.periods[slot].clone().fold(f64::NEG_INFINITY, most);
        let margin_usd = (fare_usd - view.passenger_costs_usd(from)[to.at()]).max(0.0);
        let arrival_s = clock.begin_s(slot) + leg.flight_s;
        let slots = clock.slot(arrival_s + first_s)..=clock.slot(arrival_s + last_s + SLOT_S);
        let energy_usd = self.energy_usd[slots].iter().copied().fold(f64::INFINITY, f64::min);
        let cost_usd = leg.energy_kwh * energy_usd + view.flight_costs_usd(from)[to.at()];
        (seats * margin_usd - cost_usd, margin_usd)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use proptest::prelude::{ProptestConfig, any, prop, prop_assert_eq, proptest};
    use vertifleet_core::VertiportIx;
    use vertifleet_sim::Simulation;
    use vertifleet_testkit::extended_day;

    use super::super::DayPrices;
    use crate::draw;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn a_look_at_a_few_destinations_finds_what_a_look_at_all_finds(
            day in extended_day(), size_usd in prop::sample::select(vec![0.0, 1.0, 30.0]),
            seed in any::<u64>()
        ) {
            let mut simulation = Simulation::new(day);
            let mut prices: Option<DayPrices> = None;
            while let Some(decision) = simulation.next_decision() {
                let view = simulation.view();
                let prices = prices.get_or_insert_with(|| DayPrices::of(view, decision.time));
                prices.refresh(view, decision.time);
                let mut unranked = prices.clone();
                unranked.ranks = OnceLock::new();
                prices.rank(view, 7_200);
                let added_usd = |to: VertiportIx| {
                    size_usd * (draw(seed, decision.index.into(), u32::from(to.0)) % 1_000) as f64 / 1_000.0
                };
                let choice = prices.best_with(view, &decision, size_usd, added_usd);
                prop_assert_eq!(choice, unranked.best_with(view, &decision, size_usd, added_usd));
                simulation.apply(choice).expect("a choice from the mask");
            }
        }
    }
}
