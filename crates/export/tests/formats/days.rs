//! Days that are played for the tests: a tiny one by hand, and small ones of every kind.

use std::sync::Arc;

use proptest::prelude::{Strategy, any, prop};
use vertifleet_core::{
    Aircraft, AircraftIx, AircraftType, Charging, Day, Degrees, Disturbances, Matrix, Operations,
    Scenario, Time, TypeIx, Vertiport, VertiportIx,
};
use vertifleet_export::{Calendar, Flown};
use vertifleet_sim::{Simulation, TraceRow};
use vertifleet_testkit::extended_day;

/// A scenario and the rows of its trace.
#[derive(Debug, Clone)]
pub(crate) struct Played {
    pub(crate) day: Scenario,
    pub(crate) rows: Vec<TraceRow>,
}

impl Played {
    pub(crate) fn flown(&self) -> Flown<'_> {
        Flown::new(&self.day, &self.rows).expect("rows of the day")
    }

    /// The rows that are flights.
    pub(crate) fn flights(&self) -> impl Iterator<Item = &TraceRow> {
        self.rows.iter().filter(|row| row.from != row.to)
    }

    pub(crate) fn vertiport(&self, at: VertiportIx) -> &Vertiport {
        &self.day.vertiports[at.at()]
    }

    pub(crate) fn aircraft(&self, row: &TraceRow) -> &Aircraft {
        &self.day.aircraft[row.aircraft.at()]
    }
}

/// The calendar of the tests.
pub(crate) fn calendar() -> Calendar {
    Calendar::new("2026-11-24", "America/New_York").expect("a calendar")
}

/// A day with two vertiports that lie 10 miles apart and one aircraft, which flies with passengers,
/// holds, and comes back past midnight without any.
pub(crate) fn tiny() -> Played {
    let vertiport = |id: &str, x_mi: f64, latitude: f64, longitude: f64| Vertiport {
        id: id.to_owned(),
        x_mi,
        y_mi: 0.0,
        stands: 2,
        chargers: None,
        charger_kw: None,
        busy: false,
        degrees: Some(Degrees { latitude, longitude }),
        stand_cost_usd: 0.0,
        charger_cost_usd: 0.0,
    };
    let time = |text: &str| text.parse::<Time>().expect("a time");
    let day = Day {
        name: "tiny".to_owned(),
        seed: 1,
        operations: Operations {
            start: time("22:00:00"),
            end: time("25:00:00"),
            takeoff_s: 600,
            landing_s: 300,
            hold_s: 900,
            passenger_wait_s: 0,
            charging: Charging::ToFull,
        },
        vertiports: vec![
            vertiport("Pier, \"East\"", 0.0, 40.7033, -74.0170),
            vertiport("Zürich", 10.0, 40.7033, -73.8261),
        ],
        aircraft_types: vec![AircraftType {
            id: "Quad".to_owned(),
            seats: 4,
            speed_mph: 100.0,
            battery_kwh: 110.0,
            energy_kwh_per_mi: 2.0,
            charge_kw: 120.0,
            self_discharge_per_h: 0.0,
            reserve_kwh: 0.0,
            turnaround_s: 0,
            charge_curve: None,
        }],
        aircraft: vec![Aircraft {
            id: "A1".to_owned(),
            kind: TypeIx::new(0),
            at: VertiportIx::new(0),
            start_charge_kwh: None,
        }],
        distance_mi: off_diagonal(10.0),
        corridors: None,
        fare_usd: off_diagonal(25.5).into(),
        passenger_cost_usd: off_diagonal(6.4),
        flight_cost_usd: off_diagonal(0.0),
        aircraft_cost_usd: 0.0,
        periods: vec![time("22:00:00")],
        demand: vec![off_diagonal(0)],
        energy_price_usd: vec![0.2],
        disturbances: Disturbances::default(),
    };
    let day = day.check("tiny").expect("a day within the rules");
    let row = |decided: &str, from: usize, to: usize, passengers: u16, ends: [&str; 2]| {
        let flies = from != to;
        TraceRow {
            time: time(decided),
            aircraft: AircraftIx::new(0),
            from: VertiportIx::new(from),
            to: VertiportIx::new(to),
            passengers,
            revenue_usd: 25.5 * f64::from(passengers),
            passenger_cost_usd: 6.4 * f64::from(passengers),
            energy_kwh: if flies { 20.0 } else { 0.0 },
            energy_cost_usd: if flies { 4.0 } else { 0.0 },
            flight_cost_usd: 0.0,
            charge_kwh: 0.0,
            takeoff: time(decided),
            arrival: time(ends[0]),
            ready: time(ends[1]),
        }
    };
    let rows = vec![
        row("23:15:00", 0, 1, 3, ["23:36:00", "23:46:00"]),
        row("23:46:00", 1, 1, 0, ["23:46:00", "24:01:00"]),
        row("24:01:00", 1, 0, 0, ["24:22:00", "24:32:00"]),
    ];
    Played { day, rows }
}

fn off_diagonal<T: Copy + Default>(cell: T) -> Matrix<T> {
    Matrix::from_fn(2, |from, to| if from == to { T::default() } else { cell })
}

/// Small days of every kind, played at random, on the globe, with ids of all characters that ids
/// may have.
pub(crate) fn any_played() -> impl Strategy<Value = Played> {
    let draws = prop::collection::vec(any::<u32>(), 1..40);
    // The letters of most errors are frequent; `\PC` is any character but control characters.
    let ids = prop::collection::vec("[aB,;:\"'\\\\ =/.|é-]{1,8}|\\PC{1,12}", 12);
    (extended_day(), draws, ids).prop_map(|(day, draws, ids)| {
        let rows = play(&day, &draws);
        let mut day = Scenario::clone(&day).into_day();
        for (at, vertiport) in day.vertiports.iter_mut().enumerate() {
            // The number keeps ids unique, at the front of some and at the end of others.
            vertiport.id = format!("{}{at}", ids[at]);
            vertiport.degrees = Some(Degrees {
                latitude: 40.0 + vertiport.y_mi / 69.0,
                longitude: -74.0 + vertiport.x_mi / 52.0,
            });
        }
        for (at, aircraft) in day.aircraft.iter_mut().enumerate() {
            aircraft.id = format!("{at}{}", ids[5 + at]);
        }
        Played { day: day.check("a day with other ids").expect("a day within the rules"), rows }
    })
}

/// Plays a day, with each draw choosing among the feasible vertiports.
fn play(day: &Arc<Scenario>, draws: &[u32]) -> Vec<TraceRow> {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut rows = Vec::new();
    while let Some(decision) = simulation.next_decision() {
        let mask = simulation.view().feasible(&decision);
        let rank = draws[rows.len() % draws.len()] % mask.len();
        let choice = mask.nth(rank).expect("a rank below the number of members");
        rows.push(simulation.apply(choice).expect("a choice from the mask"));
    }
    rows
}
