//! Draws one day of a network from a seed: demand, start positions (§V.A) and disturbances.
//!
//! Demand, start positions and each kind of disturbance have separate random streams, so that a
//! change in how one of them is drawn leaves the others as they were. The generator and the normal
//! distribution are plain arithmetic, the same on every machine, and counts are rounded.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::random::rounded_by_chance;
use crate::{
    AircraftType, ChargeRate, Charging, Day, DaySeed, Matrix, Network, Scenario, Vertiport,
    VertiportIx, whole_mwh,
};

/// The random streams of a day. Their numbers are part of what a seed means, so they must not
/// change.
#[derive(Debug, Clone, Copy)]
enum Stream {
    Demand = 1,
    StartPositions = 2,
    ForecastError = 3,
    TakeoffDelays = 4,
    Closures = 5,
    Outages = 6,
    Market = 7,
    Displaced = 8,
    StartCharges = 9,
}

impl Stream {
    fn of(self, seed: DaySeed) -> ChaCha8Rng {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.get().to_le_bytes());
        let mut random = ChaCha8Rng::from_seed(key);
        random.set_stream(self as u64);
        random
    }
}

impl Network {
    /// Draws the day of this seed, called `{network}-{seed}`. The same seed always gives the same
    /// day.
    ///
    /// Aircraft start as if the vertiports had the stands that `start_stands` of the file names.
    /// Aircraft for which there is no such stand are placed at random. A network that was
    /// [changed](Self::changed) keeps those of its base, so that the days of both are comparable
    /// (common random numbers): one more stand moves no aircraft, one less moves only those who
    /// stood there, and further aircraft leave the first ones where they were.
    pub fn draw(&self, seed: DaySeed) -> Scenario {
        let mut day = self.idle_day.clone().into_day();
        day.name = format!("{}-{seed}", self.name);
        day.seed = seed.get();
        self.draw_demand(&mut day.demand, &mut Stream::Demand.of(seed));
        let stands: Vec<u16> = day.vertiports.iter().map(|vertiport| vertiport.stands).collect();
        let start_stands = self.start_stands.as_ref().unwrap_or(&stands);
        let positions = start_positions(start_stands, stands.clone(), day.aircraft.len(), seed);
        for (aircraft, at) in day.aircraft.iter_mut().zip(positions) {
            aircraft.at = at;
        }
        self.draw_start_charges(&mut day, seed);
        self.draw_disturbances(&mut day, seed);
        // Demand and forecast meet the same numbers, so that they respond alike.
        for demand in day.disturbances.forecast.iter_mut().chain([&mut day.demand]) {
            self.apply_elasticity(demand, &mut Stream::Market.of(seed));
        }
        // Demand is within bounds for every network that was accepted, and start positions respect
        // the stands.
        Scenario::checked(day)
    }

    /// Whether this network draws exactly this day from the day's seed. It does not if it was
    /// changed since the day was drawn, even if it still has the same name.
    pub fn draws(&self, day: &Scenario) -> bool {
        self.draw(DaySeed::of(day)) == *day
    }

    /// Draws what is in each battery when operations start, to the watt-hour, where the network has
    /// a range for it.
    fn draw_start_charges(&self, day: &mut Day, seed: DaySeed) {
        let Some((low, high)) = self.start_charge else { return };
        let mut random = Stream::StartCharges.of(seed);
        for aircraft in &mut day.aircraft {
            let battery_kwh = day.aircraft_types[aircraft.kind.at()].battery_kwh;
            let share = low + (high - low) * random.random::<f64>();
            aircraft.start_charge_kwh = Some(start_charge_kwh(share, battery_kwh));
        }
    }

    /// Whether an aircraft decides on every day that this network may draw. On days that charge to
    /// full none does if every battery is full only after operations end.
    pub fn always_has_decisions(&self) -> bool {
        let day = &self.idle_day;
        let (Charging::ToFull, Some((low, _))) = (day.operations.charging, self.start_charge)
        else {
            return true;
        };
        let operations_s = f64::from(day.operations.end.since(day.operations.start));
        // A second less, so that rounding makes no difference.
        let is_full_in_time = |kind: &AircraftType, place: &Vertiport| {
            let rate = ChargeRate::of(kind, place);
            let battery = rate.battery(whole_mwh(start_charge_kwh(low, kind.battery_kwh)));
            rate.to_full_s(battery, 0) <= operations_s - 1.0
        };
        let always = |kind| day.vertiports.iter().all(|place| is_full_in_time(kind, place));
        day.fleet_types().into_iter().any(always)
    }

    /// Draws Q(i, j, t), pair by pair.
    fn draw_demand(&self, demand: &mut [Matrix<u32>], random: &mut ChaCha8Rng) {
        for (period, table) in demand.iter_mut().enumerate() {
            for from in VertiportIx::all(table.size()) {
                for to in VertiportIx::all(table.size()).filter(|&to| to != from) {
                    table[(from, to)] = self.demand.draw(period, from, to, random);
                }
            }
        }
    }

    /// Applies the market's factors to what was drawn at the reference fares. Where this does not
    /// give whole passengers, one of the two neighbouring numbers is taken by chance. The draws are
    /// the same at all fares, so that a higher fare never gives more passengers on the same day.
    fn apply_elasticity(&self, demand: &mut [Matrix<u32>], random: &mut ChaCha8Rng) {
        let Some(factors) = &self.demand.factors else { return };
        for (table, factors) in demand.iter_mut().zip(factors) {
            for (passengers, factor) in table.cells_mut().iter_mut().zip(factors.cells()) {
                *passengers = rounded_by_chance(f64::from(*passengers) * factor, random);
            }
        }
    }

    /// Draws the disturbances. Demand and start positions have been drawn before and stay as they
    /// would be without disturbances; the demand that was drawn becomes the forecast.
    fn draw_disturbances(&self, day: &mut Day, seed: DaySeed) {
        let model = &self.disturbances;
        if let Some(error) = &model.forecast_error {
            let mut random = Stream::ForecastError.of(seed);
            let actual = error.draw(&day.demand, &mut random);
            day.disturbances.forecast = Some(std::mem::replace(&mut day.demand, actual));
        }
        if let Some(delays) = &model.takeoff_delays {
            let mut random = Stream::TakeoffDelays.of(seed);
            day.disturbances.takeoff_delays = Some(delays.draw(&day.operations, &mut random));
        }
        let mut random = Stream::Closures.of(seed);
        for closure in &model.closures {
            closure.draw(&day.operations, &mut random, &mut day.disturbances.closures);
        }
        if let Some(outages) = &model.outages {
            let mut random = Stream::Outages.of(seed);
            let fleet = day.aircraft.len();
            day.disturbances.outages = outages.draw(&day.operations, fleet, &mut random);
        }
    }
}

/// A share of a battery, to the watt-hour.
fn start_charge_kwh(share: f64, battery_kwh: f64) -> f64 {
    ((1e3 * share * battery_kwh).round() / 1e3).min(battery_kwh)
}

/// Where `aircraft` aircraft start: where they would if the vertiports had `start_stands`, or at
/// random where there is no such stand.
fn start_positions(
    start_stands: &[u16],
    mut left: Vec<u16>,
    aircraft: usize,
    seed: DaySeed,
) -> Vec<VertiportIx> {
    let mut random = Stream::StartPositions.of(seed);
    let mut there = StartPositions::of(start_stands);
    let wanted: Vec<Option<VertiportIx>> = (0..aircraft).map(|_| there.next(&mut random)).collect();
    let mut take = |at: VertiportIx| {
        let stands = &mut left[at.at()];
        *stands = stands.checked_sub(1)?;
        Some(at)
    };
    let found: Vec<Option<VertiportIx>> =
        wanted.into_iter().map(|at| at.and_then(&mut take)).collect();
    let mut rest = StartPositions::of(&left);
    let mut random = Stream::Displaced.of(seed);
    let place = |at: Option<VertiportIx>| {
        at.or_else(|| rest.next(&mut random)).expect("a network has a stand for each aircraft")
    };
    found.into_iter().map(place).collect()
}

/// The stands that are still free while aircraft are placed one after another.
struct StartPositions {
    /// Vertiports with a stand left, in order, with the number of stands left.
    free: Vec<(VertiportIx, u16)>,
}

impl StartPositions {
    fn of(stands: &[u16]) -> Self {
        let all = VertiportIx::all(stands.len()).zip(stands.iter().copied());
        Self { free: all.filter(|&(_, stands)| stands > 0).collect() }
    }

    /// Takes a stand at a vertiport chosen uniformly among those that have one left; `None` if none
    /// has.
    fn next(&mut self, random: &mut ChaCha8Rng) -> Option<VertiportIx> {
        if self.free.is_empty() {
            return None;
        }
        let chosen = random.random_range(0..self.free.len());
        let (vertiport, stands) = &mut self.free[chosen];
        let vertiport = *vertiport;
        *stands -= 1;
        if *stands == 0 {
            self.free.remove(chosen);
        }
        Some(vertiport)
    }
}
