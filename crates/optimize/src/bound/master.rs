//! The search's model of the day: groups divide themselves among the itineraries that are known so
//! far. Prices rise where more is asked for than is available, and those of flights fall where more
//! are sold than bought.
//!
//! A group is aircraft that start alike. Passengers who choose between flights with several prices
//! are groups too.
//!
//! The model is the dual of the proximal step of a bundle method with one bundle for each group of
//! like aircraft (K. Kiwiel, *Proximity control in bundle methods for convex nondifferentiable
//! minimization*, Mathematical Programming 46, 1990): a price is the centre's price moved by a pace
//! times the excess, kept within its limits. Shifting aircraft from an itinerary to a better one of
//! the same group raises the model's value, and prices follow. This continues until no shift is
//! worth much.

mod charging;

use charging::ChargingPrices;

use super::itinerary::Itinerary;
use super::prices::{MOST_FOR_A_STAND, PACE_OF_A_SEAT, Pace, Prices, whole};
use super::time_expanded_day::TimeExpandedDay;

/// The aircraft of one layer that start alike, or the passengers of a part of the market.
#[derive(Debug, Clone)]
struct Group {
    count: f64,
    itineraries: Vec<Known>,
}

/// An itinerary that is known, and the share of the group that takes it.
#[derive(Debug, Clone)]
struct Known {
    itinerary: Itinerary,
    share: f64,
    /// Number of rounds for which no aircraft has taken the itinerary.
    idle: u32,
    worth: f64,
}

/// Number of rounds after which an itinerary that no aircraft takes is forgotten.
const FORGOTTEN: u32 = 12;
/// The most shifts of a group in one round.
const SHIFTS: u32 = 6;

/// The demand for the flights of one price: `full` flights at up to `most`, and one more at up to
/// `last`. Both numbers are 0 where passengers choose between flights with several prices: these
/// are groups of the model.
#[derive(Debug, Clone, Copy)]
struct Buyers {
    /// The highest price, which is what a full flight brings.
    most: f64,
    full: f64,
    /// The amount that the last flight brings; 0 without one.
    last: f64,
    pace: f64,
}

impl Buyers {
    fn of(day: &TimeExpandedDay, position: usize) -> Self {
        let most = day.market.most(position) as f64;
        let pace = PACE_OF_A_SEAT * day.market.pace(position);
        match day.market.alike(position) {
            Some(alike) if most > 0.0 => {
                let (full, last) = (alike.full as f64, alike.last_brings as f64);
                Self { most, full, last, pace }
            }
            _ => Self { most, full: 0.0, last: 0.0, pace },
        }
    }

    /// The number sold less the number that is bought at a price. At the price that the last flight
    /// brings, it may be bought or not.
    fn excess(self, sold: f64, price: f64) -> f64 {
        let least = if price < self.last { self.full + 1.0 } else { self.full };
        let most = if price <= self.last { self.full + 1.0 } else { self.full };
        sold - sold.clamp(least, most)
    }

    /// The price of the proximal step: from the centre, `a_flight` lower for each flight that is
    /// sold and not bought at this price, and within its limits.
    fn price(self, sold: f64, centre: f64, a_flight: f64) -> f64 {
        let without_last = centre - a_flight * (sold - self.full);
        if without_last >= self.last {
            return without_last.min(self.most);
        }
        (without_last + a_flight).clamp(0.0, self.last)
    }

    /// The surplus of the buyers at a price.
    fn surplus(self, price: f64) -> f64 {
        self.full * (self.most - price) + (self.last - price).max(0.0)
    }

    /// Whether the price moves with the number sold.
    fn is_free(self, price: f64) -> bool {
        price > 0.0 && price < self.most && price != self.last
    }
}

/// The groups of a model, without its prices.
#[derive(Debug, Clone)]
pub(super) struct Groups {
    groups: Vec<Group>,
    reach: f64,
}

impl Groups {
    /// The number of aircraft of a group that take one itinerary, if it is the one that most of
    /// them take; at most 1.
    pub(super) fn agreed(&self, group: usize) -> f64 {
        let Group { count, itineraries } = &self.groups[group];
        let share = itineraries.iter().map(|known| known.share).fold(0.0, f64::max);
        (count * share).min(1.0)
    }

    /// One aircraft of a group leaves it.
    pub(super) fn leave(&mut self, group: usize) {
        self.groups[group].count -= 1.0;
    }

    /// One aircraft that had left a group comes back.
    pub(super) fn come_back(&mut self, group: usize) {
        self.groups[group].count += 1.0;
    }

    /// Replaces all that is known of a group.
    pub(super) fn replace_itineraries(&mut self, group: usize, itinerary: Itinerary) {
        self.groups[group].itineraries = vec![Known { itinerary, share: 1.0, idle: 0, worth: 0.0 }];
    }
}

/// The model around a centre, which is the best prices so far.
pub(super) struct Master<'a> {
    day: &'a TimeExpandedDay,
    pace: &'a Pace,
    groups: Vec<Group>,
    centre: Prices,
    /// Micro-dollars by which a price moves for an excess of one, at a pace of 1.
    pub(super) reach: f64,
    /// The number of stands asked for less the number available, the number of flights sold less
    /// those that groups buy, and the model's prices; in the order of [`Prices`].
    stand_excess: Vec<f64>,
    flight_excess: Vec<f64>,
    stand: Vec<f64>,
    flight: Vec<f64>,
    /// Other facts on each price of a flight.
    buyers: Vec<Buyers>,
    charging: ChargingPrices,
    /// Price of a stand from the first slice until each slice begins and the last one ends, by
    /// vertiport, then slice.
    paid: Vec<f64>,
}

impl<'a> Master<'a> {
    /// A model in which each group takes its only known itinerary; groups are in the order of
    /// layers and vertiports.
    pub(super) fn new(
        day: &'a TimeExpandedDay,
        pace: &'a Pace,
        centre: Prices,
        itineraries: Vec<(u32, Itinerary)>,
    ) -> Self {
        let group = |(count, itinerary)| Group {
            count: f64::from(count),
            itineraries: vec![Known { itinerary, share: 1.0, idle: 0, worth: 0.0 }],
        };
        let mut master = Self {
            day,
            pace,
            groups: itineraries.into_iter().map(group).collect(),
            reach: 0.0,
            stand_excess: vec![0.0; centre.stand.len()],
            flight_excess: vec![0.0; centre.flight.len()],
            stand: centre.stand.iter().map(|&price| price as f64).collect(),
            flight: centre.flight.iter().map(|&price| price as f64).collect(),
            buyers: (0..centre.flight.len()).map(|position| Buyers::of(day, position)).collect(),
            charging: ChargingPrices::of(day, &centre.charging),
            paid: vec![0.0; centre.stand.len() + day.size()],
            centre,
        };
        master.count();
        master
    }

    /// A model of the groups of an earlier one, on a day on which there is less left.
    pub(super) fn resume(
        day: &'a TimeExpandedDay,
        pace: &'a Pace,
        centre: Prices,
        Groups { groups, reach }: Groups,
    ) -> Self {
        // The excess is counted before prices are moved by it.
        Self { groups, reach, ..Self::new(day, pace, centre, Vec::new()) }
    }

    /// The groups, to begin another model with.
    pub(super) fn into_groups(self) -> Groups {
        Groups { groups: self.groups, reach: self.reach }
    }

    /// Recomputes the excess.
    fn count(&mut self) {
        let size = self.day.size();
        for (excess, &stands) in self.stand_excess.iter_mut().zip(&self.day.stands) {
            *excess = -f64::from(stands);
        }
        self.flight_excess.fill(0.0);
        self.charging.clear();
        for group in self.groups.iter().filter(|group| group.count > 0.0) {
            for known in group.itineraries.iter().filter(|known| known.share > 0.0) {
                let aircraft = group.count * known.share;
                for (slices, place) in known.itinerary.stays() {
                    for slice in slices {
                        self.stand_excess[slice * size + place] += aircraft;
                    }
                }
                for &(at, number) in &known.itinerary.flights {
                    self.flight_excess[at as usize] += aircraft * number;
                }
                self.charging.add(&known.itinerary, aircraft);
            }
        }
    }

    /// The rate at which the bound would fall with the reach if the excess stayed the same.
    pub(super) fn fall(&self) -> f64 {
        let size = self.day.size();
        let free = |excess: f64, price: i64, most: i64| {
            let stuck = if excess < 0.0 { price <= 0 } else { price >= most };
            if stuck { 0.0 } else { excess * excess }
        };
        let stands = self.stand_excess.iter().zip(&self.centre.stand).enumerate();
        let stands = stands.map(|(at, (&excess, &price))| {
            self.pace.of_stands(at / size) * free(excess, price, MOST_FOR_A_STAND)
        });
        let flights = self.flight_excess.iter().zip(&self.centre.flight).zip(&self.buyers);
        let flights = flights.map(|((&sold, &price), buyers)| {
            let price = price as f64;
            let excess = buyers.excess(sold, price);
            let stuck = if excess > 0.0 { price <= 0.0 } else { price >= buyers.most };
            if stuck { 0.0 } else { buyers.pace * excess * excess }
        });
        let charging = self.charging.fall(&self.centre.charging);
        stands.sum::<f64>() + flights.sum::<f64>() + charging
    }

    /// Moves the centre of the model to these prices.
    pub(super) fn move_to(&mut self, centre: &Prices) {
        self.centre.clone_from(centre);
    }

    /// Adds one more itinerary to each group, in the order of [`Master::new`].
    pub(super) fn learn(&mut self, itineraries: Vec<(u32, Itinerary)>) {
        for (group, (_, itinerary)) in self.groups.iter_mut().zip(itineraries) {
            if group.itineraries.iter().all(|known| known.itinerary != itinerary) {
                group.itineraries.push(Known { itinerary, share: 0.0, idle: 0, worth: 0.0 });
            }
        }
    }

    fn stand_price(&self, at: usize) -> f64 {
        let moved = self.reach * self.pace.of_stands(at / self.day.size()) * self.stand_excess[at];
        (self.centre.stand[at] as f64 + moved).clamp(0.0, MOST_FOR_A_STAND as f64)
    }

    fn flight_price(&self, at: usize) -> f64 {
        let buyers = self.buyers[at];
        let centre = self.centre.flight[at] as f64;
        buyers.price(self.flight_excess[at], centre, self.reach * buyers.pace)
    }

    /// Shifts aircraft until all shifts together are worth no more than about `enough`
    /// micro-dollars, or for `rounds` rounds. Returns the worth of the remaining shifts.
    pub(super) fn settle(&mut self, rounds: u32, enough: f64) -> f64 {
        self.count();
        for at in 0..self.stand.len() {
            self.stand[at] = self.stand_price(at);
        }
        for place in 0..self.day.size() {
            self.pay(place, 0);
        }
        for at in 0..self.flight.len() {
            self.flight[at] = self.flight_price(at);
        }
        self.charging.reprice(&self.centre.charging, self.reach);
        let mut possible = f64::INFINITY;
        for _ in 0..rounds {
            possible = (0..self.groups.len()).map(|group| self.shift_group(group)).sum();
            if possible <= enough {
                break;
            }
        }
        for group in &mut self.groups {
            for known in &mut group.itineraries {
                known.idle = if known.share > 0.0 { 0 } else { known.idle + 1 };
            }
            group.itineraries.retain(|known| known.idle < FORGOTTEN);
        }
        possible
    }

    /// Sums the prices of a vertiport's stands, from a slice on.
    fn pay(&mut self, place: usize, first: usize) {
        let size = self.day.size();
        let slices = self.stand.len() / size;
        let row = &mut self.paid[place * (slices + 1)..][..=slices];
        let mut paid = row[first];
        for (slice, until) in row[first + 1..].iter_mut().enumerate() {
            paid += self.stand[(first + slice) * size + place];
            *until = paid;
        }
    }

    /// The worth of an itinerary at the model's prices. Rents and sales are summed in one loop:
    /// each addition waits for the one before it in its sum, but not for the other sum.
    #[inline]
    fn worth(&self, itinerary: &Itinerary) -> f64 {
        let row = self.stand.len() / self.day.size() + 1;
        let (mut rents, mut sold) = (0.0, 0.0);
        let rent = |begin: u32, (until, place): (u32, u32)| {
            let paid = &self.paid[place as usize * row..][..row];
            paid[until as usize] - paid[begin as usize]
        };
        let sale = |(at, number): (u32, f64)| self.flight[at as usize] * number;
        let (stays, flights) = (&itinerary.stays, &itinerary.flights);
        let both = stays.len().min(flights.len());
        let mut begin = 0;
        for (&stay, &flight) in stays[..both].iter().zip(&flights[..both]) {
            rents += rent(begin, stay);
            sold += sale(flight);
            begin = stay.0;
        }
        for &stay in &stays[both..] {
            rents += rent(begin, stay);
            begin = stay.0;
        }
        for &flight in &flights[both..] {
            sold += sale(flight);
        }
        itinerary.earnings - rents + sold - self.charging.payment(itinerary)
    }

    /// Shifts aircraft of a group from bad itineraries to the best. Returns what could have been
    /// gained before, micro-dollars.
    fn shift_group(&mut self, group: usize) -> f64 {
        let count = self.groups[group].count;
        if count == 0.0 {
            return 0.0;
        }
        let mut known = std::mem::take(&mut self.groups[group].itineraries);
        let mut possible = 0.0;
        for shift in 0..SHIFTS {
            for known in &mut known {
                known.worth = self.worth(&known.itinerary);
            }
            let best = (0..known.len()).max_by(|&a, &b| known[a].worth.total_cmp(&known[b].worth));
            let best = best.expect("a group has an itinerary");
            let lost = |at: usize| known[at].share * (known[best].worth - known[at].worth);
            if shift == 0 {
                possible = count * (0..known.len()).map(lost).sum::<f64>();
            }
            let worst = (0..known.len()).max_by(|&a, &b| lost(a).total_cmp(&lost(b)));
            let worst = worst.expect("a group has an itinerary");
            if lost(worst) <= 0.0 {
                break;
            }
            let share = self.shift_itineraries(&known[worst], &known[best], count);
            known[worst].share -= share;
            known[best].share += share;
        }
        self.groups[group].itineraries = known;
        possible
    }

    /// Shifts aircraft of a group of `count` from one itinerary to a better one, until both are
    /// worth about the same. Returns the share of the group that was shifted.
    fn shift_itineraries(&mut self, worst: &Known, best: &Known, count: f64) -> f64 {
        let (from, to) = (&worst.itinerary, &best.itinerary);
        let gain = best.worth - worst.worth;
        let share = (gain / (count * self.resistance(from, to))).min(worst.share);
        self.shift(from, to, count * share);
        let left = self.worth(to) - self.worth(from);
        if left >= 0.0 {
            return share;
        }
        // Too many aircraft were shifted, because prices that were at a limit have left it.
        let back = share * left / (left - gain);
        self.shift(to, from, count * back);
        share - back
    }

    /// The amount by which one aircraft that changes its itinerary lowers the worth of the shift,
    /// through the prices that are not at a limit.
    fn resistance(&self, from: &Itinerary, to: &Itinerary) -> f64 {
        let size = self.day.size();
        let free = |price: f64, most: i64| f64::from(u8::from(price > 0.0 && price < most as f64));
        let mut resistance = 0.0;
        for (slices, leave, take) in from.apart(to) {
            for slice in slices {
                let stand = |place| free(self.stand[slice * size + place], MOST_FOR_A_STAND);
                resistance += self.pace.of_stands(slice) * (stand(leave) + stand(take));
            }
        }
        // Flights that both have cancel out, but counting them keeps steps short: without them
        // `paper` stopped at a bound that was 10 $ higher.
        for &(at, number) in from.flights.iter().chain(&to.flights) {
            let buyers = self.buyers[at as usize];
            if buyers.is_free(self.flight[at as usize]) {
                resistance += buyers.pace * number.abs();
            }
        }
        resistance += self.charging.resistance(from, to);
        self.reach * resistance.max(1e-3)
    }

    /// Moves `aircraft` aircraft from one itinerary to another, and updates the prices.
    fn shift(&mut self, from: &Itinerary, to: &Itinerary, aircraft: f64) {
        let size = self.day.size();
        for (slices, leave, take) in from.apart(to) {
            for slice in slices.clone() {
                for (place, change) in [(leave, -aircraft), (take, aircraft)] {
                    let at = slice * size + place;
                    self.stand_excess[at] += change;
                    self.stand[at] = self.stand_price(at);
                }
            }
        }
        let mut changed = vec![usize::MAX; size];
        for (slices, leave, take) in from.apart(to) {
            for place in [leave, take] {
                changed[place] = changed[place].min(slices.start);
            }
        }
        for (place, &first) in changed.iter().enumerate().filter(|(_, first)| **first < usize::MAX)
        {
            self.pay(place, first);
        }
        for (itinerary, change) in [(from, -aircraft), (to, aircraft)] {
            for &(at, number) in &itinerary.flights {
                self.flight_excess[at as usize] += change * number;
                self.flight[at as usize] = self.flight_price(at as usize);
            }
            self.charging.shift(itinerary, change, (&self.centre.charging, self.reach));
        }
    }

    /// The model's prices, in whole micro-dollars.
    pub(super) fn prices(&self, to: &mut Prices) {
        for (to, &price) in to.stand.iter_mut().zip(&self.stand) {
            *to = whole(price);
        }
        for (to, &price) in to.flight.iter_mut().zip(&self.flight) {
            *to = whole(price);
        }
        self.charging.write(&mut to.charging);
    }

    /// The model's estimate of the bound that its prices prove, micro-dollars. It is never more
    /// than the true one, apart from rounding.
    pub(super) fn value(&self) -> f64 {
        let fleet = self.groups.iter().filter(|group| group.count > 0.0).map(|group| {
            let worths = group.itineraries.iter().map(|known| self.worth(&known.itinerary));
            group.count * worths.fold(f64::NEG_INFINITY, f64::max)
        });
        let stands = self.day.stands.iter().zip(&self.stand);
        let stands = stands.map(|(&number, price)| f64::from(number) * price);
        let surplus = self.buyers.iter().zip(&self.flight);
        let surplus = surplus.map(|(buyers, &price)| buyers.surplus(price));
        fleet.sum::<f64>() + stands.sum::<f64>() + surplus.sum::<f64>() + self.charging.value()
    }
}
