//! Where an aircraft is during its flight: at its vertiport while it boards and takes off, on a
//! great circle while it cruises, at the other vertiport while it lands.

use vertifleet_core::{Degrees, Operations, Time};

use crate::flown::Taken;
use crate::great_circle::GreatCircle;

/// The way between two points of a path, miles.
const STEP_MI: f64 = 2.0;

/// The most pieces that the cruise of one flight is cut into.
const MOST_PIECES: u32 = 256;

/// A point of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Waypoint {
    pub(crate) place: Degrees,
    pub(crate) time: Time,
}

/// The points of a flight, from its departure to its arrival, about every two miles of the cruise.
pub(crate) fn flight_path(
    flight: &Taken<'_>,
    [from, to]: [Degrees; 2],
    operations: &Operations,
) -> Vec<Waypoint> {
    let way = GreatCircle::between(from, to);
    let (start, end) = cruise(flight, operations);
    // Two points never have the same time, unless the whole flight takes none.
    let pieces = pieces(&way).min(end.since(start)).max(1);
    let (departure, arrival) = (flight.row.takeoff, flight.row.arrival);
    let boarding = (start > departure).then(|| Waypoint { place: way.at(0.0), time: departure });
    let cruise = (0..=pieces).map(|piece| {
        let elapsed = u64::from(end.since(start)) * u64::from(piece) / u64::from(pieces);
        let elapsed = u32::try_from(elapsed).expect("a part of the cruise");
        Waypoint { place: way.at(f64::from(piece) / f64::from(pieces)), time: start + elapsed }
    });
    let landed = (arrival > end).then(|| Waypoint { place: way.at(1.0), time: arrival });
    boarding.into_iter().chain(cruise).chain(landed).collect()
}

/// The great circle between two vertiports, about every two miles.
pub(crate) fn route_path([from, to]: [Degrees; 2]) -> Vec<Degrees> {
    let way = GreatCircle::between(from, to);
    let pieces = pieces(&way);
    (0..=pieces).map(|piece| way.at(f64::from(piece) / f64::from(pieces))).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "half the circumference of the earth at most, and not below 0"
)]
fn pieces(way: &GreatCircle) -> u32 {
    ((way.length_mi() / STEP_MI).ceil() as u32).clamp(1, MOST_PIECES)
}

/// When the cruise begins and ends. It ends when landing begins, and lasts as long as the distance
/// takes (Eq. 7); the time before it is take-off and delay. A flight of a live day may be shorter
/// than that; it cruises all the time then.
fn cruise(flight: &Taken<'_>, operations: &Operations) -> (Time, Time) {
    let (departure, arrival) = (flight.row.takeoff, flight.row.arrival);
    let cruise_s = cruise_s(flight);
    let before_cruise_s = arrival
        .since(departure)
        .checked_sub(operations.landing_s)
        .and_then(|flight_s| flight_s.checked_sub(cruise_s));
    match before_cruise_s {
        Some(before_s) if cruise_s > 0 => (departure + before_s, departure + before_s + cruise_s),
        _ => (departure, arrival),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "10,000 miles at 10 miles an hour at most, and not below 0"
)]
fn cruise_s(flight: &Taken<'_>) -> u32 {
    (3600.0 * flight.distance_mi / flight.kind.speed_mph).round() as u32
}
