//! Warnings of demand that is probably unintended.

use std::cmp::Reverse;

use vertifleet_core::{Network, Operations, Time};

use crate::hourly_demand::HourlyDemand;
use crate::{Demand, Warning};

impl HourlyDemand {
    /// The warnings of a demand for a network with the hours of operation of `base`.
    pub(crate) fn warnings(&self, source: &Demand<'_>, base: &Network) -> Vec<Warning> {
        let operations = base.operations();
        let (origin, problems) = match source {
            Demand::Table(path) => {
                let problems =
                    [self.no_passengers(), self.long_period(operations), self.outside(base)];
                (path.display().to_string(), problems)
            }
            // The periods of trip records are the hours of operation.
            Demand::Trips(_) => ("the trip records".to_owned(), [self.no_passengers(), None, None]),
        };
        let warning = |problem| Warning::Demand { origin: origin.clone(), problem };
        problems.into_iter().flatten().map(warning).collect()
    }

    fn no_passengers(&self) -> Option<String> {
        let problem = "there are no passengers, so that no flight of any day earns a fare";
        (self.passengers() == 0.0).then(|| problem.to_owned())
    }

    /// The longest period, if it lasts longer than the distance of the two periods that begin
    /// soonest after each other. Its passengers are spread over hours that the table does not have.
    fn long_period(&self, operations: &Operations) -> Option<String> {
        let given = self.periods.get(self.first_given..)?;
        let usual = given.windows(2).map(|ends| ends[1].since(ends[0])).min()?;
        let ends = given.iter().skip(1).chain([&operations.end]);
        let spans = given.iter().zip(ends).map(|(begin, end)| (end.since(*begin), begin, end));
        // The first of the longest.
        let (length, begin, end) = spans.min_by_key(|(length, ..)| Reverse(*length))?;
        (length > usual).then(|| {
            let usual = Time::from_seconds(usual);
            format!(
                "the period {begin} lasts until {end}, and others last {usual}: if hours are missing, give them rows with 0 passengers"
            )
        })
    }

    /// The passengers whose period lies outside of the hours of operation.
    fn outside(&self, base: &Network) -> Option<String> {
        let Operations { start, end, .. } = *base.operations();
        let over = |at: usize| self.periods.get(at + 1).is_some_and(|next| *next <= start);
        let outside = |at: usize| self.periods[at] >= end || over(at);
        let of_pair = |means: &Vec<f64>| -> f64 {
            means.iter().enumerate().filter(|(at, _)| outside(*at)).map(|(_, mean)| mean).sum()
        };
        let passengers: f64 = self.pairs.values().map(of_pair).sum();
        let all = self.passengers();
        (passengers > 0.0).then(|| {
            format!(
                "{passengers:.1} of {all:.1} passengers a day want to fly outside the hours of operation of {}, {start} to {end}, and hardly any flight takes them",
                base.name()
            )
        })
    }
}
