//! The report of the contents of a network.

use vertifleet_picture::numbers::{counted, grouped};
use vertifleet_study::network_overview::{NetworkOverview, TypeOverview};

use crate::report::{Report, Section, Table};

/// Largest number of vertiports for which the matrix of demand is shown.
const MOST_COLUMNS: usize = 16;

/// The report of a network.
pub fn network(overview: &NetworkOverview) -> Report<'static> {
    let mut sections = vec![
        Section::of_table("Vertiports", vertiport_rows(overview)),
        Section::of_table("Fleet", type_rows(overview)),
        Section::of_table("Demand", period_rows(overview)),
    ];
    if overview.aircraft_types.iter().any(|one| one.charge_curve.is_some()) {
        let table = curve_rows(overview);
        sections.insert(2, Section::of_table("charging power by charge", table));
    }
    if overview.vertiports.len() <= MOST_COLUMNS {
        let matrix = matrix_rows(overview);
        sections.push(Section::of_table("passengers a day, from row to column", matrix));
    }
    let warnings = overview.warnings.iter().map(|warning| format!("warning: {warning}"));
    Report {
        title: overview.name.clone(),
        opening: opening(overview),
        subject: "what a network holds",
        heading: overview.name.clone(),
        headline: warnings.collect::<Vec<_>>().join("\n\n"),
        sections,
        ..Report::default()
    }
}

fn opening(overview: &NetworkOverview) -> String {
    let [least, mean, most] = overview.distance_mi;
    let [lowest, fare, highest] = overview.fare_usd;
    format!(
        "{}: {} with {}, {}, {} passengers a day\n\
         operations {} to {}{}\n{}\
         {}\n\
         distances {least:.1} to {most:.1} miles, {mean:.1} on the mean; fares {lowest:.2} to {highest:.2} $, {fare:.2} on the mean\n\
         fleet, stands and chargers cost {} $ a day",
        overview.name,
        counted(overview.vertiports.len(), "vertiport", "vertiports"),
        room(overview),
        counted(overview.size.aircraft, "aircraft", "aircraft"),
        grouped(overview.passengers_a_day, 0),
        overview.operations[0],
        overview.operations[1],
        overview.time_zone.as_ref().map_or_else(String::new, |zone| format!(", {zone}")),
        waits(overview.passenger_wait_s).map_or_else(String::new, |waits| format!(
            "passengers who are not carried wait {waits}\n"
        )),
        charging(overview),
        grouped(overview.size.fixed_cost_usd, 0),
    )
}

/// Stands, and the chargers that are counted apart from them.
fn room(overview: &NetworkOverview) -> String {
    let stands = counted(overview.size.stands as usize, "stand", "stands");
    match overview.size.chargers as usize {
        0 => stands,
        chargers => format!("{stands} and {}", counted(chargers, "charger", "chargers")),
    }
}

/// When aircraft leave, and the charge with which they start the day.
fn charging(overview: &NetworkOverview) -> String {
    let leave = match overview.charging {
        "as_needed" => "aircraft leave when their charge suffices for the flight",
        _ => "aircraft leave with full batteries",
    };
    let [least, most] = overview.start_charge.map(percent);
    let start = if least == most {
        format!("{most} % charged")
    } else {
        format!("{least} to {most} % charged")
    };
    let start = if overview.start_charge == [1.0; 2] { "full".to_owned() } else { start };
    format!("{leave}; they start the day {start}")
}

/// A share in percent, in the fewest digits that stand for it.
fn percent(share: f64) -> String {
    ((1e8 * share).round() / 1e6).to_string()
}

/// How long unserved passengers wait, if they do.
pub(crate) fn waits(passenger_wait_s: u32) -> Option<String> {
    let (time, unit) = if passenger_wait_s.is_multiple_of(60) {
        (passenger_wait_s / 60, "min")
    } else {
        (passenger_wait_s, "s")
    };
    (time > 0).then(|| format!("{time} {unit} into the next period"))
}

fn vertiport_rows(overview: &NetworkOverview) -> Table {
    let is_limited = overview.vertiports.iter().any(|one| one.charger_kw.is_some());
    let mut columns = vec!["vertiport", "place", "stands", "chargers"];
    columns.extend(is_limited.then_some("charger, kW"));
    columns.extend(["departing", "arriving"]);
    Table::new(columns).with_rows(overview.vertiports.iter().map(|one| {
        let place = match one.degrees {
            Some([latitude, longitude]) => format!("{latitude:.4}, {longitude:.4}"),
            None => format!("{:.1}, {:.1} mi", one.position_mi[0], one.position_mi[1]),
        };
        let chargers = one.chargers.map_or_else(String::new, |chargers| chargers.to_string());
        let mut row = vec![one.id.clone(), place, one.stands.to_string(), chargers];
        row.extend(is_limited.then(|| one.charger_kw.map_or_else(String::new, plain)));
        row.extend([grouped(one.departing, 0), grouped(one.arriving, 0)]);
        row
    }))
}

fn type_rows(overview: &NetworkOverview) -> Table {
    let has_turnarounds = overview.aircraft_types.iter().any(|one| one.turnaround_s > 0);
    let mut columns = vec!["aircraft type", "aircraft", "seats", "mph", "range, mi"];
    columns.extend(["battery, kWh", "reserve, kWh", "charging, kW"]);
    columns.extend(has_turnarounds.then_some("turnaround, s"));
    Table::new(columns).with_rows(overview.aircraft_types.iter().map(|one| {
        let mut row = vec![one.id.clone(), one.aircraft.to_string(), one.seats.to_string()];
        row.extend([grouped(one.speed_mph, 1), grouped(one.range_mi, 0)]);
        row.extend([plain(one.battery_kwh), plain(one.reserve_kwh), power(one)]);
        row.extend(has_turnarounds.then(|| one.turnaround_s.to_string()));
        row
    }))
}

/// The lowest and the highest charging power.
fn power(one: &TypeOverview) -> String {
    let kw = curve(one).map(|[_, kw]| kw);
    let (least, most) = kw
        .fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), kw| (least.min(kw), most.max(kw)));
    if least < most { format!("{} to {}", plain(least), plain(most)) } else { plain(most) }
}

/// The points of a charge curve, with the power that the type takes there.
fn curve(one: &TypeOverview) -> impl Iterator<Item = [f64; 2]> {
    let points = one.charge_curve.clone().unwrap_or_else(|| vec![[1.0, one.charge_kw]]);
    let most_kw = one.charge_kw;
    points.into_iter().map(move |[charge, kw]| [charge, kw.min(most_kw)])
}

fn curve_rows(overview: &NetworkOverview) -> Table {
    let with_curve = overview.aircraft_types.iter().filter(|one| one.charge_curve.is_some());
    let rows = with_curve.flat_map(|one| {
        curve(one).map(|[charge, kw]| vec![one.id.clone(), percent(charge), plain(kw)])
    });
    Table::new(["aircraft type", "charged, %", "charging, kW"]).with_rows(rows)
}

/// A number in the fewest digits, at most three of them after the point.
fn plain(number: f64) -> String {
    ((1e3 * number).round() / 1e3).to_string()
}

fn period_rows(overview: &NetworkOverview) -> Table {
    Table::new(["from", "passengers"]).with_rows(
        overview.periods.iter().zip(&overview.passengers).map(|(start, table)| {
            let sum: f64 = table.iter().flatten().sum();
            vec![start.clone(), grouped(sum, 0)]
        }),
    )
}

fn matrix_rows(overview: &NetworkOverview) -> Table {
    let ids = overview.vertiports.iter().map(|one| one.id.as_str());
    Table::new(std::iter::once("").chain(ids)).with_rows(
        overview.vertiports.iter().enumerate().map(|(from, one)| {
            let sum =
                |to: usize| overview.passengers.iter().map(|table| table[from][to]).sum::<f64>();
            let row = (0..overview.vertiports.len()).map(|to| grouped(sum(to), 0));
            std::iter::once(one.id.clone()).chain(row).collect()
        }),
    )
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use vertifleet_core::Network;
    use vertifleet_study::network_overview::NetworkOverview;

    use super::network;

    #[test]
    fn passengers_who_wait_are_named() {
        let paper = Network::shipped("paper").expect("shipped");
        for (wait_s, said) in [(600, "wait 10 min into"), (90, "wait 90 s into")] {
            let wait = serde_json::json!(wait_s);
            let network_of = paper.changed([(&"operations.passenger_wait_s".to_owned(), &wait)]);
            let text = network(&NetworkOverview::of(&network_of.expect("a wait"))).text();
            assert!(text.contains(said), "{text}");
        }
        assert!(!network(&NetworkOverview::of(&paper)).text().contains("wait"));
    }

    #[test]
    fn batteries_and_chargers_are_named() {
        let paper = Network::shipped("paper-quick").expect("shipped");
        let changes = [
            ("start_charge", json!([0.2, 0.65])),
            ("aircraft_types.*.reserve_kwh", json!(55)),
            ("aircraft_types.*.charge_curve", json!([[0, 170], [0.8, 120.5], [1, 40]])),
            ("aircraft_types.*.turnaround_s", json!(300)),
            ("vertiports.V2.charger_kw", json!(75)),
            ("vertiports.*.chargers", json!(2)),
        ];
        let changes = changes.map(|(path, value)| (path.to_owned(), value));
        let quick = paper.changed(changes.iter().map(|(path, value)| (path, value)));
        let text = network(&NetworkOverview::of(&quick.expect("a network"))).text();
        let (before, _) = text.split_once("Demand").expect("a section on demand");
        insta::assert_snapshot!(before);
    }

    #[test]
    fn the_overview_of_new_york() {
        let new_york = Network::shipped("new-york").expect("shipped");
        insta::assert_snapshot!(network(&NetworkOverview::of(&new_york)).text());
    }
}
