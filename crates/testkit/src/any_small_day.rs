//! Small days of every kind as a proptest strategy, which shrinks failing cases.

use std::sync::Arc;

use proptest::prelude::{Just, Strategy, any, prop};
use vertifleet_core::{
    Aircraft, AircraftType, Charging, Day, Disturbances, Matrix, Operations, Scenario, Time,
    TypeIx, Vertiport, VertiportIx,
};

/// Days with 1 to 5 vertiports, 1 to 6 aircraft of 1 or 2 types and a few periods. Stands and
/// demand are scarce, and some pairs are out of range.
pub fn small_day() -> impl Strategy<Value = Arc<Scenario>> {
    (1_usize..=5, 1_usize..=6, 1_usize..=2, 1_usize..=4, any::<u64>())
        .prop_flat_map(|(vertiports, fleet, types, periods, seed)| {
            (
                Just((types, seed)),
                prop::collection::vec((0.0..40.0_f64, 0.0..40.0_f64, 1_u16..=4), vertiports),
                prop::collection::vec((0..types, 0..vertiports), fleet),
                prop::collection::vec(
                    prop::collection::vec(0_u32..12, vertiports * vertiports),
                    periods,
                ),
                prop::collection::vec(0.0..0.5_f64, periods),
                (0_u32..900, 60_u32..900, 60_u32..1800),
            )
        })
        .prop_map(|((types, seed), places, fleet, demand, energy_price_usd, clock)| {
            day(types, seed, &places, &fleet, &demand, energy_price_usd, clock)
        })
}

fn day(
    types: usize,
    seed: u64,
    places: &[(f64, f64, u16)],
    fleet: &[(usize, usize)],
    demand: &[Vec<u32>],
    energy_price_usd: Vec<f64>,
    (takeoff_s, landing_s, hold_s): (u32, u32, u32),
) -> Arc<Scenario> {
    let mut vertiports: Vec<Vertiport> = (1..)
        .zip(places)
        .map(|(number, &(x_mi, y_mi, stands))| Vertiport {
            id: format!("V{number}"),
            x_mi,
            y_mi,
            stands,
            chargers: None,
            charger_kw: None,
            busy: false,
            degrees: None,
            stand_cost_usd: if seed % 5 == 2 { 3.25 } else { 0.0 },
            charger_cost_usd: if seed % 5 == 2 { 7.75 } else { 0.0 },
        })
        .collect();
    for (at, vertiport) in vertiports.iter_mut().enumerate() {
        let standing = fleet.iter().filter(|&&(_, place)| place == at).count();
        vertiport.stands = vertiport.stands.max(u16::try_from(standing).expect("a small fleet"));
    }
    let size = vertiports.len();
    let distance_mi = Matrix::from_fn(size, |from, to| {
        let (from, to) = (&vertiports[from.at()], &vertiports[to.at()]);
        (from.x_mi - to.x_mi).hypot(from.y_mi - to.y_mi)
    });
    let day = Day {
        name: "small".to_owned(),
        seed: seed % (1 << 53),
        operations: Operations {
            start: Time::from_seconds(6 * 3600),
            end: Time::from_seconds(10 * 3600),
            takeoff_s,
            landing_s,
            hold_s,
            passenger_wait_s: 0,
            charging: Charging::ToFull,
        },
        aircraft_types: (0..types)
            .map(|kind| AircraftType {
                id: format!("T{kind}"),
                seats: [4, 1][kind],
                speed_mph: [74.5, 150.0][kind],
                battery_kwh: [110.0, 60.0][kind],
                energy_kwh_per_mi: [2.2, 3.0][kind],
                charge_kw: 150.0,
                self_discharge_per_h: [0.0, 0.01][kind],
                reserve_kwh: 0.0,
                turnaround_s: 0,
                charge_curve: None,
            })
            .collect(),
        aircraft: (1..)
            .zip(fleet)
            .map(|(number, &(kind, at))| Aircraft {
                id: format!("A{number:02}"),
                kind: TypeIx::new(kind),
                at: VertiportIx::new(at),
                start_charge_kwh: None,
            })
            .collect(),
        fare_usd: Matrix::from_fn(size, |from, to| 3.0 * distance_mi[(from, to)] + 1.25).into(),
        passenger_cost_usd: Matrix::from_fn(size, |from, to| 0.64 * distance_mi[(from, to)]),
        // Every other day has flight costs.
        flight_cost_usd: Matrix::from_fn(size, |from, to| {
            if seed.is_multiple_of(2) { 0.0 } else { 2.75 + 0.3 * distance_mi[(from, to)] }
        }),
        aircraft_cost_usd: if seed % 4 == 1 { 12.5 } else { 0.0 },
        distance_mi,
        corridors: None,
        periods: (0..demand.len())
            .map(|period| Time::from_seconds(6 * 3600 + 3600 * u32::try_from(period).expect("few")))
            .collect(),
        demand: demand
            .iter()
            .map(|cells| {
                Matrix::from_fn(size, |from, to| {
                    if from == to { 0 } else { cells[from.at() * size + to.at()] }
                })
            })
            .collect(),
        energy_price_usd,
        disturbances: Disturbances::default(),
        vertiports,
    };
    Arc::new(day.check("small day").expect("a day within the rules"))
}
