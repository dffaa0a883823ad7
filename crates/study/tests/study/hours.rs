//! The hours of flying, charging, outages and waiting are those of the trace. The test integrates
//! the trace second by second, from the page Model alone.

use std::sync::Arc;

use vertifleet_core::{
    Aircraft, AircraftType, Charging, DaySeed, Network, Scenario, Vertiport, VertiportIx,
};
use vertifleet_picture::PlayedPicture;
use vertifleet_sim::{DayTotals, Simulation, Trace, TraceRow};
use vertifleet_study::account::Account;
use vertifleet_testkit::{Size, any_energy_day, with_energy};

/// Number of steps that a second is cut into.
const STEPS: u32 = 8;
/// A battery with less than this below its capacity is full, kWh.
const FULL_KWH: f64 = 1e-6;
const SIZE: Size = Size { vertiports: 4, fleet: 5, hours: 5 };

/// Seconds by activity.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Spent {
    flying: u32,
    charging: u32,
    out_of_service: u32,
    waiting: u32,
}

/// Days of `disrupted`, `paper-quick` and `new-york-quick`, and small days of every kind.
fn days() -> impl Iterator<Item = Arc<Scenario>> {
    let comparison = DaySeed::comparison(3).expect("a seed");
    let drawn = |name: &str| Network::shipped(name).expect("shipped").draw(comparison);
    let shipped = ["disrupted", "paper-quick", "new-york-quick"].map(drawn);
    // Delays and outages on a day that charges as needed.
    let both = with_energy(&shipped[0], 5);
    assert_eq!(both.operations.charging, Charging::AsNeeded);
    let shipped = shipped.into_iter().map(Arc::new);
    shipped.chain([both]).chain((0..60).map(|number| any_energy_day(number, SIZE)))
}

/// A day on which every aircraft flies to the next feasible vertiport, or holds at every third
/// decision.
fn played(day: &Arc<Scenario>) -> (Trace, DayTotals) {
    let (mut simulation, mut rows) = (Simulation::new(Arc::clone(day)), Vec::new());
    while let Some(decision) = simulation.next_decision() {
        let feasible = simulation.view().feasible(&decision);
        let size = day.vertiports.len();
        let first = usize::from(!decision.index.is_multiple_of(3));
        let next = (first..=size).map(|step| VertiportIx::new((decision.at.at() + step) % size));
        let choice = next.into_iter().find(|&at| feasible.contains(at)).expect("hold is feasible");
        rows.push(simulation.apply(choice).expect("it is feasible"));
    }
    (Trace { rows }, simulation.totals())
}

/// The power of a charging battery, kW.
fn power_kw(kind: &AircraftType, at: &Vertiport, kwh: f64) -> f64 {
    let most_kw = kind.charge_kw.min(at.charger_kw.unwrap_or(f64::INFINITY));
    let Some(curve) = &kind.charge_curve else { return most_kw };
    let share = (kwh / kind.battery_kwh).min(1.0);
    let pair = curve.points().windows(2).find(|pair| share <= pair[1].charge);
    let pair = pair.expect("a curve ends at 1");
    let along = (share - pair[0].charge) / (pair[1].charge - pair[0].charge);
    (pair[0].kw + along * (pair[1].kw - pair[0].kw)).min(most_kw)
}

/// The nearest whole number.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]
fn whole(number: f64) -> u32 {
    number.round() as u32
}

/// What an aircraft does from the start of operations until a second.
struct Watch<'a> {
    day: &'a Scenario,
    aircraft: &'a Aircraft,
    kwh: f64,
    spent: Spent,
    now_s: u32,
}

impl Watch<'_> {
    fn kind(&self) -> &AircraftType {
        &self.day.aircraft_types[self.aircraft.kind.at()]
    }

    /// Stands until a second. `grounded` is the time of an outage after the turnaround.
    fn stand(&mut self, at: VertiportIx, until_s: u32, grounded: (u32, u32)) {
        let at = &self.day.vertiports[at.at()];
        while self.now_s < until_s {
            let full_kwh = self.kind().battery_kwh;
            if self.kwh < full_kwh - FULL_KWH {
                self.spent.charging += 1;
                for _ in 0..STEPS {
                    let seconds = 1.0 / f64::from(STEPS);
                    let half_kwh = 0.5 * seconds * power_kw(self.kind(), at, self.kwh) / 3600.0;
                    let kw = power_kw(self.kind(), at, (self.kwh + half_kwh).min(full_kwh));
                    self.kwh = (self.kwh + seconds * kw / 3600.0).min(full_kwh);
                }
            } else if (grounded.0..grounded.1).contains(&self.now_s) {
                self.spent.out_of_service += 1;
            } else {
                self.spent.waiting += 1;
            }
            self.now_s += 1;
        }
    }

    /// Flies. Returns the time for which an outage keeps the aircraft on the ground afterwards.
    fn fly(&mut self, row: &TraceRow, flight_s: u32, until_s: u32) -> (u32, u32) {
        let arrival_s = row.arrival.seconds();
        assert_eq!(self.now_s, until_s.min(arrival_s - flight_s), "it left its stand in time");
        self.spent.flying += until_s.min(arrival_s) - self.now_s;
        self.now_s = until_s.min(arrival_s);
        self.kwh -= row.energy_kwh;
        // Days that charge to full round the time of charging, by at most half a second at 250 kW.
        assert!(self.kwh > self.kind().reserve_kwh - 0.04, "{} kWh at landing", self.kwh);
        let outages = self.day.disturbances.outages.iter();
        let own = outages.filter(|outage| outage.aircraft == row.aircraft);
        let within = own.filter(|outage| outage.start <= row.arrival && row.arrival < outage.end);
        let end_s = within.map(|outage| outage.end.seconds()).max().unwrap_or(0);
        (arrival_s + self.kind().turnaround_s, end_s)
    }
}

/// Integrates the trace of one aircraft.
fn watched(day: &Scenario, rows: &[TraceRow], position: usize, until_s: u32) -> Spent {
    let aircraft = &day.aircraft[position];
    let kwh = aircraft.start_charge_kwh;
    let kwh = kwh.unwrap_or(day.aircraft_types[aircraft.kind.at()].battery_kwh);
    let now_s = day.operations.start.seconds();
    let mut watch = Watch { day, aircraft, kwh, spent: Spent::default(), now_s };
    let (mut at, mut grounded) = (aircraft.at, (0, 0));
    for row in rows.iter().filter(|row| row.aircraft.at() == position && row.from != row.to) {
        let cruise_s = 3600.0 * day.distance_mi[(row.from, row.to)] / watch.kind().speed_mph;
        let flight_s = day.operations.takeoff_s + whole(cruise_s) + day.operations.landing_s;
        let leaves_s = row.arrival.seconds() - flight_s;
        watch.stand(at, leaves_s.min(until_s), grounded);
        if leaves_s >= until_s {
            break;
        }
        grounded = watch.fly(row, flight_s, until_s);
        at = row.to;
    }
    watch.stand(at, until_s, grounded);
    watch.spent
}

/// The widths of the bars that look like an entry of the legend, added up by row; pixels.
fn widths(svg: &str, entry: &str, rows: usize) -> Vec<f64> {
    let legend = svg.split("<rect").find(|one| one.contains(&format!(">{entry}</text>")));
    let of = |text: &str, name: &str| {
        let from = text.split_once(&format!("{name}=\"")).map(|(_, from)| from.to_owned());
        from.and_then(|from| Some(from.split_once('"')?.0.to_owned()))
    };
    let mut widths = vec![0.0; rows];
    let Some(legend) = legend else { return widths };
    let is_alike = |one: &str| {
        ["fill", "fill-opacity"].into_iter().all(|name| of(one, name) == of(legend, name))
    };
    let paths = svg
        .split("<path")
        .skip(1)
        .filter(|one| is_alike(one.split('>').next().expect("a first part")));
    for path in paths {
        for block in of(path, " d").expect("a path").split('M').skip(1) {
            let numbers = block.split(|c: char| !c.is_ascii_digit() && c != '.' && c != '-');
            let numbers: Vec<f64> = numbers.filter_map(|one| one.parse().ok()).collect();
            // A row is 10 pixels high, and its bar begins above the middle of it.
            widths[whole((numbers[1] - 76.0) / 10.0 - 0.5) as usize] += numbers[2];
        }
    }
    widths
}

#[test]
fn hours_are_those_of_the_trace_integrated_second_by_second() {
    let (mut holds_charge, mut delayed, mut grounded) = (0, 0, 0.0);
    for (number, day) in days().enumerate() {
        let (trace, totals) = played(&day);
        let rows = trace.rows.clone();
        let account = Account::of(&day, "next", trace, totals);
        let end_s = day.operations.end.seconds();
        for (position, found) in account.aircraft.iter().enumerate() {
            let right = watched(&day, &rows, position, end_s);
            // Days that charge to full round each time of charging to the nearest second.
            let near = |hours: f64, seconds: u32| {
                (3600.0 * hours - f64::from(seconds)).abs() <= f64::from(found.flights) + 2.0
            };
            assert!(
                near(found.flying_h, right.flying)
                    && near(found.charging_h, right.charging)
                    && near(found.out_of_service_h, right.out_of_service)
                    && near(found.waiting_h, right.waiting),
                "day {number}: {found:?}, in seconds {right:?}"
            );
            grounded += found.out_of_service_h;
        }
        let is_as_needed = day.operations.charging == Charging::AsNeeded;
        let is_short = |row: &&TraceRow| {
            let kind = day.aircraft[row.aircraft.at()].kind;
            row.charge_kwh < day.aircraft_types[kind.at()].battery_kwh
        };
        let holds = rows.iter().filter(|row| row.from == row.to);
        holds_charge += if is_as_needed { holds.filter(is_short).count() } else { 0 };
        delayed += usize::from(is_as_needed && day.disturbances.takeoff_delays.is_some());
    }
    assert!(holds_charge > 100 && delayed > 5 && grounded > 1.0, "the days have every kind");
}

#[test]
fn the_picture_of_aircraft_draws_them_charging_for_as_long() {
    for day in days().filter(|day| day.aircraft.len() <= 30) {
        let (Trace { rows }, _) = played(&day);
        let last_s = rows.iter().map(|row| row.ready.seconds()).max().unwrap_or(0);
        let start_s = day.operations.start.seconds();
        let end_s = last_s.max(day.operations.end.seconds());
        let svg = PlayedPicture::Aircraft.draw(&day, &rows);
        let drawn = widths(&svg, "charging", day.aircraft.len());
        // The area is 912 pixels wide, and each end of a bar is drawn to a tenth of one.
        let a_pixel_s = f64::from(end_s - start_s) / 912.0;
        for (position, pixels) in drawn.iter().enumerate() {
            let flights = rows.iter().filter(|row| row.aircraft.at() == position).count();
            let right = watched(&day, &rows, position, end_s).charging;
            let off_s = (a_pixel_s * pixels - f64::from(right)).abs();
            assert!(
                off_s <= (0.1 * a_pixel_s + 1.0) * (flights + 2) as f64,
                "{}: {pixels} pixels for {right} seconds",
                day.aircraft[position].id
            );
        }
    }
}
