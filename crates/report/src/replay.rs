//! The replay of days as a page: the flights of each policy, on a map and along the day, in one
//! HTML file that needs no other.

use serde::Serialize;
use serde_json::value::RawValue;
use vertifleet_sim::{Trace, TraceRow};
use vertifleet_study::record::{Play, ReplayedDay};

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
pub(crate) fn page(days: &[ReplayedDay]) -> String {
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

/// The trace with its amounts rounded to the displayed precision, which halves its size.
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
