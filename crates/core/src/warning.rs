//! Properties of a scenario or a network that are allowed but probably unintended. They are found
//! on request, and no file is refused for them.

use std::fmt;

use crate::{
    Aircraft, AircraftType, ChargeRate, Charging, Code, Degrees, Matrix, Network, Scenario, Time,
    VertiportIx, great_circle_mi, limits, whole_mwh,
};

/// A property of a scenario or a network that is allowed but probably unintended.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// V120 aircraft without a destination (warning). From the vertiport where the aircraft starts,
    /// no other vertiport is within the range of a full battery, so the aircraft stands there all
    /// day. This is a warning: the day is played all the same.
    ///
    /// Fix: start the aircraft elsewhere, or check its type's battery and the distances.
    NoDestination {
        /// The aircraft.
        aircraft: String,
        /// Its type.
        kind: String,
        /// The vertiport where it starts.
        at: String,
    },

    /// V125 aircraft that is charged too late (warning). An aircraft starts the day with less than
    /// it needs to leave, and charges so slowly where it starts that it has that only after
    /// operations end. It needs the energy of a flight and the reserve where `charging` is
    /// `"as_needed"`, and a full battery otherwise. It stands there all day. This is a warning: the
    /// day is played all the same.
    ///
    /// Fix: raise the aircraft's `start_charge_kwh`, its type's `charge_kw` or `charge_curve`, or
    /// the vertiport's `charger_kw`.
    ChargedTooLate {
        /// The aircraft.
        aircraft: String,
        /// Its type.
        kind: String,
        /// The vertiport where it starts.
        at: String,
        /// What its battery needs at least before it leaves, kWh.
        needed_kwh: f64,
        /// When its battery has that.
        charged_at: Time,
        /// The end of operations.
        end: Time,
    },

    /// V135 vertiport out of reach (warning). No aircraft of the fleet can fly to or from a
    /// vertiport: it is too far from all others, or no corridor leads there. Often a longitude west
    /// of Greenwich was written without its minus sign; the message states at which position the
    /// vertiport would be within reach. This is a warning: days are played all the same, and no
    /// aircraft flies there.
    ///
    /// Fix: correct the position, or add a corridor, or remove the vertiport.
    OutOfReach {
        /// The vertiport.
        vertiport: String,
        /// The cause, or the likely one.
        cause: Cause,
    },

    /// V136 no stand free (warning). The fleet has as many aircraft as there are stands. A flight
    /// needs a free stand at its destination when it begins, so no aircraft ever flies. This is a
    /// warning: days are played all the same.
    ///
    /// Fix: add stands, or take fewer aircraft; a tenth more stands than aircraft is little.
    NoStandFree {
        /// Number of aircraft, which is also that of the stands.
        aircraft: usize,
    },

    /// V137 pairs out of reach (warning). At least one passenger in a hundred wants to fly between
    /// two vertiports that no aircraft of the fleet can fly between: no corridor joins them, or
    /// they are too far apart. They count as passengers who want to fly and are spilled, with any
    /// fleet. This is a warning: days are played all the same, and no share of all passengers
    /// beyond the others can be reached.
    ///
    /// Fix: add the corridors, or take the pairs out of the demand.
    PairsOutOfReach {
        /// Mean number of these passengers a day.
        passengers: f64,
        /// Mean number of all passengers a day.
        of_all: f64,
        /// The pair that most of them want to fly.
        most: (String, String),
    },

    /// V138 passengers outside the hours of operation (warning). At least one passenger in a
    /// hundred wants to fly in a period that ends before operations begin or begins after they end.
    /// They count as passengers who want to fly and are spilled, with any fleet. This is a warning:
    /// days are played all the same.
    ///
    /// Fix: change `operations`, or the periods of the demand.
    OutsideOperations {
        /// Mean number of these passengers a day.
        passengers: f64,
        /// Mean number of all passengers a day.
        of_all: f64,
    },

    /// V139 dear electricity (warning). Electricity costs more than 2 dollars a kWh on the mean of
    /// the demand periods, or more than 10 in one of them. The price is probably one for a MWh, or
    /// in cents. This is a warning: days are played all the same.
    ///
    /// Fix: give dollars a kWh. 45 dollars a MWh are 0.045 dollars a kWh.
    DearEnergy {
        /// The highest price of a demand period, dollars a kWh.
        usd_per_kwh: f64,
    },
}

/// The mean price of electricity, and the price of one period, above which the unit is probably
/// another one; dollars a kWh. Wholesale markets have had prices of 9 dollars for some hours.
const DEAR_USD: (f64, f64) = (2.0, 10.0);

/// Shares of the demand below this are not worth a warning.
const LEAST_SHARE: f64 = 0.01;

/// The reason why a vertiport is out of reach.
#[derive(Debug, Clone, PartialEq)]
pub enum Cause {
    /// No corridor leads to or from it, though others are near enough.
    NoCorridor,
    /// It lies too far from all others.
    TooFar {
        /// Miles to the nearest other vertiport.
        nearest_mi: f64,
    },
    /// It lies too far from all others, but would not if a degree had another sign or the two were
    /// exchanged.
    Misplaced {
        /// Miles to the nearest other vertiport.
        nearest_mi: f64,
        /// The likely position.
        likely: Degrees,
    },
}

impl Warning {
    /// The stable number, printed as `V120`.
    pub fn code(&self) -> Code {
        match self {
            Self::NoDestination { .. } => Code(120),
            Self::ChargedTooLate { .. } => Code(125),
            Self::OutOfReach { .. } => Code(135),
            Self::NoStandFree { .. } => Code(136),
            Self::PairsOutOfReach { .. } => Code(137),
            Self::OutsideOperations { .. } => Code(138),
            Self::DearEnergy { .. } => Code(139),
        }
    }

    /// Whether it is about passengers whom no fleet can carry.
    pub fn is_about_demand(&self) -> bool {
        matches!(self, Self::PairsOutOfReach { .. } | Self::OutsideOperations { .. })
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDestination { aircraft, kind, at } => write!(
                f,
                "aircraft {aircraft:?} of type {kind:?} reaches no other vertiport from {at:?}: it stands there all day"
            ),
            Self::ChargedTooLate { aircraft, kind, at, needed_kwh, charged_at, end } => write!(
                f,
                "aircraft {aircraft:?} of type {kind:?} never leaves {at:?}: its battery has the {needed_kwh:.1} kWh that it needs only at {charged_at}, and operations end at {end}"
            ),
            Self::OutOfReach { vertiport, cause } => {
                write!(f, "no aircraft can fly to or from vertiport {vertiport:?}: {cause}")
            }
            Self::NoStandFree { aircraft } => write!(
                f,
                "{aircraft} aircraft fill all {aircraft} stands: a flight needs a free one, so none ever flies"
            ),
            Self::PairsOutOfReach { passengers, of_all, most: (from, to) } => write!(
                f,
                "{passengers:.0} of {of_all:.0} passengers a day want to fly where no aircraft can, most of them from {from:?} to {to:?}: they are always spilled"
            ),
            Self::OutsideOperations { passengers, of_all } => write!(
                f,
                "{passengers:.0} of {of_all:.0} passengers a day want to fly outside the hours of operation: they are always spilled"
            ),
            Self::DearEnergy { usd_per_kwh } => write!(
                f,
                "electricity costs up to {usd_per_kwh} dollars a kWh: {usd_per_kwh} dollars a MWh would be {} dollars a kWh",
                limits::number(usd_per_kwh / 1e3)
            ),
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCorridor => f.write_str("no corridor that an aircraft can fly leads there"),
            Self::TooFar { nearest_mi } => {
                write!(f, "the nearest other vertiport is {nearest_mi:.0} miles away")
            }
            Self::Misplaced { nearest_mi, likely: Degrees { latitude, longitude } } => write!(
                f,
                "the nearest other vertiport is {nearest_mi:.0} miles away; at latitude {latitude} and longitude {longitude} it would be within reach"
            ),
        }
    }
}

impl Network {
    /// The warnings of this network, in file order: those that hold on every day of it.
    pub fn warnings(&self) -> Vec<Warning> {
        let day = &self.idle_day;
        let means = self.mean_demand();
        let of_all = means.iter().flat_map(Matrix::cells).sum();
        let mut warnings = day.out_of_reach();
        // The pairs of a vertiport that is named already need not be named again.
        let pairs = warnings.is_empty().then(|| self.pairs_out_of_reach(&means, of_all)).flatten();
        warnings.extend(day.full().into_iter().chain(pairs));
        warnings.extend(self.outside_operations(&means, of_all));
        warnings.extend(day.dear_energy());
        warnings
    }

    fn pairs_out_of_reach(&self, means: &[Matrix<f64>], of_all: f64) -> Option<Warning> {
        let day = &self.idle_day;
        let fleet = day.fleet_types();
        let size = day.vertiports.len();
        let pairs =
            VertiportIx::all(size).flat_map(|from| day.others(from).map(move |to| (from, to)));
        let lost = pairs
            .filter(|&(from, to)| !fleet.iter().any(|kind| day.can_fly(kind, from, to)))
            .map(|pair| (pair, means.iter().map(|table| table[pair]).sum::<f64>()));
        let lost: Vec<((VertiportIx, VertiportIx), f64)> = lost.collect();
        let passengers: f64 = lost.iter().map(|(_, passengers)| passengers).sum();
        let &((from, to), _) = lost.iter().max_by(|one, other| one.1.total_cmp(&other.1))?;
        let id = |at: VertiportIx| day.vertiports[at.at()].id.clone();
        let most = (id(from), id(to));
        is_much(passengers, of_all).then_some(Warning::PairsOutOfReach { passengers, of_all, most })
    }

    fn outside_operations(&self, means: &[Matrix<f64>], of_all: f64) -> Option<Warning> {
        let day = &self.idle_day;
        let operations = &day.operations;
        let ends = day.periods.iter().skip(1).copied().chain([limits::LATEST]);
        let periods = day.periods.iter().zip(ends).zip(means);
        let lost = periods.filter(|((start, end), _)| {
            // The paper's last period begins as operations end, and is not counted.
            **start > operations.end || *end + operations.passenger_wait_s <= operations.start
        });
        let passengers: f64 = lost.flat_map(|(_, table)| table.cells()).sum();
        is_much(passengers, of_all).then_some(Warning::OutsideOperations { passengers, of_all })
    }
}

impl Scenario {
    /// The warnings of this scenario, in file order.
    pub fn warnings(&self) -> Vec<Warning> {
        let stranded = self.aircraft.iter().filter_map(|aircraft| self.stranded(aircraft));
        let warnings = self.out_of_reach().into_iter().chain(stranded);
        warnings.chain(self.full()).chain(self.dear_energy()).collect()
    }

    /// The warning that the price of electricity is probably in another unit.
    fn dear_energy(&self) -> Option<Warning> {
        let prices = &self.energy_price_usd;
        let usd_per_kwh = prices.iter().copied().fold(0.0, f64::max);
        let mean = prices.iter().sum::<f64>() / prices.len() as f64;
        let is_dear = mean > DEAR_USD.0 || usd_per_kwh > DEAR_USD.1;
        is_dear.then_some(Warning::DearEnergy { usd_per_kwh })
    }

    /// The warning that an aircraft stays all day where it starts.
    fn stranded(&self, aircraft: &Aircraft) -> Option<Warning> {
        let (kind, start) = (&self.aircraft_types[aircraft.kind.at()], aircraft.at);
        if !self.others(start).any(|to| self.can_fly(kind, start, to)) {
            return Some(Warning::NoDestination {
                aircraft: aircraft.id.clone(),
                kind: kind.id.clone(),
                at: self.vertiports[start.at()].id.clone(),
            });
        }
        // A full battery lasts for each of these flights, and studies ask this of every day.
        aircraft.start_charge_kwh.and_then(|kwh| self.charged_too_late(aircraft, kwh))
    }

    /// The warning that an aircraft which starts with this charge has enough only after the end.
    fn charged_too_late(&self, aircraft: &Aircraft, start_kwh: f64) -> Option<Warning> {
        let (kind, start) = (&self.aircraft_types[aircraft.kind.at()], aircraft.at);
        let place = &self.vertiports[start.at()];
        let flown = self.others(start).filter(|&to| self.can_fly(kind, start, to));
        let energies = flown.map(|to| self.energy_kwh(kind, self.distance_mi[(start, to)]));
        let least_mwh = energies.map(|kwh| kind.needed_mwh(kwh)).min()?;
        let rate = ChargeRate::of(kind, place);
        let battery = rate.battery(whole_mwh(start_kwh));
        let (leaves_with_mwh, charged_s) = match self.operations.charging {
            Charging::ToFull => (rate.full_mwh(), nearest_second(rate.to_full_s(battery, 0))),
            Charging::AsNeeded => (least_mwh, rate.needed_s(battery, rate.need(least_mwh))),
        };
        let charged_at = self.operations.start + charged_s;
        let end = self.operations.end;
        (charged_at > end).then(|| Warning::ChargedTooLate {
            aircraft: aircraft.id.clone(),
            kind: kind.id.clone(),
            at: place.id.clone(),
            needed_kwh: leaves_with_mwh as f64 / 1e6,
            charged_at,
            end,
        })
    }

    /// The warning that all stands are taken permanently. Where chargers are counted apart, they
    /// are free when the day begins.
    fn full(&self) -> Option<Warning> {
        let pools = self.vertiports.iter().all(|vertiport| vertiport.chargers.is_none());
        let stands: usize = self.vertiports.iter().map(|one| usize::from(one.stands)).sum();
        let aircraft = self.aircraft.len();
        (pools && self.vertiports.len() > 1 && aircraft >= stands)
            .then_some(Warning::NoStandFree { aircraft })
    }

    /// The vertiports that no aircraft can reach or leave. A network of a single vertiport has
    /// none.
    fn out_of_reach(&self) -> Vec<Warning> {
        let fleet = self.fleet_types();
        let reached = |vertiport| {
            self.others(vertiport).any(|other| {
                fleet.iter().any(|kind| {
                    self.can_fly(kind, vertiport, other) || self.can_fly(kind, other, vertiport)
                })
            })
        };
        let all = VertiportIx::all(self.vertiports.len()).filter(|_| self.vertiports.len() > 1);
        all.filter(|&vertiport| !reached(vertiport))
            .map(|vertiport| Warning::OutOfReach {
                vertiport: self.vertiports[vertiport.at()].id.clone(),
                cause: self.cause(vertiport, &fleet),
            })
            .collect()
    }

    /// The types that the fleet has aircraft of.
    pub(crate) fn fleet_types(&self) -> Vec<&AircraftType> {
        let types = self.aircraft_types.iter().enumerate();
        let flown =
            types.filter(|&(at, _)| self.aircraft.iter().any(|aircraft| aircraft.kind.at() == at));
        flown.map(|(_, kind)| kind).collect()
    }

    /// The reason why no aircraft can reach or leave a vertiport.
    fn cause(&self, vertiport: VertiportIx, fleet: &[&AircraftType]) -> Cause {
        let reaches = |mi| fleet.iter().any(|kind| self.reaches(kind, mi));
        let ways = |other| {
            let there = self.distance_mi[(vertiport, other)];
            there.min(self.distance_mi[(other, vertiport)])
        };
        let nearest_mi = self.others(vertiport).map(ways).fold(f64::INFINITY, f64::min);
        if reaches(nearest_mi) {
            return Cause::NoCorridor;
        }
        let near_others = |degrees: &Degrees| {
            let place = (degrees.latitude, degrees.longitude);
            self.others(vertiport)
                .filter_map(|other| self.vertiports[other.at()].degrees)
                .any(|other| reaches(great_circle_mi(place, (other.latitude, other.longitude))))
        };
        let written = self.vertiports[vertiport.at()].degrees;
        let likely =
            written.and_then(|written| likely_positions(written).into_iter().find(near_others));
        match likely {
            Some(likely) => Cause::Misplaced { nearest_mi, likely },
            None => Cause::TooFar { nearest_mi },
        }
    }

    fn others(&self, vertiport: VertiportIx) -> impl Iterator<Item = VertiportIx> + use<> {
        VertiportIx::all(self.vertiports.len()).filter(move |&other| other != vertiport)
    }

    fn can_fly(&self, kind: &AircraftType, from: VertiportIx, to: VertiportIx) -> bool {
        self.is_corridor(from, to) && self.reaches(kind, self.distance_mi[(from, to)])
    }

    /// Whether a full battery lasts for a flight of this length.
    fn reaches(&self, kind: &AircraftType, distance_mi: f64) -> bool {
        kind.lasts_for(self.energy_kwh(kind, distance_mi))
    }

    /// What a flight takes: e d_ij and the self-discharge on the way, kWh. Cruise is rounded to
    /// whole seconds.
    fn energy_kwh(&self, kind: &AircraftType, distance_mi: f64) -> f64 {
        let cruise_s = (3600.0 * distance_mi / kind.speed_mph).round();
        let windows_s = self.operations.takeoff_s + self.operations.landing_s;
        let flight_h = (f64::from(windows_s) + cruise_s) / 3600.0;
        let lost_kwh = kind.battery_kwh * kind.self_discharge_per_h * flight_h;
        kind.energy_kwh_per_mi * distance_mi + lost_kwh
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "never negative, and a full charge takes at most 5,000 hours"
)]
fn nearest_second(seconds: f64) -> u32 {
    seconds.round() as u32
}

/// Whether this share of all passengers is worth a warning.
fn is_much(passengers: f64, of_all: f64) -> bool {
    passengers > 0.0 && passengers >= LEAST_SHARE * of_all
}

/// The positions that may have been intended by these degrees, with a sign missing or added, or the
/// two degrees exchanged.
fn likely_positions(Degrees { latitude, longitude }: Degrees) -> [Degrees; 5] {
    [
        Degrees { latitude, longitude: -longitude },
        Degrees { latitude: -latitude, longitude },
        Degrees { latitude: -latitude, longitude: -longitude },
        Degrees { latitude: longitude, longitude: latitude },
        Degrees { latitude: longitude, longitude: -latitude },
    ]
}
