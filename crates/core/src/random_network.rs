//! Networks drawn from a number, to train on, and to measure a policy on networks that it was not
//! trained on.
//!
//! They differ in every member of a network file: 5 to 30 vertiports, 10 to 150 aircraft,
//! distances, stands, seats, speeds, prices, and demand from half to ten times what the fleet could
//! carry. A third of those to learn from charge as needed (`random_network/charging.rs`).

mod charging;
mod city;
mod places;

use std::fmt::Write;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::{Network, Purpose};

use charging::with_charging;
pub use city::random_city;
pub use places::{RANDOM_PLACES, random_places};

/// Draws a network file and reads it. [`Network::find`] finds the random comparison networks by
/// `random:NUMBER`, and those of other purposes by `random-training:NUMBER` and
/// `random-validation:NUMBER`.
///
/// Different purposes never share a network, so a policy trained on some can be evaluated on
/// others.
pub fn random_network(purpose: Purpose, number: u64) -> Network {
    let text = text(purpose, number);
    let network = Network::from_toml(&text, "a random network");
    with_charging(network.expect("every number drawn is within its bounds"), purpose, number)
}

/// The text of the network file.
fn text(purpose: Purpose, number: u64) -> String {
    let mut random = generator(purpose, number);
    let vertiports = random.random_range(5..=30_usize);
    let fleet = random.random_range(10..=150_usize);
    let seats = random.random_range(2..=6_u32);
    let energy_kwh_per_mi = f64::from(seats) * random.random_range(0.35..0.6);
    let range_mi = random.random_range(40.0..70.0);
    let speed_mph = random.random_range(70.0..150.0);
    let hours = random.random_range(8..=14_u32);
    let mut text = format!(
        "format = \"vertifleet-network/1\"\nname = \"random-{kind}-{number}\"\nstart_positions = \"random\"\n\n\
         [operations]\nstart = \"06:00:00\"\nend = \"{end:02}:00:00\"\n\
         takeoff_s = {takeoff_s}\nlanding_s = {landing_s}\nhold_s = {hold_s}\n",
        kind = purpose.name(),
        end = 6 + hours,
        takeoff_s = random.random_range(180..=900_u32),
        landing_s = random.random_range(180..=900_u32),
        hold_s = 60 * random.random_range(5..=15_u32),
    );
    write_vertiports(&mut text, vertiports, fleet, &mut random);
    put(
        &mut text,
        format_args!(
            "\n[[aircraft_types]]\nid = \"aircraft\"\nseats = {seats}\nspeed_mph = {speed_mph}\n\
         battery_kwh = {battery_kwh}\nenergy_kwh_per_mi = {energy_kwh_per_mi}\ncharge_kw = {charge_kw}\n\
         self_discharge_per_h = 0\n\n[[fleet]]\ntype = \"aircraft\"\ncount = {fleet}\n\n\
         [tariffs]\npassenger_cost_usd_per_mi = {passenger_cost}\nfare_base = {fare_base}\n\
         fare_demand_weight = {fare_weight}\nenergy_price_usd_per_kwh = {energy_price}\n",
            battery_kwh = range_mi * energy_kwh_per_mi,
            charge_kw = random.random_range(80.0..300.0),
            passenger_cost = random.random_range(0.5..0.9),
            fare_base = random.random_range(1.8..2.6),
            fare_weight = random.random_range(0.0..1.0),
            energy_price = random.random_range(0.1..0.3),
        ),
    );
    write_demand(&mut text, vertiports, fleet, seats, hours, &mut random);
    text.push_str(
        "\n[feature_scales]\nstands = 6\npassengers = 300\nfare_usd = 40\npassenger_cost_usd = 20\n\
         energy_price_usd = 0.2\nbattery_kwh = 110\npower_kw = 65\n",
    );
    text
}

/// Writes vertiports in a square small enough for most pairs to be within range, with 1.1 to 1.6
/// stands for each aircraft in all.
fn write_vertiports(text: &mut String, vertiports: usize, fleet: usize, random: &mut ChaCha8Rng) {
    let side_mi = random.random_range(20.0..45.0);
    let stands = fleet as f64 * random.random_range(1.1..1.6);
    let weights: Vec<f64> = (0..vertiports).map(|_| random.random_range(0.5..1.5)).collect();
    let all: f64 = weights.iter().sum();
    let busy = random.random_range(1..=vertiports.div_ceil(2));
    for (at, weight) in weights.iter().enumerate() {
        put(
            text,
            format_args!(
                "\n[[vertiports]]\nid = \"V{number}\"\nx_mi = {x_mi:.1}\ny_mi = {y_mi:.1}\nstands = {stands}\nbusy = {busy}\n",
                number = at + 1,
                x_mi = random.random_range(0.0..side_mi),
                y_mi = random.random_range(0.0..side_mi),
                // Rounded up, so that the stands suffice together.
                stands = (stands * weight / all).ceil(),
                busy = at < busy,
            ),
        );
    }
}

/// Writes demand between half and ten times what the fleet can carry at about 0.8 flights an hour
/// for each aircraft.
fn write_demand(
    text: &mut String,
    vertiports: usize,
    fleet: usize,
    seats: u32,
    hours: u32,
    random: &mut ChaCha8Rng,
) {
    let capacity = 0.8 * fleet as f64 * f64::from(seats);
    let abundance = 0.5 * libm::pow(20.0, random.random_range(0.0..1.0));
    // The mean is at least enough for a flight to pay. Otherwise few aircraft among many vertiports
    // would find single passengers scattered over many pairs.
    let mean =
        (abundance * capacity / (vertiports * (vertiports - 1)) as f64).max(0.7 * f64::from(seats));
    let spread = random.random_range(0.1..0.4);
    let (busy, peak) = (random.random_range(1.0..2.5), random.random_range(1.5..4.0));
    let starts: Vec<String> = (6..=6 + hours).map(|hour| format!("\"{hour:02}:00:00\"")).collect();
    put(
        text,
        format_args!(
            "\n[demand]\nperiods = [{starts}]\nmorning_peak = \"08:00:00\"\nevening_peak = {evening}\n",
            starts = starts.join(", "),
            evening = starts[starts.len() - 3],
        ),
    );
    for (level, factor) in [("peak", peak), ("busy_pairs", busy), ("otherwise", 1.0)] {
        let mean = mean * factor;
        put(text, format_args!("{level} = {{ mean = {mean}, sd = {sd} }}\n", sd = mean * spread));
    }
}

/// Adds to a text.
fn put(text: &mut String, what: std::fmt::Arguments<'_>) {
    text.write_fmt(what).expect("memory takes everything");
}

/// The purpose that a network was drawn for, by its name: `random-training-7`,
/// `random-city-training-7` or `places-8-training-7`. `None` for other networks, which serve every
/// purpose.
pub(crate) fn drawn_for(network: &str) -> Option<Purpose> {
    let of_places = network.strip_prefix("places-").and_then(|rest| {
        let (vertiports, rest) = rest.split_once('-')?;
        is_number(vertiports).then_some(rest)
    });
    let rest = of_places.or_else(|| {
        let rest = network.strip_prefix("random-")?;
        Some(rest.strip_prefix("city-").unwrap_or(rest))
    })?;
    let (purpose, number) = rest.split_once('-')?;
    Purpose::named(purpose).filter(|_| is_number(number))
}

fn is_number(text: &str) -> bool {
    text.parse::<u64>().is_ok()
}

/// The random stream of a number; each purpose has separate streams.
fn generator(purpose: Purpose, number: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(number);
    random.set_stream(match purpose {
        Purpose::Comparison => 0,
        Purpose::Validation => 1,
        Purpose::Training => 2,
    });
    random
}

#[cfg(test)]
mod tests {
    use super::{drawn_for, random_city, random_network, random_places, text};
    use crate::{Coded, DaySeed, Network, Purpose};

    #[test]
    fn every_number_gives_a_network_within_what_is_promised() {
        for number in 0..200 {
            for purpose in Purpose::ALL {
                let network = random_network(purpose, number);
                let (vertiports, fleet) = (network.vertiports().len(), network.fleet_size());
                assert!((5..=30).contains(&vertiports) && (10..=150).contains(&fleet));
                let stands = network.vertiports().iter().map(|one| usize::from(one.stands));
                assert!(stands.sum::<usize>() > fleet);
            }
        }
    }

    #[test]
    fn the_random_network_of_a_number_is_found_by_its_name() {
        let seed = DaySeed::comparison(1).expect("a seed");
        let found = Network::find("random:7").expect("a random network");
        assert_eq!(found.draw(seed), random_network(Purpose::Comparison, 7).draw(seed));
        for name in ["random:", "random:-1", "random:seven"] {
            assert_eq!(Network::find(name).expect_err("no number").code().to_string(), "V119");
        }
    }

    #[test]
    fn networks_of_every_purpose_are_found_by_their_names_and_know_it() {
        let name = |purpose| match purpose {
            Purpose::Comparison => ("random", "random-places"),
            Purpose::Validation => ("random-validation", "random-places-validation"),
            Purpose::Training => ("random-training", "random-places-training"),
        };
        for purpose in Purpose::ALL {
            let (random, places) = name(purpose);
            let found = [format!("{random}:7"), format!("{places}:8:7")]
                .map(|name| Network::find(&name).expect("a random network"));
            let places = random_places(purpose, 8, 7).expect("8 vertiports");
            let drawn = [random_network(purpose, 7), places];
            assert_eq!(found.each_ref().map(Network::toml), drawn.each_ref().map(Network::toml));
            for network in found.iter().chain(&drawn).chain([&random_city(purpose, 7)]) {
                assert_eq!(network.purpose(), Some(purpose), "{}", network.name());
            }
        }
        for name in
            ["paper", "random-7", "random-training", "random-training-x", "places-training-7"]
        {
            assert_eq!(drawn_for(name), None, "{name}");
        }
        for name in ["random-training:", "random-testing:7", "random-places-training:7"] {
            assert_eq!(Network::find(name).expect_err("no network").code().to_string(), "V119");
        }
    }

    #[test]
    fn the_purpose_of_a_day_is_the_stricter_of_its_seed_and_its_network() {
        use Purpose::{Comparison, Training, Validation};
        let seed = |purpose| DaySeed::of_purpose(purpose, 3).expect("a seed");
        for (network, day, expected) in [
            (Comparison, Training, Comparison),
            (Comparison, Validation, Comparison),
            (Validation, Training, Validation),
            (Training, Validation, Validation),
            (Training, Comparison, Comparison),
            (Training, Training, Training),
        ] {
            let drawn = random_network(network, 7).draw(seed(day));
            assert_eq!(drawn.purpose(), expected, "{network:?}, {day:?}");
        }
        let paper = Network::shipped("paper").expect("a shipped network");
        for purpose in Purpose::ALL {
            assert_eq!(paper.draw(seed(purpose)).purpose(), purpose);
        }
    }

    #[test]
    fn a_number_means_one_network_and_another_for_each_purpose() {
        assert_eq!(text(Purpose::Training, 3), text(Purpose::Training, 3));
        let without_name = |purpose| {
            let text = text(purpose, 3);
            text.lines().filter(|line| !line.starts_with("name")).collect::<Vec<_>>().join("\n")
        };
        assert_ne!(without_name(Purpose::Training), without_name(Purpose::Comparison));
        assert_ne!(without_name(Purpose::Validation), without_name(Purpose::Comparison));
    }
}
