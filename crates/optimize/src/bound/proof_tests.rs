//! The proof's steps, checked on real days at arbitrary prices: what an aircraft pays and earns, and what is given back.

use std::sync::Arc;

use proptest::prelude::{ProptestConfig, any, prop_assert, proptest};
use vertifleet_core::{AircraftIx, DaySeed, Network as Days, Scenario, Time};
use vertifleet_policy::{Greedy, Lookahead, Policy, Priced, Random, draw, play};
use vertifleet_sim::{Simulation, Trace};

use super::certificate::Certificate;
use super::money;
use super::network::Network;
use super::prices::Prices;

/// A day of `paper`, cut short to `hours`, with fewer stands free and less demand, so that limits bind.
fn scarce_day(seed: u64, hours: u32) -> Arc<Scenario> {
    let network = Days::shipped("paper").expect("a shipped network");
    let mut day = network.draw(DaySeed::comparison(seed).expect("a seed")).into_day();
    day.operations.end = day.operations.start + hours * 3600 + 1_234;
    for (at, price) in day.energy_price_usd.iter_mut().enumerate() {
        *price = [0.2, 0.9, 0.05][at % 3];
    }
    for table in &mut day.demand {
        table.cells_mut().iter_mut().for_each(|passengers| *passengers /= 8);
    }
    Arc::new(day.check("scarce").expect("a day within the rules"))
}

fn traces(day: &Arc<Scenario>) -> Vec<Trace> {
    let policies: [&mut dyn Policy; 4] =
        [&mut Random::new(3), &mut Greedy, &mut Lookahead, &mut Priced::default()];
    let played = policies.into_iter().map(|policy| {
        let mut trace = Trace::default();
        let mut simulation = Simulation::new(Arc::clone(day));
        play(&mut simulation, policy, |row| trace.rows.push(*row)).expect("these always answer");
        trace
    });
    played.collect()
}

/// Prices with no meaning, within their limits.
fn any_prices(network: &Network, seed: u64) -> Prices {
    let zero = Prices::zero(network);
    let below = |at: usize, most: i64| {
        let part = draw(seed, 0, u32::try_from(at).expect("few prices")) % 1_000;
        i64::try_from(part).expect("small") * most / 1_000
    };
    let stand = (0..zero.stand.len()).map(|at| below(at, 20_000_000)).collect();
    let demand = network.margin.iter().enumerate().map(|(at, &most)| below(at, most)).collect();
    Prices::checked(network, stand, demand).expect("within their limits")
}

/// Where an aircraft stands or flies to at the end of each slice, by what it decided until then.
fn places(day: &Scenario, network: &Network, trace: &Trace, aircraft: AircraftIx) -> Vec<usize> {
    let at_end = |slice| {
        let end = Time::from_seconds(network.slices.last_s(slice));
        let mut decided =
            trace.rows.iter().filter(|row| row.aircraft == aircraft && row.time <= end);
        decided.next_back().map_or(day.aircraft[aircraft.at()].at, |row| row.to).at()
    };
    (0..network.slices.len()).map(at_end).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_real_day_takes_each_step_of_the_proof(seed in 0_u64..1_000, minutes in 1_u32..60, hours in 1_u32..5, mix in any::<u64>()) {
        let day = scarce_day(seed, hours);
        let network = Network::of(&day, 60 * minutes).expect("a small day");
        let prices = any_prices(&network, mix);
        let mut certificate = Certificate::new(&network);
        let bound = certificate.evaluate(&network, &prices);
        for trace in traces(&day) {
            let mut taken = vec![0; prices.stand.len()];
            let mut carried = vec![0; prices.demand.len()];
            let mut profit = 0;
            for aircraft in AircraftIx::all(day.aircraft.len()) {
                let mut left = 0;
                for (slice, place) in places(&day, &network, &trace, aircraft).into_iter().enumerate() {
                    taken[slice * network.size() + place] += 1;
                    left -= prices.stand[slice * network.size() + place];
                }
                for row in trace.rows.iter().filter(|row| row.aircraft == aircraft && row.to != row.from) {
                    let period = day.period_at(row.time);
                    let cell = (period * network.size() + row.from.at()) * network.size() + row.to.at();
                    carried[cell] += u32::from(row.passengers);
                    // Rounded down: the proof must not need the rounding of the amounts of a real day.
                    let earned = money::down(row.profit_usd());
                    profit += i128::from(earned);
                    left += earned - i64::from(row.passengers) * prices.demand[cell];
                }
                // An aircraft does no better than the longest path.
                let start = day.aircraft[aircraft.at()].at.at();
                prop_assert!(left <= certificate.worth(&network, 0, start, 0));
            }
            // What is paid is no more than what is given back.
            for (at, &count) in taken.iter().enumerate() {
                prop_assert!(count <= network.stands[at % network.size()]);
            }
            for (&count, &waiting) in carried.iter().zip(&network.demand) {
                prop_assert!(count <= waiting);
            }
            prop_assert!(profit <= bound);
        }
    }
}
