//! The surplus of passengers against a count of everything that they can buy.

use vertifleet_policy::draw;

use super::Market;
use super::buying::MOST_ENUMERATED;

/// Small numbers that differ for every seed and place.
struct Numbers {
    seed: u64,
    drawn: u32,
}

impl Numbers {
    fn below(&mut self, past: u64) -> u64 {
        self.drawn += 1;
        draw(self.seed, 7, self.drawn) % past
    }

    fn amount(&mut self, past: u64) -> i64 {
        i64::try_from(self.below(past)).expect("small")
    }
}

/// A market of one pair, and prices for its flights.
fn any_market(seed: u64, most_passengers: u64) -> (Market, Vec<i64>) {
    let mut numbers = Numbers { seed, drawn: 0 };
    let mut seats = vec![1 + u16::try_from(numbers.below(4)).expect("small")];
    if numbers.below(2) == 0 {
        seats.push(seats[0] + 1 + u16::try_from(numbers.below(3)).expect("small"));
    }
    let periods = 1 + usize::try_from(numbers.below(3)).expect("small");
    let number = |_| u32::try_from(numbers.below(most_passengers + 1)).expect("small");
    let passengers = (0..periods).map(number).collect();
    let waits = numbers.below(2) == 0;
    let margin = (0..periods).map(|_| numbers.amount(100)).collect();
    let mut market = Market {
        vertiports: 1,
        seats,
        waits,
        passengers,
        margin,
        is_offered: Vec::new(),
        choosing: Vec::new(),
    };
    let prices = periods * market.prices_a_cell();
    market.is_offered = (0..prices).map(|_| numbers.below(8) > 0).collect();
    let prices = (0..prices).map(|at| numbers.amount(1 + market.most(at).unsigned_abs())).collect();
    (market, prices)
}

/// The most that passengers from a period on can bring, by the number of flights of each price and
/// the number of passengers who wait for the period.
fn brought(market: &Market, flights: &[u32], period: usize, waiting: u32) -> i64 {
    let Some(&own) = market.passengers.get(period) else { return 0 };
    let classes = market.seats.len();
    let first = period * market.prices_a_cell();
    let seats = |from: usize| -> u32 {
        let flights = &flights[from..from + classes];
        flights.iter().zip(&market.seats).map(|(number, &seats)| number * u32::from(seats)).sum()
    };
    let early = seats(first);
    let late = if market.waits { seats(first + classes) } else { 0 };
    let mut best = i64::MIN;
    for waited in 0..=waiting.min(early) {
        for others in 0..=own.min(early + late - waited) {
            let next = if market.waits { own - others } else { 0 };
            let now = i64::from(waited + others) * market.margin[period];
            best = best.max(now + brought(market, flights, period + 1, next));
        }
    }
    best
}

/// The surplus that is found by trying all numbers of flights, unless they are too many.
fn tried(market: &Market, prices: &[i64]) -> Option<i64> {
    let enough = |at: usize| {
        let seats = u32::from(market.seats[at % market.seats.len()]);
        let cell = at / market.prices_a_cell();
        let before = if market.waits && cell > 0 { market.passengers[cell - 1] } else { 0 };
        if market.is_offered[at] { (market.passengers[cell] + before).div_ceil(seats) } else { 0 }
    };
    let most: Vec<u32> = (0..prices.len()).map(enough).collect();
    if most.iter().map(|&most| f64::from(most + 1)).product::<f64>() > 2_000.0 {
        return None;
    }
    let mut flights = vec![0; prices.len()];
    let mut best = i64::MIN;
    loop {
        let paid: i64 = flights.iter().zip(prices).map(|(&n, price)| i64::from(n) * price).sum();
        best = best.max(brought(market, &flights, 0, 0) - paid);
        let Some(at) = (0..flights.len()).find(|&at| flights[at] < most[at]) else {
            return Some(best);
        };
        flights[at] += 1;
        flights[..at].fill(0);
    }
}

#[test]
fn passengers_buy_what_leaves_them_the_most() {
    let mut compared = 0;
    for seed in 0..2_000 {
        let (market, prices) = any_market(seed, 5);
        let Some(tried) = tried(&market, &prices) else { continue };
        compared += 1;
        assert_eq!(market.surplus(&prices), i128::from(tried), "{market:?} at {prices:?}");
        // What they buy leaves them as much.
        for block in 0..market.blocks() {
            let (surplus, bought) = market.buy(block, &prices, None);
            let mut flights = vec![0; prices.len()];
            let mut paid = 0;
            for (at, number) in bought {
                let number =
                    (0..100).find(|&whole| f64::from(whole) == number).expect("whole flights");
                flights[at as usize] = number;
                paid += i64::from(number) * prices[at as usize];
            }
            if market.waits || market.passengers.len() == 1 {
                assert_eq!(surplus, i128::from(brought(&market, &flights, 0, 0) - paid));
            }
        }
    }
    assert!(compared > 1_000, "{compared} markets are small");
}

#[test]
fn one_more_passenger_is_worth_the_difference_of_two_markets() {
    for seed in 0..300 {
        let (market, prices) = any_market(seed, 9);
        for cell in 0..market.passengers.len() {
            let worth = market.worth_of_one_more(cell, &prices);
            let mut more = market.clone();
            more.passengers[cell] += 1;
            assert_eq!(more.surplus(&prices), market.surplus(&prices) + i128::from(worth));
        }
    }
}

#[test]
fn whole_flights_leave_no_more_than_fractions_of_flights() {
    for seed in 0..3_000 {
        let (market, prices) = any_market(seed, 30);
        let cells: Vec<usize> = (0..market.passengers.len()).collect();
        let of_blocks = if market.waits {
            vec![cells]
        } else {
            cells.into_iter().map(|cell| vec![cell]).collect()
        };
        for (block, cells) in of_blocks.iter().enumerate() {
            let passengers: Vec<u32> = cells.iter().map(|&cell| market.passengers[cell]).collect();
            let (whole, _) = market.buy(block, &prices, None);
            let (fractions, _) = market.buy_fractions(cells, &passengers, &prices);
            assert!(whole <= fractions, "{market:?} at {prices:?}: {whole}, {fractions}");
        }
    }
}

#[test]
fn very_many_passengers_of_flights_that_are_alike_buy_whole_ones_too() {
    let one = Market {
        vertiports: 1,
        seats: vec![4],
        waits: false,
        passengers: vec![4 * MOST_ENUMERATED + 2],
        margin: vec![10],
        is_offered: vec![true],
        choosing: Vec::new(),
    };
    // A seat is left on the last flight, which is bought for less than its two passengers bring.
    assert_eq!(one.worth_of_one_more(0, &[15]), 10);
    assert_eq!(one.worth_of_one_more(0, &[32]), 0);
}

#[test]
fn very_many_passengers_buy_fractions_of_flights() {
    let (mut market, prices) = (0..1_000)
        .map(|seed| any_market(seed, 5))
        .find(|(market, _)| market.waits && market.seats.len() == 2 && market.passengers.len() == 3)
        .expect("one of them");
    market.is_offered.fill(true);
    market.passengers.fill(MOST_ENUMERATED * 1_000_000);
    let (surplus, bought) = market.buy(0, &prices, None);
    assert!(surplus > 0 && !bought.is_empty());
}

#[test]
fn flights_that_are_added_are_priced_as_low_as_leaves_the_surplus() {
    let mut compared = 0;
    for seed in 0..500 {
        let (market, prices) = any_market(seed, 9);
        let mut more = market.clone();
        more.is_offered.fill(true);
        let found = market.prices_with_more_flights(&more, &prices);
        assert_eq!(more.surplus(&found), market.surplus(&prices));
        let mut added = (0..prices.len()).filter(|&at| !market.is_offered[at] && found[at] > 0);
        // The last that is added could not be a micro-dollar cheaper.
        if let Some(last) = added.next_back() {
            compared += 1;
            let mut lower = found.clone();
            lower[last] -= 1;
            assert!(more.surplus(&lower) > market.surplus(&prices), "{market:?} at {found:?}");
        }
        for at in (0..prices.len()).filter(|&at| market.is_offered[at]) {
            assert_eq!(found[at], prices[at]);
        }
    }
    assert!(compared > 100, "{compared} markets have flights to add");
}
