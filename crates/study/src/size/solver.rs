//! Bounds designs and plays their days, and remembers what it has found out.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{Network, Scenario, Stop};
use vertifleet_optimize::{DesignBound, day_of_passengers, upper_bound_unless};
use vertifleet_sim::DayTotals;

use super::Sizing;
use super::ceiling::Cut;
use super::goal::Goal;
use super::journal::{Finding, Part};
use super::search::{DayNumbers, Solver};
use super::space::{Design, Dimension, DimensionKind, Space};
use crate::comparison::DrawnDays;
use crate::error::Error;
use crate::journal::Journal;

/// The solver of a search, with everything that was found out.
pub(super) struct KnownDesigns<'a> {
    sizing: &'a Sizing,
    journal: &'a Journal,
    stop: &'a Stop,
    /// Called after each design that was played.
    when_played: &'a mut dyn FnMut(),
    bounds: BTreeMap<Design, Cut>,
    days: BTreeMap<Design, Vec<DayTotals>>,
    again: BTreeMap<Design, Vec<DayTotals>>,
}

impl<'a> KnownDesigns<'a> {
    /// A solver that knows what the journal held.
    pub(super) fn new(
        sizing: &'a Sizing,
        journal: &'a Journal,
        parts: Vec<Part>,
        stop: &'a Stop,
        when_played: &'a mut dyn FnMut(),
    ) -> Self {
        let (bounds, days, again) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        let mut solver = Self { sizing, journal, stop, when_played, bounds, days, again };
        for part in parts {
            solver.remember(part);
        }
        solver
    }

    fn remember(&mut self, Part { design, found }: Part) {
        match found {
            Finding::Bound(cut) => drop(self.bounds.insert(design, cut)),
            Finding::Days(days) => drop(self.days.insert(design, days)),
            Finding::Again(days) => drop(self.again.insert(design, days)),
        }
    }

    fn keep(&mut self, design: &Design, found: Finding) -> Result<(), Error> {
        let part = Part { design: design.clone(), found };
        self.journal.add(&part)?;
        self.remember(part);
        Ok(())
    }

    /// The numbers of the days of a design that was played.
    pub(super) fn days(&self, design: &Design) -> &[DayTotals] {
        &self.days[design]
    }

    /// The numbers of the days of the search with the network file as it is, whether or not a
    /// design is the same.
    pub(super) fn days_as_it_is(&mut self) -> Result<&[DayTotals], Error> {
        // A design of no numbers changes nothing in the file.
        let as_it_is = Design::new();
        if !self.days.contains_key(&as_it_is) {
            let days = self.sizing.play_days(&as_it_is, self.sizing.drawn, self.stop)?;
            self.keep(&as_it_is, Finding::Days(days))?;
        }
        Ok(&self.days[&as_it_is])
    }

    /// The numbers of the days that follow.
    pub(super) fn again(&mut self, design: &Design) -> Result<&[DayTotals], Error> {
        if !self.again.contains_key(design) {
            let days = self.sizing.play_days(design, self.sizing.again, self.stop)?;
            self.keep(design, Finding::Again(days))?;
        }
        Ok(&self.again[design])
    }

    /// The sum of the bounds of all days.
    fn bound_days(&self, network: &Network) -> Result<DesignBound, Error> {
        let (sizing, stop) = (self.sizing, self.stop);
        let days = sizing.drawn.draw(network, stop)?;
        let bound = |day: &Arc<Scenario>| {
            let day = match sizing.goal {
                Goal::MostProfit => Scenario::clone(day),
                Goal::Served(_) | Goal::LeastSpill => day_of_passengers(day),
            };
            let bound = upper_bound_unless(stop, &day, sizing.bound_step)?.ok_or(Error::Stopped)?;
            Ok(bound.of_designs(&day, network.may_have_outages())?)
        };
        let bounds = days.par_iter().map(bound).collect::<Result<Vec<DesignBound>, Error>>()?;
        Ok(bounds.into_iter().sum())
    }
}

impl Solver for KnownDesigns<'_> {
    fn bound(&mut self, above: &Design) -> Result<Cut, Error> {
        if !self.bounds.contains_key(above) {
            let sizing = self.sizing;
            let space = sizing.space.with_all_numbers();
            let bound = self.bound_days(&space.network(above)?)?;
            let days = f64::from(sizing.drawn.days);
            let cut = cut_of(&space, &bound, days, sizing.goal == Goal::MostProfit);
            self.keep(above, Finding::Bound(cut))?;
        }
        Ok(self.bounds[above].clone())
    }

    fn days(&self) -> usize {
        self.sizing.drawn.days as usize
    }

    fn play(&mut self, designs: &[Design], days: usize) -> Result<Vec<Vec<DayNumbers>>, Error> {
        let (sizing, stop) = (self.sizing, self.stop);
        for some in designs.chunks(AT_ONCE) {
            let known = |design: &Design| self.days.get(design).map_or(0, Vec::len);
            let new: Vec<(&Design, usize)> = some.iter().map(|one| (one, known(one))).collect();
            let new = new.into_iter().filter(|&(_, known)| known < days);
            let new: Vec<(&Design, usize)> = new.collect();
            let played = new.par_iter().map(|&(design, known)| {
                sizing.play_days(design, days_between(sizing.drawn, known, days), stop)
            });
            let played = played.collect::<Result<Vec<Vec<DayTotals>>, Error>>()?;
            for ((design, _), more) in new.into_iter().zip(played) {
                let mut all = self.days.get(design).cloned().unwrap_or_default();
                all.extend(more);
                self.keep(design, Finding::Days(all))?;
            }
        }
        let numbers = |day: &DayTotals| DayNumbers {
            profit_usd: day.profit_usd,
            carried: day.passengers as f64,
        };
        Ok(designs
            .iter()
            .map(|design| {
                let played = &self.days[design][..days];
                if days == sizing.drawn.days as usize {
                    (self.when_played)();
                }
                played.iter().map(numbers).collect()
            })
            .collect())
    }
}

/// Designs that are played at once. What they are found to earn is in the journal before the next
/// ones.
const AT_ONCE: usize = 16;

/// Some of the days that are drawn.
fn days_between(drawn: DrawnDays, from: usize, to: usize) -> DrawnDays {
    let number = |day: usize| u32::try_from(day).expect("a search has fewer days");
    DrawnDays { first: drawn.first.saturating_add(from as u64), days: number(to - from), ..drawn }
}

/// The bound of the mean day as a function of how many there are of each thing above its lowest
/// number, after fixed costs where profit is wanted.
fn cut_of(space: &Space, bound: &DesignBound, days: f64, after_costs: bool) -> Cut {
    let lowest: Design = vec![0; space.dimensions.len()];
    let counts = space.counts(&lowest);
    let mut constant = bound.upper_bound_usd(&counts.aircraft, &counts.places()) / days;
    let slope = |one: &Dimension| match one.what {
        DimensionKind::Aircraft(kind) => bound.aircraft_shadow_price_usd(kind) / days,
        DimensionKind::Stands(at) | DimensionKind::Chargers(at) => {
            bound.place_shadow_price_usd(at) / days
        }
    };
    let mut slopes: Vec<f64> = space.dimensions.iter().map(slope).collect();
    if after_costs {
        constant -= space.fixed_cost_usd(&lowest);
        slopes.iter_mut().zip(space.costs_of_one_usd()).for_each(|(slope, cost)| *slope -= cost);
    }
    Cut { constant, slopes }
}
