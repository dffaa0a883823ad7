//! The networks from which days can be made: those that the program ships, and those that were
//! uploaded.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use vertifleet_core::{Matrix, Network, Vertiport};

use crate::error::Error;
use crate::moment::Moment;
use crate::store::{Kind, Store, StoredNetwork, Uploaded};

/// The number of networks that can be uploaded.
const MOST: usize = 1_000;

/// A network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub(crate) struct NetworkInfo {
    /// Its name.
    pub(crate) name: String,
    /// Whether the program ships it; the others were uploaded.
    pub(crate) is_shipped: bool,
    /// The time zone of its clocks by its name in the IANA database, if it has one.
    pub(crate) time_zone: Option<String>,
    /// Its vertiports, in the order of its file.
    pub(crate) vertiports: Vec<VertiportInfo>,
    /// The types of its aircraft.
    pub(crate) aircraft_types: Vec<String>,
    /// Number of aircraft.
    pub(crate) aircraft: usize,
    /// When operations start.
    pub(crate) start: Moment,
    /// The last time at which an aircraft may decide.
    pub(crate) end: Moment,
    /// The start of each period of demand.
    pub(crate) periods: Vec<Moment>,
    /// Mean passengers of a day.
    pub(crate) passengers: f64,
    /// Settings that are allowed but probably not intended.
    pub(crate) warnings: Vec<String>,
    /// The network file, if one network is read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) toml: Option<String>,
}

/// A vertiport of a network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub(crate) struct VertiportInfo {
    /// Its id.
    id: String,
    /// Position east, miles.
    x_mi: f64,
    /// Position north, miles.
    y_mi: f64,
    /// Latitude in degrees, if it is known.
    latitude: Option<f64>,
    /// Longitude in degrees, if it is known.
    longitude: Option<f64>,
    /// Its stands.
    stands: u16,
    /// Its chargers, if they are counted separately from stands.
    chargers: Option<u16>,
}

impl VertiportInfo {
    pub(crate) fn of(vertiport: &Vertiport) -> Self {
        let degrees = vertiport.degrees;
        Self {
            id: vertiport.id.clone(),
            x_mi: vertiport.x_mi,
            y_mi: vertiport.y_mi,
            latitude: degrees.map(|degrees| degrees.latitude),
            longitude: degrees.map(|degrees| degrees.longitude),
            stands: vertiport.stands,
            chargers: vertiport.chargers,
        }
    }
}

impl NetworkInfo {
    /// Describes a network.
    pub(crate) fn of(network: &Network, is_shipped: bool) -> Self {
        let mean = network.mean_demand();
        let operations = network.operations();
        Self {
            name: network.name().to_owned(),
            is_shipped,
            time_zone: network.time_zone().map(str::to_owned),
            vertiports: network.vertiports().iter().map(VertiportInfo::of).collect(),
            aircraft_types: network.aircraft_types().iter().map(|kind| kind.id.clone()).collect(),
            aircraft: network.fleet_size(),
            start: operations.start.into(),
            end: operations.end.into(),
            periods: network.period_starts().iter().copied().map(Moment::from).collect(),
            passengers: mean.iter().flat_map(Matrix::cells).sum(),
            warnings: network.warnings().iter().map(ToString::to_string).collect(),
            toml: None,
        }
    }
}

/// Parses the text of a network that a caller sends.
pub(crate) fn read(toml: &str) -> Result<Network, Error> {
    Ok(Network::from_toml(toml, "the network")?)
}

/// The network with a name, and whether the program ships it.
///
/// # Errors
/// Returns [`Error::NotFound`] if there is none.
pub(crate) async fn find(store: &Store, name: &str) -> Result<(Network, bool), Error> {
    if let Some(network) = Network::shipped(name) {
        return Ok((network, true));
    }
    let stored = store.network(name).await?.ok_or_else(|| Error::not_found("network", name))?;
    Ok((Network::from_toml(&stored.toml, name)?, false))
}

/// All networks: those that the program ships, then those that were uploaded.
///
/// # Errors
/// Returns [`Error::Store`] if they cannot be read.
pub(crate) async fn list(store: &Store) -> Result<Vec<NetworkInfo>, Error> {
    let shipped = Network::shipped_names().filter_map(Network::shipped);
    let mut networks: Vec<_> = shipped.map(|network| NetworkInfo::of(&network, true)).collect();
    for Uploaded { name, created_ms, description } in store.uploaded(Kind::Network).await? {
        let known = match description {
            Some(known) => Some(known),
            None => described(store, &name, created_ms).await?,
        };
        networks.extend(known);
    }
    Ok(networks)
}

/// Reads an uploaded network to describe it, and stores the description. `None` if the network is
/// gone.
async fn described(
    store: &Store,
    name: &str,
    created_ms: i64,
) -> Result<Option<NetworkInfo>, Error> {
    let Some(stored) = store.network(name).await? else { return Ok(None) };
    let info = NetworkInfo::of(&Network::from_toml(&stored.toml, name)?, false);
    store.describe(Kind::Network, name, created_ms, &info).await?;
    Ok(Some(info))
}

/// Stores a network under its name, and replaces one that was uploaded before. Existing days keep
/// the network that they were made from.
///
/// # Errors
/// Returns the errors of [`check`], [`Error::BadRequest`] if the name is another one or that of a
/// shipped network, and [`Error::TooMuch`].
pub(crate) async fn put(
    store: &Store,
    name: &str,
    toml: String,
    now_ms: i64,
) -> Result<NetworkInfo, Error> {
    let network = read(&toml)?;
    if network.name() != name {
        let rule =
            format!("the network is called {:?}, and the path names {name:?}", network.name());
        return Err(Error::BadRequest { rule });
    }
    if Network::shipped(name).is_some() {
        let rule = format!("{name:?} is the name of a network that the program ships");
        return Err(Error::BadRequest { rule });
    }
    if store.number_of_others(Kind::Network, name).await? >= MOST {
        return Err(Error::TooMuch { what: "networks", most: MOST as u64 });
    }
    let info = NetworkInfo::of(&network, false);
    let stored = StoredNetwork { name: name.to_owned(), toml, created_ms: now_ms };
    store.put_network(&stored, &info).await?;
    Ok(info)
}

#[cfg(test)]
mod tests {
    use vertifleet_core::Network;

    use super::{list, put};
    use crate::store::{Kind, Location, Store, Uploaded};

    #[tokio::test]
    async fn a_network_is_listed_as_it_was_uploaded_last() {
        let folder = tempfile::tempdir().expect("a folder");
        let location = Location::Folder(folder.path().to_owned());
        let store = Store::open(&location).await.expect("a store");
        let paper = Network::shipped("paper").expect("it is shipped").toml().to_owned();
        let ours = paper.replace("\"paper\"", "\"ours\"");
        let kept = put(&store, "ours", ours.clone(), 1).await.expect("it is kept");
        let listed = async || {
            let list = list(&store).await.expect("networks");
            list.into_iter().next_back().expect("ours is the last one")
        };
        assert_eq!(listed().await, kept);
        let described = async || {
            let uploaded: Vec<Uploaded<super::NetworkInfo>> =
                store.uploaded(Kind::Network).await.expect("networks");
            uploaded.into_iter().next().and_then(|ours| ours.description)
        };
        assert_eq!(described().await.as_ref(), Some(&kept), "to the last digit");
        // As a program without descriptions would store it.
        let other = ours.replace("count = 40", "count = 39");
        let stored =
            crate::store::StoredNetwork { name: "ours".to_owned(), toml: other, created_ms: 2 };
        store.put_network(&stored, &()).await.expect("it is kept");
        assert_eq!(described().await, None);
        assert_eq!((kept.aircraft, listed().await.aircraft), (40, 39));
        assert_eq!(
            described().await.map(|info| info.aircraft),
            Some(39),
            "it is kept for next time"
        );
    }
}
