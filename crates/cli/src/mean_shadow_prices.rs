//! The mean shadow prices of stands and passengers over several days.

use serde_json::{Map, Value, json};
use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_optimize::Bound;
use vertifleet_study::statistics::{mean, standard_deviation};

use crate::shadow_prices::{self, ALL_STANDS, PASSENGERS, PassengerShadowPrice, SHOWN_PASSENGERS};

/// A mean over days.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mean {
    mean: f64,
    /// `None` for a single day.
    standard_error: Option<f64>,
}

impl Mean {
    pub(crate) fn of(values: &[f64]) -> Self {
        let deviation = standard_deviation(values);
        let standard_error = deviation.map(|deviation| deviation / (values.len() as f64).sqrt());
        Self { mean: mean(values), standard_error }
    }

    pub(crate) fn number(self) -> Value {
        json!({ "mean": self.mean, "standard_error": self.standard_error })
    }

    pub(crate) fn text(self) -> String {
        match self.standard_error {
            Some(error) => format!("{:>12.2} $    standard error {error:.2}", self.mean),
            None => format!("{:>12.2} $", self.mean),
        }
    }
}

/// The mean shadow price of one more stand, by vertiport.
fn of_stands(days: &[(&Scenario, &Bound)]) -> Vec<(String, Mean)> {
    let Some((first, _)) = days.first() else { return Vec::new() };
    let mean = |at: VertiportIx| {
        let prices: Vec<f64> =
            days.iter().map(|(_, bound)| bound.stand_shadow_price_usd(at)).collect();
        (first.vertiports[at.at()].id.clone(), Mean::of(&prices))
    };
    VertiportIx::all(first.vertiports.len()).map(mean).collect()
}

/// The mean shadow price of one more passenger, by pair and period, highest first. Only those with
/// a price above zero on some day are listed. A day on which the price is zero, or which has no
/// such period, counts as zero.
fn of_passengers(days: &[(&Scenario, &Bound)]) -> Vec<([String; 3], Mean)> {
    let mut prices: Vec<([String; 3], Vec<f64>)> = Vec::new();
    let mut places = std::collections::BTreeMap::new();
    for (number, (scenario, bound)) in days.iter().enumerate() {
        for PassengerShadowPrice { from, to, period, shadow_price_usd } in
            shadow_prices::of_passengers(scenario, bound)
        {
            let key = [from.to_owned(), to.to_owned(), period];
            let place = *places.entry(key.clone()).or_insert_with(|| {
                prices.push((key, vec![0.0; days.len()]));
                prices.len() - 1
            });
            prices[place].1[number] = shadow_price_usd;
        }
    }
    let mut means: Vec<_> =
        prices.into_iter().map(|(key, prices)| (key, Mean::of(&prices))).collect();
    means.sort_by(|one, other| {
        other.1.mean.total_cmp(&one.1.mean).then_with(|| one.0.cmp(&other.0))
    });
    means
}

/// The means as JSON.
pub(crate) fn numbers(days: &[(&Scenario, &Bound)]) -> Map<String, Value> {
    let separate = |id: &str| {
        days.iter().any(|(day, _)| {
            day.vertiports.iter().any(|place| place.id == id && place.chargers.is_some())
        })
    };
    let stands = of_stands(days);
    let by_id = |kept: &dyn Fn(&str) -> bool| -> Map<String, Value> {
        let kept = stands.iter().filter(|(id, _)| kept(id));
        kept.map(|(id, mean)| (id.clone(), mean.number())).collect()
    };
    let passengers = of_passengers(days).into_iter().map(|([from, to, period], mean)| {
        json!({
            "from": from,
            "to": to,
            "period": period,
            "mean": mean.mean,
            "standard_error": mean.standard_error,
        })
    });
    let numbers = [
        ("stand_shadow_price_usd", json!(by_id(&|_| true))),
        ("charger_shadow_price_usd", json!(by_id(&separate))),
        ("passenger_shadow_price_usd", passengers.collect()),
    ];
    numbers.map(|(name, number)| (name.to_owned(), number)).into_iter().collect()
}

/// The means as lines of text, highest first.
pub(crate) fn lines(days: &[(&Scenario, &Bound)]) -> Vec<String> {
    let mut stands = of_stands(days);
    stands.sort_by(|one, other| other.1.mean.total_cmp(&one.1.mean));
    let mut lines = vec![format!("{ALL_STANDS}, in the mean")];
    lines.extend(stands.iter().map(|(id, mean)| format!("  {id:<15} {}", mean.text())));
    let passengers = of_passengers(days);
    if !passengers.is_empty() {
        lines.push(format!("{PASSENGERS}, in the mean"));
    }
    lines.extend(passengers.iter().take(SHOWN_PASSENGERS).map(|([from, to, period], mean)| {
        format!("  {:<15} {}, period from {period}", format!("{from} -> {to}"), mean.text())
    }));
    lines.extend(shadow_prices::more_passengers(passengers.len()));
    lines
}
