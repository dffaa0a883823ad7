//! The numbers of a search: the design that was found, how it compares with the network as it is,
//! and how far it can be from the best.

use serde::Serialize;
use vertifleet_sim::DayTotals;

use super::goal::Goal;
use super::search::{Aim, Found};
use super::solver::KnownDesigns;
use super::space::{Design, DimensionKind};
use super::{Sizing, search};
use crate::error::Error;
use crate::statistics::{Estimate, mean};
use crate::sweep::Size;

/// The format of the numbers as JSON.
pub const FORMAT: &str = "vertifleet-size/1";

/// The numbers of a search.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SizeReport {
    /// [`FORMAT`].
    pub format: &'static str,
    /// The version of the program.
    pub program_version: &'static str,
    /// The command.
    pub command: String,
    /// The name of the network.
    pub network: String,
    /// The goal as it is typed.
    pub goal: String,
    /// The policy that played the days.
    pub policy: String,
    /// The seed or number of the first day.
    pub first_day: u64,
    /// The purpose of the days.
    pub split: &'static str,
    /// Days of each design.
    pub days: u32,
    /// The work of the search in designs that are played on all days, before it compares the
    /// neighbours of its answer.
    pub most_designs: usize,
    /// Whether the search ended because it had no days left.
    pub ended_early: bool,
    /// Number of days that were simulated, further days not counted.
    pub simulated_days: usize,
    /// Number of designs that differ from the one that was found by a step in one number; none of
    /// them is better on the days of the search.
    pub neighbours: usize,
    /// The length of the slices of the bounds in seconds.
    pub bound_step_s: u32,
    /// Passengers a day who want to fly.
    pub wanted_passengers: f64,
    /// Passengers a day who must be carried, if the goal is a share of them.
    pub needed_passengers: Option<f64>,
    /// Whether the design that was found carries as many.
    pub goal_is_reached: bool,
    /// What varied.
    pub dimensions: Vec<DimensionSummary>,
    /// Position in `designs` of the design that was found.
    pub best: usize,
    /// Position in `designs` of the one that is nearest to the network file.
    pub now: usize,
    /// The network file as it is, where no design is the same.
    pub left_out: Option<LeftOut>,
    /// The designs that were played on all days, in this order.
    pub designs: Vec<DesignSummary>,
    /// The design that was found, on days that the search has not seen.
    pub best_on_holdout: DesignSummary,
    /// The one that is nearest to the network file, on the same days.
    pub now_on_holdout: DesignSummary,
    /// By how much the first earns more than the second on these days, dollars.
    pub holdout_gain_usd: Option<Estimate>,
    /// How far the design that was found can be from the best.
    pub certificate: Certificate,
}

/// The network file as it is, on the days of the search: means a day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LeftOut {
    /// Profit, dollars.
    pub profit_usd: Estimate,
    /// Passengers carried as a share of those who wanted to fly; 1 if none did.
    pub served_share: f64,
    /// Whether it is better than the design that was found, by the goal.
    pub is_better: bool,
}

/// Something that designs have different numbers of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DimensionSummary {
    /// The member of the network file.
    pub member: String,
    /// The lowest number.
    pub lowest: u32,
    /// The highest number.
    pub highest: u32,
    /// From one number to the next.
    pub step: u32,
    /// The number in the network file.
    pub now: u32,
    /// The number in the design that was found.
    pub found: u32,
    /// What one more would add at most to what is wanted, after its cost: dollars a day or
    /// passengers a day.
    pub one_more_is_worth_at_most: f64,
}

/// A design that was played: means a day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignSummary {
    /// The numbers, by dimension.
    pub numbers: Vec<u32>,
    /// What its network has.
    pub size: Size,
    /// Profit, dollars.
    pub profit_usd: Estimate,
    /// Passengers carried.
    pub passengers: f64,
    /// Passengers who wanted to fly and were not carried.
    pub spilled_passengers: f64,
    /// Passengers carried as a share of those who wanted to fly; 1 if none did.
    pub served_share: f64,
    /// What it can earn at most, dollars, or, where passengers count, carry at most, on the days of
    /// the search; whatever decides.
    pub ceiling: f64,
}

/// How far the design that was found can be from the best of all, on the days of the search, under
/// any policy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "of", rename_all = "snake_case")]
pub enum Certificate {
    /// No design earns more.
    MostProfit {
        /// Dollars a day.
        no_design_earns_more_than_usd: f64,
        /// The design that was found is below this by this share.
        gap: f64,
    },
    /// No design carries more.
    MostPassengers {
        /// Passengers a day.
        no_design_carries_more_than: f64,
        /// The design that was found is below this by this share.
        gap: f64,
    },
    /// No design that carries enough costs less.
    LeastCost {
        /// Dollars a day for what varies and what does not.
        no_design_costs_less_than_usd: f64,
    },
    /// No design that carries enough has fewer aircraft.
    FewestAircraft {
        /// Number of aircraft.
        no_design_has_fewer_than: u32,
    },
    /// No design carries enough.
    OutOfReach {
        /// Passengers a day that no design passes.
        no_design_carries_more_than: f64,
    },
}

impl SizeReport {
    /// Computes the numbers of a search.
    pub(super) fn of(
        sizing: &Sizing,
        command: String,
        aim: &Aim,
        found: &Found,
        solver: &mut KnownDesigns<'_>,
    ) -> Result<Self, Error> {
        let start = &found.order[0];
        let summary = |design: &Design, days: &[DayTotals]| {
            let network = sizing.space.network(design)?;
            let ceiling = found.ceiling.at(&sizing.space.above(design));
            Ok(DesignSummary::of(sizing, design, Size::of(&network), days, ceiling))
        };
        let designs = found.order.iter().map(|one| summary(one, solver.days(one)));
        let designs = designs.collect::<Result<Vec<_>, Error>>()?;
        let best = found.order.iter().position(|one| *one == found.best).expect("it was played");
        let left_out = if sizing.space.leaves_file_out() {
            let network = sizing.space.network(&[])?;
            let days = solver.days_as_it_is()?;
            let file =
                DesignSummary::of(sizing, &Design::new(), Size::of(&network), days, f64::NAN);
            Some(LeftOut {
                is_better: is_better(sizing, aim, &file, &designs[best], found.reaches),
                profit_usd: file.profit_usd,
                served_share: file.served_share,
            })
        } else {
            None
        };
        let now_on_holdout = solver.again(start)?.to_vec();
        let best_on_holdout = solver.again(&found.best)?.to_vec();
        let differences: Vec<f64> = best_on_holdout
            .iter()
            .zip(&now_on_holdout)
            .map(|(best, now)| best.profit_usd - now.profit_usd)
            .collect();
        Ok(Self {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION"),
            command,
            network: sizing.space.network.name().to_owned(),
            goal: sizing.goal.name(),
            policy: sizing.competitor.name.clone(),
            first_day: sizing.drawn.first,
            split: sizing.drawn.purpose.name(),
            days: sizing.drawn.days,
            most_designs: sizing.designs,
            ended_early: sizing.days_of_designs()
                < found.searched_days + sizing.drawn.days as usize,
            simulated_days: found.simulated_days,
            neighbours: found.neighbours,
            bound_step_s: sizing.bound_step.seconds(),
            wanted_passengers: designs[0].passengers + designs[0].spilled_passengers,
            needed_passengers: matches!(sizing.goal, Goal::Served(_)).then_some(aim.need),
            goal_is_reached: found.reaches,
            dimensions: dimensions(sizing, found),
            best,
            now: 0,
            left_out,
            certificate: certificate(sizing, aim, found, &designs[best]),
            best_on_holdout: summary(&found.best, &best_on_holdout)?,
            now_on_holdout: summary(start, &now_on_holdout)?,
            holdout_gain_usd: (best != 0).then(|| Estimate::of(&differences)),
            designs,
        })
    }

    /// The design that was found.
    pub fn found(&self) -> &DesignSummary {
        &self.designs[self.best]
    }

    /// The design that is nearest to the network file.
    pub fn as_it_is(&self) -> &DesignSummary {
        &self.designs[self.now]
    }

    /// What the design is called that is nearest to the network file: the network as it is, if the
    /// numbers that are searched have it.
    pub fn name_of_start(&self) -> &'static str {
        let here = &self.as_it_is().numbers;
        let is_it = self.dimensions.iter().zip(here).all(|(one, &number)| one.now == number);
        if is_it { "as it is" } else { "nearest to now" }
    }

    /// What the design is called that was found.
    pub fn name_of_best(&self) -> &'static str {
        if self.goal_is_reached { "found" } else { "carries most" }
    }

    /// The numbers as JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain data")
    }
}

/// Worths below this, in dollars or passengers a day, are shown as 0.
const LEAST_WORTH: f64 = 0.05;

impl DimensionSummary {
    /// Whether what was found is the highest number that was searched, and one more might be better
    /// by anything that is shown.
    pub fn is_at_limit(&self) -> bool {
        self.found == self.highest && self.one_more_is_worth_at_most >= LEAST_WORTH
    }
}

impl DesignSummary {
    fn of(sizing: &Sizing, design: &Design, size: Size, days: &[DayTotals], ceiling: f64) -> Self {
        let average =
            |number: fn(&DayTotals) -> f64| mean(&days.iter().map(number).collect::<Vec<f64>>());
        let passengers = average(|day| day.passengers as f64);
        let spilled_passengers = average(|day| day.spilled_passengers as f64);
        let wanted = passengers + spilled_passengers;
        Self {
            numbers: sizing.space.numbers(design),
            size,
            profit_usd: Estimate::of(&days.iter().map(|day| day.profit_usd).collect::<Vec<f64>>()),
            passengers,
            spilled_passengers,
            served_share: if wanted > 0.0 { passengers / wanted } else { 1.0 },
            ceiling,
        }
    }
}

/// Whether the network file as it is is better than the design that was found, by the goal.
fn is_better(
    sizing: &Sizing,
    aim: &Aim,
    file: &DesignSummary,
    found: &DesignSummary,
    reaches: bool,
) -> bool {
    match sizing.goal {
        Goal::MostProfit => file.profit_usd.mean > found.profit_usd.mean,
        Goal::LeastSpill => file.passengers > found.passengers,
        Goal::Served(_) if !aim.reaches(file.passengers) => {
            !reaches && file.passengers > found.passengers
        }
        Goal::Served(_) if sizing.has_costs() => {
            !reaches || file.size.fixed_cost_usd < found.size.fixed_cost_usd
        }
        Goal::Served(_) => !reaches || file.size.aircraft < found.size.aircraft,
    }
}

fn dimensions(sizing: &Sizing, found: &Found) -> Vec<DimensionSummary> {
    let dimensions = sizing.space.dimensions.iter().zip(&found.best).enumerate();
    let above = sizing.space.above(&found.best);
    let summary =
        |(at, (one, &steps)): (usize, (&super::space::Dimension, &u32))| DimensionSummary {
            member: one.path.clone(),
            lowest: one.low,
            highest: one.number(one.steps),
            step: one.step,
            now: one.now,
            found: one.number(steps),
            one_more_is_worth_at_most: found.ceiling.slope(&above, at),
        };
    dimensions.map(summary).collect()
}

fn certificate(
    sizing: &Sizing,
    aim: &Aim,
    found: &search::Found,
    best: &DesignSummary,
) -> Certificate {
    let most = found.ceiling.most();
    let gap = |value: f64| vertifleet_optimize::gap(most, value);
    match sizing.goal {
        Goal::MostProfit => Certificate::MostProfit {
            no_design_earns_more_than_usd: most,
            gap: gap(best.profit_usd.mean),
        },
        Goal::LeastSpill => Certificate::MostPassengers {
            no_design_carries_more_than: most,
            gap: gap(best.passengers),
        },
        Goal::Served(_) if most < aim.need => {
            Certificate::OutOfReach { no_design_carries_more_than: most }
        }
        Goal::Served(_) if sizing.has_costs() => {
            let lowest = sizing.space.fixed_cost_usd(&vec![0; found.best.len()]);
            let least_usd = found.ceiling.least_cost(&aim.costs, aim.need);
            Certificate::LeastCost { no_design_costs_less_than_usd: lowest + least_usd }
        }
        Goal::Served(_) => {
            let dimensions = sizing.space.dimensions.iter();
            let aircraft = dimensions.map(|one| match one.what {
                DimensionKind::Aircraft(_) => 1.0,
                DimensionKind::Stands(_) | DimensionKind::Chargers(_) => 0.0,
            });
            let least = found.ceiling.least_cost(&aircraft.collect::<Vec<f64>>(), aim.need);
            let lowest =
                sizing.space.counts(&vec![0; found.best.len()]).aircraft.iter().sum::<u32>();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "few aircraft"
            )]
            let more = (least - 1e-6).ceil().max(0.0) as u32;
            Certificate::FewestAircraft { no_design_has_fewer_than: lowest + more }
        }
    }
}
