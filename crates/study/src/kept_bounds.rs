//! Bounds that are kept between runs, in the folder `vertifleet` in the user's cache folder, as the
//! XDG base directory specification (freedesktop.org, version 0.8) defines it.

use std::env;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::{Scenario, Stop};
use vertifleet_optimize::{Step, kept_upper_bound, upper_bound_unless};

use crate::error::Error;
use crate::run::BoundedDay;

/// The folder of kept bounds, if there is one.
pub struct KeptBounds {
    folder: Option<PathBuf>,
}

impl KeptBounds {
    /// The bounds in `$XDG_CACHE_HOME/vertifleet`, or `.cache/vertifleet` in the home folder.
    /// Without either, none are kept.
    pub fn of_this_user() -> Self {
        // The specification requires that relative paths be ignored.
        let absolute =
            |name| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let caches =
            absolute("XDG_CACHE_HOME").or_else(|| absolute("HOME").map(|home| home.join(".cache")));
        Self { folder: caches.map(|caches| caches.join("vertifleet")) }
    }

    /// Computes the upper bounds of the days; `bounded` is called after each day, from any thread.
    ///
    /// # Errors
    /// Returns an error if a day is too large for a bound with this step; [`Error::Stopped`] if
    /// `stopped` is requested meanwhile.
    pub(crate) fn days(
        &self,
        scenarios: Vec<Arc<Scenario>>,
        step: Step,
        stopped: &Stop,
        bounded: &(impl Fn() + Sync),
    ) -> Result<Vec<BoundedDay>, Error> {
        let bound = |scenario: Arc<Scenario>| {
            // Reading a kept bound does not check for a stop, and there may be many of them.
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

    /// The upper bound of a day in dollars; `None` if `stopped` is requested. If the folder cannot
    /// be written to, the bound is computed without it.
    fn upper_bound_usd(
        &self,
        scenario: &Scenario,
        step: Step,
        stopped: &Stop,
    ) -> Result<Option<f64>, Error> {
        let kept = |folder| kept_upper_bound(stopped, scenario, step, folder);
        let bound = match self.folder.as_deref().map(kept) {
            Some(Err(vertifleet_optimize::Error::Core(_))) | None => {
                upper_bound_unless(stopped, scenario, step)
            }
            Some(outcome) => outcome,
        };
        Ok(bound?.map(|bound| bound.upper_bound_usd()))
    }
}
