//! The common part of all studies: competitors play days, which may be bounded first.

use std::sync::Arc;

use vertifleet_core::{Scenario, Stop};
use vertifleet_optimize::Step;

use crate::competitor::Competitor;
use crate::error::Error;
use crate::kept_bounds::KeptBounds;
use crate::record::PolicyRecord;
use crate::run::{BoundedDay, Kept, play_all};

/// The most days, or networks, of a study.
pub const MOST_DAYS: u32 = 1_000_000;

/// Follows the progress of a study. Each method returns a function that is called after every day,
/// from any thread.
pub trait Watch {
    /// The function that is called after a day.
    type Bar: Fn() + Sync;
    /// Called before this many days are bounded.
    fn bounds(&self, days: usize) -> Self::Bar;
    /// Called before this policy plays this many days; it is number `position` of `policies`,
    /// from 1.
    fn policy(&self, name: &str, position: usize, policies: usize, days: usize) -> Self::Bar;
    /// Called when a policy has played all its days.
    fn played(&self, _: &PolicyRecord) {}
}

/// Ignores the progress.
#[derive(Debug, Clone, Copy)]
pub struct Unwatched;

impl Watch for Unwatched {
    type Bar = fn();

    fn bounds(&self, _: usize) -> fn() {
        || ()
    }

    fn policy(&self, _: &str, _: usize, _: usize, _: usize) -> fn() {
        || ()
    }
}

/// The upper bounds of the days.
pub(crate) enum Bounds {
    /// The study needs none.
    None,
    /// They are proven with this step.
    Prove(Step),
    /// They are known, in dollars, day by day.
    Known(Vec<f64>),
}

impl From<Option<Step>> for Bounds {
    fn from(step: Option<Step>) -> Self {
        step.map_or(Self::None, Self::Prove)
    }
}

/// Days and the competitors that will play them. Every competitor can play every day.
pub(crate) struct Study {
    pub(crate) competitors: Vec<Competitor>,
    pub(crate) scenarios: Vec<Arc<Scenario>>,
    pub(crate) bounds: Bounds,
}

impl Study {
    /// # Errors
    /// Returns [`Error::Empty`] if there is no competitor or no day, and an error if a competitor
    /// cannot play one of the days.
    pub(crate) fn new(
        competitors: Vec<Competitor>,
        scenarios: Vec<Arc<Scenario>>,
        bounds: impl Into<Bounds>,
    ) -> Result<Self, Error> {
        if competitors.is_empty() || scenarios.is_empty() {
            return Err(Error::Empty { policies: competitors.len(), days: scenarios.len() });
        }
        for scenario in &scenarios {
            competitors.iter().try_for_each(|competitor| competitor.check_fits(scenario))?;
        }
        Ok(Self { competitors, scenarios, bounds: bounds.into() })
    }

    pub(crate) fn days(&self) -> impl Iterator<Item = &Scenario> + Clone {
        self.scenarios.iter().map(Arc::as_ref)
    }

    /// Bounds all days, if bounds are asked for, and plays them with every competitor, one
    /// competitor after the other.
    pub(crate) fn play(
        &self,
        kept: Kept,
        stop: &Stop,
        watch: &impl Watch,
    ) -> Result<Vec<PolicyRecord>, Error> {
        let Self { competitors, scenarios, bounds } = self;
        let (number, scenarios) = (scenarios.len(), scenarios.clone());
        let days = match bounds {
            Bounds::Prove(slices) => {
                KeptBounds::of_this_user().days(scenarios, *slices, stop, &watch.bounds(number))?
            }
            Bounds::Known(bounds_usd) => BoundedDay::with_bounds(scenarios, bounds_usd),
            Bounds::None => scenarios.into_iter().map(BoundedDay::unbounded).collect(),
        };
        let play = |(at, competitor): (usize, &Competitor)| {
            let played = watch.policy(&competitor.name, at + 1, competitors.len(), number);
            let record = play_all(competitor, &days, kept, stop, &played)?;
            watch.played(&record);
            Ok(record)
        };
        competitors.iter().enumerate().map(play).collect()
    }
}
