//! The replay of days as a page: what each policy did on them, on a map and along the day, in one
//! HTML file that needs no other.

use std::sync::Arc;

use serde::Serialize;
use serde_json::value::RawValue;
use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_sim::{Simulation, Trace, TraceRow};

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

#[derive(Serialize)]
struct Shown {
    days: Vec<ShownDay>,
}

#[derive(Serialize)]
struct ShownDay {
    name: String,
    scenario: Box<RawValue>,
    plays: Vec<ShownPlay>,
}

#[derive(Serialize)]
struct ShownPlay {
    policy: String,
    trace: String,
    profit_usd: f64,
}

/// The days as `web/src/replay/days.ts` reads them.
pub fn json(days: &[ReplayedDay]) -> String {
    let shown = Shown { days: days.iter().map(ShownDay::of).collect() };
    serde_json::to_string(&shown).expect("days can always be written")
}

/// The page that replays these days.
pub fn page(days: &[ReplayedDay]) -> String {
    let text = json(days);
    let vertiports = days.iter().flat_map(|day| day.scenario.vertiports.iter());
    let places: Vec<(f64, f64)> = vertiports
        .filter_map(|vertiport| vertiport.degrees)
        .map(|degrees| (degrees.latitude, degrees.longitude))
        .collect();
    vertifleet_console::replay_page(&text, &places)
}

impl ShownDay {
    fn of(day: &ReplayedDay) -> Self {
        let scenario = RawValue::from_string(day.scenario.to_json().trim().to_owned());
        let play = |play: &Play| ShownPlay {
            policy: play.policy.clone(),
            trace: to_the_cent(&play.trace).to_csv(&day.scenario),
            profit_usd: play.profit_usd,
        };
        Self {
            name: day.scenario.name.clone(),
            scenario: scenario.expect("a scenario is written as JSON"),
            plays: day.plays.iter().map(play).collect(),
        }
    }
}

/// The trace with its amounts rounded, which is what people look at and takes half the room.
fn to_the_cent(trace: &Trace) -> Trace {
    let rounded = |amount: f64| (amount * 100.0).round() / 100.0;
    let row = |row: &TraceRow| TraceRow {
        revenue_usd: rounded(row.revenue_usd),
        passenger_cost_usd: rounded(row.passenger_cost_usd),
        energy_kwh: rounded(row.energy_kwh),
        energy_cost_usd: rounded(row.energy_cost_usd),
        flight_cost_usd: rounded(row.flight_cost_usd),
        ..*row
    };
    Trace { rows: trace.rows.iter().map(row).collect() }
}
