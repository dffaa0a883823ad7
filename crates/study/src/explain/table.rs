//! The explanation as text for a terminal.

use vertifleet_picture::numbers::{grouped, signed};

use super::{AircraftUse, Explanation};
use crate::table::append_aligned;

/// Most pairs that are listed; JSON has all of them.
const MOST_PAIRS: usize = 10;

pub(super) fn text(explanation: &Explanation) -> String {
    let totals = &explanation.totals;
    let mut text = format!(
        "{} with {}: profit {} $, {:.1} % of the upper bound of {} $ (slices of {} min)\n\n",
        explanation.day,
        explanation.policy,
        grouped(totals.profit_usd, 2),
        100.0 * totals.profit_usd / explanation.upper_bound_usd.max(f64::MIN_POSITIVE),
        grouped(explanation.upper_bound_usd, 2),
        explanation.bound_step_s / 60,
    );
    append_aligned(&mut text, &ledger(explanation));
    text += "\ndemand by period\n";
    append_aligned(&mut text, &periods(explanation));
    text += "\nwhere most money is spilled\n";
    append_aligned(&mut text, &pairs(explanation, MOST_PAIRS));
    text += "\nvertiports\n";
    append_aligned(&mut text, &vertiports(explanation));
    text += "\naircraft, means by type\n";
    append_aligned(&mut text, &types(explanation));
    text += "\nwhat a change would be worth on this day, solved again\n";
    append_aligned(&mut text, &worth(explanation));
    text + "\nThe policy's difference is that of one day, which chance moves by more than most changes are worth: a sweep \
            measures changes over many days. The bound's is that of what is possible.\n"
}

fn cells(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|&text| text.to_owned()).collect()
}

/// Where the money comes from and goes to.
pub(super) fn ledger(explanation: &Explanation) -> Vec<Vec<String>> {
    let totals = &explanation.totals;
    let mut rows = vec![cells(&["ledger", "$", "share of revenue"])];
    let share = |usd: f64| {
        if totals.revenue_usd > 0.0 {
            format!("{:.1} %", 100.0 * usd / totals.revenue_usd)
        } else {
            String::new()
        }
    };
    for (name, usd) in [
        ("revenue", totals.revenue_usd),
        ("passenger cost", -totals.passenger_cost_usd),
        ("energy cost", -totals.energy_cost_usd),
        ("flight cost", -totals.flight_cost_usd),
        ("aircraft cost", -totals.aircraft_cost_usd),
        ("site cost", -totals.site_cost_usd),
        ("profit", totals.profit_usd),
    ] {
        if usd != 0.0 || name == "profit" {
            rows.push(vec![name.to_owned(), grouped(usd, 2), share(usd)]);
        }
    }
    rows
}

/// Demand served and spilled by period.
pub(super) fn periods(explanation: &Explanation) -> Vec<Vec<String>> {
    let head =
        ["from", "wanted", "carried", "spilled", "margin spilled, $", "flights", "empty", "holds"];
    let mut rows = vec![cells(&head)];
    rows.extend(explanation.periods.iter().map(|one| {
        vec![
            one.period.clone(),
            grouped(one.demand.wanted as f64, 0),
            grouped(one.demand.carried as f64, 0),
            grouped(one.demand.spilled as f64, 0),
            grouped(one.demand.spilled_margin_usd, 0),
            one.flights.to_string(),
            one.repositioning_flights.to_string(),
            one.holds.to_string(),
        ]
    }));
    rows
}

/// The pairs with the most money spilled.
pub(super) fn pairs(explanation: &Explanation, most: usize) -> Vec<Vec<String>> {
    let head = [
        "pair",
        "wanted",
        "carried",
        "spilled",
        "margin spilled, $",
        "flights",
        "empty",
        "profit, $",
    ];
    let mut rows = vec![cells(&head)];
    rows.extend(explanation.pairs.iter().take(most).map(|one| {
        vec![
            format!("{} -> {}", one.from, one.to),
            grouped(one.demand.wanted as f64, 0),
            grouped(one.demand.carried as f64, 0),
            grouped(one.demand.spilled as f64, 0),
            grouped(one.demand.spilled_margin_usd, 0),
            one.flights.to_string(),
            one.repositioning_flights.to_string(),
            grouped(one.profit_usd, 0),
        ]
    }));
    rows
}

/// How full the vertiports were.
pub(super) fn vertiports(explanation: &Explanation) -> Vec<Vec<String>> {
    let head =
        ["vertiport", "room", "departures", "arrivals", "taken", "full", "one more stand, $"];
    let mut rows = vec![cells(&head)];
    rows.extend(explanation.vertiports.iter().map(|one| {
        vec![
            one.id.clone(),
            one.room.to_string(),
            one.departures.to_string(),
            one.arrivals.to_string(),
            format!("{:.0} %", 100.0 * one.taken_share),
            format!("{:.0} % of the time", 100.0 * one.full_share),
            grouped(one.stand_shadow_price_usd, 0),
        ]
    }));
    rows
}

/// What aircraft did, as means by type.
pub(super) fn types(explanation: &Explanation) -> Vec<Vec<String>> {
    let head = [
        "type",
        "aircraft",
        "flights",
        "empty",
        "flying, h",
        "charging, h",
        "waiting, h",
        "profit, $",
    ];
    let mut rows = vec![cells(&head)];
    let mut kinds: Vec<&str> = explanation.aircraft.iter().map(|one| one.kind.as_str()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    for kind in kinds {
        let of_kind: Vec<&AircraftUse> =
            explanation.aircraft.iter().filter(|one| one.kind == kind).collect();
        let mean = |number: fn(&AircraftUse) -> f64| {
            of_kind.iter().map(|one| number(one)).sum::<f64>() / of_kind.len() as f64
        };
        rows.push(vec![
            kind.to_owned(),
            of_kind.len().to_string(),
            grouped(mean(|one| one.flights.into()), 1),
            grouped(mean(|one| one.repositioning_flights.into()), 1),
            grouped(mean(|one| one.flying_h), 1),
            grouped(mean(|one| one.charging_h), 1),
            grouped(mean(|one| one.waiting_h), 1),
            grouped(mean(|one| one.profit_usd), 0),
        ]);
    }
    rows
}

/// What changes are worth.
pub(super) fn worth(explanation: &Explanation) -> Vec<Vec<String>> {
    let mut rows = vec![vec![
        "change".to_owned(),
        format!("{}, $", explanation.policy),
        "bound, $".to_owned(),
    ]];
    rows.extend(explanation.worth.iter().map(|one| {
        let policy = one.policy_usd.map_or_else(|| "n/a".to_owned(), |usd| signed(usd, 0));
        vec![one.change.clone(), policy, signed(one.bound_usd, 0)]
    }));
    rows
}
