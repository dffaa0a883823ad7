//! What a network holds, in numbers.

use serde::Serialize;
use vertifleet_core::{
    AircraftType, ChargeCurve, Matrix, Network, Operations, VertiportIx, Warning,
};

use crate::sweep::Size;

/// What a network holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NetworkOverview {
    /// Its name.
    pub name: String,
    /// The time zone of its clocks.
    pub time_zone: Option<String>,
    /// Start and end of operations.
    pub operations: [String; 2],
    /// When aircraft may leave: `to_full` or `as_needed`.
    pub charging: &'static str,
    /// The lowest and the highest share of its battery that an aircraft starts the day with.
    pub start_charge: [f64; 2],
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
    /// The greatest power of a charger, kW, if that is limited.
    pub charger_kw: Option<f64>,
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
    /// The longest flight for which a full battery lasts and keeps the reserve, miles.
    pub range_mi: f64,
    /// Capacity of the battery, kWh.
    pub battery_kwh: f64,
    /// Energy that a flight keeps in the battery at least, kWh.
    pub reserve_kwh: f64,
    /// Share of the capacity that a battery in flight loses per hour.
    pub self_discharge_per_h: f64,
    /// The greatest charging power, kW.
    pub charge_kw: f64,
    /// Charging power by the share of the battery that is charged, kW: linear between these points,
    /// and at most `charge_kw`. `None` for `charge_kw` at every charge.
    pub charge_curve: Option<Vec<[f64; 2]>>,
    /// Seconds on the ground after a landing at least.
    pub turnaround_s: u32,
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
            charger_kw: one.charger_kw,
            departing: all.row(at).iter().sum(),
            arriving: VertiportIx::all(all.size()).map(|from| all[(from, at)]).sum(),
        };
        let kind = |(at, one): (usize, &AircraftType)| TypeOverview {
            id: one.id.clone(),
            aircraft: day.aircraft.iter().filter(|aircraft| aircraft.kind.at() == at).count(),
            seats: one.seats,
            speed_mph: one.speed_mph,
            range_mi: range_mi(one, &day.operations),
            battery_kwh: one.battery_kwh,
            reserve_kwh: one.reserve_kwh,
            self_discharge_per_h: one.self_discharge_per_h,
            charge_kw: one.charge_kw,
            charge_curve: one.charge_curve.as_ref().map(points),
            turnaround_s: one.turnaround_s,
        };
        let (least_charge, most_charge) = network.start_charge().unwrap_or((1.0, 1.0));
        let rows = |table: &Matrix<f64>| table.rows().map(<[f64]>::to_vec).collect();
        let ixs = VertiportIx::all(day.vertiports.len());
        Self {
            name: network.name().to_owned(),
            time_zone: network.time_zone().map(str::to_owned),
            operations: [day.operations.start.to_string(), day.operations.end.to_string()],
            charging: day.operations.charging.name(),
            start_charge: [least_charge, most_charge],
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
}

/// The longest flight of a type, miles. It takes, with self-discharge, what a full battery holds
/// above the reserve.
fn range_mi(kind: &AircraftType, operations: &Operations) -> f64 {
    let lost_kw = kind.battery_kwh * kind.self_discharge_per_h;
    let windows_h = f64::from(operations.takeoff_s + operations.landing_s) / 3_600.0;
    let left_kwh = kind.battery_kwh - kind.reserve_kwh - lost_kw * windows_h;
    let mi = left_kwh / (kind.energy_kwh_per_mi + lost_kw / kind.speed_mph);
    // A quotient of decimals is off by less.
    (1e6 * mi.max(0.0)).round() / 1e6
}

fn points(curve: &ChargeCurve) -> Vec<[f64; 2]> {
    curve.points().iter().map(|point| [point.charge, point.kw]).collect()
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

#[cfg(test)]
mod tests {
    use proptest::prelude::{prop_assert, proptest};
    use serde_json::json;
    use vertifleet_core::{Matrix, Network, TypeIx, VertiportIx};
    use vertifleet_sim::Legs;

    use super::{NetworkOverview, range_mi};

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

    proptest! {
        /// The simulator decides which flights a full battery lasts for.
        #[test]
        fn the_range_is_the_longest_flight_that_the_rules_allow(
            reserve in 0.0..0.9_f64, lost_per_h in 0.0..0.3_f64, kind in 0_usize..2
        ) {
            let network = Network::shipped("new-york").expect("shipped");
            let mut day = network.mean_day().into_day();
            let of_type = &mut day.aircraft_types[kind];
            of_type.reserve_kwh = reserve * of_type.battery_kwh;
            of_type.self_discharge_per_h = lost_per_h;
            let range_mi = range_mi(of_type, &day.operations);
            for (off_mi, is_within) in [(-0.05, true), (0.05, false)] {
                let mut day = day.clone();
                let mi = range_mi + off_mi;
                if mi <= 0.0 {
                    continue;
                }
                let size = day.vertiports.len();
                day.distance_mi =
                    Matrix::from_fn(size, |from, to| if from == to { 0.0 } else { mi });
                let day = day.check("a day").expect("a day");
                let legs = Legs::of(&day);
                let kind = TypeIx::new(kind);
                let from = VertiportIx::new(0);
                let reached = legs.within_range(kind, from).iter().next().is_some();
                prop_assert!(reached == is_within, "{range_mi} {off_mi}");
            }
        }
    }

    #[test]
    fn batteries_and_chargers_are_stated_with_the_range_that_they_allow() {
        let paper = Network::shipped("paper").expect("shipped");
        let changes = [
            ("operations.charging", json!("as_needed")),
            ("start_charge", json!([0.2, 0.6])),
            ("aircraft_types.*.reserve_kwh", json!(55)),
            ("aircraft_types.*.charge_curve", json!([[0, 90], [1, 40]])),
            ("aircraft_types.*.turnaround_s", json!(300)),
            ("vertiports.V2.charger_kw", json!(75)),
        ];
        let changes = changes.map(|(path, value)| (path.to_owned(), value));
        let network = paper.changed(changes.iter().map(|(path, value)| (path, value)));
        let overview = NetworkOverview::of(&network.expect("a network"));
        let found = serde_json::to_value(&overview).expect("plain data");
        let kind = &found["aircraft_types"][0];
        assert_eq!(kind["range_mi"], 25.0, "half of the 50 miles of `paper`");
        assert_eq!((&kind["battery_kwh"], &kind["reserve_kwh"]), (&json!(110.0), &json!(55.0)));
        assert_eq!(kind["charge_curve"], json!([[0.0, 90.0], [1.0, 40.0]]));
        assert_eq!((&kind["charge_kw"], &kind["turnaround_s"]), (&json!(150.0), &json!(300)));
        assert_eq!(
            (&found["charging"], &found["start_charge"]),
            (&json!("as_needed"), &json!([0.2, 0.6]))
        );
        assert_eq!(found["vertiports"][0]["charger_kw"], json!(null));
        assert_eq!(found["vertiports"][1]["charger_kw"], json!(75.0));
    }
}
