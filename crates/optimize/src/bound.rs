//! The certified upper bound: what no schedule of a day can earn more than.
//!
//! Stands and passengers get prices (`bound/prices.rs`). Prices prove a bound in exact arithmetic, whatever they are
//! (`bound/certificate.rs`), over a day that is laid out once (`bound/time_expanded_day.rs`). What the fleet would do at them
//! (`bound/ways.rs`) says how to better them (`bound/descent.rs`), from coarse slices of time to fine ones (`bound/ladder.rs`).
//! docs/src/concepts/bound.md has the proof. A bound can be kept in a file (`bound/cache.rs`).

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

use vertifleet_core::{Scenario, Stop, Time, VertiportIx};

use crate::Error;
use descent::Found;
use prices::Prices;
use slices::Slices;
use time_expanded_day::TimeExpandedDay;

pub use cache::cached_upper_bound;
pub(crate) use ladder::Watch;

/// How long prices stay the same at most: a whole number of minutes from 1 to 60. A shorter step never gives a looser bound, and
/// takes longer.
///
/// Slices of time have 60, 15, 5, 3 or 1 minutes: the longest of these that is no longer than the step asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    minutes: u32,
}

impl Step {
    /// Prices that stay the same for at most so many minutes.
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
    /// 5 minutes.
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
    /// By period, from, to: what one more passenger is worth at most, micro-dollars.
    passenger_worth: Vec<i64>,
    micro_usd: i128,
    is_final: bool,
}

/// Proves how much a day can earn at most. Same scenario and step, same bound, bit for bit.
///
/// # Errors
/// [`Error::TooManyFlights`] if the day is too large for this step.
pub fn upper_bound(scenario: &Scenario, step: Step) -> Result<Bound, Error> {
    let never = Stop::default();
    Ok(upper_bound_unless(&never, scenario, step)?.expect("it is not stopped"))
}

/// As [`upper_bound`]; nothing, soon after `stopped` is raised.
///
/// # Errors
/// Those of [`upper_bound`].
pub fn upper_bound_unless(
    stopped: &Stop,
    scenario: &Scenario,
    step: Step,
) -> Result<Option<Bound>, Error> {
    let bound = search(scenario, step, &Unless { stopped })?;
    Ok(bound.filter(|_| !stopped.is_requested()))
}

/// As [`upper_bound`], while `watch` follows it: the best bound by the time that it wants no more, none if that is before the first.
///
/// # Errors
/// Those of [`upper_bound`].
pub(crate) fn search(
    scenario: &Scenario,
    step: Step,
    watch: &dyn Watch,
) -> Result<Option<Bound>, Error> {
    ladder::climb(scenario, step, watch)
}

/// Whether a day is not too large for a bound with this step.
///
/// # Errors
/// [`Error::TooManyFlights`] if it is.
pub(crate) fn fits(scenario: &Scenario, step: Step) -> Result<(), Error> {
    TimeExpandedDay::fits(scenario, step.seconds())
}

/// Follows nothing.
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
    /// What prices have been found to prove.
    fn of(step: Step, network: &TimeExpandedDay, found: &Found) -> Self {
        Self {
            step,
            slices: network.slices.clone(),
            passenger_worth: network.worth_of_passengers(&found.prices),
            prices: found.prices.clone(),
            micro_usd: found.bound(network),
            is_final: false,
        }
    }

    /// No schedule of the day earns more, dollars.
    pub fn upper_bound_usd(&self) -> f64 {
        money::usd_up(self.micro_usd)
    }

    /// Whether the search for it came to its end. If not, time was over first, and a longer search may find a lower bound.
    pub fn is_final(&self) -> bool {
        self.is_final
    }

    /// How long prices stay the same at most, seconds. It may be longer than what was asked for, where longer slices prove more.
    pub fn step_s(&self) -> u32 {
        self.step.seconds()
    }

    /// What one more stand costs during the step that contains a time, dollars. 0 past the last take-off time.
    pub fn stand_price_usd(&self, vertiport: VertiportIx, time: Time) -> f64 {
        let slice = self.slices.containing(time.seconds());
        let at = slice * self.size() + vertiport.at();
        self.prices.stand.get(at).map_or(0.0, |&price| money::usd(price))
    }

    /// With one more stand all day, no schedule earns more than the bound and so many dollars: its price over the day.
    pub fn stand_worth_usd(&self, vertiport: VertiportIx) -> f64 {
        let prices = self.prices.stand.iter().skip(vertiport.at());
        money::usd(prices.step_by(self.size()).sum())
    }

    /// With one more passenger of a demand period, no schedule earns more than the bound and so many dollars: the passenger's price, or
    /// all that a passenger earns where fewer want to fly than an aircraft has seats.
    pub fn passenger_worth_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        let size = self.size();
        money::usd(self.passenger_worth[(period * size + from.at()) * size + to.at()])
    }

    /// Number of vertiports.
    fn size(&self) -> usize {
        self.prices.stand.len() / self.slices.len()
    }
}
