//! A network, from which days are drawn: everything that is the same every day, and how the rest is
//! distributed.

use std::path::{Path, PathBuf};

use crate::demand_model::DemandModel;
use crate::disturbances::{DelayModel, DisturbanceModel};
use crate::paths::origin;
use crate::random::to_whole;
use crate::{
    AircraftType, Error, FeatureScales, Matrix, Operations, Purpose, Scenario, Time, Vertiport,
    drawn_for, input, nearest, network_file, parse, random_network, random_places,
};

/// The prefix of the number of a random comparison network.
const RANDOM: &str = "random:";
/// The prefix of the size and the number of a comparison network at random places.
const RANDOM_PLACES: &str = "random-places:";
/// The prefixes of the same for networks of other purposes.
const OF_PURPOSES: [(Purpose, &str, &str); 3] = [
    (Purpose::Comparison, RANDOM, RANDOM_PLACES),
    (Purpose::Validation, "random-validation:", "random-places-validation:"),
    (Purpose::Training, "random-training:", "random-places-training:"),
];
/// The networks that are compiled into the program, by name.
const SHIPPED: &[(&str, &str)] = &[
    ("paper", include_str!("../../../networks/paper.toml")),
    ("paper-quick", include_str!("../../../networks/paper-quick.toml")),
    ("disrupted", include_str!("../../../networks/disrupted.toml")),
    ("new-york", include_str!("../../../networks/new-york.toml")),
    ("new-york-quick", include_str!("../../../networks/new-york-quick.toml")),
    ("large", include_str!("../../../networks/large.toml")),
    ("as-coded", include_str!("../../../networks/as-coded.toml")),
    ("san-francisco", include_str!("../../../networks/san-francisco.toml")),
    ("los-angeles", include_str!("../../../networks/los-angeles.toml")),
    ("dallas", include_str!("../../../networks/dallas.toml")),
    ("paris", include_str!("../../../networks/paris.toml")),
];

/// A checked network: every day drawn from it is a valid [`Scenario`].
#[derive(Debug, Clone)]
pub struct Network {
    pub(crate) name: String,
    pub(crate) time_zone: Option<String>,
    /// The text that the network was read from.
    pub(crate) toml: String,
    /// The files that the network was read from.
    pub(crate) files: Vec<PathBuf>,
    /// Everything that is the same every day. The idle day has no passengers, and its aircraft
    /// stand anywhere that is allowed.
    pub(crate) idle_day: Scenario,
    /// The stands that start positions are drawn for, where they are not those of the vertiports.
    pub(crate) start_stands: Option<Vec<u16>>,
    /// The lowest and the highest share of its battery that an aircraft starts with, if batteries
    /// are not full.
    pub(crate) start_charge: Option<(f64, f64)>,
    pub(crate) demand: DemandModel,
    pub(crate) disturbances: DisturbanceModel,
    pub(crate) feature_scales: FeatureScales,
}

/// Reads the text of a network file with `read`, which gets the text, the folder and the name.
fn read_text<E>(
    path: &Path,
    read: impl FnOnce(&str, Option<&Path>, &str) -> Result<Network, E>,
) -> Result<Result<Network, E>, Error> {
    let origin = origin(path);
    let text = input::read_at_most(path, input::LONGEST_NETWORK)?;
    let text = parse::utf8(&text).map_err(|error| error.in_file(&origin))?;
    Ok(read(text, path.parent(), &origin).map(|mut network| {
        network.files.push(path.to_owned());
        network
    }))
}

impl Network {
    /// Reads and checks a network file.
    ///
    /// # Errors
    /// The file, or the table of demand that it names, cannot be read, is too long, or breaks a
    /// rule of the format. The message names the member.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        read_text(path.as_ref(), network_file::network)?
    }

    /// Reads a network file, or returns all its errors that can be found in one pass, for people
    /// who are writing one. The file is read once, so it may be a pipe.
    ///
    /// # Errors
    /// The file cannot be read, is no text, or is too long.
    pub fn read_or_findings(path: impl AsRef<Path>) -> Result<Result<Self, Vec<Error>>, Error> {
        read_text(path.as_ref(), network_file::network_or_findings)
    }

    /// Reads and checks the text of a network file, which must not name a table in another file.
    /// `origin` names the text in messages.
    ///
    /// # Errors
    /// The text is longer than 32 MiB or breaks a rule of the format; the message names the member.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, Error> {
        input::check_length(text.as_bytes(), input::LONGEST_NETWORK)
            .map_err(|error| error.in_file(origin))?;
        network_file::network(text, None, origin)
    }

    /// The shipped network of this name.
    #[expect(clippy::missing_panics_doc, reason = "a test reads every shipped network")]
    pub fn shipped(name: &str) -> Option<Self> {
        let (name, text) = SHIPPED.iter().find(|(shipped, _)| *shipped == name)?;
        let network = Self::from_toml(text, &format!("networks/{name}.toml"));
        Some(network.expect("a test reads every shipped network"))
    }

    /// The names of the shipped networks.
    pub fn shipped_names() -> impl ExactSizeIterator<Item = &'static str> {
        SHIPPED.iter().map(|(name, _)| *name)
    }

    /// Finds the shipped network of this name, the random comparison network of this number
    /// (`random:7`), the one of this number with a given number of vertiports at random places
    /// (`random-places:8:7`), the same for training or validation (`random-training:7`,
    /// `random-places-validation:8:7`), or else reads the network file at this path.
    ///
    /// # Errors
    /// [`Error::UnknownNetwork`] if it is none of these, and the errors of [`Network::read`].
    pub fn find(name_or_path: &str) -> Result<Self, Error> {
        if let Some(network) = Self::shipped(name_or_path) {
            return Ok(network);
        }
        for (purpose, random, places) in OF_PURPOSES {
            let number = name_or_path.strip_prefix(random).and_then(|number| number.parse().ok());
            if let Some(number) = number {
                return Ok(random_network(purpose, number));
            }
            let places = name_or_path.strip_prefix(places).and_then(|rest| rest.split_once(':'));
            if let Some((Ok(vertiports), Ok(number))) =
                places.map(|(vertiports, number)| (vertiports.parse(), number.parse()))
            {
                return random_places(purpose, vertiports, number);
            }
        }
        let path = Path::new(name_or_path);
        let looks_like_a_path = path.components().count() > 1 || path.extension().is_some();
        if looks_like_a_path || path.exists() {
            return Self::read(path);
        }
        let meant = nearest(name_or_path, Self::shipped_names());
        Err(Error::UnknownNetwork {
            name: parse::shortened(name_or_path, 64),
            shipped: Self::shipped_names().collect::<Vec<_>>().join(", "),
            meant: meant.map(|name| format!("did you mean {name}?")),
        })
    }

    /// The name by which [`find`](Self::find) finds the random comparison network of this number.
    pub fn random_name(number: u64) -> String {
        format!("{RANDOM}{number}")
    }

    /// The name by which [`find`](Self::find) finds the comparison network of this number with
    /// `vertiports` vertiports at random places.
    pub fn random_places_name(vertiports: usize, number: u64) -> String {
        format!("{RANDOM_PLACES}{vertiports}:{number}")
    }

    /// The network's name. The days drawn from it are called `{name}-{seed}`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The lowest and the highest share of its battery that an aircraft starts the day with; `None`
    /// if batteries are full then.
    pub fn start_charge(&self) -> Option<(f64, f64)> {
        self.start_charge
    }

    /// The purpose that the network was drawn for; `None` for networks that were not drawn, which
    /// serve every purpose.
    pub fn purpose(&self) -> Option<Purpose> {
        drawn_for(&self.name)
    }

    /// The time zone of the clocks of its vertiports by its name in the IANA database, for example
    /// `America/New_York`, if the file names one.
    pub fn time_zone(&self) -> Option<&str> {
        self.time_zone.as_deref()
    }

    /// The text of the network file, with the rows of its table of demand in it if it has one.
    /// Reading this text gives the same network.
    pub fn toml(&self) -> &str {
        &self.toml
    }

    /// The files that the network was read from: the network file and its table of demand. Empty
    /// for a shipped or random network.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The vertiports, in file order.
    pub fn vertiports(&self) -> &[Vertiport] {
        &self.idle_day.vertiports
    }

    /// The aircraft types, in file order.
    pub fn aircraft_types(&self) -> &[AircraftType] {
        &self.idle_day.aircraft_types
    }

    /// Number of aircraft of all types together.
    pub fn fleet_size(&self) -> usize {
        self.idle_day.aircraft.len()
    }

    /// The cost of the fleet, the stands and the chargers, which no decision changes; dollars a
    /// day.
    pub fn fixed_cost_usd(&self) -> f64 {
        self.idle_day.fixed_cost_usd()
    }

    /// Start of each demand period; the last one lasts for the rest of the day.
    pub fn period_starts(&self) -> &[Time] {
        &self.idle_day.periods
    }

    /// Number of demand periods.
    pub fn periods(&self) -> usize {
        self.idle_day.periods.len()
    }

    /// Times of operations, the same every day.
    pub fn operations(&self) -> &Operations {
        &self.idle_day.operations
    }

    /// The divisors of the features of learned policies.
    pub fn feature_scales(&self) -> FeatureScales {
        self.feature_scales
    }

    /// For each vertiport the probability of each delay of take-offs, in whole seconds from 0 on;
    /// `None` where no network setting makes flights late. The delays of slots and vertiports are
    /// independent.
    pub fn takeoff_delay_probabilities(&self) -> Option<Vec<Vec<f64>>> {
        self.disturbances.takeoff_delays.as_ref().map(DelayModel::probabilities)
    }

    /// Whether aircraft may be out of service for some time on a day of this network.
    pub fn may_have_outages(&self) -> bool {
        self.disturbances.outages.is_some()
    }

    /// The day on which everything is as its mean: demand is rounded to whole passengers, nothing
    /// is late, closed or out of service except for closures of every day, and aircraft stand
    /// anywhere that is allowed. For pictures and tables.
    pub fn mean_day(&self) -> Scenario {
        let mut day = self.idle_day.clone().into_day();
        day.name.clone_from(&self.name);
        for (table, means) in day.demand.iter_mut().zip(self.mean_demand()) {
            *table = Matrix::from_fn(means.size(), |from, to| to_whole(means[(from, to)]));
        }
        Scenario::checked(day)
    }

    /// Mean passengers by period (of Eq. 1 on `paper`), around which the demand of days is drawn.
    pub fn mean_demand(&self) -> Vec<Matrix<f64>> {
        self.demand.all_means(self.vertiports().len())
    }
}
