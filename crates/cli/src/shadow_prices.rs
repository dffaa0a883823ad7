//! The shadow prices of stands and passengers as JSON and as lines of text. A shadow price is an
//! upper limit on the rise of the upper bound for one more stand or passenger.
//!
//! With one more stand or passenger, the same prices prove the bound plus its shadow price: no
//! schedule of that day earns more. If the bound of the changed day is proved again, it comes from
//! another search, and may be slightly above or below that.

use serde::Serialize;
use serde_json::{Map, Value, json};
use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_optimize::Bound;

/// Largest number of shadow prices of passengers in the lines of text.
pub(crate) const SHOWN_PASSENGERS: usize = 10;
/// The heading of the lines about stands.
pub(crate) const ALL_STANDS: &str =
    "with one more stand, all day, no schedule earns more than the bound and";
/// The heading of the lines about passengers.
pub(crate) const PASSENGERS: &str =
    "with one more passenger, no schedule earns more than the bound and";

/// The shadow price of one more stand all day, dollars by vertiport, in file order.
pub(crate) fn of_stands(scenario: &Scenario, bound: &Bound) -> Map<String, Value> {
    let price =
        |vertiport| (id(scenario, vertiport), json!(bound.stand_shadow_price_usd(vertiport)));
    VertiportIx::all(scenario.vertiports.len()).map(price).collect()
}

/// The shadow price of one more charger all day, dollars by vertiport, for the vertiports that have
/// separate chargers. The bound does not distinguish chargers from other stands, so this is the
/// shadow price of one more stand there.
pub(crate) fn of_chargers(scenario: &Scenario, bound: &Bound) -> Map<String, Value> {
    let separate = VertiportIx::all(scenario.vertiports.len())
        .filter(|vertiport| scenario.vertiports[vertiport.at()].chargers.is_some());
    let price =
        |vertiport| (id(scenario, vertiport), json!(bound.stand_shadow_price_usd(vertiport)));
    separate.map(price).collect()
}

/// The shadow price in dollars of one more passenger from `from` to `to` in the period that begins
/// at the time `period`, in the form that JSON output has.
#[derive(Serialize)]
pub(crate) struct PassengerShadowPrice<'a> {
    pub(crate) from: &'a str,
    pub(crate) to: &'a str,
    pub(crate) period: String,
    pub(crate) shadow_price_usd: f64,
}

/// The shadow price of one more passenger, by pair and period, highest first; pairs and periods
/// without one are left out.
pub(crate) fn of_passengers<'a>(
    scenario: &'a Scenario,
    bound: &Bound,
) -> Vec<PassengerShadowPrice<'a>> {
    let name = |at: VertiportIx| scenario.vertiports[at.at()].id.as_str();
    let entry = |Passenger { shadow_price_usd, period, from, to }| PassengerShadowPrice {
        from: name(from),
        to: name(to),
        period: scenario.periods[period].to_string(),
        shadow_price_usd,
    };
    passengers(scenario, bound).into_iter().map(entry).collect()
}

/// The prices of stands and of passengers as lines of text, highest first.
pub(crate) fn lines(scenario: &Scenario, bound: &Bound) -> Vec<String> {
    let mut lines = vec![ALL_STANDS.to_owned()];
    let mut stands: Vec<_> = VertiportIx::all(scenario.vertiports.len())
        .map(|vertiport| (bound.stand_shadow_price_usd(vertiport), vertiport))
        .collect();
    stands.sort_by(|one, other| other.0.total_cmp(&one.0));
    for (shadow_price_usd, vertiport) in stands {
        lines.push(format!("  {:<15} {shadow_price_usd:>12.2} $", id(scenario, vertiport)));
    }
    let passengers = passengers(scenario, bound);
    if !passengers.is_empty() {
        lines.push(PASSENGERS.to_owned());
    }
    for &Passenger { shadow_price_usd, period, from, to } in
        passengers.iter().take(SHOWN_PASSENGERS)
    {
        let pair = format!("{} -> {}", id(scenario, from), id(scenario, to));
        lines.push(format!(
            "  {pair:<15} {shadow_price_usd:>12.2} $  period from {}",
            scenario.periods[period]
        ));
    }
    lines.extend(more_passengers(passengers.len()));
    lines
}

/// A line with the number of shadow prices of passengers that are left out, if any are.
pub(crate) fn more_passengers(count: usize) -> Option<String> {
    let more = count.saturating_sub(SHOWN_PASSENGERS);
    (more > 0).then(|| format!("  and {more} more, which --json lists"))
}

struct Passenger {
    shadow_price_usd: f64,
    period: usize,
    from: VertiportIx,
    to: VertiportIx,
}

fn passengers(scenario: &Scenario, bound: &Bound) -> Vec<Passenger> {
    let size = scenario.vertiports.len();
    let mut prices: Vec<Passenger> = (0..scenario.periods.len())
        .flat_map(|period| VertiportIx::all(size).map(move |from| (period, from)))
        .flat_map(|(period, from)| VertiportIx::all(size).map(move |to| (period, from, to)))
        .map(|(period, from, to)| {
            let shadow_price_usd = bound.passenger_shadow_price_usd(period, from, to);
            Passenger { shadow_price_usd, period, from, to }
        })
        .filter(|passenger| passenger.shadow_price_usd > 0.0)
        .collect();
    prices.sort_by(|one, other| other.shadow_price_usd.total_cmp(&one.shadow_price_usd));
    prices
}

fn id(scenario: &Scenario, vertiport: VertiportIx) -> String {
    scenario.vertiports[vertiport.at()].id.clone()
}
