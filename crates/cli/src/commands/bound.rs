//! `vertifleet bound`: proves upper bounds on the profit of known days.

use std::process::ExitCode;
use std::time::Instant;

use rayon::prelude::*;
use serde_json::{Value, json};
use vertifleet_core::{Network, Scenario, Stop};
use vertifleet_optimize::{Bound, Error, Step, bound_without_foresight, upper_bound};
use vertifleet_study::OwnDays;

use crate::args::BoundArguments;
use crate::commands::{read_scenario, warn_unserved_days};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::mean_shadow_prices::{self, Mean};
use crate::output::print;
use crate::shadow_prices;

pub(crate) fn run(arguments: &BoundArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let step = Step::from_minutes(arguments.step)?.with_levels(arguments.levels)?;
    let network = arguments.without_foresight.as_deref().map(Network::find).transpose()?;
    let bounded = |scenario| Day::bounded(scenario, step, network.as_ref());
    let (numbers, lines) = match &arguments.scenarios[..] {
        [one] if !one.is_dir() => {
            let scenario = read_scenario(one)?;
            let day = bounded(&scenario)?;
            (day.numbers(), day.lines())
        }
        several => {
            let days = OwnDays::read(several)?;
            warn_unserved_days(days.days());
            let scenarios: Vec<&Scenario> = days.days().collect();
            let bounded = scenarios.into_par_iter().map(bounded).collect::<Result<Vec<_>, _>>()?;
            (numbers_of_days(&bounded), lines_of_days(&bounded))
        }
    };
    if arguments.json {
        print(&serde_json::to_string_pretty(&numbers).expect("numbers are plain data"))?;
    } else {
        print(&lines.join("\n"))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A day with its upper bound.
struct Day<'a> {
    scenario: &'a Scenario,
    bound: Bound,
    /// The bound without foresight, dollars, if it was requested.
    without_foresight_usd: Option<f64>,
    seconds: f64,
}

impl<'a> Day<'a> {
    fn bounded(scenario: &'a Scenario, step: Step, from: Option<&Network>) -> Result<Self, Error> {
        let begun = Instant::now();
        let bound = upper_bound(scenario, step)?;
        let without_foresight_usd = from
            .map(|network| {
                let bound = bound_without_foresight(&Stop::default(), network, scenario, step)?;
                let bound = bound.expect("it is not stopped");
                Ok::<f64, Error>(bound.upper_bound_usd())
            })
            .transpose()?;
        let seconds = begun.elapsed().as_secs_f64();
        Ok(Self { scenario, bound, without_foresight_usd, seconds })
    }

    fn numbers(&self) -> Value {
        let Self { scenario, bound, without_foresight_usd, seconds } = self;
        let mut numbers = json!({
            "name": scenario.name,
            "upper_bound_usd": bound.upper_bound_usd(),
            "step_s": bound.step_s(),
            "seconds": seconds,
            "stand_shadow_price_usd": shadow_prices::of_stands(scenario, bound),
            "charger_shadow_price_usd": shadow_prices::of_chargers(scenario, bound),
            "passenger_shadow_price_usd": shadow_prices::of_passengers(scenario, bound),
        });
        if let Some(usd) = without_foresight_usd {
            numbers["without_foresight_usd"] = json!(usd);
        }
        numbers
    }

    fn lines(&self) -> Vec<String> {
        let mut lines = vec![
            format!("{} bounded in {:.1} s", self.scenario.name, self.seconds),
            format!(
                "  upper bound     {:>12.2} $    no schedule earns more (slices of {} min)",
                self.bound.upper_bound_usd(),
                self.bound.step_s() / 60
            ),
        ];
        lines.extend(self.without_foresight_usd.map(|usd| {
            format!(
                "  no foresight    {usd:>12.2} $    only its mean over many days bounds anything"
            )
        }));
        lines.extend(shadow_prices::lines(self.scenario, &self.bound));
        lines
    }
}

/// The mean bound of the days.
fn mean_bound(days: &[Day<'_>]) -> Mean {
    Mean::of(&days.iter().map(|day| day.bound.upper_bound_usd()).collect::<Vec<_>>())
}

/// The mean bound without foresight, and its distance below the mean bound; `None` if it was not
/// requested.
fn mean_without_foresight(days: &[Day<'_>]) -> Option<(Mean, Mean)> {
    let without: Option<Vec<f64>> = days.iter().map(|day| day.without_foresight_usd).collect();
    let without = without.filter(|without| !without.is_empty())?;
    let below = days.iter().zip(&without).map(|(day, usd)| day.bound.upper_bound_usd() - usd);
    Some((Mean::of(&without), Mean::of(&below.collect::<Vec<_>>())))
}

/// The days as pairs of scenario and bound.
fn pairs<'a>(days: &'a [Day<'a>]) -> Vec<(&'a Scenario, &'a Bound)> {
    days.iter().map(|day| (day.scenario, &day.bound)).collect()
}

fn numbers_of_days(days: &[Day<'_>]) -> Value {
    let mut mean = mean_shadow_prices::numbers(&pairs(days));
    mean.insert("upper_bound_usd".to_owned(), mean_bound(days).number());
    if let Some((without, below)) = mean_without_foresight(days) {
        mean.insert("without_foresight_usd".to_owned(), without.number());
        mean.insert("foresight_usd".to_owned(), below.number());
    }
    json!({ "days": days.iter().map(Day::numbers).collect::<Vec<_>>(), "mean": mean })
}

fn lines_of_days(days: &[Day<'_>]) -> Vec<String> {
    let mut lines = vec!["no schedule earns more than".to_owned()];
    lines.extend(days.iter().map(|day| {
        let (name, bound_usd) = (&day.scenario.name, day.bound.upper_bound_usd());
        format!("  {name:<15} {bound_usd:>12.2} $    slices of {} min", day.bound.step_s() / 60)
    }));
    lines.push(format!("  {:<15} {}", "mean", mean_bound(days).text()));
    if let Some((without, below)) = mean_without_foresight(days) {
        lines.push(
            "no policy that learns of delays as they come earns more on the mean than".to_owned(),
        );
        lines.push(format!("  {:<15} {}", "mean", without.text()));
        lines.push(format!("  {:<15} {}", "less by", below.text()));
    }
    lines.extend(mean_shadow_prices::lines(&pairs(days)));
    lines
}
