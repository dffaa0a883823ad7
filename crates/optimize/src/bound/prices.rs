//! Prices of what is scarce: a stand when a slice ends, and the right to carry a passenger.
//!
//! Any prices within the limits that this file keeps to prove a bound (`certificate.rs`); good ones prove a tight one.

use super::network::Network;

/// The most that a stand may cost in a slice, micro-dollars. It keeps every sum of `certificate.rs` within `i64`.
const MOST_FOR_A_STAND: i64 = 100_000_000_000_000;

/// Prices in whole micro-dollars.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Prices {
    /// What an aircraft pays for its stand when a slice ends, by slice, then vertiport.
    pub(super) stand: Vec<i64>,
    /// What the right to carry a passenger costs, by period, from, to; no more than the passenger earns.
    pub(super) demand: Vec<i64>,
}

impl Prices {
    /// Everything for nothing.
    pub(super) fn zero(network: &Network) -> Self {
        Self {
            stand: vec![0; network.slices.len() * network.size()],
            demand: vec![0; network.demand.len()],
        }
    }

    /// Prices that somebody kept, if they are prices for this network.
    pub(super) fn checked(network: &Network, stand: Vec<i64>, demand: Vec<i64>) -> Option<Self> {
        let lengths = stand.len() == network.slices.len() * network.size()
            && demand.len() == network.demand.len();
        let within = stand.iter().all(|price| (0..=MOST_FOR_A_STAND).contains(price))
            && demand
                .iter()
                .zip(&network.margin)
                .all(|(price, margin)| (0..=*margin).contains(price));
        (lengths && within).then_some(Self { stand, demand })
    }

    /// The prices of a step from `self`: each goes up by `step` times what is wanted too much of it, down by what is wanted
    /// too little, and stays within its limits.
    pub(super) fn step(&self, network: &Network, excess: &Excess, step: f64, to: &mut Self) {
        let moved =
            |price: i64, excess: f64, most: i64| whole(price as f64 + step * excess).clamp(0, most);
        for ((to, &from), &excess) in to.stand.iter_mut().zip(&self.stand).zip(&excess.stand) {
            *to = moved(from, excess, MOST_FOR_A_STAND);
        }
        let demand = to.demand.iter_mut().zip(&self.demand).zip(&excess.demand);
        for (((to, &from), &excess), &margin) in demand.zip(&network.margin) {
            *to = moved(from, excess, margin);
        }
    }
}

/// How much more of everything is wanted than there is; less than 0 where some is left. In the order of [`Prices`].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Excess {
    pub(super) stand: Vec<f64>,
    pub(super) demand: Vec<f64>,
}

impl Excess {
    /// All there is is left.
    pub(super) fn of_nobody(network: &Network) -> Self {
        let stands = network.stands.iter().cycle().take(network.slices.len() * network.size());
        let all = |count: &u32| -f64::from(*count);
        Self { stand: stands.map(all).collect(), demand: network.demand.iter().map(all).collect() }
    }

    /// Moves each entry a part of the way towards another's.
    pub(super) fn approach(&mut self, other: &Self, part: f64) {
        let entries = self.stand.iter_mut().zip(&other.stand);
        for (mean, entry) in entries.chain(self.demand.iter_mut().zip(&other.demand)) {
            *mean += part * (entry - *mean);
        }
    }

    /// The squares, summed over the prices that may still move the way their excess points.
    pub(super) fn movable_square(&self, network: &Network, prices: &Prices) -> f64 {
        let stands = self.stand.iter().zip(&prices.stand).map(|(e, p)| (e, p, &MOST_FOR_A_STAND));
        let demand = self.demand.iter().zip(&prices.demand).zip(&network.margin);
        let demand = demand.map(|((e, p), most)| (e, p, most));
        stands
            .chain(demand)
            .filter(|&(&excess, &price, &most)| if excess < 0.0 { price > 0 } else { price < most })
            .map(|(excess, ..)| excess * excess)
            .sum()
    }
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates, and limits follow")]
fn whole(micro: f64) -> i64 {
    micro.round() as i64
}
