//! A comparison from what is asked for to its records: who takes part, on which days, measured against what.

use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::{DaySeed, Network, Scenario, Stop};
use vertifleet_optimize::Step;

use crate::entrants::{Asked, Entrant, contenders};
use crate::error::Error;
use crate::kept_bounds::KeptBounds;
use crate::origin::NetworkOrigin;
use crate::own_days::OwnDays;
use crate::record::{ComparisonRecords, PolicyRecord};
use crate::run::{BoundedDay, run};

/// Some days of a network and who will play them; everything that can be found wrong beforehand has been looked for.
pub struct Comparison {
    network: String,
    origin: NetworkOrigin,
    entrants: Vec<Entrant>,
    scenarios: Vec<Arc<Scenario>>,
    first_seed: Option<u64>,
    days_from: Option<String>,
    step: Option<Step>,
}

/// Who is told how far a comparison is. Each member is asked for something to call after every day, from any thread.
pub trait Watch {
    /// What is called after a day.
    type Bar: Fn() + Sync;
    /// So many days are being bounded.
    fn bounds(&self, days: usize) -> Self::Bar;
    /// So many days are being played by this policy; `position` of `policies`, from 1.
    fn policy(&self, name: &str, position: usize, policies: usize, days: usize) -> Self::Bar;
}

impl Comparison {
    /// The days of a network from `first_seed` on, each with its upper bound where a step is given.
    ///
    /// # Errors
    /// If there is no such policy or day, two policies have one name, or a policy cannot play these days; [`Error::Stopped`]
    /// soon after `stopped` is raised.
    pub fn new(
        network: &Network,
        asked: &Asked<'_>,
        (first_seed, days): (u64, u32),
        step: Option<Step>,
        stopped: &Stop,
    ) -> Result<Self, Error> {
        let entrants = entrants(asked, days as usize)?;
        let scenarios = draw(network, first_seed, days, stopped)?;
        let first = scenarios.first().ok_or(Error::Empty { policies: entrants.len(), days: 0 })?;
        entrants.iter().try_for_each(|entrant| entrant.check_fits(first))?;
        let origin = NetworkOrigin::of_all(network.name(), &scenarios);
        Ok(Self {
            network: network.name().to_owned(),
            origin,
            entrants,
            scenarios,
            first_seed: Some(first_seed),
            days_from: None,
            step,
        })
    }

    /// Days of the user's own, each with its upper bound where a step is given.
    ///
    /// # Errors
    /// If there is no such policy, two policies have one name, or a policy cannot play one of these days.
    pub fn of_own(days: OwnDays, asked: &Asked<'_>, step: Option<Step>) -> Result<Self, Error> {
        let entrants = entrants(asked, days.scenarios.len())?;
        // Drawn days have one fleet and one set of rules; these may differ in everything but their vertiports.
        for day in days.days() {
            entrants.iter().try_for_each(|entrant| entrant.check_fits(day))?;
        }
        Ok(Self {
            network: days.network().to_owned(),
            origin: days.origin(),
            entrants,
            scenarios: days.scenarios,
            first_seed: None,
            days_from: Some(days.from),
            step,
        })
    }

    /// The days that will be played.
    pub fn days(&self) -> impl Iterator<Item = &Scenario> {
        self.scenarios.iter().map(Arc::as_ref)
    }

    /// What is allowed but hardly meant ([`Recipe::warning`](crate::policies::Recipe::warning)).
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.entrants.iter().filter_map(|entrant| {
            entrant.recipe()?.warning(&entrant.name, &self.network, self.origin)
        })
    }

    /// Plays all days with every policy; `command` is what the study says it was made with.
    ///
    /// # Errors
    /// [`Error::Stopped`] soon after `stopped` is raised; else if a day is too large for its bound, or a policy cannot play
    /// one to its end.
    pub fn run(
        self,
        command: String,
        stopped: &Stop,
        watch: &impl Watch,
    ) -> Result<ComparisonRecords, Error> {
        let Self { network, origin, entrants, scenarios, first_seed, days_from, step } = self;
        let number = scenarios.len();
        let days = match step {
            Some(step) => {
                KeptBounds::of_this_user().days(scenarios, step, stopped, &watch.bounds(number))?
            }
            None => scenarios.into_iter().map(BoundedDay::unbounded).collect(),
        };
        let policies = play(&days, &entrants, stopped, watch)?;
        // How a policy learned on another network says nothing of these days. None was trained on days of the user's own.
        let here = |entrant: &&Entrant| days_from.is_none() && entrant.was_trained_on(&network);
        Ok(ComparisonRecords {
            curves: entrants.iter().filter(here).filter_map(Entrant::curve).collect(),
            trainings: entrants.iter().filter(here).filter_map(Entrant::training).collect(),
            network,
            network_origin: origin,
            seed: first_seed,
            days_from,
            days: number,
            bound_step_s: step.map(Step::seconds),
            command,
            policies,
        })
    }
}

/// All that are asked for, no two of one name.
fn entrants(asked: &Asked<'_>, days: usize) -> Result<Vec<Entrant>, Error> {
    let entrants = asked.entrants()?;
    contenders(&entrants)?;
    if entrants.is_empty() {
        return Err(Error::Empty { policies: 0, days });
    }
    Ok(entrants)
}

/// Plays all days with every policy, one after the other, and tells the watch.
///
/// # Errors
/// As [`run`].
pub fn play(
    days: &[BoundedDay],
    entrants: &[Entrant],
    stopped: &Stop,
    watch: &impl Watch,
) -> Result<Vec<PolicyRecord>, Error> {
    let mut begun = 0;
    run(days, &contenders(entrants)?, stopped, |name| {
        begun += 1;
        watch.policy(name, begun, entrants.len(), days.len())
    })
}

fn draw(
    network: &Network,
    first: u64,
    days: u32,
    stopped: &Stop,
) -> Result<Vec<Arc<Scenario>>, Error> {
    let seed = |day: u32| DaySeed::comparison(first.saturating_add(u64::from(day)));
    // The last seed first, so that nothing is drawn where not everything can be.
    seed(days.saturating_sub(1))?;
    let draw = |day: u32| {
        if stopped.is_requested() {
            return Err(Error::Stopped);
        }
        Ok(Arc::new(network.draw(seed(day)?)))
    };
    (0..days).into_par_iter().map(draw).collect()
}
