//! The report of what a network holds.

use vertifleet_picture::numbers::{counted, grouped};
use vertifleet_study::network_overview::NetworkOverview;

use crate::report::{Report, Section, Table};

/// With more vertiports, the matrix of demand is left out.
const MOST_COLUMNS: usize = 16;

/// The report of a network.
pub fn network(overview: &NetworkOverview) -> Report<'static> {
    let mut sections = vec![
        Section::of_table("Vertiports", vertiport_rows(overview)),
        Section::of_table("Fleet", type_rows(overview)),
        Section::of_table("Demand", period_rows(overview)),
    ];
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
         distances {least:.1} to {most:.1} miles, {mean:.1} on the mean; fares {lowest:.2} to {highest:.2} $, {fare:.2} on the mean\n\
         fleet, stands and chargers cost {} $ a day",
        overview.name,
        counted(overview.vertiports.len(), "vertiport", "vertiports"),
        counted(overview.size.stands as usize, "stand", "stands"),
        counted(overview.size.aircraft, "aircraft", "aircraft"),
        grouped(overview.passengers_a_day, 0),
        overview.operations[0],
        overview.operations[1],
        overview.time_zone.as_ref().map_or_else(String::new, |zone| format!(", {zone}")),
        waits(overview.passenger_wait_s).map_or_else(String::new, |waits| format!(
            "passengers who are not carried wait {waits}\n"
        )),
        grouped(overview.size.fixed_cost_usd, 0),
    )
}

/// How long passengers who are not carried wait, if they do.
pub(crate) fn waits(passenger_wait_s: u32) -> Option<String> {
    let (time, unit) = if passenger_wait_s.is_multiple_of(60) {
        (passenger_wait_s / 60, "min")
    } else {
        (passenger_wait_s, "s")
    };
    (time > 0).then(|| format!("{time} {unit} into the next period"))
}

fn vertiport_rows(overview: &NetworkOverview) -> Table {
    let mut rows =
        vec![cells(&["vertiport", "place", "stands", "chargers", "departing", "arriving"])];
    rows.extend(overview.vertiports.iter().map(|one| {
        let place = match one.degrees {
            Some([latitude, longitude]) => format!("{latitude:.4}, {longitude:.4}"),
            None => format!("{:.1}, {:.1} mi", one.position_mi[0], one.position_mi[1]),
        };
        let chargers = one.chargers.map_or_else(String::new, |chargers| chargers.to_string());
        let (departing, arriving) = (grouped(one.departing, 0), grouped(one.arriving, 0));
        vec![one.id.clone(), place, one.stands.to_string(), chargers, departing, arriving]
    }));
    Table { rows, best: Vec::new() }
}

fn type_rows(overview: &NetworkOverview) -> Table {
    let mut rows = vec![cells(&["aircraft type", "aircraft", "seats", "mph", "range, mi"])];
    rows.extend(overview.aircraft_types.iter().map(|one| {
        let (speed, range) = (grouped(one.speed_mph, 1), grouped(one.range_mi, 0));
        vec![one.id.clone(), one.aircraft.to_string(), one.seats.to_string(), speed, range]
    }));
    Table { rows, best: Vec::new() }
}

fn period_rows(overview: &NetworkOverview) -> Table {
    let mut rows = vec![cells(&["from", "passengers"])];
    rows.extend(overview.periods.iter().zip(&overview.passengers).map(|(start, table)| {
        let sum: f64 = table.iter().flatten().sum();
        vec![start.clone(), grouped(sum, 0)]
    }));
    Table { rows, best: Vec::new() }
}

fn matrix_rows(overview: &NetworkOverview) -> Table {
    let mut rows = vec![
        std::iter::once(String::new())
            .chain(overview.vertiports.iter().map(|one| one.id.clone()))
            .collect::<Vec<_>>(),
    ];
    rows.extend(overview.vertiports.iter().enumerate().map(|(from, one)| {
        let sum = |to: usize| overview.passengers.iter().map(|table| table[from][to]).sum::<f64>();
        let row = (0..overview.vertiports.len()).map(|to| grouped(sum(to), 0));
        std::iter::once(one.id.clone()).chain(row).collect()
    }));
    Table { rows, best: Vec::new() }
}

fn cells(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|&text| text.to_owned()).collect()
}

#[cfg(test)]
mod tests {
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
    fn the_overview_of_new_york() {
        let new_york = Network::shipped("new-york").expect("shipped");
        insta::assert_snapshot!(network(&NetworkOverview::of(&new_york)).text());
    }
}
