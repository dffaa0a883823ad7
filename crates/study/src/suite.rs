//! Suites: frozen sets of days with names and certified upper bounds, so that results of different
//! people can be set side by side.
//!
//! A suite's days are drawn, not stored. The table of a suite (`suites/NAME.csv`, made by
//! `make suites`) has a hash of each day, and a day that is drawn otherwise than it was when the
//! suite was frozen is refused. All days are comparison days, which no training and no validation
//! ever draws.
//!
//! `random:N` names the days of the first N random networks in the same way. They are not frozen:
//! their bounds are proven when they are needed.

mod frozen;

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::{
    DaySeed, Network, Purpose, Scenario, Stop, nearest, random_network, random_places,
};
use vertifleet_optimize::Step;

use crate::error::Error;
use crate::kept_bounds::KeptBounds;
use crate::run::BoundedDay;
use crate::study::MOST_DAYS;
use frozen::FrozenDay;

/// A set of days with a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Suite {
    /// Its name, for example `paper-100`.
    pub name: Cow<'static, str>,
    /// Describes its days, in one short phrase.
    pub description: Cow<'static, str>,
    /// Number of its days.
    pub days: usize,
    /// Minutes for which the prices of its bounds stay the same.
    pub step_minutes: u32,
    drawn_from: DrawnFrom,
    /// The text of its table, if it is frozen.
    table: Option<&'static str>,
}

/// What the days of a suite are drawn from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DrawnFrom {
    /// A shipped network, from seed 1 on.
    Network(&'static str),
    /// The same number of days of each shipped city, one city after the other, each from seed 1 on.
    Cities,
    /// A random network for each day, from number 0 on; the seed is the network's number.
    RandomNetworks,
    /// A network like the paper's with this number of vertiports at random places for each day,
    /// from number 0 on; the seed is the network's number.
    RandomPlaces(usize),
}

macro_rules! suite {
    ($name:literal, $days:literal, $step:literal, $from:expr, $description:literal) => {
        Suite {
            name: Cow::Borrowed($name),
            description: Cow::Borrowed($description),
            days: $days,
            step_minutes: $step,
            drawn_from: $from,
            table: Some(include_str!(concat!("../../../suites/", $name, ".csv"))),
        }
    };
}

/// The cities of `cities-100`.
const CITIES: [&str; 5] = ["new-york", "san-francisco", "los-angeles", "dallas", "paris"];

/// The name of random networks, which a number follows.
const RANDOM: &str = "random:";
/// Minutes for which the prices of bounds of random networks stay the same.
const RANDOM_STEP_MINUTES: u32 = 3;

/// All frozen suites.
pub const SUITES: [Suite; 9] = [
    suite!("paper-100", 100, 1, DrawnFrom::Network("paper"), "100 days of the paper's network"),
    suite!(
        "disrupted-100",
        100,
        1,
        DrawnFrom::Network("disrupted"),
        "100 days of the paper's network that go wrong"
    ),
    suite!(
        "new-york-100",
        100,
        1,
        DrawnFrom::Network("new-york"),
        "100 days of nine sites around New York"
    ),
    suite!(
        "paper-quick-20",
        20,
        3,
        DrawnFrom::Network("paper-quick"),
        "20 days of the paper's network on which aircraft leave before they are full"
    ),
    suite!(
        "new-york-quick-20",
        20,
        3,
        DrawnFrom::Network("new-york-quick"),
        "20 days around New York on which aircraft leave before they are full"
    ),
    suite!("cities-100", 100, 1, DrawnFrom::Cities, "20 days of each of five real cities"),
    suite!(
        "random-50",
        50,
        1,
        DrawnFrom::RandomNetworks,
        "a day of each of 50 networks that differ in everything"
    ),
    suite!(
        "random-places-100",
        100,
        1,
        DrawnFrom::RandomPlaces(8),
        "100 days like the paper's, each with its vertiports at other places"
    ),
    suite!(
        "large",
        10,
        3,
        DrawnFrom::Network("large"),
        "10 days of 60 vertiports and 300 aircraft"
    ),
];

/// A day of a suite.
#[derive(Debug, Clone)]
pub struct SuiteDay {
    /// The day.
    pub scenario: Arc<Scenario>,
    /// The hash of the day.
    pub hash: String,
    /// The certified upper bound of its profit, dollars; `None` if it has not been proven.
    pub upper_bound_usd: Option<f64>,
}

impl From<SuiteDay> for BoundedDay {
    fn from(SuiteDay { scenario, upper_bound_usd, .. }: SuiteDay) -> Self {
        Self { scenario, upper_bound_usd }
    }
}

impl Suite {
    /// The suite with this name.
    ///
    /// # Errors
    /// Returns [`Error::UnknownSuite`] if there is none.
    pub fn find(name: &str) -> Result<Self, Error> {
        let frozen = SUITES.into_iter().find(|suite| suite.name == name);
        frozen.or_else(|| Self::of_random_networks(name)).ok_or_else(|| {
            let names: Vec<Cow<'_, str>> = SUITES.map(|suite| suite.name).into();
            let meant = nearest(name, names.iter().map(AsRef::as_ref));
            Error::UnknownSuite {
                name: name.to_owned(),
                known: format!("{}, random:1 to random:{MOST_DAYS}", names.join(", ")),
                meant: meant.map(|name| format!("did you mean {name}?")),
            }
        })
    }

    /// A day of each of the first random networks, if the name asks for a number of them.
    fn of_random_networks(name: &str) -> Option<Self> {
        let networks: u32 = name.strip_prefix(RANDOM)?.parse().ok()?;
        (1..=MOST_DAYS).contains(&networks).then(|| Self {
            name: format!("{RANDOM}{networks}").into(),
            description: format!("a day of each of {networks} networks that differ in everything")
                .into(),
            days: networks as usize,
            step_minutes: RANDOM_STEP_MINUTES,
            drawn_from: DrawnFrom::RandomNetworks,
            table: None,
        })
    }

    /// The network that all of its days are drawn from; `None` if each day has a different
    /// network.
    pub fn network(&self) -> Option<&'static str> {
        match self.drawn_from {
            DrawnFrom::Network(name) => Some(name),
            DrawnFrom::Cities | DrawnFrom::RandomNetworks | DrawnFrom::RandomPlaces(_) => None,
        }
    }

    /// The numbers of days of each of its strata, in their order: the days of one network are a
    /// stratum, unless each day has a different network.
    pub(crate) fn strata(&self) -> Vec<usize> {
        match self.drawn_from {
            DrawnFrom::Cities => vec![self.days / CITIES.len(); CITIES.len()],
            _ => vec![self.days],
        }
    }

    /// The name of the network whose shipped weights are meant. Days at random places are like
    /// those of `paper`.
    pub(crate) fn home(&self) -> &'static str {
        match self.drawn_from {
            DrawnFrom::Network(name) => name,
            DrawnFrom::Cities => "cities",
            DrawnFrom::RandomNetworks => "random",
            DrawnFrom::RandomPlaces(_) => "paper",
        }
    }

    /// Draws the days, and checks that they are the ones that were frozen, if any were.
    ///
    /// # Errors
    /// Returns [`Error::SuiteChanged`] if a day is not what it was; [`Error::Stopped`] soon after
    /// `stop` is requested.
    pub fn draw(&self, stop: &Stop) -> Result<Vec<SuiteDay>, Error> {
        let Some(table) = self.table else {
            let day = |scenario: Arc<Scenario>| SuiteDay {
                hash: frozen::hash(&scenario),
                upper_bound_usd: None,
                scenario,
            };
            return Ok(self.scenarios(stop)?.into_par_iter().map(day).collect());
        };
        let frozen = frozen::parse(table);
        let changed = |day: String| Error::SuiteChanged { suite: self.name.to_string(), day };
        if frozen.len() != self.days {
            return Err(changed(format!("{} days in its table", frozen.len())));
        }
        let check = |(scenario, frozen): (Arc<Scenario>, FrozenDay)| {
            let (hash, upper_bound_usd) = (frozen.hash.to_owned(), Some(frozen.upper_bound_usd));
            let day = SuiteDay { scenario, hash, upper_bound_usd };
            if stop.is_requested() {
                Err(Error::Stopped)
            } else if frozen.name == day.scenario.name && frozen.hash == frozen::hash(&day.scenario)
            {
                Ok(day)
            } else {
                Err(changed(day.scenario.name.clone()))
            }
        };
        let drawn = self.scenarios(stop)?;
        drawn.into_iter().zip(frozen).collect::<Vec<_>>().into_par_iter().map(check).collect()
    }

    /// Draws the days as [`draw`](Self::draw) does, and proves the bounds that are missing.
    ///
    /// # Errors
    /// Returns the errors of [`draw`](Self::draw), and an error if a day is too large for its
    /// bound.
    pub fn draw_with_bounds(&self, stop: &Stop) -> Result<Vec<SuiteDay>, Error> {
        let mut days = self.draw(stop)?;
        if !self.is_frozen() {
            let scenarios = days.iter().map(|day| Arc::clone(&day.scenario)).collect();
            let bounded = KeptBounds::of_this_user().days(scenarios, self.step()?, stop, &|| ())?;
            for (day, bounded) in days.iter_mut().zip(bounded) {
                day.upper_bound_usd = bounded.upper_bound_usd;
            }
        }
        Ok(days)
    }

    /// Whether its days and bounds are those of a table.
    pub(crate) fn is_frozen(&self) -> bool {
        self.table.is_some()
    }

    /// The length of the slices of its bounds.
    pub(crate) fn step(&self) -> Result<Step, Error> {
        Ok(Step::from_minutes(self.step_minutes)?)
    }

    /// Proves the bounds of all days again, and returns the text of the suite's table. `bounded` is
    /// called after each day, from any thread.
    ///
    /// # Errors
    /// Returns an error if a day is too large for its bound; [`Error::Stopped`] soon after `stop`
    /// is requested.
    pub fn freeze(&self, stop: &Stop, bounded: &(impl Fn() + Sync)) -> Result<String, Error> {
        let days =
            KeptBounds::of_this_user().days(self.scenarios(stop)?, self.step()?, stop, bounded)?;
        Ok(frozen::text(
            days.iter()
                .map(|day| (&*day.scenario, day.upper_bound_usd.expect("every day was bounded"))),
        ))
    }

    fn scenarios(&self, stop: &Stop) -> Result<Vec<Arc<Scenario>>, Error> {
        let shipped = |name| Network::shipped(name).expect("a test draws the days of every suite");
        let networks: Vec<Network> = match self.drawn_from {
            DrawnFrom::Network(name) => vec![shipped(name)],
            DrawnFrom::Cities => CITIES.map(shipped).into(),
            DrawnFrom::RandomNetworks | DrawnFrom::RandomPlaces(_) => Vec::new(),
        };
        let days_each = self.days / networks.len().max(1);
        let draw = |number: usize| {
            if stop.is_requested() {
                return Err(Error::Stopped);
            }
            let seed = |number: usize| DaySeed::comparison(number as u64);
            Ok(Arc::new(match self.drawn_from {
                DrawnFrom::Network(_) | DrawnFrom::Cities => {
                    networks[number / days_each].draw(seed(number % days_each + 1)?)
                }
                DrawnFrom::RandomNetworks => {
                    random_network(Purpose::Comparison, number as u64).draw(seed(number)?)
                }
                DrawnFrom::RandomPlaces(size) => {
                    random_places(Purpose::Comparison, size, number as u64)?.draw(seed(number)?)
                }
            }))
        };
        (0..self.days).into_par_iter().map(draw).collect()
    }
}
