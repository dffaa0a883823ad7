//! The mean of the draws is the given mean, even where demand is thin, for every demand model but
//! Eq. 1, which rounds as in the paper.

use vertifleet_core::{DaySeed, Matrix, Network, Scenario, VertiportIx};

const SMALL: &str = include_str!("../data/small.toml");
const NEW_YORK: &str = include_str!("../../../../networks/new-york.toml");
const DAYS: u64 = 10_000;

/// The small network with another demand model.
fn with_demand(demand: &str) -> Network {
    let begin = SMALL.find("[demand]").expect("a demand model");
    let end = SMALL.find("[feature_scales]").expect("what follows it");
    let text = format!("{}{demand}\n\n{}", &SMALL[..begin], &SMALL[end..]);
    Network::from_toml(&text, "net.toml").expect("a valid network")
}

/// The passengers from A to B in the first period of each day.
fn drawn(network: &Network) -> Vec<f64> {
    let (from, to) = (VertiportIx::new(0), VertiportIx::new(1));
    let day = |number| network.draw(DaySeed::comparison(number).expect("a small seed"));
    (0..DAYS).map(|number| f64::from(day(number).demand[0][(from, to)])).collect()
}

/// Mean and variance.
fn moments(drawn: &[f64]) -> (f64, f64) {
    let count = drawn.len() as f64;
    let mean = drawn.iter().sum::<f64>() / count;
    let spread = drawn.iter().map(|one| (one - mean).powi(2)).sum::<f64>();
    (mean, spread / (count - 1.0))
}

#[test]
fn each_distribution_draws_the_mean_that_is_asked() {
    for (settings, variance) in [
        ("", (|mean| mean) as fn(f64) -> f64),
        ("distribution = \"poisson\"", |mean| mean),
        ("distribution = \"negative-binomial\"\ndispersion = 0.5", |mean| mean + 0.5 * mean * mean),
        ("distribution = \"negative-binomial\"\ndispersion = 3", |mean| mean + 3.0 * mean * mean),
        // These are the variance of the normal draw plus the most that rounding by chance adds.
        ("noise = 0", |_| 0.25),
        ("noise = 0.1", |mean| 0.01 * mean * mean + 0.25),
        ("distribution = \"normal\"\nnoise = 0.4", |mean| 0.16 * mean * mean + 0.25),
    ] {
        for mean in [0.05, 0.3, 1.0, 7.0, 60.0] {
            let passengers = format!(
                "{settings}\n[[hourly_demand.pairs]]\nfrom = \"A\"\nto = \"B\"\npassengers = [{mean}, 0]"
            );
            let hourly = "[hourly_demand]\nperiods = [\"06:00:00\", \"08:00:00\"]\n";
            let network = with_demand(&format!("{hourly}{passengers}"));
            let (found, found_variance) = moments(&drawn(&network));
            let most = variance(mean);
            let error = (most / DAYS as f64).sqrt();
            assert!((found - mean).abs() <= 4.0 * error, "{settings}: {mean} became {found}");
            assert!(found_variance <= 1.2 * most, "{settings}, {mean}: variance {found_variance}");
            if !settings.contains("noise") {
                assert!(found_variance >= 0.8 * most, "{settings}, {mean}: {found_variance}");
            }
        }
    }
}

#[test]
fn a_day_that_is_spread_over_hours_has_the_passengers_that_are_asked() {
    for settings in ["noise = 0.2", "", "distribution = \"negative-binomial\"\ndispersion = 1.5"] {
        let network = with_demand(&format!(
            "[daily_demand]\nperiods = [\"06:00:00\", \"08:00:00\"]\nshares_percent = [30, 70]\n{settings}\n\
             passengers = [[0, 1], [0.1, 0]]"
        ));
        let (found, variance) = moments(&drawn(&network));
        let error = (variance / DAYS as f64).sqrt();
        assert!((found - 0.3).abs() <= 4.0 * error, "{settings}: 0.3 became {found}");
    }
}

#[test]
fn uniform_demand_has_its_mean() {
    let network = with_demand("[uniform_demand]\nperiods = [\"06:00:00\"]\nleast = 0\nmost = 3");
    let (found, variance) = moments(&drawn(&network));
    assert!((found - 1.5).abs() <= 4.0 * (variance / DAYS as f64).sqrt(), "{found}");
}

/// A regression test: rounding to the nearest made 150 passengers a day 12, 400 became 230, and
/// 1,000 became 883.
#[test]
fn new_york_has_so_many_passengers_a_day_as_are_asked() {
    assert!(NEW_YORK.contains("passengers = 8000\n"));
    for asked in [150.0, 400.0, 1_000.0, 8_000.0] {
        let text = NEW_YORK.replace("passengers = 8000\n", &format!("passengers = {asked:.0}\n"));
        let network = Network::from_toml(&text, "net.toml").expect("a valid network");
        // 0.969 is the share of the hours of operations; the rest of the day is night.
        let asked = 0.969 * asked;
        let days: Vec<_> = (0..300)
            .map(|number| network.draw(DaySeed::comparison(number).expect("a small seed")))
            .collect();
        let total = |demand: &[Matrix<u32>]| -> f64 {
            demand.iter().flat_map(Matrix::cells).map(|&passengers| f64::from(passengers)).sum()
        };
        let forecast = |day: &Scenario| total(day.disturbances.forecast.as_ref().expect("one"));
        // In one hour of 50, demand from a vertiport surges by half.
        for (asked, all) in [
            (asked, days.iter().map(forecast).collect::<Vec<f64>>()),
            (1.01 * asked, days.iter().map(|day| total(&day.demand)).collect()),
        ] {
            let (found, variance) = moments(&all);
            let error = (variance / all.len() as f64).sqrt();
            assert!((found - asked).abs() <= 4.0 * error, "{asked} became {found}");
            assert!(error < 0.01 * asked, "enough days to tell: {error}");
        }
    }
}

/// A surge by 30 % turns 1 passenger into 1.3, which rounding to the nearest would turn into 1
/// again.
#[test]
fn a_surge_of_few_passengers_is_as_large_as_it_should_be() {
    for (forecast, noise) in [(1, 0.02), (2, 0.0), (3, 0.2)] {
        let network = with_demand(&format!(
            "[uniform_demand]\nperiods = [\"06:00:00\"]\nleast = {forecast}\nmost = {forecast}\n\n\
             [disturbances]\nforecast_error = {{ noise = {noise}, surge_probability = 1, surge_factor = 1.3 }}"
        ));
        let (found, variance) = moments(&drawn(&network));
        let (asked, error) = (1.3 * f64::from(forecast), (variance / DAYS as f64).sqrt());
        assert!((found - asked).abs() <= 4.0 * error, "{asked} became {found}");
    }
}

/// Products of such weights are 0, or have few digits.
#[test]
fn demand_by_gravity_depends_on_the_ratios_of_weights_only() {
    let weights = "weights = [3, 3, 2, 4, 3, 3, 1, 1, 1]";
    assert!(NEW_YORK.contains(weights));
    let drawn = |unit: f64| {
        let scaled = [3, 3, 2, 4, 3, 3, 1, 1, 1].map(|one| format!("{:e}", f64::from(one) * unit));
        let text = NEW_YORK.replacen(weights, &format!("weights = [{}]", scaled.join(", ")), 1);
        let network = Network::from_toml(&text, "gravity.toml").expect("a network");
        network.draw(DaySeed::comparison(1).expect("a small seed")).demand.clone()
    };
    let shipped = drawn(1.0);
    assert!(shipped[4].cells().iter().any(|&passengers| passengers > 0));
    for power in [-500, -530, -560, -1_000, 17] {
        assert!(drawn(2.0_f64.powi(power)) == shipped, "2^{power}");
    }
}
