//! The first days of a study as each policy played them, for a replay.

use std::sync::Arc;

use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_sim::{Simulation, Trace};

use crate::record::{Play, PolicyRecord, ReplayedDay};

/// The most days that the replay of a comparison shows.
pub(crate) const MOST_DAYS: usize = 3;
/// Fewer days are shown if there would be more decisions than this on all of them: about 4 MiB of
/// text. The first day is shown in any case.
const MOST_DECISIONS: usize = 60_000;

/// The first days of a study whose choices were kept. The choices are taken out of the records, so
/// that these are the same whatever is shown of them.
pub(crate) fn replayed(days: &[Arc<Scenario>], policies: &mut [PolicyRecord]) -> Vec<ReplayedDay> {
    let mut decisions = 0;
    let mut is_shown = |position: usize| {
        let of_day = |policy: &PolicyRecord| policy.days[position].choices.len();
        decisions += policies.iter().map(of_day).sum::<usize>();
        position == 0 || decisions <= MOST_DECISIONS
    };
    let days = days.iter().take(MOST_DAYS).enumerate();
    let shown = days.take_while(|(position, _)| is_shown(*position));
    let replay = |(position, scenario): (usize, &Arc<Scenario>)| ReplayedDay {
        scenario: Arc::clone(scenario),
        plays: policies.iter().map(|policy| Play::again(scenario, position, policy)).collect(),
    };
    let replayed = shown.map(replay).collect();
    for day in policies.iter_mut().flat_map(|policy| &mut policy.days) {
        day.choices = Vec::new();
    }
    replayed
}

impl Play {
    /// Takes the choices of a policy on a day once more.
    fn again(scenario: &Arc<Scenario>, position: usize, policy: &PolicyRecord) -> Self {
        let day = &policy.days[position];
        let mut simulation = Simulation::new(Arc::clone(scenario));
        let again = |&choice: &VertiportIx| {
            simulation.next_decision().expect("there was a decision for every choice");
            simulation.apply(choice).expect("what was possible then is possible again")
        };
        let trace = Trace { rows: day.choices.iter().map(again).collect() };
        Self { policy: policy.name.clone(), trace, profit_usd: day.totals.profit_usd }
    }
}
