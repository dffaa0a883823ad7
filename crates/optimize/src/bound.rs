//! The certified upper bound: dollars that no schedule of a day earns more than.
//!
//! Stands and flights get prices (`bound/prices.rs`). Any prices prove a bound in exact arithmetic
//! (`bound/certificate.rs`), over a day that is laid out once (`bound/time_expanded_day.rs`), with
//! passengers who buy whole flights (`bound/market.rs`). The best itineraries of the fleet at the
//! prices (`bound/best_itineraries.rs`) show how to improve them (`bound/descent.rs`), from coarse
//! slices of time to fine ones (`bound/ladder.rs`). docs/src/concepts/bound.md has the proof. The
//! prices of a bound can be kept in a file (`bound/kept.rs`).

mod best_itineraries;
mod certificate;
mod charge_levels;
mod charging_time;
mod descent;
mod designs;
mod itinerary;
mod kept;
mod ladder;
mod market;
mod master;
mod money;
mod outages;
mod penalty;
mod prices;
#[cfg(test)]
mod proof_tests;
mod rest;
mod slices;
mod step;
mod time_expanded_day;
mod without_foresight;
#[cfg(test)]
mod without_foresight_tests;

use vertifleet_core::{Scenario, Stop, Time, VertiportIx};

use crate::Error;
use descent::Found;
use ladder::{PathLevels, Relaxed, search};
use market::Market;
use prices::Prices;
use slices::Slices;
use step::STEPS;
use time_expanded_day::TimeExpandedDay;

pub use designs::{DesignBound, day_of_passengers};
pub use kept::kept_upper_bound;
pub(crate) use ladder::Watch;
pub(crate) use rest::{Rest, Way};
pub use step::Step;
pub use without_foresight::bound_without_foresight;

/// A difference of profits that is too small to matter.
pub(crate) const CENT_USD: f64 = 0.01;

/// A proven bound, and the prices that prove it.
#[derive(Debug, Clone)]
pub struct Bound {
    step: Step,
    slices: Slices,
    market: Market,
    prices: Prices,
    micro_usd: i128,
    /// The fixed cost of the fleet and its sites, micro-dollars.
    fixed_cost: i64,
    /// Number of levels of charge.
    levels: u16,
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
    upper_bound_of_rest(stopped, scenario, &[], step)
}

/// Does the same for what is left of a day ([`RemainingDay`](vertifleet_sim::live::RemainingDay)),
/// in which each aircraft takes a stand from the start of operations on, but decides first when it
/// is `ready`. Aircraft past the end of `ready` are ready from the start.
///
/// # Errors
/// The errors of [`upper_bound`].
pub fn upper_bound_of_rest(
    stopped: &Stop,
    scenario: &Scenario,
    ready: &[Time],
    step: Step,
) -> Result<Option<Bound>, Error> {
    let bound =
        search(Relaxed::known(scenario, ready), step, PathLevels::All, &Unless { stopped })?;
    Ok(bound.filter(|_| !stopped.is_requested()))
}

/// The best bound on a path to the shortest step for which the day is not too large, with as many
/// levels of charge as each cut takes, or until `watch` stops the search. `None` if that is before
/// the first bound, or the day is too large for every step.
pub(crate) fn finest_bound(scenario: &Scenario, watch: &dyn Watch) -> Option<Bound> {
    let fits = |step: &Step| TimeExpandedDay::fits(scenario, step.seconds(), 1).is_ok();
    let step = STEPS.into_iter().rev().find(fits)?;
    search(Relaxed::known(scenario, &[]), step, PathLevels::Highest, watch).ok().flatten()
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
            market: day.market.clone(),
            prices: found.prices.clone(),
            micro_usd: found.bound(day),
            fixed_cost: day.fixed_cost,
            levels: day.levels,
            is_final: false,
        }
    }

    /// The bound: no schedule of the day earns more, dollars.
    pub fn upper_bound_usd(&self) -> f64 {
        money::usd_up(self.micro_usd)
    }

    /// Whether a profit equals the bound to the cent, so that no schedule earns more.
    pub fn is_reached_by(&self, profit_usd: f64) -> bool {
        self.upper_bound_usd() <= profit_usd + CENT_USD
    }

    /// The [`gap`] of a profit to this bound, both before the costs of aircraft and sites, which no
    /// decision changes.
    pub fn gap(&self, profit_usd: f64) -> f64 {
        let operating_usd = money::usd_up(self.micro_usd + i128::from(self.fixed_cost));
        gap(operating_usd, profit_usd + money::usd(self.fixed_cost))
    }

    /// Whether the search came to its end. If not, it ran out of time, and a longer search may find
    /// a lower bound.
    pub fn is_final(&self) -> bool {
        self.is_final
    }

    /// Seconds over which prices stay the same at most. This may be longer than the requested step,
    /// where longer slices prove more.
    pub fn step_s(&self) -> u32 {
        self.step.seconds()
    }

    /// Price of a stand over the whole day, dollars. With one more stand all day, no schedule earns
    /// more than the bound plus this amount.
    pub fn stand_shadow_price_usd(&self, vertiport: VertiportIx) -> f64 {
        let prices = self.prices.stand.iter().skip(vertiport.at());
        money::usd(prices.step_by(self.size()).sum())
    }

    /// The same price by demand period, dollars; slices lie within one period each, so the prices
    /// of periods add up to that of the whole day.
    pub fn stand_shadow_prices_by_period_usd(
        &self,
        vertiport: VertiportIx,
        periods: usize,
    ) -> Vec<f64> {
        let mut micro_usd = vec![0; periods];
        let prices = self.prices.stand.iter().skip(vertiport.at()).step_by(self.size());
        for (slice, price) in prices.enumerate() {
            micro_usd[self.slices.period(slice)] += price;
        }
        micro_usd.into_iter().map(money::usd).collect()
    }

    /// With one more passenger of a demand period, no schedule earns more than the bound plus this
    /// amount in dollars. It is by how much one more passenger raises what the passengers of the
    /// pair can bring beyond the prices of their flights.
    pub fn passenger_shadow_price_usd(
        &self,
        period: usize,
        from: VertiportIx,
        to: VertiportIx,
    ) -> f64 {
        let size = self.size();
        let cell = (period * size + from.at()) * size + to.at();
        money::usd(self.market.worth_of_one_more(cell, &self.prices.flight))
    }

    /// Number of vertiports.
    fn size(&self) -> usize {
        self.prices.stand.len() / self.slices.len()
    }
}

/// The amount by which a profit is below a bound, as a share of the bound. Where nothing can be
/// earned, or a loss can only be kept small, it is the share of the loss that might be avoided,
/// from 0 to 1. Less than a cent counts as 0.
pub fn gap(bound_usd: f64, profit_usd: f64) -> f64 {
    if bound_usd > CENT_USD {
        (bound_usd - profit_usd) / bound_usd
    } else if profit_usd < -CENT_USD {
        (bound_usd - profit_usd) / -profit_usd
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::gap;

    #[test]
    fn a_gap_is_a_share_of_what_can_be_earned_or_of_the_loss() {
        for (bound_usd, profit_usd, share) in [
            (200.0, 150.0, 0.25),
            (200.0, -100.0, 1.5),
            (0.0, 0.0, 0.0),
            // What rounding leaves of nothing.
            (6e-11, -1e-4, 0.0),
            (1e-4, 0.0, 0.0),
            (0.0, -70.0, 1.0),
            // $100 of the loss cannot be avoided, $25 can.
            (-100.0, -125.0, 0.2),
            (-100.0, -100.0, 0.0),
        ] {
            let found = gap(bound_usd, profit_usd);
            assert!((found - share).abs() < 1e-12, "{bound_usd}, {profit_usd}: {found}");
        }
    }
}
