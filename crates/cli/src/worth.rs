//! The shadow prices of stands and passengers, which are what one more of them is worth at a bound's prices, as JSON
//! and as lines of text.
//!
//! With one more stand or passenger, the same prices prove the bound plus its worth: no schedule of that day earns
//! more. A bound that is proved anew comes from another search, and may be a little above or below that.

use serde::Serialize;
use serde_json::{Map, Value, json};
use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_optimize::Bound;

/// Number of pairs and periods in the lines of text.
pub(crate) const SHOWN_PASSENGERS: usize = 10;
/// The heading of the lines about stands.
pub(crate) const ALL_STANDS: &str =
    "with one more stand, all day, no schedule earns more than the bound and";
/// The heading of the lines about passengers.
pub(crate) const PASSENGERS: &str =
    "with one more passenger, no schedule earns more than the bound and";

/// The worth of one more stand all day, dollars by vertiport, in file order.
pub(crate) fn of_stands(scenario: &Scenario, bound: &Bound) -> Map<String, Value> {
    let worth = |vertiport| (id(scenario, vertiport), json!(bound.stand_worth_usd(vertiport)));
    VertiportIx::all(scenario.vertiports.len()).map(worth).collect()
}

/// The worth of one more charger all day, dollars by vertiport, for the vertiports that have chargers beside their
/// other stands. The bound does not tell the two apart, so this is the worth of one more stand there.
pub(crate) fn of_chargers(scenario: &Scenario, bound: &Bound) -> Map<String, Value> {
    let separate = VertiportIx::all(scenario.vertiports.len())
        .filter(|vertiport| scenario.vertiports[vertiport.at()].chargers.is_some());
    let worth = |vertiport| (id(scenario, vertiport), json!(bound.stand_worth_usd(vertiport)));
    separate.map(worth).collect()
}

/// The worth in dollars of one more passenger of a pair in the period that begins at a time, as it stands in JSON.
#[derive(Serialize)]
pub(crate) struct PassengerWorth<'a> {
    pub(crate) from: &'a str,
    pub(crate) to: &'a str,
    pub(crate) period: String,
    pub(crate) worth_usd: f64,
}

/// The worth of one more passenger, by pair and period, highest first; pairs and periods without a worth are left out.
pub(crate) fn of_passengers<'a>(scenario: &'a Scenario, bound: &Bound) -> Vec<PassengerWorth<'a>> {
    let name = |at: VertiportIx| scenario.vertiports[at.at()].id.as_str();
    let entry = |Passenger { worth_usd, period, from, to }| PassengerWorth {
        from: name(from),
        to: name(to),
        period: scenario.periods[period].to_string(),
        worth_usd,
    };
    passengers(scenario, bound).into_iter().map(entry).collect()
}

/// The worths of stands and of passengers as lines of text, highest first.
pub(crate) fn lines(scenario: &Scenario, bound: &Bound) -> Vec<String> {
    let mut lines = vec![ALL_STANDS.to_owned()];
    let mut stands: Vec<_> = VertiportIx::all(scenario.vertiports.len())
        .map(|vertiport| (bound.stand_worth_usd(vertiport), vertiport))
        .collect();
    stands.sort_by(|one, other| other.0.total_cmp(&one.0));
    for (worth_usd, vertiport) in stands {
        lines.push(format!("  {:<15} {worth_usd:>12.2} $", id(scenario, vertiport)));
    }
    let passengers = passengers(scenario, bound);
    if !passengers.is_empty() {
        lines.push(PASSENGERS.to_owned());
    }
    for &Passenger { worth_usd, period, from, to } in passengers.iter().take(SHOWN_PASSENGERS) {
        let pair = format!("{} -> {}", id(scenario, from), id(scenario, to));
        lines.push(format!(
            "  {pair:<15} {worth_usd:>12.2} $  period from {}",
            scenario.periods[period]
        ));
    }
    lines.extend(more_passengers(passengers.len()));
    lines
}

/// A line that says how many lines about passengers are left out, if any are.
pub(crate) fn more_passengers(count: usize) -> Option<String> {
    let more = count.saturating_sub(SHOWN_PASSENGERS);
    (more > 0).then(|| format!("  and {more} more, which --json lists"))
}

struct Passenger {
    worth_usd: f64,
    period: usize,
    from: VertiportIx,
    to: VertiportIx,
}

fn passengers(scenario: &Scenario, bound: &Bound) -> Vec<Passenger> {
    let size = scenario.vertiports.len();
    let mut worth: Vec<Passenger> = (0..scenario.periods.len())
        .flat_map(|period| VertiportIx::all(size).map(move |from| (period, from)))
        .flat_map(|(period, from)| VertiportIx::all(size).map(move |to| (period, from, to)))
        .map(|(period, from, to)| {
            let worth_usd = bound.passenger_worth_usd(period, from, to);
            Passenger { worth_usd, period, from, to }
        })
        .filter(|passenger| passenger.worth_usd > 0.0)
        .collect();
    worth.sort_by(|one, other| other.worth_usd.total_cmp(&one.worth_usd));
    worth
}

fn id(scenario: &Scenario, vertiport: VertiportIx) -> String {
    scenario.vertiports[vertiport.at()].id.clone()
}
