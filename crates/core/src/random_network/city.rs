//! Networks like those of real cities, drawn from a number, to train on.
//!
//! [`random_network`](crate::random_network) draws networks whose flights are mostly full. In
//! cities a pair has a few passengers an hour, spread by gravity and drawn one by one; two types of
//! aircraft fly; energy and fares may change with the hour; and days go wrong.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::charging::with_charging;
use super::{generator, put};
use crate::{Network, Purpose};

/// The share of a day's passengers in each hour from 6 on, percent: those of `new-york`.
const SHARES_PERCENT: [f64; 17] =
    [3.2, 7.7, 5.9, 4.5, 5.1, 5.9, 6.2, 6.0, 6.6, 7.7, 7.8, 8.6, 7.4, 5.6, 4.1, 3.1, 1.5];
/// The first hour of the day.
const FIRST_HOUR: usize = 6;

/// Draws a network of 5 to 40 vertiports and 10 to 200 aircraft, and reads it.
///
/// Different purposes never share a network, so a policy trained on some can be evaluated on
/// others.
pub fn random_city(purpose: Purpose, number: u64) -> Network {
    let text = text(purpose, number);
    let network = Network::from_toml(&text, "a random city");
    with_charging(network.expect("every number drawn is within its bounds"), purpose, number)
}

/// The text of the network file.
fn text(purpose: Purpose, number: u64) -> String {
    let mut random = generator(purpose, number);
    let vertiports = random.random_range(5..=40_usize);
    let fleet = random.random_range(2 * vertiports..=5 * vertiports);
    let hours = random.random_range(12..=SHARES_PERCENT.len());
    let mut text = format!(
        "format = \"vertifleet-network/1\"\nname = \"random-city-{kind}-{number}\"\nstart_positions = \"random\"\n\n\
         [operations]\nstart = \"{FIRST_HOUR:02}:00:00\"\nend = \"{end:02}:00:00\"\n\
         takeoff_s = {stay_s}\nlanding_s = {stay_s}\nhold_s = {hold_s}\n",
        kind = purpose.name(),
        end = FIRST_HOUR + hours,
        stay_s = 60 * random.random_range(3..=8_u32),
        hold_s = 300 * random.random_range(1..=3_u32),
    );
    write_vertiports(&mut text, vertiports, fleet, &mut random);
    write_fleet(&mut text, fleet, &mut random);
    write_tariffs(&mut text, hours, &mut random);
    write_demand(&mut text, (vertiports, fleet), hours, &mut random);
    if random.random_range(0.0..1.0) < 0.7 {
        write_disturbances(&mut text, vertiports, &mut random);
    }
    text
}

/// Vertiports in a square of 20 to 70 miles, with 1.2 to 2.2 stands for each aircraft in all.
fn write_vertiports(text: &mut String, vertiports: usize, fleet: usize, random: &mut ChaCha8Rng) {
    let side_mi = random.random_range(20.0..70.0);
    let stands = fleet as f64 * random.random_range(1.2..2.2) / vertiports as f64;
    for at in 1..=vertiports {
        let (x_mi, y_mi) = (random.random_range(0.0..side_mi), random.random_range(0.0..side_mi));
        let stands = (stands * random.random_range(0.6..1.4)).ceil();
        put(
            text,
            format_args!(
                "\n[[vertiports]]\nid = \"V{at}\"\nx_mi = {x_mi:.1}\ny_mi = {y_mi:.1}\nstands = {stands}\nbusy = false\n",
            ),
        );
    }
}

/// One or two types, which differ in speed and battery.
fn write_fleet(text: &mut String, fleet: usize, random: &mut ChaCha8Rng) {
    let types = random.random_range(1..=2_usize);
    let seats = random.random_range(3..=5_u32);
    for kind in 0..types {
        let range_mi = random.random_range(60.0..110.0);
        let energy_kwh_per_mi = random.random_range(1.2..2.2);
        put(
            text,
            format_args!(
                "\n[[aircraft_types]]\nid = \"type-{kind}\"\nseats = {seats}\nspeed_mph = {speed_mph}\n\
                 battery_kwh = {battery_kwh}\nenergy_kwh_per_mi = {energy_kwh_per_mi}\ncharge_kw = {charge_kw}\n\
                 self_discharge_per_h = 0\n\n[[fleet]]\ntype = \"type-{kind}\"\ncount = {count}\n",
                speed_mph = random.random_range(100.0..200.0),
                battery_kwh = range_mi * energy_kwh_per_mi,
                charge_kw = random.random_range(120.0..350.0),
                count = (fleet + kind) / types,
            ),
        );
    }
}

/// Fares by the mile, of which half of the cities have higher ones in their peaks, and a price of
/// energy, which half of them have by the hour.
fn write_tariffs(text: &mut String, hours: usize, random: &mut ChaCha8Rng) {
    put(
        text,
        format_args!(
            "\n[tariffs]\npassenger_cost_usd_per_mi = {passenger_cost}\nfare_usd_per_mi = {fare}\n\
             boarding_fee_usd = {boarding}\nfare_base = 0\nfare_demand_weight = 0\nflight_cost_usd = {flight}\n",
            passenger_cost = random.random_range(0.5..1.5),
            fare = random.random_range(2.5..6.0),
            boarding = random.random_range(0.0..30.0),
            flight = random.random_range(0.0..40.0),
        ),
    );
    let by_hour = |usual: f64, then: f64, when: &dyn Fn(usize) -> bool| {
        let of = |hour| if when(hour) { then } else { usual }.to_string();
        (FIRST_HOUR..FIRST_HOUR + hours).map(of).collect::<Vec<_>>().join(", ")
    };
    if random.random_range(0..2) == 0 {
        let factor = random.random_range(1.1..1.4);
        let is_peak = |hour| matches!(hour, 7 | 8 | 16..=18);
        put(text, format_args!("fare_factors = [{}]\n", by_hour(1.0, factor, &is_peak)));
    }
    let price_usd = random.random_range(0.08..0.3);
    if random.random_range(0..2) == 0 {
        let dear_usd = price_usd * random.random_range(1.2..2.0);
        let prices = by_hour(price_usd, dear_usd, &|hour| (12..20).contains(&hour));
        put(text, format_args!("energy_price_usd_per_kwh = [{prices}]\n"));
    } else {
        put(text, format_args!("energy_price_usd_per_kwh = {price_usd}\n"));
    }
}

/// 40 to 140 passengers a day for each aircraft, by gravity, who decide independently.
fn write_demand(
    text: &mut String,
    (vertiports, fleet): (usize, usize),
    hours: usize,
    random: &mut ChaCha8Rng,
) {
    let list = |items: Vec<String>| items.join(", ");
    let periods = (FIRST_HOUR..FIRST_HOUR + hours).map(|hour| format!("\"{hour:02}:00:00\""));
    let shares = SHARES_PERCENT[..hours].iter().map(f64::to_string);
    let weights =
        (0..vertiports).map(|_| format!("{:.1}", libm::pow(10.0, random.random_range(0.0..1.0))));
    let (weights, passengers) =
        (list(weights.collect()), fleet as f64 * random.random_range(40.0..140.0));
    put(
        text,
        format_args!(
            "\n[daily_demand]\nperiods = [{periods}]\nshares_percent = [{shares}]\ndistribution = \"poisson\"\n\n\
             [daily_demand.gravity]\npassengers = {passengers}\nweights = [{weights}]\n",
            periods = list(periods.collect()),
            shares = list(shares.collect()),
        ),
    );
}

/// Errors of the forecast, late take-offs, closures around a vertiport, and aircraft out of
/// service.
fn write_disturbances(text: &mut String, vertiports: usize, random: &mut ChaCha8Rng) {
    put(
        text,
        format_args!(
            "\n[disturbances.forecast_error]\nnoise = {noise}\nsurge_probability = {surges}\nsurge_factor = 1.5\n\n\
             [disturbances.takeoff_delays]\nslot_s = 900\nvertiports = [\n",
            noise = random.random_range(0.1..0.3),
            surges = random.random_range(0.0..0.05),
        ),
    );
    for at in 1..=vertiports {
        let probability = random.random_range(0.05..0.25);
        put(
            text,
            format_args!(
                "    {{ at = \"V{at}\", probability = {probability}, mean_s = 300, most_s = 900 }},\n"
            ),
        );
    }
    let centre = random.random_range(1..=vertiports);
    let routes = (1..=vertiports).filter(|&at| at != centre && at % 3 == centre % 3);
    let routes = routes
        .map(|at| format!("    {{ from = \"V{centre}\", to = \"V{at}\", both_ways = true }},\n"));
    let routes: String = routes.collect();
    put(text, format_args!("]\n"));
    if !routes.is_empty() {
        put(
            text,
            format_args!(
                "\n[[disturbances.closures]]\nprobability = {probability}\nleast_s = 2700\nmost_s = 10800\nroutes = [\n{routes}]\n",
                probability = random.random_range(0.1..0.5),
            ),
        );
    }
    put(
        text,
        format_args!(
            "\n[disturbances.outages]\nprobability = {probability}\nleast_s = 3600\nmost_s = 10800\n",
            probability = random.random_range(0.01..0.06),
        ),
    );
}

#[cfg(test)]
mod tests {
    use super::{random_city, text};
    use crate::{DaySeed, Purpose};

    #[test]
    fn every_number_gives_a_network_whose_days_can_be_drawn() {
        let seed = DaySeed::training(1, 1).expect("a seed");
        for number in 0..200 {
            for purpose in Purpose::ALL {
                let network = random_city(purpose, number);
                let (vertiports, fleet) = (network.vertiports().len(), network.fleet_size());
                assert!((5..=40).contains(&vertiports) && (10..=200).contains(&fleet));
                let stands = network.vertiports().iter().map(|one| usize::from(one.stands));
                assert!(stands.sum::<usize>() > fleet);
                assert_eq!(network.draw(seed).aircraft.len(), fleet);
            }
        }
    }

    #[test]
    fn a_number_means_one_city_and_another_for_each_purpose() {
        assert_eq!(text(Purpose::Training, 3), text(Purpose::Training, 3));
        let without_name = |purpose| {
            let text = text(purpose, 3);
            text.lines().filter(|line| !line.starts_with("name")).collect::<Vec<_>>().join("\n")
        };
        assert_ne!(without_name(Purpose::Training), without_name(Purpose::Validation));
    }
}
