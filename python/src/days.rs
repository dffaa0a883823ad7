//! `Days`: the source of an environment's days.

use std::sync::Arc;

use pyo3::prelude::*;
use vertifleet_core::{self as core, DaySeed, Purpose, random_network, random_places};
use vertifleet_observe::{Observer, Sizes};

use crate::failure::Failure;
use crate::layout::SizesTuple;
use crate::network::Network;
use crate::pickle::Reduced;

/// Largest numbers of vertiports, aircraft, types and periods of a random network.
const RANDOM: Sizes = Sizes { vertiports: 30, aircraft: 150, types: 1, periods: 15 };

/// The source of days: given networks, or a new network for each day. Every number names a day.
#[pyclass(frozen, module = "vertifleet._native")]
#[derive(Clone)]
pub(crate) struct Days {
    source: Source,
    purpose: Purpose,
}

#[derive(Clone)]
enum Source {
    /// Days of these networks in turn.
    Networks(Vec<Network>),
    /// A random network for each day.
    Random,
    /// The paper's network at random places for each day, with this many vertiports.
    RandomPlaces(usize),
}

#[pymethods]
impl Days {
    /// Days of some networks in turn, of "random", or of "random-places:N". `split` is "training",
    /// "validation" or "comparison"; the days of different splits are disjoint.
    #[new]
    fn new(source: SourceArgument, split: &str) -> Result<Self, Failure> {
        let purpose = purpose_of(split)?;
        let source = match source {
            SourceArgument::Networks(networks) => Source::given(networks)?,
            SourceArgument::Drawn(name) => Source::drawn(&name)?,
        };
        Ok(Self { source, purpose })
    }

    /// Whether a name stands for a source that draws a new network for each day.
    #[staticmethod]
    fn are_drawn(name: &str) -> bool {
        let size = name.strip_prefix(RANDOM_PLACES);
        name == "random" || size.is_some_and(|size| !size.contains(':'))
    }

    /// Largest numbers of vertiports, aircraft, types and periods of a day.
    #[getter]
    fn sizes(&self) -> SizesTuple {
        let Sizes { vertiports, aircraft, types, periods } = self.most();
        (vertiports, aircraft, types, periods)
    }

    /// Whether all days have the same vertiports, aircraft, types and periods.
    #[getter]
    fn are_of_one_size(&self) -> bool {
        match &self.source {
            Source::Networks(networks) => {
                networks.iter().all(|network| Sizes::of(&network.network) == self.most())
            }
            Source::Random => false,
            Source::RandomPlaces(_) => true,
        }
    }

    /// Number of days; their numbers are below it.
    #[getter]
    fn count(&self) -> u64 {
        let seeds = self.purpose.seeds();
        (seeds.end - seeds.start).min(DaySeed::TRAINING_DAYS)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (Py<PyAny>, &'static str)> {
        let source = match &self.source {
            Source::Networks(networks) => networks.clone().into_pyobject(py)?.into_any().unbind(),
            Source::Random => "random".into_pyobject(py)?.into_any().unbind(),
            Source::RandomPlaces(vertiports) => {
                format!("{RANDOM_PLACES}{vertiports}").into_pyobject(py)?.into_any().unbind()
            }
        };
        Ok((py.get_type::<Self>().into_any(), (source, self.purpose.name())))
    }
}

/// The purpose of the days of a split.
pub(crate) fn purpose_of(split: &str) -> Result<Purpose, Failure> {
    Purpose::named(split).ok_or_else(|| {
        Failure::argument(format!(
            "split must be \"training\", \"validation\" or \"comparison\", found {split:?}"
        ))
    })
}

const RANDOM_PLACES: &str = "random-places:";

/// Networks, or the name of a source of random ones.
#[derive(FromPyObject)]
enum SourceArgument {
    Drawn(String),
    Networks(Vec<Network>),
}

impl Source {
    fn given(networks: Vec<Network>) -> Result<Self, Failure> {
        if networks.is_empty() {
            return Err(Failure::argument("a list of networks must not be empty".to_owned()));
        }
        if let Some(Network { network, .. }) =
            networks.iter().find(|network| !network.network.always_has_decisions())
        {
            return Err(Failure::argument(format!(
                "network {:?} may draw days that have no decisions: with the lowest start_charge every battery is full only after operations end; raise start_charge or charge_kw",
                network.name()
            )));
        }
        Ok(Self::Networks(networks))
    }

    fn drawn(name: &str) -> Result<Self, Failure> {
        if name == "random" {
            return Ok(Self::Random);
        }
        let vertiports = name.strip_prefix(RANDOM_PLACES).and_then(|number| number.parse().ok());
        match vertiports.filter(|vertiports| core::RANDOM_PLACES.contains(vertiports)) {
            Some(vertiports) => Ok(Self::RandomPlaces(vertiports)),
            None => Err(Failure::argument(format!(
                "networks are drawn by \"random\", or \"random-places:N\" with N from {} to {}, found {name:?}",
                core::RANDOM_PLACES.start(),
                core::RANDOM_PLACES.end()
            ))),
        }
    }
}

impl Days {
    fn most(&self) -> Sizes {
        match &self.source {
            Source::Networks(networks) => {
                let sizes = networks.iter().map(|network| Sizes::of(&network.network));
                sizes.reduce(Sizes::max).expect("there is a network")
            }
            Source::Random => RANDOM,
            &Source::RandomPlaces(vertiports) => {
                let network = random_places(self.purpose, vertiports, 0);
                Sizes::of(&network.expect("the number of vertiports has been checked"))
            }
        }
    }

    /// Checks that there is a day with this number.
    pub(crate) fn check(&self, number: u64) -> Result<(), Failure> {
        DaySeed::of_purpose(self.purpose, number)?;
        Ok(())
    }

    /// The day with this number, and an observer of its network's days.
    pub(crate) fn day(&self, number: u64) -> Result<(Arc<core::Scenario>, Observer), core::Error> {
        let seed = DaySeed::of_purpose(self.purpose, number)?;
        let drawn;
        let network: &core::Network = match &self.source {
            Source::Networks(networks) => {
                let at = number % networks.len() as u64;
                &networks[usize::try_from(at).expect("a position")].network
            }
            Source::Random => {
                drawn = random_network(self.purpose, number);
                &drawn
            }
            &Source::RandomPlaces(vertiports) => {
                drawn = random_places(self.purpose, vertiports, number)?;
                &drawn
            }
        };
        Ok((Arc::new(network.draw(seed)), Observer::of(network)))
    }

    /// The observer of days from elsewhere: that of the first network.
    pub(crate) fn observer(&self) -> Observer {
        match &self.source {
            Source::Networks(networks) => Observer::of(&networks[0].network),
            Source::Random => Observer::of(&random_network(self.purpose, 0)),
            &Source::RandomPlaces(vertiports) => {
                let network = random_places(self.purpose, vertiports, 0);
                Observer::of(&network.expect("the number of vertiports has been checked"))
            }
        }
    }
}
