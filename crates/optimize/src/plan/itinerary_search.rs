//! The best rest of the day for one aircraft while all others keep their flights.
//!
//! This is a longest path over labels (vertiport, second at which the aircraft is ready). From each
//! label the aircraft flies to any vertiport that has a stand for it from take-off until it is
//! ready again, or holds. Labels are settled forwards in time. Of the labels of one vertiport
//! within one slot of time only the best is kept, which bounds the work; on days that charge as
//! needed, the best with each part of a full battery. Each is exact to the second, so the result is
//! feasible, except at vertiports with chargers and waiting stands (`chargers.rs`).

use vertifleet_core::{AircraftIx, TypeIx, VertiportIx};

use super::batteries::PARTS;
use super::day::Day;
use super::guiding_prices::GuidingPrices;
use super::hop::{Arrival, Hop, Landing, Standing};
use super::passengers::Departure;
use super::problem::Problem;
use super::schedule::{Flight, Schedule};
use super::stand_times::{Moment, Window};

/// Variation of a search, so that an itinerary is not always completed in the same way.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bias {
    /// Seconds, below [`slot_s`](ItinerarySearch::slot_s), by which slots begin earlier, so that
    /// another one of several close labels is kept.
    pub(super) shift_s: u32,
    /// Share of the stand prices that the aircraft has to pay, so that it leaves scarce stands to
    /// others.
    pub(super) rent_share: f64,
    /// Share that the aircraft has to pay of what flights bring beyond what they sell for, so that
    /// it leaves passengers to others.
    pub(super) flight_share: f64,
    /// Most dollars by which the assumed profit of a flight is off, so that the aircraft may leave
    /// a flight to another, or fly without profit to make room.
    pub(super) noise_usd: f64,
    /// Seed of the noise of each pair of vertiports and period.
    pub(super) noise_seed: u64,
}

/// The prices that guide a search, and how.
#[derive(Clone, Copy)]
pub(super) struct Guided<'a> {
    pub(super) prices: &'a GuidingPrices,
    pub(super) bias: Bias,
}

/// The best known way to be ready at a vertiport within a slot.
#[derive(Debug, Clone, Copy)]
struct Label {
    value_usd: f64,
    ready_s: u32,
    /// The previous label, as a position in the table.
    before: u32,
}

/// In place of the label before the first one.
const NONE: u32 = u32::MAX;
const UNREACHED: Label = Label { value_usd: f64::NEG_INFINITY, ready_s: 0, before: NONE };

/// The best way found to the plan's end: its last label, and the destination of the flight from
/// there that passes the end, if there is one.
#[derive(Debug, Clone, Copy)]
struct Finish {
    value_usd: f64,
    label: u32,
    last_to: Option<VertiportIx>,
}

/// The memory of the search, kept from one itinerary to the next.
#[derive(Debug, Default)]
pub(super) struct ItinerarySearch {
    /// The length of a slot, in which only the best label of a vertiport is kept, is 2 to this
    /// power in seconds. No flight and no hold is shorter, so every label leads to a later slot.
    slot_bits: u32,
    /// The best label by slot, vertiport, then part of a full battery.
    labels: Vec<Label>,
    /// The number of parts of a full battery: 1 on days that charge to full.
    parts: usize,
    /// The landing before each label. Empty on days that charge to full.
    arrivals: Vec<Arrival>,
    /// The windows in which each vertiport has a stand for one more aircraft, vertiport by
    /// vertiport. Each list ends with a window that never opens.
    windows: Vec<Window>,
    /// The windows of the waiting stands, by vertiport. Empty on a day without such stands.
    waiting_stands: Vec<Vec<Window>>,
    /// Whether the aircraft is on a waiting stand at each label. Empty on a day without such
    /// stands.
    has_stand: Vec<bool>,
    /// The amount that a flight brings, without its energy, dollars: by period, and whether
    /// passengers of the period before still wait, then vertiport and number of the hop. A table is
    /// filled when the first flight of its time is looked at.
    offers_usd: Vec<f64>,
    has_offers: Vec<bool>,
    /// Position in `windows` of the first window of each vertiport that has not closed yet.
    current: Vec<usize>,
    best: Option<Finish>,
}

/// The itinerary to be completed.
struct Task<'a> {
    problem: &'a Problem,
    schedule: &'a Schedule,
    aircraft: AircraftIx,
    kind: TypeIx,
    seats: i64,
    /// First second of the first slot.
    origin_s: u32,
    prices: &'a GuidingPrices,
    bias: Bias,
}

impl Task<'_> {
    /// The difference between the assumed and the true profit of a flight of a pair and period,
    /// dollars.
    #[inline]
    fn noise_usd(&self, cell: usize) -> f64 {
        if self.bias.noise_usd == 0.0 {
            return 0.0;
        }
        let bits = (cell as u64 ^ self.bias.noise_seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.bias.noise_usd * ((bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }
}

/// A label that is being settled: the aircraft decides at this vertiport and time.
#[derive(Clone, Copy)]
struct Choice {
    label: u32,
    place: VertiportIx,
    time_s: u32,
    arrival: Arrival,
    standing: Standing,
    moment: Moment,
    value_usd: f64,
    /// The demand period of the decision.
    period: usize,
    /// The minute of the decision in the stand prices.
    minute: usize,
}

/// A place that a choice leads to.
#[derive(Clone, Copy)]
struct Place {
    at: VertiportIx,
    /// When the aircraft can be there.
    window: Window,
    /// Whether it is on a waiting stand.
    has_stand: bool,
    /// Its latest landing there.
    arrival: Arrival,
}

impl ItinerarySearch {
    /// A search in short slots.
    pub(super) fn thorough() -> Self {
        // No flight and no hold is shorter than a minute.
        Self::in_slots(5)
    }

    /// A search in slots of about four minutes, or of the shortest flight or hold of a day. On days
    /// that charge as needed, where each slot has more labels, they are about a hundredth of the
    /// day.
    pub(super) fn quick(day: &Day) -> Self {
        let longest_s = match day.batteries {
            Some(_) => (day.end_s - day.first_s).div_ceil(100).max(1),
            None => 1 << 8,
        };
        Self::in_slots(day.shortest_s().min(longest_s).ilog2())
    }

    fn in_slots(slot_bits: u32) -> Self {
        Self { slot_bits, ..Self::default() }
    }

    /// The length of a slot, seconds.
    pub(super) fn slot_s(&self) -> u32 {
        1 << self.slot_bits
    }

    /// Writes the flights that complete the itinerary of `aircraft` best to `flights`. Returns
    /// `false` if the itinerary cannot be completed, because others have taken every stand that the
    /// aircraft could stay at.
    pub(super) fn complete(
        &mut self,
        problem: &Problem,
        Guided { prices, bias }: Guided<'_>,
        schedule: &Schedule,
        aircraft: AircraftIx,
        flights: &mut Vec<Flight>,
    ) -> bool {
        debug_assert!(!schedule.is_whole(aircraft), "a whole itinerary is complete");
        flights.clear();
        let day = &problem.day;
        let (place, Landing { ready_s, arrival }) = schedule.open_end(aircraft);
        let task = Task {
            problem,
            schedule,
            aircraft,
            kind: day.kind(aircraft),
            seats: day.seats(aircraft),
            origin_s: ready_s.saturating_sub(bias.shift_s),
            prices,
            bias,
        };
        self.prepare(&task);
        let has_stand = schedule.flights(aircraft).is_empty();
        let place = Place { at: place, window: Window::ALWAYS, has_stand, arrival };
        self.enter(&task, &place, Label { value_usd: 0.0, ready_s, before: NONE });
        self.settle(&task);
        let Some(finish) = self.best else { return false };
        self.read_back(&task, &finish, flights);
        true
    }

    fn prepare(&mut self, task: &Task<'_>) {
        let day = &task.problem.day;
        self.best = None;
        self.windows.clear();
        self.current.clear();
        for vertiport in VertiportIx::all(day.vertiports) {
            self.current.push(self.windows.len());
            task.schedule.stands.append_windows(vertiport, &mut self.windows);
            self.windows.push(Window { opens: Moment::NEVER, closes: Moment::NEVER });
        }
        let pairs = day.vertiports * day.vertiports;
        self.has_offers.clear();
        self.has_offers.resize(2 * day.period_starts_s.len(), false);
        self.offers_usd.resize(self.has_offers.len() * pairs, 0.0);
        let slots = ((day.end_s - task.origin_s) >> self.slot_bits) + 1;
        self.labels.clear();
        self.parts = if day.batteries.is_some() { PARTS } else { 1 };
        self.labels.resize(slots as usize * day.vertiports * self.parts, UNREACHED);
        let charged = if day.batteries.is_some() { self.labels.len() } else { 0 };
        self.arrivals.resize(charged, Arrival::default());
        self.has_stand.clear();
        if let Some(waiting) = &task.schedule.waiting_stands {
            self.has_stand.resize(self.labels.len(), false);
            self.waiting_stands.resize(day.vertiports, Vec::new());
            for (vertiport, windows) in
                VertiportIx::all(day.vertiports).zip(&mut self.waiting_stands)
            {
                windows.clear();
                waiting.stands.append_windows(vertiport, windows);
            }
        }
    }

    #[inline]
    fn enter(&mut self, task: &Task<'_>, place: &Place, label: Label) {
        let day = &task.problem.day;
        let slot = ((label.ready_s - task.origin_s) >> self.slot_bits) as usize;
        let mut at = slot * day.vertiports + place.at.at();
        if let Some(batteries) = &day.batteries {
            at = at * PARTS + batteries.part(task.kind, place.at, place.arrival, label.ready_s);
        }
        if label.value_usd > self.labels[at].value_usd {
            self.labels[at] = label;
            if let Some(of_label) = self.has_stand.get_mut(at) {
                *of_label = place.has_stand;
            }
            if let Some(of_label) = self.arrivals.get_mut(at) {
                *of_label = place.arrival;
            }
        }
    }

    fn settle(&mut self, task: &Task<'_>) {
        let day = &task.problem.day;
        let mut slot_s = task.origin_s;
        let mut slot_period = 0;
        for first in (0..self.labels.len()).step_by(day.vertiports * self.parts) {
            slot_period = day.period_from(slot_period, slot_s);
            for current in &mut self.current {
                while self.windows[*current].closes <= Moment::of(slot_s, AircraftIx(0)) {
                    *current += 1;
                }
            }
            for place in VertiportIx::all(day.vertiports) {
                let of_place = first + place.at() * self.parts;
                let mut best_usd = f64::NEG_INFINITY;
                // The labels with more charge come first: one that is worth no more than one of
                // them leads nowhere better.
                for at in (of_place..of_place + self.parts).rev() {
                    let Label { value_usd, ready_s, .. } = self.labels[at];
                    if value_usd > best_usd {
                        best_usd = value_usd;
                        self.settle_label(task, (at, place), ready_s, slot_period);
                    }
                }
            }
            slot_s += self.slot_s();
        }
    }

    #[inline]
    fn settle_label(
        &mut self,
        task: &Task<'_>,
        (at, place): (usize, VertiportIx),
        time_s: u32,
        slot_period: usize,
    ) {
        let day = &task.problem.day;
        let arrival = self.arrivals.get(at).copied().unwrap_or_default();
        let standing = day.standing(task.aircraft, place, time_s, arrival);
        let choice = Choice {
            label: u32::try_from(at).expect("a day has fewer than 2^32 labels"),
            place,
            time_s,
            arrival,
            standing,
            moment: Moment::of(time_s, task.aircraft),
            value_usd: self.labels[at].value_usd,
            period: day.period_from(slot_period, time_s),
            minute: task.prices.minute(time_s),
        };
        self.decide(task, &choice);
    }

    #[inline]
    fn decide(&mut self, task: &Task<'_>, choice: &Choice) {
        self.hold(task, choice);
        let day = &task.problem.day;
        let first = self.offers(task, choice) + choice.place.at() * day.vertiports;
        for (offer, hop) in (first..).zip(day.hops(task.kind, choice.place)) {
            self.fly(task, choice, hop, offer);
        }
    }

    /// Where the table of what flights bring at the time of a choice begins in `offers_usd`.
    #[inline]
    fn offers(&mut self, task: &Task<'_>, choice: &Choice) -> usize {
        let day = &task.problem.day;
        let departure = Departure { cell: 0, period: choice.period, take_off_s: choice.time_s };
        let table = 2 * choice.period + usize::from(departure.is_early(day));
        let first = table * day.vertiports * day.vertiports;
        if !self.has_offers[table] {
            self.has_offers[table] = true;
            self.fill_offers(task, departure, first);
        }
        first
    }

    /// Fills the table of a time, which is that of any departure in it.
    fn fill_offers(&mut self, task: &Task<'_>, any: Departure, first: usize) {
        let day = &task.problem.day;
        let rows = self.offers_usd[first..].chunks_mut(day.vertiports);
        for (place, row) in VertiportIx::all(day.vertiports).zip(rows) {
            for (offer_usd, hop) in row.iter_mut().zip(day.hops(task.kind, place)) {
                let departure = Departure { cell: day.cell(any.period, place, hop.to), ..any };
                let margin_usd = task.schedule.passengers.margin_usd(day, departure, task.seats);
                let above_usd = task.prices.above_price_usd(day, task.kind, departure, margin_usd);
                *offer_usd = margin_usd - hop.flight_cost_usd + task.noise_usd(departure.cell)
                    - task.bias.flight_share * above_usd;
            }
        }
    }

    #[inline]
    fn hold(&mut self, task: &Task<'_>, choice: &Choice) {
        let has_stand = self.has_waiting_stand(task, choice);
        // Otherwise the aircraft has its place at least until it decides.
        let window =
            if has_stand { Some(Window::ALWAYS) } else { self.window(choice.place, choice.moment) };
        let Some(window) = window else { return };
        let ready_s = choice.time_s + task.problem.day.hold_s;
        let place = Place { at: choice.place, window, has_stand, arrival: choice.arrival };
        self.reach(task, choice, place, ready_s, 0.0);
    }

    /// Whether the aircraft can hold on a waiting stand, because it is on one already or one is
    /// free.
    #[inline]
    fn has_waiting_stand(&self, task: &Task<'_>, choice: &Choice) -> bool {
        let day = &task.problem.day;
        if day.waiting_stands(choice.place).is_none() {
            return false;
        }
        let windows = &self.waiting_stands[choice.place.at()];
        let at = windows.partition_point(|window| window.closes <= choice.moment);
        let may_move = day.batteries.as_ref().is_none_or(|batteries| {
            batteries.full_s(task.kind, choice.place, choice.arrival) <= choice.time_s
        });
        self.has_stand[choice.label as usize]
            || may_move && windows.get(at).is_some_and(|window| window.opens <= choice.moment)
    }

    #[inline]
    fn fly(&mut self, task: &Task<'_>, choice: &Choice, hop: &Hop, offer: usize) {
        let Some(window) = self.window(hop.to, choice.moment) else { return };
        let day = &task.problem.day;
        if day.is_closed(choice.place, hop.to, choice.time_s) {
            return;
        }
        let landing = day.landing(task.aircraft, choice.place, hop, choice.standing);
        let Some(Landing { ready_s, arrival }) = landing else { return };
        let energy_usd = day.energy_cost_usd(hop, choice.period, arrival.second);
        let place = Place { at: hop.to, window, has_stand: false, arrival };
        self.reach(task, choice, place, ready_s, self.offers_usd[offer] - energy_usd);
    }

    /// The window of a vertiport that contains a moment, which must not be before the slot that is
    /// being settled.
    #[inline]
    fn window(&self, vertiport: VertiportIx, moment: Moment) -> Option<Window> {
        let mut at = self.current[vertiport.at()];
        while self.windows[at].closes <= moment {
            at += 1;
        }
        let window = self.windows[at];
        (window.opens <= moment).then_some(window)
    }

    /// Enters that the aircraft can be ready at a place at `ready_s`, if it can stay there until
    /// then.
    #[inline]
    fn reach(
        &mut self,
        task: &Task<'_>,
        choice: &Choice,
        place: Place,
        ready_s: u32,
        profit_usd: f64,
    ) {
        let (day, prices, Place { at, window, .. }) = (&task.problem.day, task.prices, place);
        let rent_usd = prices.rent_usd(at, choice.minute, prices.minute(ready_s));
        let value_usd = choice.value_usd + profit_usd - task.bias.rent_share * rent_usd;
        if ready_s <= day.end_s {
            if Moment::of(ready_s, task.aircraft) < window.closes {
                let label = Label { value_usd, ready_s, before: choice.label };
                self.enter(task, &place, label);
            }
        } else if window.closes == Moment::NEVER
            && self.best.is_none_or(|best| value_usd > best.value_usd)
        {
            let last_to = (at != choice.place).then_some(at);
            self.best = Some(Finish { value_usd, label: choice.label, last_to });
        }
    }

    fn read_back(&self, task: &Task<'_>, finish: &Finish, flights: &mut Vec<Flight>) {
        let day = &task.problem.day;
        let place = |label: u32| VertiportIx::new(label as usize / self.parts % day.vertiports);
        let flight = |label: u32, to: VertiportIx| {
            let (from, take_off_s) = (place(label), self.labels[label as usize].ready_s);
            let arrival = self.arrivals.get(label as usize).copied().unwrap_or_default();
            let hop = day.hop(task.kind, from, to);
            let standing = day.standing(task.aircraft, from, take_off_s, arrival);
            let landing = day.landing(task.aircraft, from, hop, standing);
            let landing = landing.expect("it has been found to take off in time");
            Flight { take_off_s, from, to, landing }
        };
        let mut at = finish.label;
        flights.extend(finish.last_to.map(|to| flight(at, to)));
        while self.labels[at as usize].before != NONE {
            let before = self.labels[at as usize].before;
            if place(before) != place(at) {
                flights.push(flight(before, place(at)));
            }
            at = before;
        }
        flights.reverse();
    }
}
