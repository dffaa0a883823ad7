//! A day of three vertiports and two aircraft, and a schedule for it worked out by hand.
//!
//! At 60 mph a mile takes a minute. At 1 kWh per mile, charging a mile's energy again at 60 kW
//! takes another minute. 6 % of 100 kWh are lost in an hour, which is 0.1 kWh in a minute.

use vertifleet_core::{
    Aircraft, AircraftIx, AircraftType, Charging, Day, Disturbances, Matrix, Operations, Time,
    TypeIx, Vertiport, VertiportIx,
};
use vertifleet_sim::{Trace, TraceRow};

/// The day in its open form, to be changed and checked.
pub(crate) fn day() -> Day {
    let vertiport = |id: &str, x_mi, stands| Vertiport {
        id: id.to_owned(),
        x_mi,
        y_mi: 0.0,
        stands,
        chargers: None,
        charger_kw: None,
        busy: false,
        degrees: None,
        stand_cost_usd: 0.0,
        charger_cost_usd: 0.0,
    };
    let aircraft = |id: &str, at| Aircraft {
        id: id.to_owned(),
        kind: TypeIx(0),
        at: VertiportIx(at),
        start_charge_kwh: None,
    };
    Day {
        name: "by-hand".to_owned(),
        seed: 1,
        operations: Operations {
            start: time("06:00:00"),
            end: time("08:00:00"),
            takeoff_s: 300,
            landing_s: 300,
            hold_s: 900,
            passenger_wait_s: 0,
            charging: Charging::ToFull,
        },
        vertiports: vec![
            vertiport("V1", 0.0, 1),
            vertiport("V2, by the \"lake\"", 20.0, 1),
            vertiport("V3", 40.0, 2),
        ],
        aircraft_types: vec![AircraftType {
            id: "T".to_owned(),
            seats: 4,
            speed_mph: 60.0,
            battery_kwh: 100.0,
            energy_kwh_per_mi: 1.0,
            charge_kw: 60.0,
            self_discharge_per_h: 0.06,
            reserve_kwh: 0.0,
            turnaround_s: 0,
            charge_curve: None,
        }],
        aircraft: vec![aircraft("A1", 0), aircraft("A2", 1)],
        distance_mi: table([[0.0, 20.0, 40.0], [20.0, 0.0, 30.0], [40.01, 30.0, 0.0]]),
        corridors: None,
        fare_usd: table([[0.0, 30.0, 50.0], [30.0, 0.0, 40.0], [50.0, 40.0, 0.0]]).into(),
        passenger_cost_usd: table([[0.0, 13.0, 26.0], [13.0, 0.0, 20.0], [26.0, 20.0, 0.0]]),
        flight_cost_usd: table([[0.0; 3]; 3]),
        aircraft_cost_usd: 0.0,
        periods: vec![time("06:00:00"), time("07:00:00")],
        demand: vec![
            table([[0, 5, 6], [3, 0, 0], [0, 0, 0]]),
            table([[0, 9, 9], [9, 0, 9], [0, 9, 0]]),
        ],
        energy_price_usd: vec![0.2, 0.3],
        disturbances: Disturbances::default(),
    }
}

/// Five decisions that keep every rule.
pub(crate) fn schedule() -> Trace {
    let rows = vec![
        // 4 of 6 passengers; 40 miles, 50 minutes, 40 + 5 kWh, 45 minutes of charging, at the early
        // price.
        flight(("06:00:00", 0), (0, 2), 4, [200.0, 104.0, 45.0, 9.0], ("06:50:00", "07:35:00")),
        // V1's only stand has just become free. 3 passengers; 20 miles, 30 minutes, 20 + 3 kWh.
        flight(("06:00:00", 1), (1, 0), 3, [90.0, 39.0, 23.0, 4.6], ("06:30:00", "06:53:00")),
        // The 2 passengers left of the early period, with charging at the late price. V3 is full
        // then.
        flight(("06:53:00", 1), (0, 2), 2, [100.0, 52.0, 45.0, 13.5], ("07:43:00", "08:28:00")),
        flight(("07:35:00", 0), (2, 2), 0, [0.0; 4], ("07:35:00", "07:50:00")),
        // No passengers. 40.01 miles: 2400.6 s of cruise are rounded to 2401, 3001 s in all;
        // 40.01 + 6 * 3001 / 3600 kWh, 2700.7 s of charging are rounded to 2701.
        flight(
            ("07:50:00", 0),
            (2, 0),
            0,
            [0.0, 0.0, 45.011_666_666_666_67, 13.503_5],
            ("08:40:01", "09:25:02"),
        ),
    ];
    Trace { rows }
}

/// A row of a day that charges to full.
pub(crate) fn flight(
    (time_of_day, aircraft): (&str, u16),
    (from, to): (u16, u16),
    passengers: u16,
    amounts: [f64; 4],
    (arrival, ready): (&str, &str),
) -> TraceRow {
    let [revenue_usd, passenger_cost_usd, energy_kwh, energy_cost_usd] = amounts;
    TraceRow {
        time: time(time_of_day),
        aircraft: AircraftIx(aircraft),
        from: VertiportIx(from),
        to: VertiportIx(to),
        passengers,
        revenue_usd,
        passenger_cost_usd,
        energy_kwh,
        energy_cost_usd,
        flight_cost_usd: 0.0,
        charge_kwh: 0.0,
        takeoff: time(time_of_day),
        arrival: time(arrival),
        ready: time(ready),
    }
}

pub(crate) fn time(text: &str) -> Time {
    text.parse().expect("a time")
}

fn table<T: Copy>(rows: [[T; 3]; 3]) -> Matrix<T> {
    Matrix::from_fn(3, |from, to| rows[from.at()][to.at()])
}
