//! The rules that every day obeys, checked once: code that holds a [`Scenario`] may rely on them.
//!
//! Bounds of single numbers are in `limits.rs`. This file checks that the members of a day agree
//! with each other.

use std::collections::HashSet;

use crate::limits::{self, Limits, entries};
use crate::{Day, Error, FormatError, Matrix, Scenario, Time};

mod beyond;
mod energy;

impl Day {
    /// Checks every rule; `origin` names the file, or the other source of the day, in messages.
    ///
    /// # Errors
    /// The first rule that is broken, with its member and value.
    pub fn check(self, origin: &str) -> Result<Scenario, Error> {
        self.checked().map_err(|error| error.in_file(origin))
    }

    /// Checks every rule.
    pub(crate) fn checked(self) -> Result<Scenario, FormatError> {
        Check { day: &self }.everything()?;
        Ok(Scenario::checked(self))
    }
}

/// Refuses an empty list and one longer than `most`.
pub(crate) fn entry_count(member: &str, found: usize, most: usize) -> Result<(), FormatError> {
    if (1..=most).contains(&found) {
        return Ok(());
    }
    Err(FormatError::EntryCount { member: member.to_owned(), most, found })
}

/// Refuses more cells of demand than a day may have.
pub(crate) fn demand_cells(vertiports: usize, periods: usize) -> Result<(), FormatError> {
    let cells = vertiports * vertiports * periods;
    entry_count("demand (vertiports x vertiports x periods)", cells, entries::DEMAND)
}

/// Refuses a name that is empty, too long, or cannot be printed on one line.
pub(crate) fn id(member: impl FnOnce() -> String, id: &str) -> Result<(), FormatError> {
    const RULE: &str = "1 to 64 characters without control characters";
    if (1..=64).contains(&id.chars().count()) && !id.chars().any(char::is_control) {
        return Ok(());
    }
    let found = id.chars().take(64).collect();
    Err(FormatError::BadId { member: member(), rule: RULE, found })
}

/// Refuses ids that are not well formed or not unique; `list` is the list's name in the file,
/// `entry` the word for one of its entries.
pub(crate) fn ids<'a>(
    list: &str,
    entry: &str,
    ids: impl Iterator<Item = &'a String>,
) -> Result<(), FormatError> {
    let mut seen = HashSet::new();
    for (at, one) in ids.enumerate() {
        id(|| format!("{list}[{at}]: id"), one)?;
        if !seen.insert(one) {
            let member = format!("{list}[{at}]: {entry} {one:?}");
            return Err(FormatError::DuplicateId { member });
        }
    }
    Ok(())
}

/// Refuses a span that ends before it starts, or later than any day.
pub(crate) fn span(start: Time, end: Time, member: impl Fn() -> String) -> Result<(), FormatError> {
    if start > end {
        return Err(FormatError::StartAfterEnd {
            member: member(),
            start: start.to_string(),
            end: end.to_string(),
        });
    }
    not_too_late(end, || format!("{}: end", member()))
}

fn not_too_late(time: Time, member: impl FnOnce() -> String) -> Result<(), FormatError> {
    if time <= limits::LATEST {
        return Ok(());
    }
    Err(FormatError::OutOfRange {
        member: member(),
        rule: format!("at most {}", limits::LATEST),
        found: time.to_string(),
        hint: None,
    })
}

/// A day that is being checked. Each function checks one family of rules.
struct Check<'a> {
    day: &'a Day,
}

impl Check<'_> {
    fn everything(&self) -> Result<(), FormatError> {
        id(|| "name".to_owned(), &self.day.name)?;
        self.seed()?;
        self.operations()?;
        self.periods()?;
        self.passenger_wait()?;
        self.vertiports()?;
        self.aircraft_types()?;
        self.aircraft()?;
        self.start_charges()?;
        self.distances()?;
        self.money()?;
        self.demand()?;
        self.corridors()?;
        self.disturbances()
    }

    fn seed(&self) -> Result<(), FormatError> {
        if self.day.seed < limits::SEED_LIMIT {
            return Ok(());
        }
        Err(FormatError::SeedOutOfRange { found: self.day.seed.to_string() })
    }

    fn operations(&self) -> Result<(), FormatError> {
        let operations = &self.day.operations;
        let number = |value: u32, limits: &Limits, member: &str| {
            limits.check(f64::from(value), || format!("operations: {member}"))
        };
        span(operations.start, operations.end, || "operations".to_owned())?;
        number(operations.takeoff_s, &limits::PHASE_S, "takeoff_s")?;
        number(operations.landing_s, &limits::PHASE_S, "landing_s")?;
        number(
            operations.takeoff_s + operations.landing_s,
            &limits::FLIGHT_S,
            "takeoff_s + landing_s",
        )?;
        number(operations.hold_s, &limits::HOLD_S, "hold_s")
    }

    fn periods(&self) -> Result<(), FormatError> {
        let periods = &self.day.periods;
        entry_count("periods", periods.len(), entries::PERIODS)?;
        let start = self.day.operations.start;
        let order = |at: usize, rule: String| FormatError::PeriodOrder {
            member: format!("periods[{at}]"),
            rule,
            found: periods[at].to_string(),
        };
        if periods[0] > start {
            return Err(order(0, format!("no later than the start of operations {start}")));
        }
        if let Some(at) = periods.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(order(at + 1, format!("after the period before it, {}", periods[at])));
        }
        let last = periods.len() - 1;
        not_too_late(periods[last], || format!("periods[{last}]"))
    }

    /// Checks that passengers who wait into the next period have left when that one ends.
    fn passenger_wait(&self) -> Result<(), FormatError> {
        let wait_s = self.day.operations.passenger_wait_s;
        let member = || "operations: passenger_wait_s".to_owned();
        limits::PASSENGER_WAIT_S.check(f64::from(wait_s), member)?;
        let lengths_s = self.day.periods.windows(2).map(|pair| pair[1].since(pair[0]));
        let Some(shortest_s) = lengths_s.min().filter(|&shortest_s| wait_s > shortest_s) else {
            return Ok(());
        };
        Err(FormatError::OutOfRange {
            member: member(),
            rule: format!(
                "at most {shortest_s}, the length of the shortest demand period that another one follows"
            ),
            found: wait_s.to_string(),
            hint: Some(limits::PASSENGER_WAIT_HINT),
        })
    }

    fn vertiports(&self) -> Result<(), FormatError> {
        let vertiports = &self.day.vertiports;
        entry_count("vertiports", vertiports.len(), entries::VERTIPORTS)?;
        ids("vertiports", "vertiport", vertiports.iter().map(|vertiport| &vertiport.id))?;
        for vertiport in vertiports {
            let number = |value: f64, limits: &Limits, member: &str| {
                limits.check(value, || format!("vertiport {:?}: {member}", vertiport.id))
            };
            number(vertiport.x_mi, &limits::POSITION_MI, "x_mi")?;
            number(vertiport.y_mi, &limits::POSITION_MI, "y_mi")?;
            number(vertiport.stands.into(), &limits::STANDS, "stands")?;
            if let Some(chargers) = vertiport.chargers {
                number(chargers.into(), &limits::CHARGERS, "chargers")?;
            }
            if let Some(charger_kw) = vertiport.charger_kw {
                number(charger_kw, &limits::CHARGE_KW, "charger_kw")?;
            }
            number(vertiport.stand_cost_usd, &limits::MONEY_USD, "stand_cost")?;
            number(vertiport.charger_cost_usd, &limits::MONEY_USD, "charger_cost")?;
            if let Some(degrees) = vertiport.degrees {
                number(degrees.latitude, &limits::LATITUDE, "latitude")?;
                number(degrees.longitude, &limits::LONGITUDE, "longitude")?;
            }
        }
        Ok(())
    }

    fn aircraft_types(&self) -> Result<(), FormatError> {
        let kinds = &self.day.aircraft_types;
        entry_count("aircraft_types", kinds.len(), entries::AIRCRAFT_TYPES)?;
        ids("aircraft_types", "aircraft type", kinds.iter().map(|kind| &kind.id))?;
        for kind in kinds {
            let number = |value: f64, limits: &Limits, member: &str| {
                limits.check(value, || format!("aircraft type {:?}: {member}", kind.id))
            };
            number(kind.seats.into(), &limits::SEATS, "seats")?;
            number(kind.speed_mph, &limits::SPEED_MPH, "speed_mph")?;
            number(kind.battery_kwh, &limits::BATTERY_KWH, "battery_kwh")?;
            number(kind.energy_kwh_per_mi, &limits::ENERGY_KWH_PER_MI, "energy_kwh_per_mi")?;
            number(kind.charge_kw, &limits::CHARGE_KW, "charge_kw")?;
            number(
                kind.self_discharge_per_h,
                &limits::SELF_DISCHARGE_PER_H,
                "self_discharge_per_h",
            )?;
            Self::energy(kind)?;
        }
        Ok(())
    }

    fn aircraft(&self) -> Result<(), FormatError> {
        let day = self.day;
        entry_count("aircraft", day.aircraft.len(), entries::AIRCRAFT)?;
        ids("aircraft", "aircraft", day.aircraft.iter().map(|aircraft| &aircraft.id))?;
        let mut standing = vec![0; day.vertiports.len()];
        for aircraft in &day.aircraft {
            let unknown = |member: &str, index: usize, list| FormatError::UnknownId {
                member: format!("aircraft {:?}: {member}", aircraft.id),
                found: format!("#{index}"),
                list,
            };
            if aircraft.kind.at() >= day.aircraft_types.len() {
                return Err(unknown("type", aircraft.kind.at(), "aircraft types"));
            }
            let Some(count) = standing.get_mut(aircraft.at.at()) else {
                return Err(unknown("at", aircraft.at.at(), "vertiports"));
            };
            *count += 1;
        }
        for (vertiport, &aircraft) in day.vertiports.iter().zip(&standing) {
            if aircraft > usize::from(vertiport.stands) {
                return Err(FormatError::StandsExceeded {
                    vertiport: vertiport.id.clone(),
                    stands: vertiport.stands,
                    aircraft,
                });
            }
        }
        Ok(())
    }

    fn distances(&self) -> Result<(), FormatError> {
        let distances = &self.day.distance_mi;
        self.square(distances, || "distance_mi".to_owned())?;
        cells(distances, &limits::DISTANCE_MI, "distance_mi")?;
        for (at, row) in distances.rows().enumerate() {
            if row[at] != 0.0 {
                return Err(FormatError::OutOfRange {
                    member: format!("distance_mi[{at}][{at}]"),
                    rule: "0".to_owned(),
                    found: limits::number(row[at]),
                    hint: Some("the diagonal is the distance from a vertiport to itself"),
                });
            }
        }
        Ok(())
    }

    fn money(&self) -> Result<(), FormatError> {
        let day = self.day;
        let fares = day.fare_usd.tables();
        let tables = fares.clone().count();
        if tables != 1 {
            self.per_period("fare", tables)?;
        }
        for (period, table) in fares.enumerate() {
            let member = if tables == 1 { "fare".to_owned() } else { format!("fare[{period}]") };
            self.square(table, || member.clone())?;
            cells(table, &limits::MONEY_USD, &member)?;
        }
        self.square(&day.passenger_cost_usd, || "passenger_cost".to_owned())?;
        cells(&day.passenger_cost_usd, &limits::MONEY_USD, "passenger_cost")?;
        self.square(&day.flight_cost_usd, || "flight_cost".to_owned())?;
        cells(&day.flight_cost_usd, &limits::MONEY_USD, "flight_cost")?;
        let member = || "aircraft_cost".to_owned();
        limits::MONEY_USD.check(day.aircraft_cost_usd, member)?;
        self.per_period("energy_price", day.energy_price_usd.len())?;
        for (at, &price) in day.energy_price_usd.iter().enumerate() {
            limits::ENERGY_PRICE_USD.check(price, || format!("energy_price[{at}]"))?;
        }
        Ok(())
    }

    fn demand(&self) -> Result<(), FormatError> {
        self.passengers(&self.day.demand, "demand")
    }

    /// Checks that there is a table of passengers for each period, and that each has 0 on the
    /// diagonal.
    fn passengers(&self, tables: &[Matrix<u32>], member: &str) -> Result<(), FormatError> {
        self.per_period(member, tables.len())?;
        demand_cells(self.day.vertiports.len(), self.day.periods.len())?;
        for (period, table) in tables.iter().enumerate() {
            self.square(table, || format!("{member}[{period}]"))?;
            for (from, row) in table.rows().enumerate() {
                for (to, &passengers) in row.iter().enumerate() {
                    let member = || format!("{member}[{period}][{from}][{to}]");
                    limits::PASSENGERS.check(passengers.into(), member)?;
                    if from == to && passengers != 0 {
                        return Err(FormatError::SelfDemand {
                            member: member(),
                            found: passengers,
                        });
                    }
                }
            }
        }
        Ok(())
    }

    fn square<T>(
        &self,
        table: &Matrix<T>,
        member: impl FnOnce() -> String,
    ) -> Result<(), FormatError> {
        let size = self.day.vertiports.len();
        if table.size() == size {
            return Ok(());
        }
        Err(FormatError::WrongShape {
            member: member(),
            expected: format!("a row and a column for each of {size} vertiports"),
            found: table.size(),
        })
    }

    fn per_period(&self, member: &str, found: usize) -> Result<(), FormatError> {
        let periods = self.day.periods.len();
        if found == periods {
            return Ok(());
        }
        Err(FormatError::WrongShape {
            member: member.to_owned(),
            expected: format!("an entry for each of {periods} periods"),
            found,
        })
    }
}

/// Checks every cell of a table.
fn cells(table: &Matrix<f64>, limits: &Limits, member: &str) -> Result<(), FormatError> {
    for (from, row) in table.rows().enumerate() {
        for (to, &value) in row.iter().enumerate() {
            limits.check(value, || format!("{member}[{from}][{to}]"))?;
        }
    }
    Ok(())
}
