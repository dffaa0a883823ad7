//! Where bounds are kept between runs: `vertifleet` in the user's cache folder, as the XDG base directory specification
//! (freedesktop.org, version 0.8) names it.

use std::env;
use std::path::PathBuf;

use vertifleet_core::Scenario;
use vertifleet_optimize::{Error, Step, cached_upper_bound, upper_bound};

/// The folder of kept bounds, where there can be one.
pub(crate) struct KeptBounds {
    folder: Option<PathBuf>,
}

impl KeptBounds {
    /// `$XDG_CACHE_HOME/vertifleet`, or `.cache/vertifleet` in the home folder. Nothing is kept where neither is known.
    pub(crate) fn of_this_user() -> Self {
        // The specification asks that relative paths be ignored.
        let absolute =
            |name| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let caches =
            absolute("XDG_CACHE_HOME").or_else(|| absolute("HOME").map(|home| home.join(".cache")));
        Self { folder: caches.map(|caches| caches.join("vertifleet")) }
    }

    /// The bound of a day, dollars. A folder that cannot be written to is no reason to go without.
    pub(crate) fn upper_bound_usd(&self, scenario: &Scenario, step: Step) -> Result<f64, Error> {
        let kept = self.folder.as_deref().map(|folder| cached_upper_bound(scenario, step, folder));
        let bound = match kept {
            Some(Err(Error::Core(_))) | None => upper_bound(scenario, step),
            Some(outcome) => outcome,
        };
        Ok(bound?.upper_bound_usd())
    }
}
