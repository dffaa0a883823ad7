//! The report of the contents of a network.

use vertifleet_picture::numbers::{counted, grouped};
use vertifleet_study::network_overview::NetworkOverview;

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
    Table::new(["vertiport", "place", "stands", "chargers", "departing", "arriving"]).with_rows(
        overview.vertiports.iter().map(|one| {
            let place = match one.degrees {
                Some([latitude, longitude]) => format!("{latitude:.4}, {longitude:.4}"),
                None => format!("{:.1}, {:.1} mi", one.position_mi[0], one.position_mi[1]),
            };
            let chargers = one.chargers.map_or_else(String::new, |chargers| chargers.to_string());
            let (departing, arriving) = (grouped(one.departing, 0), grouped(one.arriving, 0));
            vec![one.id.clone(), place, one.stands.to_string(), chargers, departing, arriving]
        }),
    )
}

fn type_rows(overview: &NetworkOverview) -> Table {
    Table::new(["aircraft type", "aircraft", "seats", "mph", "range, mi"]).with_rows(
        overview.aircraft_types.iter().map(|one| {
            let (speed, range) = (grouped(one.speed_mph, 1), grouped(one.range_mi, 0));
            vec![one.id.clone(), one.aircraft.to_string(), one.seats.to_string(), speed, range]
        }),
    )
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
