//! The market for flights: what passengers can bring beyond the prices of the flights that they board.
//!
//! In the relaxation an aircraft sells its flights, each at a price that depends on the demand period, the pair of vertiports
//! and the number of seats. The passengers of the pair buy whole flights, as many as leave them the most after they have
//! paid: their *surplus*. Five passengers cannot buy a flight and a quarter, so the surplus is worked out over whole numbers
//! of flights, exactly. docs/src/concepts/bound.md has the proof.

#[cfg(test)]
mod tests;

use vertifleet_core::{Matrix, Scenario};

use super::money;

/// The most passengers of a cell for whom flights of several sizes are counted out, and of two periods together where
/// passengers wait. More fill so many flights that fractions of flights make no difference.
const MOST_COUNTED: u32 = 1_000;
/// The price of what cannot be bought. The sum of a few of them is in `i64`.
const UNAFFORDABLE: i64 = i64::MAX / 8;

/// The flights that passengers of a day may board, and the passengers.
#[derive(Debug, Clone)]
pub(super) struct Market {
    vertiports: usize,
    /// The different numbers of seats of aircraft, in ascending order.
    seats: Vec<u16>,
    /// Whether passengers wait into the next period, so that flights early in a period are not those late in it.
    waits: bool,
    /// Passengers by period, from, to.
    passengers: Vec<u32>,
    /// The highest margin of a passenger, by period, from, to; micro-dollars, never negative.
    margin: Vec<i64>,
    /// Whether there is any such flight, in the order of prices.
    is_flown: Vec<bool>,
}

/// The flights of a cell, which is a demand period and a pair of vertiports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Those that passengers of the period before may board; all flights where nobody waits.
    Early,
    Late,
}

/// Flights that passengers buy: the position of their price, and their number.
pub(super) type Bought = Vec<(u32, u32)>;

/// The flights of one cell where all have the same number of seats and nobody waits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Alike {
    /// Number of flights that leave full.
    pub(super) full: i64,
    /// What a full flight brings, and what the last flight brings that does not leave full, or 0 without one;
    /// micro-dollars.
    pub(super) brings: i64,
    pub(super) last_brings: i64,
}

impl Market {
    /// The market of a day, in which no flight is offered yet.
    pub(super) fn of(scenario: &Scenario) -> Self {
        let mut seats: Vec<u16> = scenario.aircraft_types.iter().map(|kind| kind.seats).collect();
        seats.sort_unstable();
        seats.dedup();
        let mut market = Self {
            vertiports: scenario.vertiports.len(),
            seats,
            waits: scenario.operations.passenger_wait_s > 0,
            passengers: scenario.demand.iter().flat_map(Matrix::cells).copied().collect(),
            margin: margins(scenario),
            is_flown: Vec::new(),
        };
        market.is_flown = vec![false; market.passengers.len() * market.prices_a_cell()];
        market
    }

    fn prices_a_cell(&self) -> usize {
        self.seats.len() * if self.waits { 2 } else { 1 }
    }

    fn pairs(&self) -> usize {
        self.vertiports * self.vertiports
    }

    /// Number of prices.
    pub(super) fn prices(&self) -> usize {
        self.is_flown.len()
    }

    /// The position of the price of flights of a cell with so many seats.
    pub(super) fn position(&self, cell: usize, part: Part, seats: u16) -> usize {
        let class = self.seats.partition_point(|&fewer| fewer < seats);
        self.first_of(cell, part) + class
    }

    fn first_of(&self, cell: usize, part: Part) -> usize {
        let late = if self.waits && part == Part::Late { self.seats.len() } else { 0 };
        cell * self.prices_a_cell() + late
    }

    /// Adds flights with this position of their price to those that are offered.
    pub(super) fn offer(&mut self, position: usize) {
        self.is_flown[position] = true;
    }

    /// The price at which nobody buys flights, which is what a flight may bring at most; micro-dollars.
    pub(super) fn most(&self, position: usize) -> i64 {
        if !self.is_flown[position] {
            return 0;
        }
        let cell = position / self.prices_a_cell();
        let (offset, class) = (position % self.prices_a_cell(), position % self.seats.len());
        let is_early = self.waits && offset == class;
        let waiting = cell.checked_sub(self.pairs()).filter(|_| is_early);
        let waiting = waiting.map_or(0, |cell| self.passengers[cell]);
        let boarding = self.passengers[cell].saturating_add(waiting);
        i64::from(boarding.min(self.seats[class].into())) * self.margin[cell]
    }

    /// The pace at which the price of a flight moves, in proportion to that of the price of a passenger.
    pub(super) fn pace(&self, position: usize) -> f64 {
        f64::from(self.seats[position % self.seats.len()]).powi(2)
    }

    /// Whether all flights of a cell have one price, so that cells have nothing to do with each other.
    pub(super) fn has_one_price_a_cell(&self) -> bool {
        self.prices_a_cell() == 1
    }

    /// The flights of the price at a position, if all flights of a cell have one price.
    pub(super) fn alike(&self, position: usize) -> Option<Alike> {
        self.has_one_price_a_cell().then(|| self.alike_for(position, self.passengers[position]))
    }

    /// The same if so many passengers want to fly.
    fn alike_for(&self, cell: usize, passengers: u32) -> Alike {
        let (seats, margin) = (u32::from(self.seats[0]), self.margin[cell]);
        Alike {
            full: (passengers / seats).into(),
            brings: i64::from(seats) * margin,
            last_brings: i64::from(passengers % seats) * margin,
        }
    }

    /// The surplus of all passengers at these prices of flights, micro-dollars.
    pub(super) fn surplus(&self, prices: &[i64]) -> i128 {
        if !self.has_one_price_a_cell() {
            return (0..self.blocks()).map(|block| self.buy(block, prices, None).0).sum();
        }
        let offered = (0..self.prices()).filter(|&position| self.is_flown[position]);
        let alike = offered.filter_map(|position| Some((self.alike(position)?, prices[position])));
        alike.map(|(alike, price)| alike.surplus(price)).sum()
    }

    /// The highest margin of a passenger of a cell, micro-dollars.
    #[cfg(test)]
    pub(super) fn margin(&self, cell: usize) -> i64 {
        self.margin[cell]
    }

    /// Number of parts of the market that have nothing to do with each other: cells, or pairs where passengers wait.
    pub(super) fn blocks(&self) -> usize {
        if self.waits { self.pairs() } else { self.passengers.len() }
    }

    /// By how much one more passenger of a cell raises the surplus, micro-dollars.
    pub(super) fn worth_of_one_more(&self, cell: usize, prices: &[i64]) -> i64 {
        let block = self.block_of(cell);
        let (more, _) = self.buy(block, prices, Some(cell));
        let (now, _) = self.buy(block, prices, None);
        i64::try_from(more - now).expect("a passenger brings no more than the highest margin")
    }

    fn block_of(&self, cell: usize) -> usize {
        if self.waits { cell % self.pairs() } else { cell }
    }

    /// These prices, and for the flights that only another market of the same passengers offers, the lowest prices at which
    /// its passengers have no more surplus than those of this one.
    pub(super) fn prices_with_more_flights(&self, more: &Self, prices: &[i64]) -> Vec<i64> {
        let mut known = self.clone();
        let mut prices = prices.to_vec();
        for position in (0..prices.len()).filter(|&at| more.is_flown[at] && !self.is_flown[at]) {
            let block = self.block_of(position / self.prices_a_cell());
            let (surplus, _) = known.buy(block, &prices, None);
            known.offer(position);
            let (mut least, mut most) = (0, known.most(position));
            while least < most {
                prices[position] = least + (most - least) / 2;
                if known.buy(block, &prices, None).0 > surplus {
                    least = prices[position] + 1;
                } else {
                    most = prices[position];
                }
            }
            prices[position] = most;
        }
        prices
    }

    /// The surplus of a block, if `one_more` passenger of a cell wants to fly, and the flights that are bought for it.
    pub(super) fn buy(
        &self,
        block: usize,
        prices: &[i64],
        one_more: Option<usize>,
    ) -> (i128, Bought) {
        let periods = self.passengers.len() / self.pairs();
        let cells: Vec<usize> = if self.waits {
            (0..periods).map(|period| period * self.pairs() + block).collect()
        } else {
            vec![block]
        };
        let passengers: Vec<u32> = cells
            .iter()
            .map(|&cell| self.passengers[cell].saturating_add((one_more == Some(cell)).into()))
            .collect();
        if self.has_one_price_a_cell() {
            return self.buy_alike(block, passengers[0], prices[block]);
        }
        let longest = passengers.windows(2).map(|two| two[0].saturating_add(two[1])).max();
        if longest.unwrap_or(passengers[0]) > MOST_COUNTED {
            return self.buy_fractions(&cells, &passengers, prices);
        }
        let (mut seen, mut after) = (Vec::with_capacity(cells.len()), vec![0; 1]);
        for period in (0..cells.len()).rev() {
            let before = if period > 0 { passengers[period - 1] } else { 0 };
            let own = passengers[period];
            after.resize(own as usize + 1, 0);
            let counted = self.count_out(cells[period], (before, own), &after, prices);
            after.clone_from(&counted.surplus);
            seen.push(counted);
        }
        seen.reverse();
        let surplus = i128::from(after[0]);
        let (mut bought, mut waiting) = (Bought::new(), 0);
        for counted in &seen {
            let choice = counted.choices[waiting];
            counted.early.flights_for(choice.early_seats, &mut bought);
            counted.late.flights_for(choice.boarding() - choice.early_seats, &mut bought);
            waiting = choice.left;
        }
        (surplus, bought)
    }

    /// The surplus of a cell whose flights all have one price, and the flights that are bought.
    fn buy_alike(&self, cell: usize, passengers: u32, price: i64) -> (i128, Bought) {
        if !self.is_flown[cell] {
            return (0, Bought::new());
        }
        let alike = self.alike_for(cell, passengers);
        let full = if price <= alike.brings { passengers / u32::from(self.seats[0]) } else { 0 };
        let last = u32::from(price < alike.last_brings);
        (alike.surplus(price), vec![(index(cell), full + last)])
    }

    /// The best that passengers of a cell can do, by the number of those who have waited for it. `after` is the surplus of
    /// later periods by the number who wait for the next.
    fn count_out(
        &self,
        cell: usize,
        (before, own): (u32, u32),
        after: &[i64],
        prices: &[i64],
    ) -> Counted {
        let (before, own) = (before as usize, own as usize);
        let early = self.offers(cell, Part::Early, before + own, prices);
        let late_seats = if self.waits { own } else { 0 };
        let late = self.offers(cell, Part::Late, late_seats, prices);
        let margin = self.margin[cell];
        let nobody = (i64::MIN, Choice::default());
        let mut best = vec![nobody; before + 1];
        for boarding in 0..=before + own {
            // At least as many seats are bought early as passengers board who have waited.
            let (mut cost, mut bought) = (UNAFFORDABLE, 0);
            let least = (boarding + 1).saturating_sub(late.cost.len());
            let mut looked_at = boarding + 1;
            for waited in (0..=before.min(boarding)).rev() {
                while looked_at > waited.max(least) {
                    looked_at -= 1;
                    let both = early.cost[looked_at] + late.cost[boarding - looked_at];
                    if both < cost {
                        (cost, bought) = (both, looked_at);
                    }
                }
                let others = boarding - waited;
                if others <= own && cost < UNAFFORDABLE {
                    let left = own - others;
                    let brings = i64::try_from(boarding).expect("they are counted") * margin;
                    let surplus = brings - cost + after[left];
                    if surplus > best[waited].0 {
                        best[waited] =
                            (surplus, Choice { waited, others, early_seats: bought, left });
                    }
                }
            }
        }
        // Nobody has to board who has waited.
        for waited in 1..=before {
            if best[waited].0 <= best[waited - 1].0 {
                best[waited] = best[waited - 1];
            }
        }
        let (surplus, choices) = best.into_iter().unzip();
        Counted { surplus, choices, early, late }
    }

    /// The cheapest flights of a cell for any number of seats.
    fn offers(&self, cell: usize, part: Part, seats: usize, prices: &[i64]) -> Offers {
        let first = self.first_of(cell, part);
        let positions = first..first + self.seats.len();
        let offered = positions.filter(|&position| self.is_flown[position]);
        let flights: Vec<(u32, usize, i64)> = offered
            .map(|position| {
                let seats = self.seats[position - first].into();
                (index(position), seats, prices[position])
            })
            .collect();
        let mut cost = Vec::with_capacity(seats + 1);
        cost.push(0);
        for seats in 1..=seats {
            let with = |&(_, of_flight, price): &(u32, usize, i64)| {
                price + cost[seats.saturating_sub(of_flight)]
            };
            cost.push(flights.iter().map(with).min().unwrap_or(UNAFFORDABLE));
        }
        Offers { flights, cost }
    }

    /// The surplus if every passenger may buy a seat for a fraction of the price of a flight, which is no less than that of
    /// whole flights.
    fn buy_fractions(&self, cells: &[usize], passengers: &[u32], prices: &[i64]) -> (i128, Bought) {
        let (mut surplus, mut bought) = (0, Bought::new());
        for (period, (&cell, &passengers)) in cells.iter().zip(passengers).enumerate() {
            let next = cells.get(period + 1).map(|&cell| (cell, Part::Early));
            let parts = [Some((cell, Part::Early)), Some((cell, Part::Late)), next];
            let mut best = (0, None);
            for (cell, part) in parts.into_iter().flatten() {
                for (class, &seats) in self.seats.iter().enumerate() {
                    let position = self.first_of(cell, part) + class;
                    if self.is_flown[position] {
                        let brings = i64::from(seats) * self.margin[cell] - prices[position];
                        let all = i128::from(brings) * i128::from(passengers);
                        let all = (all + i128::from(seats) - 1).div_euclid(i128::from(seats));
                        if all > best.0 {
                            best = (all, Some((position, seats)));
                        }
                    }
                }
            }
            surplus += best.0;
            if let Some((position, seats)) = best.1 {
                bought.push((index(position), passengers / u32::from(seats)));
            }
        }
        (surplus, bought)
    }
}

/// The position of a price in less memory.
pub(super) fn index(position: usize) -> u32 {
    u32::try_from(position).expect("the readers bound the cells of demand at 4,000,000")
}

impl Alike {
    /// The surplus at a price of a flight, micro-dollars.
    pub(super) fn surplus(self, price: i64) -> i128 {
        i128::from(self.full) * i128::from((self.brings - price).max(0))
            + i128::from((self.last_brings - price).max(0))
    }
}

/// The cheapest flights for any number of seats.
struct Offers {
    /// The position of the price, the seats and the price of each size of flights.
    flights: Vec<(u32, usize, i64)>,
    /// By seats, micro-dollars.
    cost: Vec<i64>,
}

impl Offers {
    /// Adds the cheapest flights with so many seats or more.
    fn flights_for(&self, mut seats: usize, bought: &mut Bought) {
        while seats > 0 {
            let cheapest = self.flights.iter().find(|&&(_, of_flight, price)| {
                self.cost[seats] == price + self.cost[seats.saturating_sub(of_flight)]
            });
            let &(position, of_flight, _) = cheapest.expect("these seats can be bought");
            match bought.iter_mut().find(|(other, _)| *other == position) {
                Some((_, number)) => *number += 1,
                None => bought.push((position, 1)),
            }
            seats = seats.saturating_sub(of_flight);
        }
    }
}

/// What passengers of a cell do.
#[derive(Debug, Clone, Copy, Default)]
struct Choice {
    /// Those who board and have waited, and the others who board.
    waited: usize,
    others: usize,
    /// The seats that are bought early in the period. The rest is bought late.
    early_seats: usize,
    /// Those who wait for the next period.
    left: usize,
}

impl Choice {
    fn boarding(self) -> usize {
        self.waited + self.others
    }
}

/// The best of a cell and of all later ones, by the number who have waited for it.
struct Counted {
    surplus: Vec<i64>,
    choices: Vec<Choice>,
    early: Offers,
    late: Offers,
}

/// The highest margin of a passenger, by period and pair. Carrying a passenger at a loss is never better than carrying
/// none.
fn margins(scenario: &Scenario) -> Vec<i64> {
    let costs = scenario.passenger_cost_usd.cells();
    let fares = (0..scenario.periods.len())
        .flat_map(|period| scenario.fare_usd.in_period(period).cells().iter().zip(costs));
    fares.map(|(fare, cost)| money::up(fare - cost).max(0)).collect()
}
