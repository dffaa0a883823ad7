//! The tables of a played day.

use vertifleet_picture::ledger_lines;
use vertifleet_picture::numbers::grouped;

use vertifleet_study::account::{Account, AircraftUse};

use crate::report::Table;

fn cells(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|&text| text.to_owned()).collect()
}

/// Where the money comes from and goes to.
pub(crate) fn ledger(account: &Account) -> Table {
    let lines = ledger_lines(account.scenario(), &account.trace().rows);
    let revenue_usd = lines[0].1;
    let share = |usd: f64| {
        if revenue_usd > 0.0 {
            format!("{:.1} %", 100.0 * usd / revenue_usd)
        } else {
            String::new()
        }
    };
    let mut rows = vec![cells(&["ledger", "$", "share of revenue"])];
    for (name, usd) in lines {
        rows.push(vec![name.to_owned(), grouped(usd, 2), share(usd)]);
    }
    Table { rows, best: Vec::new() }
}

/// Demand served and spilled by period.
pub(crate) fn periods(account: &Account) -> Table {
    let head =
        ["from", "wanted", "carried", "spilled", "margin spilled, $", "flights", "empty", "holds"];
    let mut rows = vec![cells(&head)];
    rows.extend(account.periods.iter().map(|one| {
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
    Table { rows, best: Vec::new() }
}

/// The pairs with the most money spilled, of those that can be flown.
pub(crate) fn pairs(account: &Account, most: usize) -> Table {
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
    let can_be_flown = account.pairs.iter().filter(|one| one.can_be_flown);
    rows.extend(can_be_flown.take(most).map(|one| {
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
    Table { rows, best: Vec::new() }
}

/// The pairs and periods with the most money spilled, of those that can be flown.
pub(crate) fn worst_cells(account: &Account, most: usize) -> Table {
    let mut rows =
        vec![cells(&["pair", "from", "wanted", "carried", "spilled", "margin spilled, $"])];
    let can_be_flown = account.spilled.iter().filter(|one| one.can_be_flown);
    rows.extend(can_be_flown.take(most).map(|one| {
        vec![
            format!("{} -> {}", one.from, one.to),
            one.period.clone(),
            grouped(one.demand.wanted as f64, 0),
            grouped(one.demand.carried as f64, 0),
            grouped(one.demand.spilled as f64, 0),
            grouped(one.demand.spilled_margin_usd, 0),
        ]
    }));
    Table { rows, best: Vec::new() }
}

/// How full the vertiports were, and what their stands are worth if that is known.
pub(crate) fn vertiports(account: &Account) -> Table {
    let is_worth_known = account.vertiports.iter().any(|one| one.stand_worth.is_some());
    let mut head = cells(&["vertiport", "room", "departures", "arrivals", "taken", "full"]);
    head.extend(is_worth_known.then(|| "one more stand before its cost, $".to_owned()));
    let mut rows = vec![head];
    rows.extend(account.vertiports.iter().map(|one| {
        let mut row = vec![
            one.id.clone(),
            one.room.to_string(),
            one.departures.to_string(),
            one.arrivals.to_string(),
            format!("{:.0} %", 100.0 * one.taken_share),
            format!("{:.0} % of the time", 100.0 * one.full_share),
        ];
        row.extend(one.stand_worth.as_ref().map(|worth| grouped(worth.stand_shadow_price_usd, 0)));
        row
    }));
    Table { rows, best: Vec::new() }
}

/// What aircraft did, as means by type. Time out of service has a column only where an outage kept
/// an aircraft on the ground.
pub(crate) fn types(account: &Account) -> Table {
    let has_outages = account.aircraft.iter().any(|one| one.out_of_service_h > 0.0);
    let mut head =
        cells(&["type", "aircraft", "flights", "empty", "flying, h", "charging, h", "waiting, h"]);
    head.extend(has_outages.then(|| "out of service, h".to_owned()));
    head.push("profit before aircraft cost, $".to_owned());
    let mut rows = vec![head];
    let mut kinds: Vec<&str> = account.aircraft.iter().map(|one| one.kind.as_str()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    for kind in kinds {
        let of_kind: Vec<&AircraftUse> =
            account.aircraft.iter().filter(|one| one.kind == kind).collect();
        let mean = |number: fn(&AircraftUse) -> f64| {
            of_kind.iter().map(|one| number(one)).sum::<f64>() / of_kind.len() as f64
        };
        let mut row = vec![
            kind.to_owned(),
            of_kind.len().to_string(),
            grouped(mean(|one| one.flights.into()), 1),
            grouped(mean(|one| one.repositioning_flights.into()), 1),
            grouped(mean(|one| one.flying_h), 1),
            grouped(mean(|one| one.charging_h), 1),
            grouped(mean(|one| one.waiting_h), 1),
        ];
        row.extend(has_outages.then(|| grouped(mean(|one| one.out_of_service_h), 2)));
        row.push(grouped(mean(|one| one.profit_usd), 0));
        rows.push(row);
    }
    Table { rows, best: Vec::new() }
}
