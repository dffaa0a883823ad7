//! The network of the paper at other places, drawn from a number, as the public code of its authors
//! draws new ones for each day.

use std::fmt::Write;
use std::ops::RangeInclusive;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::generator;
use crate::{Error, Network, Purpose};

/// Side of the square that places are drawn from, miles (§V.A).
const SIDE_MI: f64 = 50.0;
/// No two vertiports are nearer to each other, miles.
const LEAST_DISTANCE_MI: f64 = 1.0;
/// Aircraft for each vertiport, as in `paper`.
const AIRCRAFT_PER_VERTIPORT: usize = 5;

/// The numbers of vertiports that [`random_places`] takes.
pub const RANDOM_PLACES: RangeInclusive<usize> = 2..=60;

/// Draws the places of `vertiports` vertiports, evenly over a square of 50 miles. All else is as in
/// `paper`: of 8 vertiports 3 are busy and there are 40 aircraft, and other numbers have as many in
/// proportion. Pairs that are more than 50 miles apart cannot be flown.
///
/// Different purposes never share a network, so a policy trained on some can be evaluated on
/// others.
///
/// # Errors
/// [`Error::UnknownNetwork`] for a number of vertiports outside [`RANDOM_PLACES`].
pub fn random_places(purpose: Purpose, vertiports: usize, number: u64) -> Result<Network, Error> {
    if !RANDOM_PLACES.contains(&vertiports) {
        return Err(Error::UnknownNetwork {
            name: format!("random-places:{vertiports}"),
            shipped: "random-places:2 to random-places:60".to_owned(),
            meant: None,
        });
    }
    let paper = Network::shipped("paper").expect("the paper's network is shipped");
    let (before, rest) = paper.toml().split_once("[[vertiports]]").expect("it has vertiports");
    let (_, after) = rest.split_once("[[aircraft_types]]").expect("it has aircraft");
    let name = format!("places-{vertiports}-{}-{number}", purpose.name());
    let mut text = before.replace("name = \"paper\"", &format!("name = \"{name}\""));
    let busy = (3 * vertiports).div_ceil(8);
    for (at, (x_mi, y_mi)) in places(&mut generator(purpose, number), vertiports).iter().enumerate()
    {
        write!(
            text,
            "[[vertiports]]\nid = \"V{number}\"\nx_mi = {x_mi:.1}\ny_mi = {y_mi:.1}\nstands = 6\nbusy = {busy}\n\n",
            number = at + 1,
            busy = at < busy,
        )
        .expect("memory takes everything");
    }
    text.push_str("[[aircraft_types]]");
    let fleet = format!("count = {}", AIRCRAFT_PER_VERTIPORT * vertiports);
    text.push_str(&after.replace("count = 40", &fleet));
    Ok(Network::from_toml(&text, &name).expect("every number drawn is within its bounds"))
}

fn places(random: &mut ChaCha8Rng, vertiports: usize) -> Vec<(f64, f64)> {
    let mut places: Vec<(f64, f64)> = Vec::with_capacity(vertiports);
    while places.len() < vertiports {
        let mut draw = || (10.0 * random.random_range(0.0..SIDE_MI)).round() / 10.0;
        let place = (draw(), draw());
        let is_apart =
            |other: &(f64, f64)| (other.0 - place.0).hypot(other.1 - place.1) >= LEAST_DISTANCE_MI;
        if places.iter().all(is_apart) {
            places.push(place);
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::{RANDOM_PLACES, random_places};
    use crate::{DaySeed, Network, Purpose};

    #[test]
    fn places_differ_and_all_else_is_as_in_the_paper() {
        let paper = Network::shipped("paper").expect("a shipped network");
        let one = random_places(Purpose::Training, 8, 1).expect("a number");
        let two = random_places(Purpose::Training, 8, 2).expect("a number");
        assert_eq!(one.toml(), random_places(Purpose::Training, 8, 1).expect("a number").toml());
        assert_ne!(one.vertiports(), two.vertiports());
        assert_eq!((one.fleet_size(), one.periods()), (paper.fleet_size(), paper.periods()));
        let busy = |network: &Network| network.toml().matches("busy = true").count();
        assert_eq!(busy(&one), busy(&paper));
        let other = random_places(Purpose::Validation, 8, 1).expect("a number");
        assert_ne!(one.vertiports(), other.vertiports());
    }

    #[test]
    fn every_size_gives_a_network() {
        for vertiports in RANDOM_PLACES {
            let network = random_places(Purpose::Comparison, vertiports, 7).expect("a size");
            assert_eq!(network.vertiports().len(), vertiports);
            network.draw(DaySeed::comparison(1).expect("a seed"));
        }
        assert!(random_places(Purpose::Comparison, 1, 7).is_err());
    }
}
