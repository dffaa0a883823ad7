//! `vertifleet bound`: proves how much known days can earn at most.

use std::process::ExitCode;
use std::time::Instant;

use rayon::prelude::*;
use serde_json::{Value, json};
use vertifleet_core::Scenario;
use vertifleet_optimize::{Bound, Error, Step, upper_bound};
use vertifleet_study::OwnDays;

use crate::args::BoundArguments;
use crate::commands::{read_scenario, warn_of_days};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::mean_shadow_prices::{self, Mean};
use crate::output::print;
use crate::shadow_prices;

pub(crate) fn run(arguments: &BoundArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let step = Step::from_minutes(arguments.step)?;
    let (numbers, lines) = match &arguments.scenarios[..] {
        [one] if !one.is_dir() => {
            let scenario = read_scenario(one)?;
            let day = Day::bounded(&scenario, step)?;
            (day.numbers(), day.lines())
        }
        several => {
            let days = OwnDays::read(several)?;
            warn_of_days(days.days());
            let scenarios: Vec<&Scenario> = days.days().collect();
            let bounded = scenarios.into_par_iter().map(|scenario| Day::bounded(scenario, step));
            let bounded = bounded.collect::<Result<Vec<_>, _>>()?;
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
    seconds: f64,
}

impl<'a> Day<'a> {
    fn bounded(scenario: &'a Scenario, step: Step) -> Result<Self, Error> {
        let begun = Instant::now();
        let bound = upper_bound(scenario, step)?;
        Ok(Self { scenario, bound, seconds: begun.elapsed().as_secs_f64() })
    }

    fn numbers(&self) -> Value {
        let Self { scenario, bound, seconds } = self;
        json!({
            "name": scenario.name,
            "upper_bound_usd": bound.upper_bound_usd(),
            "step_s": bound.step_s(),
            "seconds": seconds,
            "stand_shadow_price_usd": shadow_prices::of_stands(scenario, bound),
            "charger_shadow_price_usd": shadow_prices::of_chargers(scenario, bound),
            "passenger_shadow_price_usd": shadow_prices::of_passengers(scenario, bound),
        })
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
        lines.extend(shadow_prices::lines(self.scenario, &self.bound));
        lines
    }
}

/// The mean bound of the days.
fn mean_bound(days: &[Day<'_>]) -> Mean {
    Mean::of(&days.iter().map(|day| day.bound.upper_bound_usd()).collect::<Vec<_>>())
}

/// The days as pairs of scenario and bound.
fn pairs<'a>(days: &'a [Day<'a>]) -> Vec<(&'a Scenario, &'a Bound)> {
    days.iter().map(|day| (day.scenario, &day.bound)).collect()
}

fn numbers_of_days(days: &[Day<'_>]) -> Value {
    let mut mean = mean_shadow_prices::numbers(&pairs(days));
    mean.insert("upper_bound_usd".to_owned(), mean_bound(days).number());
    json!({ "days": days.iter().map(Day::numbers).collect::<Vec<_>>(), "mean": mean })
}

fn lines_of_days(days: &[Day<'_>]) -> Vec<String> {
    let mut lines = vec!["no schedule earns more than".to_owned()];
    lines.extend(days.iter().map(|day| {
        let (name, bound_usd) = (&day.scenario.name, day.bound.upper_bound_usd());
        format!("  {name:<15} {bound_usd:>12.2} $    slices of {} min", day.bound.step_s() / 60)
    }));
    lines.push(format!("  {:<15} {}", "mean", mean_bound(days).text()));
    lines.extend(mean_shadow_prices::lines(&pairs(days)));
    lines
}
