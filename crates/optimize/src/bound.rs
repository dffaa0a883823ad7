//! The certified upper bound: what no schedule of a day can earn more than.
//!
//! Stands and passengers get prices (`bound/prices.rs`). Prices prove a bound in exact arithmetic, whatever they are
//! (`bound/certificate.rs`), over a day that is laid out once (`bound/network.rs`); a search finds prices that prove a good
//! one (`bound/descent.rs`). docs/src/concepts/bound.md has the proof. A bound can be kept in a file (`bound/cache.rs`).

mod cache;
mod certificate;
mod descent;
mod money;
mod network;
mod prices;
#[cfg(test)]
mod proof_tests;
mod slices;

use std::sync::atomic::AtomicBool;

use vertifleet_core::{Scenario, Time, TypeIx, VertiportIx};

use crate::Error;
use certificate::Certificate;
use descent::descend;
use network::Network;
use prices::Prices;

pub use cache::cached_upper_bound;

/// How long prices stay the same: a whole number of minutes from 1 to 60. Shorter steps give a tighter bound, later.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    minutes: u32,
}

impl Step {
    /// Prices that stay the same for so many minutes.
    ///
    /// # Errors
    /// [`Error::Step`] unless `minutes` is from 1 to 60.
    pub fn from_minutes(minutes: u32) -> Result<Self, Error> {
        if (1..=60).contains(&minutes) {
            Ok(Self { minutes })
        } else {
            Err(Error::Step { found: minutes })
        }
    }

    /// The same in seconds.
    pub fn seconds(self) -> u32 {
        60 * self.minutes
    }

    /// Steps of the search for prices: more prices take more of them.
    fn effort(self) -> u32 {
        (2_000 / self.minutes).max(200)
    }
}

impl Default for Step {
    /// 5 minutes.
    fn default() -> Self {
        Self { minutes: 5 }
    }
}

/// A proven bound, and the prices that prove it.
#[derive(Debug, Clone)]
pub struct Bound {
    step: Step,
    network: Network,
    prices: Prices,
    certificate: Certificate,
    micro_usd: i128,
}

/// Proves how much a day can earn at most. Same scenario and step, same bound, bit for bit.
///
/// # Errors
/// [`Error::TooManyFlights`] if the day is too large for this step.
pub fn upper_bound(scenario: &Scenario, step: Step) -> Result<Bound, Error> {
    let never = AtomicBool::new(false);
    Ok(upper_bound_unless(&never, scenario, step)?.expect("nobody stops it"))
}

/// As [`upper_bound`]; nothing, soon after `stopped` is raised.
///
/// # Errors
/// Those of [`upper_bound`].
pub fn upper_bound_unless(
    stopped: &AtomicBool,
    scenario: &Scenario,
    step: Step,
) -> Result<Option<Bound>, Error> {
    let network = Network::of(scenario, step.seconds())?;
    let mut certificate = Certificate::new(&network);
    let zero = Prices::zero(&network);
    let prices = descend(&network, &mut certificate, zero, step.effort(), stopped);
    Ok(prices.map(|prices| Bound::proven(step, network, certificate, prices)))
}

impl Bound {
    /// What `prices` prove.
    fn proven(step: Step, network: Network, mut certificate: Certificate, prices: Prices) -> Self {
        let micro_usd = certificate.evaluate(&network, &prices);
        Self { step, network, prices, certificate, micro_usd }
    }

    /// No schedule of the day earns more, dollars.
    pub fn upper_bound_usd(&self) -> f64 {
        money::usd_up(self.micro_usd)
    }

    /// How long prices stay the same at most, seconds.
    pub fn step_s(&self) -> u32 {
        self.step.seconds()
    }

    /// What an aircraft of a type that is ready at a vertiport may still earn at most, after it has paid for stands and
    /// passengers at the bound's prices; dollars, to the second. 0 past the last take-off time.
    ///
    /// `None` for a type that has no aircraft.
    pub fn worth_usd(&self, kind: TypeIx, vertiport: VertiportIx, time: Time) -> Option<f64> {
        let layer = self.network.layers.iter().position(|layer| layer.kind == kind)?;
        let second = time.seconds().saturating_sub(self.network.slices.start_s(0));
        let worth = self.certificate.worth(&self.network, layer, vertiport.at(), second as usize);
        Some(money::usd(worth))
    }

    /// What one more stand is worth during the step that contains a time, dollars. 0 past the last take-off time.
    pub fn stand_price_usd(&self, vertiport: VertiportIx, time: Time) -> f64 {
        let slice = self.network.slices.containing(time.seconds());
        let at = slice * self.network.size() + vertiport.at();
        self.prices.stand.get(at).map_or(0.0, |&price| money::usd(price))
    }

    /// What one more stand is worth all day, dollars.
    pub fn stand_worth_usd(&self, vertiport: VertiportIx) -> f64 {
        let prices = self.prices.stand.iter().skip(vertiport.at());
        money::usd(prices.step_by(self.network.size()).sum())
    }

    /// What one more passenger of a demand period is worth, dollars.
    pub fn passenger_worth_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        let size = self.network.size();
        money::usd(self.prices.demand[(period * size + from.at()) * size + to.at()])
    }
}
