//! Worlds that days are drawn from: one network, or networks that are drawn too, a new one for each
//! day.

use std::sync::Arc;

use crate::{Error, Network, Purpose, RANDOM_PLACES, random_network, random_places};

/// The source that days are drawn from.
#[derive(Debug, Clone)]
pub enum World {
    /// One network.
    Network(Arc<Network>),
    /// Networks that differ in everything ([`random_network`]).
    Random,
    /// Networks like the paper's with this number of vertiports, at random places
    /// ([`random_places`]).
    RandomPlaces(usize),
}

const RANDOM: &str = "random";
const PLACES: &str = "random-places:";

impl World {
    /// Finds the world of this name: `random`, `random-places:8`, or a network as [`Network::find`]
    /// does.
    ///
    /// # Errors
    /// The errors of [`Network::find`], and [`Error::UnknownNetwork`] for a number of vertiports
    /// outside [`RANDOM_PLACES`](crate::RANDOM_PLACES).
    pub fn find(name: &str) -> Result<Self, Error> {
        if name == RANDOM {
            return Ok(Self::Random);
        }
        let vertiports = name.strip_prefix(PLACES).and_then(|size| size.parse().ok());
        match vertiports {
            Some(vertiports) if RANDOM_PLACES.contains(&vertiports) => {
                Ok(Self::RandomPlaces(vertiports))
            }
            Some(_) => Err(Error::UnknownNetwork {
                name: name.to_owned(),
                shipped: format!(
                    "{PLACES}{} to {PLACES}{}",
                    RANDOM_PLACES.start(),
                    RANDOM_PLACES.end()
                ),
                meant: None,
            }),
            None => Ok(Self::Network(Arc::new(Network::find(name)?))),
        }
    }

    /// The name of the network, or the one by which [`find`](Self::find) finds the world.
    pub fn name(&self) -> String {
        match self {
            Self::Network(network) => network.name().to_owned(),
            Self::Random => RANDOM.to_owned(),
            Self::RandomPlaces(vertiports) => format!("{PLACES}{vertiports}"),
        }
    }

    /// The number of vertiports of every day, if all days have the same.
    pub fn vertiports(&self) -> Option<usize> {
        match self {
            Self::Network(network) => Some(network.vertiports().len()),
            Self::Random => None,
            &Self::RandomPlaces(vertiports) => Some(vertiports),
        }
    }

    /// The network of the day of a purpose with this number. Networks of different purposes are
    /// never the same, unless there is only one.
    ///
    /// # Panics
    /// Never panics: numbers of vertiports were checked when the world was made by
    /// [`find`](Self::find).
    pub fn network(&self, purpose: Purpose, number: u64) -> Arc<Network> {
        match self {
            Self::Network(network) => Arc::clone(network),
            Self::Random => Arc::new(random_network(purpose, number)),
            &Self::RandomPlaces(vertiports) => {
                let network = random_places(purpose, vertiports, number);
                Arc::new(network.expect("a number of vertiports that can be drawn"))
            }
        }
    }
}

impl From<Arc<Network>> for World {
    fn from(network: Arc<Network>) -> Self {
        Self::Network(network)
    }
}

#[cfg(test)]
mod tests {
    use super::World;
    use crate::Purpose;

    #[test]
    fn worlds_are_found_by_their_names() {
        for (name, vertiports) in
            [("random", None), ("random-places:8", Some(8)), ("paper", Some(8))]
        {
            let world = World::find(name).expect("a world");
            assert_eq!((world.name(), world.vertiports()), (name.to_owned(), vertiports));
        }
        for wrong in ["random-places:1", "random-places:61", "nowhere"] {
            assert!(World::find(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn networks_that_are_drawn_belong_to_one_day_of_one_purpose() {
        let world = World::RandomPlaces(8);
        let network = |purpose, number| world.network(purpose, number).toml().to_owned();
        assert_eq!(network(Purpose::Training, 3), network(Purpose::Training, 3));
        assert_ne!(network(Purpose::Training, 3), network(Purpose::Training, 4));
        assert_ne!(network(Purpose::Training, 3), network(Purpose::Validation, 3));
    }
}
