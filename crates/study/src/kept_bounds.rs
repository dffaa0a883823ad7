//! Where bounds are kept between runs: `vertifleet` in the user's cache folder, as the XDG base directory specification
//! (freedesktop.org, version 0.8) names it.

use std::env;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::{Scenario, Stop};
use vertifleet_optimize::{Step, cached_upper_bound, upper_bound_unless};

use crate::error::Error;
use crate::run::BoundedDay;

/// The folder of kept bounds, where there can be one.
pub struct KeptBounds {
    folder: Option<PathBuf>,
}

impl KeptBounds {
    /// `$XDG_CACHE_HOME/vertifleet`, or `.cache/vertifleet` in the home folder. Nothing is kept where neither is known.
    pub fn of_this_user() -> Self {
        // The specification asks that relative paths be ignored.
        let absolute =
            |name| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let caches =
            absolute("XDG_CACHE_HOME").or_else(|| absolute("HOME").map(|home| home.join(".cache")));
        Self { folder: caches.map(|caches| caches.join("vertifleet")) }
    }

    /// The days with their upper bounds; `bounded` is called after each, from any thread.
    ///
    /// # Errors
    /// If a day is too large for a bound with this step; [`Error::Stopped`] if `stopped` is raised meanwhile.
    pub fn days(
        &self,
        scenarios: Vec<Arc<Scenario>>,
        step: Step,
        stopped: &Stop,
        bounded: &(impl Fn() + Sync),
    ) -> Result<Vec<BoundedDay>, Error> {
        let bound = |scenario: Arc<Scenario>| {
            // A bound that is kept is not stopped, but there may be many of them.
            if stopped.is_requested() {
                return Err(Error::Stopped);
            }
            let upper_bound_usd =
                self.upper_bound_usd(&scenario, step, stopped)?.ok_or(Error::Stopped)?;
            bounded();
            Ok(BoundedDay { scenario, upper_bound_usd: Some(upper_bound_usd) })
        };
        scenarios.into_par_iter().map(bound).collect()
    }

    /// The bound of a day, dollars, unless `stopped` is raised. A folder that cannot be written to is no reason to go without.
    fn upper_bound_usd(
        &self,
        scenario: &Scenario,
        step: Step,
        stopped: &Stop,
    ) -> Result<Option<f64>, Error> {
        let kept = |folder| cached_upper_bound(stopped, scenario, step, folder);
        let bound = match self.folder.as_deref().map(kept) {
            Some(Err(vertifleet_optimize::Error::Core(_))) | None => {
                upper_bound_unless(stopped, scenario, step)
            }
            Some(outcome) => outcome,
        };
        Ok(bound?.map(|bound| bound.upper_bound_usd()))
    }
}
