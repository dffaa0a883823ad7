//! Random networks whose days charge as needed, so that policies also learn on such days.
//!
//! A share of the networks to train on and to validate by is changed so. All other members stay as
//! they were drawn, but for batteries, which hold whole watt-hours: charges are counted in whole
//! milliwatt-hours. Comparison networks are never changed: suites refer to their days.

use rand::RngExt;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

use crate::{AircraftType, Network, Purpose};

/// The share of networks that charge as needed.
const SHARE: f64 = 1.0 / 3.0;

/// The network, or in a share of draws the same network with charging as needed. In half of those
/// draws each, power falls towards a full battery, flights leave a reserve, a turnaround takes
/// time, and aircraft start the day with part of their charge.
pub(super) fn with_charging(network: Network, purpose: Purpose, number: u64) -> Network {
    let Some(mut random) = generator(purpose, number) else { return network };
    if random.random_range(0.0..1.0) >= SHARE {
        return network;
    }
    let mut changes = vec![("operations.charging".to_owned(), json!("as_needed"))];
    let battery_kwh = |kind: &AircraftType| (1e3 * kind.battery_kwh).floor() / 1e3;
    for kind in network.aircraft_types() {
        changes.push((of_type(&kind.id, "battery_kwh"), json!(battery_kwh(kind))));
    }
    let half = |random: &mut ChaCha8Rng| random.random_range(0..2) == 0;
    if half(&mut random) {
        let (full, end) = (random.random_range(0.6..0.9), random.random_range(0.2..0.6));
        for kind in network.aircraft_types() {
            let kw = kind.charge_kw;
            let curve = json!([[0.0, kw], [full, kw], [1.0, end * kw]]);
            changes.push((of_type(&kind.id, "charge_curve"), curve));
        }
    }
    if half(&mut random) {
        let reserve = random.random_range(0.05..0.2);
        for kind in network.aircraft_types() {
            changes.push((of_type(&kind.id, "reserve_kwh"), json!(reserve * battery_kwh(kind))));
        }
    }
    if half(&mut random) {
        let turnaround_s = 60 * random.random_range(2..=10_u32);
        changes.push(("aircraft_types.*.turnaround_s".to_owned(), json!(turnaround_s)));
    }
    if half(&mut random) {
        let least = random.random_range(0.2..0.8);
        changes.push(("start_charge".to_owned(), json!([least, 1.0])));
    }
    let changes = changes.iter().map(|(path, value): &(String, Value)| (path, value));
    network.changed(changes).expect("every number drawn is within its bounds")
}

fn of_type(id: &str, member: &str) -> String {
    format!("aircraft_types.{id}.{member}")
}

/// The random stream of a number, separate from the one that the rest of the network is drawn from;
/// `None` for comparison networks.
fn generator(purpose: Purpose, number: u64) -> Option<ChaCha8Rng> {
    let stream = match purpose {
        Purpose::Comparison => return None,
        Purpose::Validation => 3,
        Purpose::Training => 4,
    };
    let mut random = ChaCha8Rng::seed_from_u64(number);
    random.set_stream(stream);
    Some(random)
}

#[cfg(test)]
mod tests {
    use crate::{Charging, DaySeed, Network, Purpose, random_city, random_network};

    fn charges_as_needed(network: &Network) -> bool {
        let seed = DaySeed::training(1, 1).expect("a seed");
        network.draw(seed).operations.charging == Charging::AsNeeded
    }

    #[test]
    fn a_third_of_the_networks_to_learn_from_charge_as_needed_and_no_comparison_network_does() {
        for draw in [random_network, random_city] {
            for (purpose, expected) in [
                (Purpose::Comparison, 0..=0),
                (Purpose::Validation, 70..=130),
                (Purpose::Training, 70..=130),
            ] {
                let networks = (0..300).map(|number| draw(purpose, number));
                let found = networks.filter(charges_as_needed).count();
                assert!(expected.contains(&found), "{purpose:?}: {found} of 300");
            }
        }
    }

    #[test]
    fn such_networks_differ_in_curves_reserves_turnarounds_and_start_charges() {
        let networks = (0..300).map(|number| random_network(Purpose::Training, number));
        let (mut seen, mut all) = ([0; 4], 0);
        for network in networks.filter(charges_as_needed) {
            all += 1;
            let kind = &network.aircraft_types()[0];
            let day = network.draw(DaySeed::training(1, 1).expect("a seed"));
            let starts = day.aircraft.iter().any(|one| one.start_charge_kwh.is_some());
            let differs = [
                kind.charge_curve.is_some(),
                kind.reserve_kwh > 0.0,
                kind.turnaround_s > 0,
                starts,
            ];
            for (seen, differs) in seen.iter_mut().zip(differs) {
                *seen += u32::from(differs);
            }
        }
        assert!(seen.iter().all(|&seen| 4 * seen > all && 4 * seen < 3 * all), "{seen:?} of {all}");
    }
}
