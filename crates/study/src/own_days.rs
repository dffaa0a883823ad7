//! The user's own days to compare policies on, instead of days drawn from a seed: scenario files,
//! or scenarios in memory.
//!
//! Results are averaged and compared pair by pair, so the days must go together: they must have the
//! same vertiports in the same order, and each must have a different name. Fleet, demand, tariffs,
//! times and disturbances may differ from day to day.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use vertifleet_core::Scenario;

use crate::error::Error;
use crate::origin::{NetworkOrigin, network_of};

/// The user's own days, which go together.
#[derive(Debug, Clone)]
pub struct OwnDays {
    pub(crate) scenarios: Vec<Arc<Scenario>>,
    /// Where the days came from, as text.
    pub(crate) from: String,
}

impl OwnDays {
    /// Reads the scenario files at these paths, in their order. A folder stands for all of its
    /// files whose names end in `.json`, in the order of their names.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read or is not a scenario, and the errors of
    /// [`of`](Self::of).
    pub fn read(paths: &[PathBuf]) -> Result<Self, Error> {
        let files = files(paths)?;
        let read = |path: &PathBuf| Ok(Arc::new(Scenario::read(path)?));
        let scenarios = files.iter().map(read).collect::<Result<_, Error>>()?;
        Self::of(scenarios, folders(paths, &files))
    }

    /// Takes these days; `from` says where they came from.
    ///
    /// # Errors
    /// Returns [`Error::DaysDiffer`] if there are no days, if they have different vertiports, or if
    /// two have the same name.
    pub fn of(scenarios: Vec<Arc<Scenario>>, from: String) -> Result<Self, Error> {
        let differ = |rule: String| Err(Error::DaysDiffer { rule });
        let Some(first) = scenarios.first() else {
            return differ(format!("there is none in {from}"));
        };
        let ids = |day: &Scenario| -> Vec<String> {
            day.vertiports.iter().map(|vertiport| vertiport.id.clone()).collect()
        };
        let (expected, mut names) = (ids(first), BTreeSet::new());
        for day in &scenarios {
            if ids(day) != expected {
                return differ(format!(
                    "{:?} has other vertiports than {:?}, or in another order",
                    day.name, first.name
                ));
            }
            if !names.insert(&day.name) {
                return differ(format!("two of them have the name {:?}", day.name));
            }
        }
        Ok(Self { scenarios, from })
    }

    /// The days.
    pub fn days(&self) -> impl Iterator<Item = &Scenario> {
        self.scenarios.iter().map(Arc::as_ref)
    }

    /// The days, with the text that says where they came from.
    pub fn into_parts(self) -> (Vec<Arc<Scenario>>, String) {
        (self.scenarios, self.from)
    }

    /// The name of the network that all days share, as `paper-7` has that of `paper`; otherwise
    /// where the days came from.
    pub fn network(&self) -> &str {
        self.shared_network().unwrap_or(&self.from)
    }

    /// Whether the days come from a shipped network.
    pub(crate) fn origin(&self) -> NetworkOrigin {
        self.shared_network()
            .map_or(NetworkOrigin::Own, |network| NetworkOrigin::of_all(network, &self.scenarios))
    }

    fn shared_network(&self) -> Option<&str> {
        let mut names = self.scenarios.iter().map(|day| network_of(day));
        let first = names.next()?;
        names.all(|name| name == first).then_some(first)
    }
}

/// The files that the paths stand for: a folder stands for all of its files whose names end in
/// `.json`, in the order of their names.
pub(crate) fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            files.extend(files_in(path)?);
        } else {
            files.push(path.clone());
        }
    }
    Ok(files)
}

fn files_in(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let cannot = |cause| {
        let origin = folder.display().to_string();
        Error::Core(vertifleet_core::Error::CannotRead { origin, cause })
    };
    let entries = fs::read_dir(folder).map_err(cannot)?;
    let paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<PathBuf>, _>>();
    let mut paths = paths.map_err(cannot)?;
    // A hidden file is an unfinished one, or one that the user did not make.
    let hidden =
        |path: &Path| path.file_name().is_some_and(|name| name.as_encoded_bytes()[0] == b'.');
    paths.retain(|path| path.extension().is_some_and(|end| end == "json") && !hidden(path));
    paths.sort();
    Ok(paths)
}

/// The folders as they were named, and the folders of named files.
fn folders(paths: &[PathBuf], files: &[PathBuf]) -> String {
    let folder = |path: &PathBuf| {
        let folder = if path.is_dir() { path } else { path.parent().unwrap_or(path) };
        let folder = if folder.as_os_str().is_empty() { Path::new("./") } else { folder };
        folder.display().to_string()
    };
    // If there are no files, the message must name the folders that the user gave.
    let meant = if files.is_empty() { paths } else { files };
    let mut names: Vec<String> = Vec::new();
    for name in paths.iter().filter(|path| path.is_dir()).chain(meant).map(folder) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;
    use std::sync::Arc;

    use vertifleet_core::{Coded, DaySeed, Network, Scenario};

    use super::OwnDays;
    use crate::origin::NetworkOrigin;

    fn day(network: &str, seed: u64) -> Arc<Scenario> {
        let network = Network::find(network).expect("a network");
        Arc::new(network.draw(DaySeed::comparison(seed).expect("a seed")))
    }

    fn named(day: &Scenario, name: &str) -> Arc<Scenario> {
        let mut day = day.clone().into_day();
        name.clone_into(&mut day.name);
        Arc::new(day.check("a day").expect("a name"))
    }

    #[test]
    fn a_folder_stands_for_its_files_in_the_order_of_their_names() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        for (name, seed) in [("b.json", 1), ("a.json", 2), (".hidden.json", 3), ("c.txt", 4)] {
            fs::write(at(name), day("paper", seed).to_json()).expect("a file");
        }
        let seeds = |paths: &[PathBuf]| -> Vec<u64> {
            OwnDays::read(paths).expect("days").days().map(|day| day.seed).collect()
        };
        assert_eq!(seeds(&[folder.path().to_owned()]), [2, 1]);
        assert_eq!(seeds(&[at("c.txt"), at("b.json")]), [4, 1], "named files in their order");
        let days = OwnDays::read(&[at("b.json")]).expect("a day");
        assert_eq!(
            (days.network(), days.from.as_str()),
            ("paper", &*folder.path().to_string_lossy())
        );
    }

    #[test]
    fn days_that_do_not_go_together_are_refused() {
        let paper = day("paper", 1);
        for days in [
            vec![],
            vec![Arc::clone(&paper), day("random:1", 1)],
            vec![Arc::clone(&paper), Arc::clone(&paper)],
        ] {
            let error = OwnDays::of(days, "nowhere".to_owned()).expect_err("no days that fit");
            assert_eq!(error.code().to_string(), "V410", "{error}");
        }
    }

    #[test]
    fn days_are_of_the_shipped_network_only_if_it_draws_them_all() {
        let (one, two) = (day("paper", 1), day("paper", 2));
        let origin = |days| OwnDays::of(days, "here".to_owned()).expect("days").origin();
        assert_eq!(origin(vec![one.clone(), two.clone()]), NetworkOrigin::Shipped);
        let mut changed = two.as_ref().clone().into_day();
        changed.vertiports[0].stands += 1;
        let changed = Arc::new(changed.check("a day").expect("a day"));
        assert_eq!(origin(vec![one.clone(), changed]), NetworkOrigin::Changed);
        let renamed = OwnDays::of(vec![one, named(&two, "fog")], "here".to_owned()).expect("days");
        assert_eq!((renamed.origin(), renamed.network()), (NetworkOrigin::Own, "here"));
    }
}
