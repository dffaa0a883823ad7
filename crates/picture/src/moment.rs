//! The fleet at one moment of a day, from the rows of its trace so far.

use vertifleet_core::{Scenario, Time, VertiportIx};
use vertifleet_sim::{Boarded, TraceRow};

/// Where an aircraft is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Whereabouts {
    /// It stands at this vertiport.
    Standing(VertiportIx),
    /// It is in the air.
    Flying {
        /// Where it comes from.
        from: VertiportIx,
        /// Where it flies to.
        to: VertiportIx,
        /// Share of the time from the decision to the arrival that has passed.
        share: f64,
        /// Passengers on board as a share of the seats.
        load: f64,
    },
}

/// The fleet at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// The time.
    pub time: Time,
    /// Each aircraft's whereabouts.
    pub aircraft: Vec<Whereabouts>,
    /// Aircraft that stand at each vertiport.
    pub standing: Vec<u32>,
    /// Aircraft in the air towards each vertiport.
    pub coming: Vec<u32>,
    /// Passengers of this demand period who still want to leave each vertiport.
    pub waiting: Vec<u32>,
    /// Profit of all flights decided so far, less the cost of the fleet; dollars.
    pub profit_usd: f64,
    /// Flights decided so far.
    pub flights: u32,
    /// Passengers carried so far.
    pub passengers: u64,
}

impl Moment {
    /// The fleet at this time. `rows` is the trace of the day so far, or of all of it: rows after
    /// the time do not count.
    pub fn of(day: &Scenario, rows: &[TraceRow], time: Time) -> Self {
        let rows = &rows[..rows.partition_point(|row| row.time <= time)];
        let vertiports = day.vertiports.len();
        let mut moment = Self {
            time,
            aircraft: day
                .aircraft
                .iter()
                .map(|aircraft| Whereabouts::Standing(aircraft.at))
                .collect(),
            standing: vec![0; vertiports],
            coming: vec![0; vertiports],
            waiting: waiting(day, rows, time),
            profit_usd: -day.fixed_cost_usd(),
            flights: 0,
            passengers: 0,
        };
        for row in rows {
            moment.aircraft[row.aircraft.at()] = whereabouts(day, row, time);
            moment.flights += u32::from(row.to != row.from);
            moment.passengers += u64::from(row.passengers);
            moment.profit_usd += row.profit_usd();
        }
        for place in &moment.aircraft {
            match *place {
                Whereabouts::Standing(at) => moment.standing[at.at()] += 1,
                Whereabouts::Flying { to, .. } => moment.coming[to.at()] += 1,
            }
        }
        moment
    }
}

/// Where the aircraft of a row is, if it was its last decision.
fn whereabouts(day: &Scenario, row: &TraceRow, time: Time) -> Whereabouts {
    if row.to == row.from || time < row.takeoff {
        return Whereabouts::Standing(row.from);
    }
    if time >= row.arrival {
        return Whereabouts::Standing(row.to);
    }
    let seats = day.aircraft_types[day.aircraft[row.aircraft.at()].kind.at()].seats;
    Whereabouts::Flying {
        from: row.from,
        to: row.to,
        share: f64::from(time.since(row.takeoff)) / f64::from(row.arrival.since(row.takeoff)),
        load: f64::from(row.passengers) / f64::from(seats),
    }
}

/// Passengers who want to leave each vertiport at a time.
fn waiting(day: &Scenario, rows: &[TraceRow], time: Time) -> Vec<u32> {
    let mut boarded = Boarded::of(day);
    for row in rows {
        boarded.board(row);
    }
    let at = |from| boarded.waiting(time).map(|table| table.row(from).iter().sum::<u32>()).sum();
    VertiportIx::all(day.vertiports.len()).map(at).collect()
}
