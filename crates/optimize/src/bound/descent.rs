//! Good prices, found step by step: the volume algorithm.
//!
//! F. Barahona and R. Anbil, *The volume algorithm: producing primal solutions with a subgradient method*, Mathematical
//! Programming 87, 2000. At the best prices so far, every aircraft takes the way that is worth most to it; where more is
//! wanted than there is, the price rises, elsewhere it falls. Because all aircraft of a place want the same, what is wanted
//! is not taken at face value but as a running mean over the steps. Prices that prove a lower bound are the next to start
//! from; where that does not come for a while, steps get shorter.

use std::sync::atomic::{AtomicBool, Ordering};

use super::certificate::Certificate;
use super::network::Network;
use super::prices::{Excess, Prices};

/// Length of the first step, so that the bound would fall by this share of it if the excess stayed what it is.
const AIM: f64 = 0.02;
/// Steps get so much longer after each that succeeds, up to `LONGEST`, and so much shorter after many in a row that fail.
const LONGER: f64 = 1.05;
const LONGEST: f64 = 2.0;
const SHORTER: f64 = 0.7;
/// Shorter steps than this change nothing that anyone could see.
const SHORTEST: f64 = 1e-7;

/// Weight of a step in the running mean of a search with so many `steps`.
fn weight(steps: u32) -> f64 {
    (10.0 / f64::from(steps)).min(0.05)
}

/// Failures in a row after which the steps of a search with so many `steps` get shorter.
fn patience(steps: u32) -> u32 {
    (steps / 65).max(3)
}

/// The best prices found from `prices` on in so many steps; `certificate` stands at others afterwards. None if `stopped` is raised
/// meanwhile.
pub(super) fn descend(
    network: &Network,
    certificate: &mut Certificate,
    mut prices: Prices,
    steps: u32,
    stopped: &AtomicBool,
) -> Option<Prices> {
    let mut bound = certificate.evaluate(network, &prices);
    let mut excess = Excess::of_nobody(network);
    certificate.excess(network, &prices, &mut excess);
    let mut mean = excess.clone();
    let mut trial = prices.clone();
    let (mut factor, mut failures) = (1.0, 0);
    for _ in 0..steps {
        if stopped.load(Ordering::Relaxed) {
            return None;
        }
        let square = mean.movable_square(network, &prices);
        if square == 0.0 || factor < SHORTEST {
            break;
        }
        let step = factor * AIM * bound as f64 / square;
        prices.step(network, &mean, step, &mut trial);
        let proven = certificate.evaluate(network, &trial);
        certificate.excess(network, &trial, &mut excess);
        mean.approach(&excess, weight(steps));
        if proven < bound {
            bound = proven;
            std::mem::swap(&mut prices, &mut trial);
            failures = 0;
            factor = (factor * LONGER).min(LONGEST);
        } else {
            failures += 1;
            if failures == patience(steps) {
                failures = 0;
                factor *= SHORTER;
            }
        }
    }
    Some(prices)
}
