//! A network: what days are drawn from, all that is the same every day and how the rest is distributed.

use std::path::{Path, PathBuf};

use crate::demand_model::DemandModel;
use crate::disturbance_model::DisturbanceModel;
use crate::{
    AircraftType, Error, FeatureScales, Matrix, Operations, Purpose, Scenario, Vertiport, files,
    nearest, network_file, parse, random_network,
};

/// What stands before the number of a random network.
const RANDOM: &str = "random:";
/// The networks inside the program, by name.
const SHIPPED: &[(&str, &str)] = &[
    ("paper", include_str!("../../../networks/paper.toml")),
    ("disrupted", include_str!("../../../networks/disrupted.toml")),
    ("new-york", include_str!("../../../networks/new-york.toml")),
    ("as-coded", include_str!("../../../networks/as-coded.toml")),
];

/// A checked network: every day drawn from it is a valid [`Scenario`].
#[derive(Debug, Clone)]
pub struct Network {
    pub(crate) name: String,
    /// The text that it was read from.
    pub(crate) toml: String,
    /// The files that it was read from.
    pub(crate) files: Vec<PathBuf>,
    /// All that is the same every day. Its aircraft stand anywhere that is allowed, and it has no passengers.
    pub(crate) idle_day: Scenario,
    pub(crate) demand: DemandModel,
    pub(crate) disturbances: DisturbanceModel,
    pub(crate) feature_scales: FeatureScales,
}

impl Network {
    /// Reads and checks a network file.
    ///
    /// # Errors
    /// The file, or the table of demand that it names, cannot be read, is too long, or breaks a rule of the format; the
    /// message names the member.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let origin = files::origin(path);
        let text = files::read_at_most(path, files::LONGEST_NETWORK)?;
        let mut network =
            network_file::network(parse::utf8(&text, &origin)?, path.parent(), &origin)?;
        network.files.push(path.to_owned());
        Ok(network)
    }

    /// Reads and checks the text of a network file, which names no table beside it; `origin` stands for the file in
    /// messages.
    ///
    /// # Errors
    /// The text is longer than 32 MiB or breaks a rule of the format; the message names the member.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, Error> {
        files::check_length(text.as_bytes(), files::LONGEST_NETWORK, origin)?;
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

    /// The shipped network of this name, the random network for comparison of this number (`random:7`), or else the network
    /// file at this path.
    ///
    /// # Errors
    /// [`Error::UnknownNetwork`] if it is none of them, else as [`Network::read`].
    pub fn find(name_or_path: &str) -> Result<Self, Error> {
        if let Some(network) = Self::shipped(name_or_path) {
            return Ok(network);
        }
        let number = name_or_path.strip_prefix(RANDOM).and_then(|number| number.parse().ok());
        if let Some(number) = number {
            return Ok(random_network(Purpose::Comparison, number));
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

    /// The name by which [`find`](Self::find) knows the random network for comparison of this number.
    pub fn random_name(number: u64) -> String {
        format!("{RANDOM}{number}")
    }

    /// Its name; the days drawn from it are called `{name}-{seed}`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text of its network file, with the rows of its table of demand in it if it has one: reading it again gives the
    /// same network.
    pub fn toml(&self) -> &str {
        &self.toml
    }

    /// The files that it was read from: its own and its table of demand; none if it is a shipped or a random network.
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

    /// Aircraft of all types together.
    pub fn fleet_size(&self) -> usize {
        self.idle_day.aircraft.len()
    }

    /// Clock of every day.
    pub fn operations(&self) -> &Operations {
        &self.idle_day.operations
    }

    /// What learned policies divide their features by.
    pub fn feature_scales(&self) -> FeatureScales {
        self.feature_scales
    }

    /// The means of demand by period (of Eq. 1 on `paper`), passengers: what the days' draws scatter around.
    pub fn mean_demand(&self) -> Vec<Matrix<f64>> {
        let vertiports = self.vertiports().len();
        let means = |period| self.demand.means(period, vertiports);
        (0..self.demand.periods.len()).map(means).collect()
    }
}
