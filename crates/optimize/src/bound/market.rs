//! The market for flights: what passengers can bring beyond the prices of the flights that they
//! board.
//!
//! In the relaxation an aircraft sells its flights, each at a price that depends on the demand
//! period, the pair of vertiports and the number of seats. The passengers of the pair buy whole
//! flights, as many as leave them the most after they have paid: their *surplus*. Five passengers
//! cannot buy a flight and a quarter, so the surplus is computed over whole numbers of flights,
//! exactly. docs/src/concepts/bound.md has the proof.

mod buying;
#[cfg(test)]
mod tests;

use vertifleet_core::{Matrix, Scenario};

use super::money;

/// The flights that passengers of a day may board, and the passengers.
#[derive(Debug, Clone)]
pub(super) struct Market {
    vertiports: usize,
    /// The different numbers of seats of aircraft, in ascending order.
    seats: Vec<u16>,
    /// Whether passengers wait into the next period, so that flights early in a period are not
    /// those late in it.
    waits: bool,
    /// Passengers by period, from, to.
    passengers: Vec<u32>,
    /// The highest margin of a passenger, by period, from, to; micro-dollars, never negative.
    margin: Vec<i64>,
    /// Whether there is any such flight, in the order of prices.
    is_offered: Vec<bool>,
    /// The blocks in which passengers choose between flights with several prices.
    choosing: Vec<usize>,
}

/// The flights of a cell, which is a demand period and a pair of vertiports. Both parts have the
/// same prices if passengers do not wait into the next period.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Those that passengers of the period before may board, as long as they wait.
    Early,
    Late,
}

/// Flights that passengers buy: the position of their price, and their number.
pub(super) type Bought = Vec<(u32, f64)>;

/// The flights of one cell if all have the same number of seats and passengers do not wait.
#[derive(Debug, Clone, Copy)]
pub(super) struct Alike {
    /// Number of flights that leave full.
    pub(super) full: i64,
    /// The amount that a full flight brings, and that of the last flight if it does not leave full,
    /// or 0; micro-dollars.
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
            is_offered: Vec::new(),
            choosing: Vec::new(),
        };
        market.is_offered = vec![false; market.passengers.len() * market.prices_a_cell()];
        market
    }

    pub(super) fn prices_a_cell(&self) -> usize {
        self.seats.len() * if self.waits { 2 } else { 1 }
    }

    fn pairs(&self) -> usize {
        self.vertiports * self.vertiports
    }

    /// Number of prices.
    pub(super) fn prices(&self) -> usize {
        self.is_offered.len()
    }

    /// The position of the price of flights of a cell with this number of seats.
    pub(super) fn position(&self, cell: usize, part: Part, seats: u16) -> usize {
        let class = self.seats.partition_point(|&fewer| fewer < seats);
        self.first_of(cell, part) + class
    }

    fn first_of(&self, cell: usize, part: Part) -> usize {
        let late = if self.waits && part == Part::Late { self.seats.len() } else { 0 };
        cell * self.prices_a_cell() + late
    }

    /// Sets the passengers who are left, by cell. Prices that are now above the [most](Self::most)
    /// are no longer valid.
    pub(super) fn set_passengers(&mut self, left: Vec<u32>) {
        self.passengers = left;
    }

    /// Adds flights with this position of their price to those that are offered.
    pub(super) fn offer(&mut self, position: usize) {
        self.is_offered[position] = true;
    }

    /// The highest price of a flight: the most that its passengers can bring; micro-dollars.
    pub(super) fn most(&self, position: usize) -> i64 {
        if !self.is_offered[position] {
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

    /// The pace at which the price of a flight moves, in proportion to that of a flight with one
    /// seat.
    pub(super) fn pace(&self, position: usize) -> f64 {
        f64::from(self.seats[position % self.seats.len()]).powi(2)
    }

    /// Whether all flights of a cell have one price, so that cells have nothing to do with each
    /// other.
    pub(super) fn has_one_price_a_cell(&self) -> bool {
        self.prices_a_cell() == 1
    }

    /// The flights of the price at a position, if all flights of a cell have one price.
    pub(super) fn alike(&self, position: usize) -> Option<Alike> {
        self.has_one_price_a_cell().then(|| self.alike_for(position, self.passengers[position]))
    }

    /// The same if `passengers` want to fly.
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
        let offered = (0..self.prices()).filter(|&position| self.is_offered[position]);
        let alike = offered.filter_map(|position| Some((self.alike(position)?, prices[position])));
        alike.map(|(alike, price)| alike.surplus(price)).sum()
    }

    /// The highest margin of a passenger of a cell, micro-dollars.
    #[cfg(test)]
    pub(super) fn margin(&self, cell: usize) -> i64 {
        self.margin[cell]
    }

    /// Number of parts of the market that have nothing to do with each other: cells, or pairs where
    /// passengers wait.
    pub(super) fn blocks(&self) -> usize {
        if self.waits { self.pairs() } else { self.passengers.len() }
    }

    /// The blocks in which passengers choose between flights with several prices.
    pub(super) fn blocks_that_choose(&self) -> impl Iterator<Item = usize> {
        self.choosing.iter().copied()
    }

    /// Finds the blocks that choose, once all flights are offered. They stay the same when
    /// passengers are gone, because groups of the search are in their order.
    pub(super) fn find_choosing_blocks(&mut self) {
        let blocks = if self.has_one_price_a_cell() { 0 } else { self.blocks() };
        self.choosing = (0..blocks).filter(|&block| self.offers_any(block)).collect();
    }

    fn offers_any(&self, block: usize) -> bool {
        let prices = self.prices_a_cell();
        let mut positions =
            self.cells_of(block).flat_map(|cell| cell * prices..(cell + 1) * prices);
        positions.any(|at| self.most(at) > 0)
    }

    /// By how much one more passenger of a cell raises the surplus, micro-dollars.
    pub(super) fn worth_of_one_more(&self, cell: usize, prices: &[i64]) -> i64 {
        let block = self.block_of(cell);
        let (more, _) = self.buy(block, prices, Some(cell));
        let (now, _) = self.buy(block, prices, None);
        i64::try_from(more - now).expect("a passenger changes the surplus by a few flights")
    }

    /// The cells of a block, in the order of their periods.
    fn cells_of(&self, block: usize) -> impl Iterator<Item = usize> {
        let past = if self.waits { self.passengers.len() } else { block + 1 };
        (block..past).step_by(self.pairs())
    }

    fn block_of(&self, cell: usize) -> usize {
        if self.waits { cell % self.pairs() } else { cell }
    }

    /// These prices, and for the flights that only another market of the same passengers offers,
    /// the lowest prices at which its passengers have no more surplus than those of this one.
    pub(super) fn prices_with_more_flights(&self, more: &Self, prices: &[i64]) -> Vec<i64> {
        let mut known = self.clone();
        let mut prices = prices.to_vec();
        for position in (0..prices.len()).filter(|&at| more.is_offered[at] && !self.is_offered[at])
        {
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
}

impl Alike {
    /// The surplus at a price of a flight, micro-dollars.
    pub(super) fn surplus(self, price: i64) -> i128 {
        i128::from(self.full) * i128::from((self.brings - price).max(0))
            + i128::from((self.last_brings - price).max(0))
    }
}

/// The position of a price as 32 bits.
pub(super) fn compact(position: usize) -> u32 {
    u32::try_from(position).expect("the readers bound the cells of demand at 4,000,000")
}

/// The highest margin of a passenger, by period and pair. Carrying a passenger at a loss is never
/// better than carrying none.
fn margins(scenario: &Scenario) -> Vec<i64> {
    let costs = scenario.passenger_cost_usd.cells();
    let fares = (0..scenario.periods.len())
        .flat_map(|period| scenario.fare_usd.in_period(period).cells().iter().zip(costs));
    fares.map(|(fare, cost)| money::up(fare - cost).max(0)).collect()
}
