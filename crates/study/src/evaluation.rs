//! An evaluation: policies on the days of a suite, measured as shares of the suite's certified
//! bounds, with a result file for each policy that others can verify.

mod result;
mod summary;
mod verify;

use vertifleet_core::Stop;

use crate::competitor::{Competitor, Selection};
use crate::error::Error;
use crate::record::PolicyRecord;
use crate::run::Kept;
use crate::study::{Study, Watch};
use crate::suite::{Suite, SuiteDay};

pub use result::{
    RESULT, RESULT_FORMAT, ResultDay, ResultFile, ResultPolicy, TrainingRun, check_runs,
};
pub use summary::{EvaluatedPolicy, EvaluationReport, FORMAT, SuiteReport};
pub use verify::{Verification, verify};
pub(crate) use verify::{can_be_drawn, verify_on};

/// A suite and the competitors that will play it. Everything that can be checked beforehand has
/// been checked.
pub struct Evaluation {
    suite: Suite,
    hashes: Vec<String>,
    study: Study,
    left_out: Vec<LeftOut>,
}

/// A policy that cannot play the days of a suite.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct LeftOut {
    /// Its name.
    pub policy: String,
    /// Why it cannot play them.
    pub reason: String,
}

impl Evaluation {
    /// Draws the days of a suite, and finds the policies. A policy that cannot play these days,
    /// because its weights belong to another network, is left out.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, if two policies have the same name, if no
    /// policy can play these days, or if the days are not the ones that were frozen;
    /// [`Error::Stopped`] soon after `stop` is requested.
    pub fn new(suite: Suite, selection: &Selection<'_>, stop: &Stop) -> Result<Self, Error> {
        let days = suite.draw(stop)?;
        let (competitors, left_out) = select(&suite, selection, &days)?;
        let hashes = days.iter().map(|day| day.hash.clone()).collect();
        let bound_step = if suite.is_frozen() { None } else { Some(suite.step()?) };
        let study = Study::new(competitors, days, bound_step)?;
        Ok(Self { suite, hashes, study, left_out })
    }

    /// Plays all days with every policy; `command` is the command line that the results record.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested, and an error if a policy cannot
    /// play a day to its end.
    pub fn run(
        self,
        command: String,
        stop: &Stop,
        watch: &impl Watch,
    ) -> Result<EvaluationRecords, Error> {
        let policies = self.study.play(Kept::Choices, stop, watch)?;
        let Self { suite, hashes, left_out, .. } = self;
        Ok(EvaluationRecords { suite, command, hashes, policies, left_out })
    }
}

/// The records of policies on the days of a suite.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationRecords {
    /// The suite.
    pub suite: Suite,
    /// The command line of the evaluation.
    pub command: String,
    /// The hash of each day.
    pub hashes: Vec<String>,
    /// The records of every policy, with bounds and choices. The other policies are measured
    /// against the first.
    pub policies: Vec<PolicyRecord>,
    /// The policies that cannot play these days.
    pub left_out: Vec<LeftOut>,
}

/// The policies that can play these days, and those that cannot.
fn select(
    suite: &Suite,
    selection: &Selection<'_>,
    days: &[SuiteDay],
) -> Result<(Vec<Competitor>, Vec<LeftOut>), Error> {
    let (mut competitors, mut left_out, mut first_error) = (Vec::new(), Vec::new(), None);
    for (policy, competitor) in selection.resolve_each(suite.home())? {
        let fits = |competitor: &Competitor| {
            days.iter().try_for_each(|day| competitor.check_fits(&day.scenario))
        };
        match competitor.and_then(|competitor| fits(&competitor).map(|()| competitor)) {
            Ok(competitor) => competitors.push(competitor),
            Err(error) if error.is_misfit() => {
                left_out.push(LeftOut { policy, reason: error.to_string() });
                first_error.get_or_insert(error);
            }
            Err(error) => return Err(error),
        }
    }
    match first_error {
        Some(error) if competitors.is_empty() => Err(error),
        _ => Ok((competitors, left_out)),
    }
}
