//! What a network holds, as numbers for programs and as a table for people.

use serde::Serialize;
use vertifleet_core::{AircraftType, Matrix, Network, VertiportIx, Warning};
use vertifleet_picture::numbers::{counted, grouped};

use crate::sweep::Size;
use crate::table::append_aligned;

/// With more vertiports, the matrix of demand is left out of the table.
const MOST_COLUMNS: usize = 16;

/// What a network holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NetworkOverview {
    /// Its name.
    pub name: String,
    /// The time zone of its clocks.
    pub time_zone: Option<String>,
    /// Start and end of operations.
    pub operations: [String; 2],
    /// Seconds for which passengers who are not carried wait into the next period.
    pub passenger_wait_s: u32,
    /// The vertiports.
    pub vertiports: Vec<VertiportOverview>,
    /// The aircraft types with the number of aircraft of each.
    pub aircraft_types: Vec<TypeOverview>,
    /// Aircraft, stands, chargers, and what they cost a day.
    pub size: Size,
    /// Shortest, mean and longest distance between two vertiports, miles.
    pub distance_mi: [f64; 3],
    /// Lowest, mean and highest fare of a pair that has passengers, over all periods, dollars.
    pub fare_usd: [f64; 3],
    /// The starts of the demand periods.
    pub periods: Vec<String>,
    /// Mean passengers, `[period][from][to]`.
    pub passengers: Vec<Vec<Vec<f64>>>,
    /// Mean passengers of a day.
    pub passengers_a_day: f64,
    /// What is allowed in the network but hardly meant.
    pub warnings: Vec<String>,
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

/// A vertiport of a network.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VertiportOverview {
    /// Its id.
    pub id: String,
    /// Latitude and longitude in degrees, if they are known.
    pub degrees: Option<[f64; 2]>,
    /// Miles east and north.
    pub position_mi: [f64; 2],
    /// Stands.
    pub stands: u16,
    /// Chargers that are counted apart from stands.
    pub chargers: Option<u16>,
    /// Mean passengers a day who leave from it.
    pub departing: f64,
    /// Mean passengers a day who want to reach it.
    pub arriving: f64,
}

/// An aircraft type of a network.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TypeOverview {
    /// Its id.
    pub id: String,
    /// Aircraft of this type.
    pub aircraft: usize,
    /// Seats.
    pub seats: u16,
    /// Cruise speed, miles per hour.
    pub speed_mph: f64,
    /// How far a full battery lasts without self-discharge, miles.
    pub range_mi: f64,
}

impl NetworkOverview {
    /// The overview of a network.
    pub fn of(network: &Network) -> Self {
        let day = network.mean_day();
        let means = network.mean_demand();
        let all = total(&means);
        let pairs = || {
            VertiportIx::all(all.size())
                .flat_map(|from| VertiportIx::all(all.size()).map(move |to| (from, to)))
                .filter(|(from, to)| from != to)
        };
        let fares = day.fare_usd.tables().flat_map(|table| {
            pairs().filter(|&pair| all[pair] > 0.0).map(|pair| table[pair]).collect::<Vec<f64>>()
        });
        let vertiport = |(at, one): (VertiportIx, &vertifleet_core::Vertiport)| VertiportOverview {
            id: one.id.clone(),
            degrees: one.degrees.map(|place| [place.latitude, place.longitude]),
            position_mi: [one.x_mi, one.y_mi],
            stands: one.stands,
            chargers: one.chargers,
            departing: all.row(at).iter().sum(),
            arriving: VertiportIx::all(all.size()).map(|from| all[(from, at)]).sum(),
        };
        let kind = |(at, one): (usize, &AircraftType)| TypeOverview {
            id: one.id.clone(),
            aircraft: day.aircraft.iter().filter(|aircraft| aircraft.kind.at() == at).count(),
            seats: one.seats,
            speed_mph: one.speed_mph,
            range_mi: one.battery_kwh / one.energy_kwh_per_mi,
        };
        let rows = |table: &Matrix<f64>| table.rows().map(<[f64]>::to_vec).collect();
        let ixs = VertiportIx::all(day.vertiports.len());
        Self {
            name: network.name().to_owned(),
            time_zone: network.time_zone().map(str::to_owned),
            operations: [day.operations.start.to_string(), day.operations.end.to_string()],
            passenger_wait_s: day.operations.passenger_wait_s,
            vertiports: ixs.zip(&day.vertiports).map(vertiport).collect(),
            aircraft_types: day.aircraft_types.iter().enumerate().map(kind).collect(),
            size: Size::of(network),
            distance_mi: spread(&pairs().map(|pair| day.distance_mi[pair]).collect::<Vec<f64>>()),
            fare_usd: spread(&fares.collect::<Vec<f64>>()),
            periods: network.period_starts().iter().map(ToString::to_string).collect(),
            passengers: means.iter().map(rows).collect(),
            passengers_a_day: all.cells().iter().sum(),
            warnings: network.warnings().iter().map(Warning::to_string).collect(),
        }
    }

    /// The overview as a table for a terminal.
    pub fn text(&self) -> String {
        let [least, mean, most] = self.distance_mi;
        let [lowest, fare, highest] = self.fare_usd;
        let mut text = format!(
            "{}: {} with {}, {}, {} passengers a day\n\
             operations {} to {}{}\n{}\
             distances {least:.1} to {most:.1} miles, {mean:.1} on the mean; fares {lowest:.2} to {highest:.2} $, {fare:.2} on the mean\n\
             fleet, stands and chargers cost {} $ a day\n\n",
            self.name,
            counted(self.vertiports.len(), "vertiport", "vertiports"),
            counted(self.size.stands as usize, "stand", "stands"),
            counted(self.size.aircraft, "aircraft", "aircraft"),
            grouped(self.passengers_a_day, 0),
            self.operations[0],
            self.operations[1],
            self.time_zone.as_ref().map_or_else(String::new, |zone| format!(", {zone}")),
            waits(self.passenger_wait_s).map_or_else(String::new, |waits| format!(
                "passengers who are not carried wait {waits}\n"
            )),
            grouped(self.size.fixed_cost_usd, 0),
        );
        append_aligned(&mut text, &self.vertiport_rows());
        text.push('\n');
        append_aligned(&mut text, &self.type_rows());
        text.push('\n');
        append_aligned(&mut text, &self.period_rows());
        if self.vertiports.len() <= MOST_COLUMNS {
            text += "\npassengers a day, from row to column\n";
            append_aligned(&mut text, &self.matrix_rows());
        }
        for warning in &self.warnings {
            text = text + "\nwarning: " + warning + "\n";
        }
        text
    }

    fn vertiport_rows(&self) -> Vec<Vec<String>> {
        let mut rows =
            vec![cells(&["vertiport", "place", "stands", "chargers", "departing", "arriving"])];
        rows.extend(self.vertiports.iter().map(|one| {
            let place = match one.degrees {
                Some([latitude, longitude]) => format!("{latitude:.4}, {longitude:.4}"),
                None => format!("{:.1}, {:.1} mi", one.position_mi[0], one.position_mi[1]),
            };
            let chargers = one.chargers.map_or_else(String::new, |chargers| chargers.to_string());
            let (departing, arriving) = (grouped(one.departing, 0), grouped(one.arriving, 0));
            vec![one.id.clone(), place, one.stands.to_string(), chargers, departing, arriving]
        }));
        rows
    }

    fn type_rows(&self) -> Vec<Vec<String>> {
        let mut rows = vec![cells(&["aircraft type", "aircraft", "seats", "mph", "range, mi"])];
        rows.extend(self.aircraft_types.iter().map(|one| {
            let (speed, range) = (grouped(one.speed_mph, 1), grouped(one.range_mi, 0));
            vec![one.id.clone(), one.aircraft.to_string(), one.seats.to_string(), speed, range]
        }));
        rows
    }

    fn period_rows(&self) -> Vec<Vec<String>> {
        let mut rows = vec![cells(&["from", "passengers"])];
        rows.extend(self.periods.iter().zip(&self.passengers).map(|(start, table)| {
            let sum: f64 = table.iter().flatten().sum();
            vec![start.clone(), grouped(sum, 0)]
        }));
        rows
    }

    fn matrix_rows(&self) -> Vec<Vec<String>> {
        let mut rows = vec![
            std::iter::once(String::new())
                .chain(self.vertiports.iter().map(|one| one.id.clone()))
                .collect::<Vec<_>>(),
        ];
        rows.extend(self.vertiports.iter().enumerate().map(|(from, one)| {
            let sum = |to: usize| self.passengers.iter().map(|table| table[from][to]).sum::<f64>();
            let row = (0..self.vertiports.len()).map(|to| grouped(sum(to), 0));
            std::iter::once(one.id.clone()).chain(row).collect()
        }));
        rows
    }
}

/// The sum over all periods.
fn total(means: &[Matrix<f64>]) -> Matrix<f64> {
    let size = means.first().map_or(0, Matrix::size);
    Matrix::from_fn(size, |from, to| means.iter().map(|table| table[(from, to)]).sum())
}

/// The least, the mean and the greatest of some numbers; 0 if there are none.
fn spread(numbers: &[f64]) -> [f64; 3] {
    if numbers.is_empty() {
        return [0.0; 3];
    }
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least, crate::statistics::mean(numbers), most]
}

fn cells(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|&text| text.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use vertifleet_core::Network;

    use super::NetworkOverview;

    #[test]
    fn an_overview_adds_up() {
        for name in Network::shipped_names() {
            let overview = NetworkOverview::of(&Network::shipped(name).expect("listed"));
            let departing: f64 = overview.vertiports.iter().map(|one| one.departing).sum();
            let arriving: f64 = overview.vertiports.iter().map(|one| one.arriving).sum();
            let all = overview.passengers_a_day;
            assert!((departing - all).abs() < 1e-6 * all && (arriving - all).abs() < 1e-6 * all);
            let aircraft: usize = overview.aircraft_types.iter().map(|one| one.aircraft).sum();
            assert_eq!(aircraft, overview.size.aircraft, "{name}");
        }
    }

    #[test]
    fn passengers_who_wait_are_named() {
        let paper = Network::shipped("paper").expect("shipped");
        for (wait_s, said) in [(600, "wait 10 min into"), (90, "wait 90 s into")] {
            let wait = serde_json::json!(wait_s);
            let network = paper.changed([(&"operations.passenger_wait_s".to_owned(), &wait)]);
            let text = NetworkOverview::of(&network.expect("a wait")).text();
            assert!(text.contains(said), "{text}");
        }
        assert!(!NetworkOverview::of(&paper).text().contains("wait"));
    }

    #[test]
    fn the_overview_of_new_york() {
        let network = Network::shipped("new-york").expect("shipped");
        insta::assert_snapshot!(NetworkOverview::of(&network).text());
    }
}
