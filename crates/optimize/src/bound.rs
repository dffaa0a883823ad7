//! The certified upper bound: dollars that no schedule of a day earns more than.
//!
//! Stands and passengers get prices (`bound/prices.rs`). Any prices prove a bound in exact arithmetic
//! (`bound/certificate.rs`), over a day that is laid out once (`bound/time_expanded_day.rs`). What the fleet would do
//! at the prices (`bound/ways.rs`) shows how to improve them (`bound/descent.rs`), from coarse slices of time to fine
//! ones (`bound/ladder.rs`). docs/src/concepts/bound.md has the proof. The prices of a bound can be kept in a file
//! (`bound/cache.rs`).

mod cache;
mod certificate;
mod descent;
mod ladder;
mod master;
mod money;
mod prices;
#[cfg(test)]
mod proof_tests;
mod slices;
mod time_expanded_day;
mod ways;

use vertifleet_core::{Scenario, Stop, VertiportIx};

use crate::Error;
use descent::Found;
use prices::Prices;
use slices::Slices;
use time_expanded_day::TimeExpandedDay;

pub use cache::cached_upper_bound;
pub(crate) use ladder::Watch;

/// The longest time over which prices stay the same: a whole number of minutes from 1 to 60. A shorter step never gives
/// a looser bound, and takes longer.
///
/// Slices of time have 60, 15, 5, 3 or 1 minutes: the longest of these that is no longer than the requested step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    minutes: u32,
}

impl Step {
    /// A step in which prices stay the same for at most `minutes`.
    ///
    /// # Errors
    /// [`Error::Step`] unless `minutes` is from 1 to 60.
    pub fn from_minutes(minutes: u32) -> Result<Self, Error> {
        if (1..=60).contains(&minutes) {
            Ok(Self { minutes: ladder::cut_within(minutes) })
        } else {
            Err(Error::Step { found: minutes })
        }
    }

    /// The length of the slices, seconds.
    pub fn seconds(self) -> u32 {
        60 * self.minutes
    }
}

impl Default for Step {
    /// A step of 5 minutes.
    fn default() -> Self {
        Self { minutes: 5 }
    }
}

/// A proven bound, and the prices that prove it.
#[derive(Debug, Clone)]
pub struct Bound {
    step: Step,
    slices: Slices,
    prices: Prices,
    /// By period, from, to: the most that one more passenger is worth, micro-dollars.
    passenger_shadow_price_usd: Vec<i64>,
    micro_usd: i128,
    is_final: bool,
}

/// Proves an upper bound of a day. The same scenario and step give the same bound, bit for bit.
///
/// # Errors
/// [`Error::TooManyFlights`] if the day is too large for this step.
pub fn upper_bound(scenario: &Scenario, step: Step) -> Result<Bound, Error> {
    let never = Stop::default();
    Ok(upper_bound_unless(&never, scenario, step)?.expect("it is not stopped"))
}

/// Does the same as [`upper_bound`], or returns `None` soon after `stopped` is requested.
///
/// # Errors
/// The errors of [`upper_bound`].
pub fn upper_bound_unless(
    stopped: &Stop,
    scenario: &Scenario,
    step: Step,
) -> Result<Option<Bound>, Error> {
    let bound = search(scenario, step, &Unless { stopped })?;
    Ok(bound.filter(|_| !stopped.is_requested()))
}

/// Does the same as [`upper_bound`] while `watch` follows it. Returns the best bound when `watch` stops the search, or
/// `None` if that is before the first bound.
///
/// # Errors
/// The errors of [`upper_bound`].
pub(crate) fn search(
    scenario: &Scenario,
    step: Step,
    watch: &dyn Watch,
) -> Result<Option<Bound>, Error> {
    ladder::climb(scenario, step, watch)
}

/// Checks that a day is not too large for a bound with this step.
///
/// # Errors
/// [`Error::TooManyFlights`] if the day is too large.
pub(crate) fn fits(scenario: &Scenario, step: Step) -> Result<(), Error> {
    TimeExpandedDay::fits(scenario, step.seconds())
}

/// Ignores all progress, and only passes a request to stop on.
struct Unless<'a> {
    stopped: &'a Stop,
}

impl Watch for Unless<'_> {
    fn stopped(&self) -> &Stop {
        self.stopped
    }

    fn has_come(&self, _: f64) {}

    fn has_found(&self, _: &Bound) {}

    fn is_lowest(&self, _: f64) -> bool {
        false
    }
}

impl Bound {
    /// The bound that the found prices prove.
    fn of(step: Step, day: &TimeExpandedDay, found: &Found) -> Self {
        Self {
            step,
            slices: day.slices.clone(),
            passenger_shadow_price_usd: day.passenger_shadow_prices(&found.prices),
            prices: found.prices.clone(),
            micro_usd: found.bound(day),
            is_final: false,
        }
    }

    /// The bound: no schedule of the day earns more, dollars.
    pub fn upper_bound_usd(&self) -> f64 {
        money::usd_up(self.micro_usd)
    }

    /// Whether the search came to its end. If not, it ran out of time, and a longer search may find a lower bound.
    pub fn is_final(&self) -> bool {
        self.is_final
    }

    /// Seconds over which prices stay the same at most. This may be longer than the requested step, where longer slices
    /// prove more.
    pub fn step_s(&self) -> u32 {
        self.step.seconds()
    }

    /// Price of a stand over the whole day, dollars. With one more stand all day, no schedule earns more than the bound
    /// plus this amount.
    pub fn stand_shadow_price_usd(&self, vertiport: VertiportIx) -> f64 {
        let prices = self.prices.stand.iter().skip(vertiport.at());
        money::usd(prices.step_by(self.size()).sum())
    }

    /// With one more passenger of a demand period, no schedule earns more than the bound plus this amount in dollars.
    /// It is the passenger's price, or the whole margin of a passenger where fewer want to fly than an aircraft has
    /// seats.
    pub fn passenger_shadow_price_usd(
        &self,
        period: usize,
        from: VertiportIx,
        to: VertiportIx,
    ) -> f64 {
        let size = self.size();
        money::usd(self.passenger_shadow_price_usd[(period * size + from.at()) * size + to.at()])
    }

    /// Number of vertiports.
    fn size(&self) -> usize {
        self.prices.stand.len() / self.slices.len()
    }
}
