//! The tables of a played day.

use vertifleet_picture::ledger_lines;
use vertifleet_picture::numbers::grouped;
use vertifleet_study::account::{Account, AircraftUse, Loss};

use crate::report::Table;

/// The ledger: revenue, costs and profit.
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
    let rows = lines.into_iter();
    Table::new(["ledger", "$", "share of revenue"])
        .with_rows(rows.map(|(name, usd)| vec![name.to_owned(), grouped(usd, 2), share(usd)]))
}

/// The columns of demand.
const DEMAND: [&str; 4] = ["wanted", "carried", "spilled", "margin spilled, $"];

/// The cells of demand.
fn demand(demand: &Loss) -> [String; 4] {
    [
        grouped(demand.wanted as f64, 0),
        grouped(demand.carried as f64, 0),
        grouped(demand.spilled as f64, 0),
        grouped(demand.spilled_margin_usd, 0),
    ]
}

/// Demand served and spilled by period.
pub(crate) fn periods(account: &Account) -> Table {
    let columns = ["from"].into_iter().chain(DEMAND).chain(["flights", "empty", "holds"]);
    Table::new(columns).with_rows(account.periods.iter().map(|one| {
        let mut row = vec![one.period.clone()];
        row.extend(demand(&one.demand));
        row.extend(
            [one.flights, one.repositioning_flights, one.holds].map(|count| count.to_string()),
        );
        row
    }))
}

/// The pairs with the most money spilled, among those that can be flown.
pub(crate) fn pairs(account: &Account, most: usize) -> Table {
    let columns = ["pair"].into_iter().chain(DEMAND).chain(["flights", "empty", "profit, $"]);
    let can_be_flown = account.pairs.iter().filter(|one| one.can_be_flown);
    Table::new(columns).with_rows(can_be_flown.take(most).map(|one| {
        let mut row = vec![format!("{} -> {}", one.from, one.to)];
        row.extend(demand(&one.demand));
        row.extend([one.flights, one.repositioning_flights].map(|count| count.to_string()));
        row.push(grouped(one.profit_usd, 0));
        row
    }))
}

/// The pairs and periods with the most money spilled, among those that can be flown.
pub(crate) fn worst_cells(account: &Account, most: usize) -> Table {
    let can_be_flown = account.spilled.iter().filter(|one| one.can_be_flown);
    Table::new(["pair", "from"].into_iter().chain(DEMAND)).with_rows(can_be_flown.take(most).map(
        |one| {
            let mut row = vec![format!("{} -> {}", one.from, one.to), one.period.clone()];
            row.extend(demand(&one.demand));
            row
        },
    ))
}

/// How full the vertiports were, and the value of one more stand if it was computed.
pub(crate) fn vertiports(account: &Account) -> Table {
    let is_worth_known = account.vertiports.iter().any(|one| one.stand_worth.is_some());
    let mut columns = vec!["vertiport", "room", "departures", "arrivals", "taken", "full"];
    columns.extend(is_worth_known.then_some("one more stand before its cost, $"));
    Table::new(columns).with_rows(account.vertiports.iter().map(|one| {
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
    }))
}

/// The hours of aircraft, as means by type. Time out of service has a column only if an outage
/// grounded an aircraft.
pub(crate) fn types(account: &Account) -> Table {
    let has_outages = account.aircraft.iter().any(|one| one.out_of_service_h > 0.0);
    let mut columns =
        vec!["type", "aircraft", "flights", "empty", "flying, h", "charging, h", "waiting, h"];
    columns.extend(has_outages.then_some("out of service, h"));
    columns.push("profit before aircraft cost, $");
    let mut kinds: Vec<&str> = account.aircraft.iter().map(|one| one.kind.as_str()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    Table::new(columns).with_rows(kinds.into_iter().map(|kind| {
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
        row
    }))
}
