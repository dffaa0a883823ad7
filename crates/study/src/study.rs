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

/// Days and the competitors that will play them. Every competitor can play every day.
pub(crate) struct Study {
    pub(crate) competitors: Vec<Competitor>,
    days: Vec<BoundedDay>,
    /// The step with which upper bounds of the days are to be proven.
    pub(crate) bound_step: Option<Step>,
}

impl Study {
    /// # Errors
    /// Returns [`Error::Empty`] if there is no competitor or no day, and an error if a competitor
    /// cannot play one of the days.
    pub(crate) fn new<Day: Into<BoundedDay>>(
        competitors: Vec<Competitor>,
        days: Vec<Day>,
        bound_step: Option<Step>,
    ) -> Result<Self, Error> {
        if competitors.is_empty() || days.is_empty() {
            return Err(Error::Empty { policies: competitors.len(), days: days.len() });
        }
        let days: Vec<BoundedDay> = days.into_iter().map(Into::into).collect();
        for day in &days {
            competitors.iter().try_for_each(|competitor| competitor.check_fits(&day.scenario))?;
        }
        Ok(Self { competitors, days, bound_step })
    }

    pub(crate) fn days(&self) -> impl Iterator<Item = &Scenario> + Clone {
        self.days.iter().map(|day| &*day.scenario)
    }

    pub(crate) fn scenarios(&self) -> Vec<Arc<Scenario>> {
        self.days.iter().map(|day| Arc::clone(&day.scenario)).collect()
    }

    /// Bounds all days, if bounds are asked for, and plays them with every competitor, one
    /// competitor after the other.
    pub(crate) fn play(
        &self,
        kept: Kept,
        stop: &Stop,
        watch: &impl Watch,
    ) -> Result<Vec<PolicyRecord>, Error> {
        let (competitors, number) = (&self.competitors, self.days.len());
        let proven = self.bound_step.map(|step| {
            let bounded = watch.bounds(number);
            KeptBounds::of_this_user().days(self.scenarios(), step, stop, &bounded)
        });
        let proven = proven.transpose()?;
        let days = proven.as_ref().unwrap_or(&self.days);
        let play = |(at, competitor): (usize, &Competitor)| {
            let played = watch.policy(&competitor.name, at + 1, competitors.len(), number);
            let record = play_all(competitor, days, kept, stop, &played)?;
            watch.played(&record);
            Ok(record)
        };
        competitors.iter().enumerate().map(play).collect()
    }
}
