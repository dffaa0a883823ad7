//! Sizing: how many aircraft, stands and chargers a network should have.
//!
//! The search ([`Goal`]) goes over designs, each of which is the network with other numbers of
//! aircraft, stands and chargers. All designs meet the same days with common random numbers, as the
//! cells of a [sweep](crate::sweep) do. Bounds of a few designs bound all of them
//! ([`vertifleet_optimize::DesignBound`]), which shows where good designs are and proves how far
//! the best that was found can be from the best there is. No design one step from the best in one
//! number is better on the same days. The best is played again on days that the
//! search has not seen, because the best of many looks better than it is.

mod ceiling;
mod goal;
mod journal;
mod search;
mod solver;
mod space;
mod summary;

use std::path::Path;

use serde_json::{Value, json};
use vertifleet_core::{Matrix, Network, Scenario, Stop};
use vertifleet_optimize::Step;
use vertifleet_sim::DayTotals;

use crate::comparison::DrawnDays;
use crate::competitor::{Competitor, Selection};
use crate::error::Error;
use crate::journal::{Head, Journal, fingerprint, make_folder};
use crate::run::Kept;
use crate::study::{Study, Unwatched};
use crate::sweep::Factor;

use search::{Aim, search};
use solver::KnownDesigns;
use space::{Design, Space};

pub use goal::Goal;
pub use journal::{JOURNAL, JOURNAL_KIND};
pub use summary::{Certificate, DesignSummary, DimensionSummary, FORMAT, SizeReport};

/// The most designs that a search may play.
pub const MOST_DESIGNS: usize = 1_000;

/// What a search is asked for.
pub struct SizeRequest<'a> {
    /// The network whose numbers are searched.
    pub network: &'a Network,
    /// What may vary, and settings that are the same in every design.
    pub factors: Vec<Factor>,
    /// What is wanted.
    pub goal: Goal,
    /// The policy that plays the days: exactly one.
    pub selection: &'a Selection<'a>,
    /// The days of every design. As many that follow them tell how good the best design is.
    pub drawn: DrawnDays,
    /// The step of the bounds.
    pub bound_step: Step,
    /// The work of the search in designs that are played on all days. The neighbours of its answer
    /// are compared besides.
    pub designs: usize,
}

/// A search that is ready to begin. Everything that can be checked beforehand has been checked.
pub struct Sizing {
    space: Space,
    goal: Goal,
    competitor: Competitor,
    drawn: DrawnDays,
    again: DrawnDays,
    bound_step: Step,
    designs: usize,
    fingerprint: String,
}

impl Sizing {
    /// Reads the request.
    ///
    /// # Errors
    /// Returns an error if a factor leads nowhere or varies something else than aircraft, stands
    /// and chargers, if no design has an aircraft and a stand for it, if there is no such policy,
    /// or if it cannot play the days.
    pub fn new(request: SizeRequest<'_>) -> Result<Self, Error> {
        let SizeRequest { network, factors, goal, selection, drawn, bound_step, designs } = request;
        let again = DrawnDays { first: drawn.first.saturating_add(u64::from(drawn.days)), ..drawn };
        again.check()?;
        let competitors = selection.resolve(network.name())?;
        let policies = competitors.len();
        let days = drawn.days as usize;
        if days == 0 {
            return Err(Error::Empty { policies, days });
        }
        let [competitor] = <[Competitor; 1]>::try_from(competitors).map_err(|_| Error::Asked {
            rule: format!("one policy plays the days of a search, found {policies}"),
            hint: "give one name",
        })?;
        if !(2..=MOST_DESIGNS).contains(&designs) {
            return Err(Error::Asked {
                rule: format!("a search plays 2 to {MOST_DESIGNS} designs, found {designs}"),
                hint: "the network as it is is one of them, so ask for two at least, and for thousands by `vertifleet sweep`",
            });
        }
        let space = Space::new(network, &factors, goal)?;
        let fingerprint = String::new();
        let mut sizing =
            Self { space, goal, competitor, drawn, again, bound_step, designs, fingerprint };
        sizing.fingerprint = sizing.fingerprint();
        sizing.competitor.check_fits(&sizing.first_day()?)?;
        Ok(sizing)
    }

    /// The first day of the network as it is, for warnings.
    ///
    /// # Errors
    /// Returns an error if there is no such day.
    pub fn first_day(&self) -> Result<Scenario, Error> {
        Ok(self.space.network.draw(self.drawn.seed(0)?))
    }

    /// About how many designs are played on all days: those of the search at most, and the
    /// neighbours of its answer.
    pub fn designs(&self) -> usize {
        self.designs + 2 * self.space.dimensions.len()
    }

    /// The days that the designs of the search have.
    fn days_of_designs(&self) -> usize {
        self.designs * self.drawn.days as usize
    }

    /// A number that changes when anything changes that the results depend on.
    fn fingerprint(&self) -> String {
        let dimension = |one: &space::Dimension| json!([one.path, one.low, one.step, one.steps]);
        let policy = &self.competitor;
        let text = json!({
            "program": env!("CARGO_PKG_VERSION"),
            "network": self.space.network.toml(),
            "dimensions": self.space.dimensions.iter().map(dimension).collect::<Vec<Value>>(),
            "goal": self.goal.name(),
            "policy": [policy.name.clone(), policy.description()],
            "weights": policy.weights_sha256(),
            "days": [self.drawn.purpose.name(), self.drawn.first, self.drawn.days],
            "bound_step_s": self.bound_step.seconds(),
            "designs": self.designs,
        });
        fingerprint(&text)
    }

    /// Searches. What is found out of each design is in the folder, which is made if it is not
    /// there, before the next one, and what is there already is not found out again. `played` is
    /// called after each design that was played. With `force`, another search in the folder is
    /// replaced.
    ///
    /// # Errors
    /// Returns [`Error::CannotMakeFolder`], [`Error::OtherStudy`] if the folder holds another
    /// search, [`Error::Stopped`] soon after `stop` is requested, and an error if a day is too
    /// large for its bound or a policy cannot play one.
    pub fn run(
        &self,
        folder: &Path,
        command: String,
        force: bool,
        stop: &Stop,
        played: &mut dyn FnMut(),
    ) -> Result<SizeRecords, Error> {
        make_folder(folder)?;
        let head = Head { format: journal::FORMAT.to_owned(), study: self.fingerprint.clone() };
        let (journal, parts) = Journal::open(&folder.join(JOURNAL), &head, force, |_| true)?;
        let mut solver = KnownDesigns::new(self, &journal, parts, stop, played);
        let aim = self.aim(stop)?;
        let found = search(&self.space, &aim, self.designs, &mut solver)?;
        let report = SizeReport::of(self, command, &aim, &found, &mut solver)?;
        // A separate line, whatever the command holds.
        let made_by = report.command.replace(['\n', '\r'], " ");
        let best = format!(
            "# The design that was found by: {made_by}\n\n{}",
            self.space.network(&found.best)?.toml()
        );
        Ok(SizeRecords { report, best })
    }

    /// Plays days of a design.
    fn play_days(
        &self,
        design: &Design,
        drawn: DrawnDays,
        stop: &Stop,
    ) -> Result<Vec<DayTotals>, Error> {
        let network = self.space.network(design)?;
        let study = Study::new(vec![self.competitor.clone()], drawn.draw(&network, stop)?, None)?;
        let policies = study.play(Kept::Totals, stop, &Unwatched)?;
        Ok(policies[0].days.iter().map(|day| day.totals).collect())
    }

    /// The mean number of passengers a day who want to fly.
    fn wanted(&self, stop: &Stop) -> Result<f64, Error> {
        let days = self.drawn.draw(&self.space.network, stop)?;
        let cells = days.iter().flat_map(|day| &day.demand).flat_map(Matrix::cells);
        Ok(cells.map(|&passengers| f64::from(passengers)).sum::<f64>() / f64::from(self.drawn.days))
    }

    /// What is wanted. Where nothing costs anything, designs are compared by their aircraft, and by
    /// their stands where they have equally many.
    fn aim(&self, stop: &Stop) -> Result<Aim, Error> {
        let need = match self.goal {
            Goal::Served(share) => share * self.wanted(stop)?,
            Goal::MostProfit | Goal::LeastSpill => 0.0,
        };
        let of_size = |one: &space::Dimension| if one.is_aircraft() { 1.0 } else { 1e-3 };
        let costs = if self.has_costs() {
            self.space.costs_of_one_usd()
        } else {
            self.space.dimensions.iter().map(of_size).collect()
        };
        Ok(Aim { goal: self.goal, need, costs })
    }

    /// Whether anything that varies has a cost.
    fn has_costs(&self) -> bool {
        self.space.costs_of_one_usd().iter().any(|&cost| cost > 0.0)
    }
}

/// The outcome of a search.
pub struct SizeRecords {
    /// The numbers.
    pub report: SizeReport,
    /// The network file of the best design.
    pub best: String,
}
