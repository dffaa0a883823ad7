//! The search's model of the day: a fleet that divides itself among the ways that are known so far, at prices that rise
//! where more is wanted than there is.
//!
//! It is the dual of the proximal step of a bundle method with one bundle for each group of like aircraft (K. Kiwiel, *Proximity control in bundle
//! methods for convex nondifferentiable minimization*, Mathematical Programming 46, 1990): a price is that of the centre, plus a pace
//! times what is wanted too much, within its limits. Shifting aircraft from a way to a better one of the same group raises
//! the model's value, and prices follow; this goes on until no shift is worth much.

use std::ops::Range;

use super::prices::{MOST_FOR_A_STAND, PACE_OF_PASSENGERS, Pace, Prices, whole};
use super::time_expanded_day::TimeExpandedDay;

/// A way through the day.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    /// What its flights earn before anything is paid, micro-dollars.
    pub(super) earnings: f64,
    /// Where the aircraft is, or flies to, when slices end: up to which slice at which vertiport, one stay after the other.
    pub(super) stays: Vec<(u32, u32)>,
    /// Place of the passengers of its flights in [`TimeExpandedDay::demand`], and how many they are.
    pub(super) flights: Vec<(u32, u32)>,
}

impl Way {
    /// The aircraft is at a place, or flies there, when the slices from one to before another end.
    pub(super) fn stay(&mut self, place: usize, slices: Range<usize>) {
        let position = |at: usize| u32::try_from(at).expect("a day has few slices and vertiports");
        if !slices.is_empty() {
            self.stays.push((position(slices.end), position(place)));
        }
    }

    /// The slices of each stay, and where it is.
    fn stays(&self) -> impl Iterator<Item = (Range<usize>, usize)> {
        let mut begin = 0;
        self.stays.iter().map(move |&(until, place)| {
            let slices = begin..until as usize;
            begin = slices.end;
            (slices, place as usize)
        })
    }

    /// The slices in which this way and another are at different places, this one's and the other's, in order.
    fn apart(&self, other: &Self) -> impl Iterator<Item = (Range<usize>, usize, usize)> {
        let (mut one, mut two, mut begin) = (0, 0, 0);
        std::iter::from_fn(move || {
            loop {
                let (&(one_until, here), &(two_until, there)) =
                    (self.stays.get(one)?, other.stays.get(two)?);
                let until = one_until.min(two_until);
                one += usize::from(one_until == until);
                two += usize::from(two_until == until);
                let slices = begin as usize..until as usize;
                begin = until;
                if here != there {
                    return Some((slices, here as usize, there as usize));
                }
            }
        })
    }
}

/// Aircraft of one layer that start at the same vertiport.
#[derive(Debug)]
struct Group {
    count: f64,
    ways: Vec<Known>,
}

/// A way that is known, and the share of the group that takes it.
#[derive(Debug)]
struct Known {
    way: Way,
    share: f64,
    /// Since when no aircraft takes it, in rounds.
    idle: u32,
    worth: f64,
}

/// Ways that no aircraft takes are forgotten after so many rounds.
const FORGOTTEN: u32 = 12;
/// A group has had its turns when it has shifted so often.
const SHIFTS: u32 = 6;

/// The model, around a centre.
pub(super) struct Master<'a> {
    network: &'a TimeExpandedDay,
    pace: &'a Pace,
    groups: Vec<Group>,
    centre: Prices,
    /// What a price moves by where one more is wanted than there is, micro-dollars, at a pace of 1.
    pub(super) reach: f64,
    /// What is wanted too much or too little, and the model's prices, in the order of [`Prices`].
    stand_excess: Vec<f64>,
    demand_excess: Vec<f64>,
    stand: Vec<f64>,
    demand: Vec<f64>,
    /// What a stand costs from the first slice until each slice begins and the last one ends, by vertiport, then slice.
    paid: Vec<f64>,
}

impl<'a> Master<'a> {
    /// Each group takes the one way that is known, in the order of layers and vertiports.
    pub(super) fn new(
        network: &'a TimeExpandedDay,
        pace: &'a Pace,
        centre: Prices,
        ways: Vec<(u32, Way)>,
    ) -> Self {
        let group = |(count, way)| Group {
            count: f64::from(count),
            ways: vec![Known { way, share: 1.0, idle: 0, worth: 0.0 }],
        };
        let mut master = Self {
            network,
            pace,
            groups: ways.into_iter().map(group).collect(),
            reach: 0.0,
            stand_excess: vec![0.0; centre.stand.len()],
            demand_excess: vec![0.0; centre.demand.len()],
            stand: centre.stand.iter().map(|&price| price as f64).collect(),
            demand: centre.demand.iter().map(|&price| price as f64).collect(),
            paid: vec![0.0; centre.stand.len() + network.size()],
            centre,
        };
        master.count();
        master
    }

    /// Counts what is wanted anew.
    fn count(&mut self) {
        let size = self.network.size();
        for (at, excess) in self.stand_excess.iter_mut().enumerate() {
            *excess = -f64::from(self.network.stands[at % size]);
        }
        for (excess, &waiting) in self.demand_excess.iter_mut().zip(&self.network.demand) {
            *excess = -f64::from(waiting);
        }
        for group in &self.groups {
            for known in group.ways.iter().filter(|known| known.share > 0.0) {
                let aircraft = group.count * known.share;
                for (slices, place) in known.way.stays() {
                    for slice in slices {
                        self.stand_excess[slice * size + place] += aircraft;
                    }
                }
                for &(cell, passengers) in &known.way.flights {
                    self.demand_excess[cell as usize] += aircraft * f64::from(passengers);
                }
            }
        }
    }

    /// How fast the bound would fall if what is wanted stayed the same, by the reach.
    pub(super) fn fall(&self) -> f64 {
        let size = self.network.size();
        let free = |excess: f64, price: i64, most: i64| {
            let stuck = if excess < 0.0 { price <= 0 } else { price >= most };
            if stuck { 0.0 } else { excess * excess }
        };
        let stands = self.stand_excess.iter().zip(&self.centre.stand).enumerate();
        let stands = stands.map(|(at, (&excess, &price))| {
            self.pace.of_stands(at / size) * free(excess, price, MOST_FOR_A_STAND)
        });
        let demand = self.demand_excess.iter().zip(&self.centre.demand).zip(&self.network.margin);
        let demand =
            demand.map(|((&excess, &price), &most)| PACE_OF_PASSENGERS * free(excess, price, most));
        stands.sum::<f64>() + demand.sum::<f64>()
    }

    /// From now on the model is around these prices.
    pub(super) fn move_to(&mut self, centre: &Prices) {
        self.centre.clone_from(centre);
    }

    /// One more way is known of each group, in the order of [`Master::new`].
    pub(super) fn learn(&mut self, ways: Vec<(u32, Way)>) {
        for (group, (_, way)) in self.groups.iter_mut().zip(ways) {
            if group.ways.iter().all(|known| known.way != way) {
                group.ways.push(Known { way, share: 0.0, idle: 0, worth: 0.0 });
            }
        }
    }

    fn stand_price(&self, at: usize) -> f64 {
        let moved =
            self.reach * self.pace.of_stands(at / self.network.size()) * self.stand_excess[at];
        (self.centre.stand[at] as f64 + moved).clamp(0.0, MOST_FOR_A_STAND as f64)
    }

    fn demand_price(&self, cell: usize) -> f64 {
        let moved = self.reach * PACE_OF_PASSENGERS * self.demand_excess[cell];
        (self.centre.demand[cell] as f64 + moved).clamp(0.0, self.network.margin[cell] as f64)
    }

    /// Shifts aircraft until shifts are worth no more than about `enough`, micro-dollars all together, or for so many rounds; what they
    /// are worth still.
    pub(super) fn settle(&mut self, rounds: u32, enough: f64) -> f64 {
        self.count();
        for at in 0..self.stand.len() {
            self.stand[at] = self.stand_price(at);
        }
        for place in 0..self.network.size() {
            self.pay(place, 0);
        }
        for cell in 0..self.demand.len() {
            self.demand[cell] = self.demand_price(cell);
        }
        let mut possible = f64::INFINITY;
        for _ in 0..rounds {
            possible = (0..self.groups.len()).map(|group| self.shift_group(group)).sum();
            if possible <= enough {
                break;
            }
        }
        for group in &mut self.groups {
            for known in &mut group.ways {
                known.idle = if known.share > 0.0 { 0 } else { known.idle + 1 };
            }
            group.ways.retain(|known| known.idle < FORGOTTEN);
        }
        possible
    }

    /// Sums the prices of a vertiport's stands up, from a slice on.
    fn pay(&mut self, place: usize, first: usize) {
        let size = self.network.size();
        let slices = self.stand.len() / size;
        let row = &mut self.paid[place * (slices + 1)..][..=slices];
        let mut paid = row[first];
        for (slice, until) in row[first + 1..].iter_mut().enumerate() {
            paid += self.stand[(first + slice) * size + place];
            *until = paid;
        }
    }

    /// What a way is worth at the model's prices.
    fn worth(&self, way: &Way) -> f64 {
        let row = self.stand.len() / self.network.size() + 1;
        let rents = way.stays().map(|(slices, place)| {
            self.paid[place * row + slices.end] - self.paid[place * row + slices.start]
        });
        let passengers =
            way.flights.iter().map(|&(cell, n)| self.demand[cell as usize] * f64::from(n));
        way.earnings - rents.sum::<f64>() - passengers.sum::<f64>()
    }

    /// Shifts aircraft of a group from bad ways to the best; what could be gained before, micro-dollars.
    fn shift_group(&mut self, group: usize) -> f64 {
        let count = self.groups[group].count;
        let mut known = std::mem::take(&mut self.groups[group].ways);
        let mut possible = 0.0;
        for shift in 0..SHIFTS {
            for known in &mut known {
                known.worth = self.worth(&known.way);
            }
            let best = (0..known.len()).max_by(|&a, &b| known[a].worth.total_cmp(&known[b].worth));
            let best = best.expect("a group has a way");
            let lost = |at: usize| known[at].share * (known[best].worth - known[at].worth);
            if shift == 0 {
                possible = count * (0..known.len()).map(lost).sum::<f64>();
            }
            let worst = (0..known.len()).max_by(|&a, &b| lost(a).total_cmp(&lost(b)));
            let worst = worst.expect("a group has a way");
            if lost(worst) <= 0.0 {
                break;
            }
            let share = self.shift_ways(&known[worst], &known[best], count);
            known[worst].share -= share;
            known[best].share += share;
        }
        self.groups[group].ways = known;
        possible
    }

    /// Shifts aircraft of a group of so many from one way to a better one, until both are worth about the same; the share of the
    /// group that was shifted.
    fn shift_ways(&mut self, worst: &Known, best: &Known, count: f64) -> f64 {
        let (from, to) = (&worst.way, &best.way);
        let gain = best.worth - worst.worth;
        let share = (gain / (count * self.resistance(from, to))).min(worst.share);
        self.shift(from, to, count * share);
        let left = self.worth(to) - self.worth(from);
        if left >= 0.0 {
            return share;
        }
        // Prices that were not free to move have become so: too many went.
        let back = share * left / (left - gain);
        self.shift(to, from, count * back);
        share - back
    }

    /// By how much one aircraft that leaves one way for another lowers what the shift is worth, by the prices that are free to move.
    fn resistance(&self, from: &Way, to: &Way) -> f64 {
        let size = self.network.size();
        let free = |price: f64, most: i64| f64::from(u8::from(price > 0.0 && price < most as f64));
        let mut resistance = 0.0;
        for (slices, leave, take) in from.apart(to) {
            for slice in slices {
                let stand = |place| free(self.stand[slice * size + place], MOST_FOR_A_STAND);
                resistance += self.pace.of_stands(slice) * (stand(leave) + stand(take));
            }
        }
        for &(cell, passengers) in from.flights.iter().chain(&to.flights) {
            let cell = cell as usize;
            let passenger = free(self.demand[cell], self.network.margin[cell]);
            resistance +=
                PACE_OF_PASSENGERS * passenger * f64::from(passengers) * f64::from(passengers);
        }
        self.reach * resistance.max(1e-3)
    }

    /// Some aircraft leave one way for another, and prices follow.
    fn shift(&mut self, from: &Way, to: &Way, aircraft: f64) {
        let size = self.network.size();
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
        for (way, change) in [(from, -aircraft), (to, aircraft)] {
            for &(cell, passengers) in &way.flights {
                self.demand_excess[cell as usize] += change * f64::from(passengers);
                self.demand[cell as usize] = self.demand_price(cell as usize);
            }
        }
    }

    /// The model's prices, in whole micro-dollars.
    pub(super) fn prices(&self, to: &mut Prices) {
        for (to, &price) in to.stand.iter_mut().zip(&self.stand) {
            *to = whole(price);
        }
        for (to, &price) in to.demand.iter_mut().zip(&self.demand) {
            *to = whole(price);
        }
    }

    /// What the model thinks that its prices prove, micro-dollars; never more than they do, but for rounding.
    pub(super) fn value(&self) -> f64 {
        let fleet = self.groups.iter().map(|group| {
            let worths = group.ways.iter().map(|known| self.worth(&known.way));
            group.count * worths.fold(f64::NEG_INFINITY, f64::max)
        });
        let stands = self.network.stands.iter().cycle().zip(&self.stand);
        let given_back = stands.chain(self.network.demand.iter().zip(&self.demand));
        fleet.sum::<f64>() + given_back.map(|(&n, price)| f64::from(n) * price).sum::<f64>()
    }
}
