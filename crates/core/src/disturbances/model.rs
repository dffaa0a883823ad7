//! How the disturbances of a network's days are distributed, and how one day's are drawn.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::Deserialize;

use crate::limits::{self, Limits};
use crate::random::{rounded_by_chance, to_whole, uniform};
use crate::raw::{Positions, RawRoute, each};
use crate::{
    AircraftIx, Closure, FormatError, Matrix, Operations, Outage, Route, TakeoffDelays, Time,
    VertiportIx, check,
};

/// The disturbances that a network's days may have; none by default.
#[derive(Debug, Clone, Default)]
pub(crate) struct DisturbanceModel {
    pub(crate) forecast_error: Option<ForecastError>,
    pub(crate) takeoff_delays: Option<DelayModel>,
    pub(crate) closures: Vec<ClosureModel>,
    pub(crate) outages: Option<OutageModel>,
}

impl DisturbanceModel {
    /// Number of closures on a day on which every possible closure happens.
    pub(crate) fn most_closures(&self) -> usize {
        self.closures.iter().map(|closure| closure.routes.len()).sum()
    }
}

/// How actual demand scatters around the forecast.
#[derive(Debug, Clone)]
pub(crate) struct ForecastError {
    /// Standard deviation of a pair's demand in a period, as a share of its forecast.
    noise: f64,
    /// Probability that demand from a vertiport surges in a period, and by which factor it then
    /// exceeds the forecast.
    surge_probability: f64,
    surge_factor: f64,
}

impl ForecastError {
    /// Draws actual demand around the forecast.
    pub(crate) fn draw(
        &self,
        forecast: &[Matrix<u32>],
        random: &mut ChaCha8Rng,
    ) -> Vec<Matrix<u32>> {
        let mut actual = forecast.to_vec();
        for table in &mut actual {
            for from in VertiportIx::all(table.size()) {
                let surges = uniform(random) < self.surge_probability;
                let factor = if surges { self.surge_factor } else { 1.0 };
                for to in VertiportIx::all(table.size()) {
                    let deviation: f64 = StandardNormal.sample(random);
                    let mut expected = f64::from(table[(from, to)]) * factor;
                    // Rounding to the nearest goes up as often as down if the centre is a whole
                    // number, and so keeps the mean. A surge of few passengers may not be a whole
                    // number.
                    if expected.fract() != 0.0 {
                        expected = f64::from(rounded_by_chance(expected, random));
                    }
                    let drawn = expected * (1.0 + self.noise * deviation);
                    table[(from, to)] = to_whole(drawn.min(limits::MOST_PASSENGERS));
                }
            }
        }
        actual
    }
}

/// The model of take-off delays, which are drawn for each slot and vertiport.
#[derive(Debug, Clone)]
pub(crate) struct DelayModel {
    slot_s: u32,
    /// By vertiport; `None` where flights are always on time.
    late: Vec<Option<Late>>,
}

/// Flights leave late in some slots, by an exponential draw of at most `most_s`.
#[derive(Debug, Clone, Copy)]
struct Late {
    probability: f64,
    mean_s: f64,
    most_s: f64,
}

impl DelayModel {
    pub(crate) fn draw(&self, operations: &Operations, random: &mut ChaCha8Rng) -> TakeoffDelays {
        let slots = TakeoffDelays::slots(self.slot_s, operations.start, operations.end);
        let mut slot = || {
            self.late
                .iter()
                .map(|late| {
                    // Both draws are always made, so that one vertiport's settings do not change
                    // the delays of the others.
                    let (chance, size) = (uniform(random), uniform(random));
                    late.map_or(0, |late| late.delay_s(chance, size))
                })
                .collect()
        };
        TakeoffDelays { slot_s: self.slot_s, delay_s: (0..slots).map(|_| slot()).collect() }
    }

    /// For each vertiport the probability of each whole number of seconds, from 0 on. The delays of
    /// slots are independent.
    pub(crate) fn probabilities(&self) -> Vec<Vec<f64>> {
        self.late.iter().map(|late| late.map_or(vec![1.0], Late::probabilities)).collect()
    }
}

impl Late {
    /// The probability of each whole number of seconds, as [`delay_s`](Self::delay_s) draws and
    /// rounds them.
    fn probabilities(self) -> Vec<f64> {
        let most_s = if self.mean_s > 0.0 { to_whole(self.most_s) } else { 0 };
        // The probability of a delay that is rounded to at least this number of seconds.
        let at_least = |delay_s: u32| match delay_s {
            0 => 1.0,
            delay_s if delay_s > most_s => 0.0,
            _ => self.probability * libm::exp((0.5 - f64::from(delay_s)) / self.mean_s),
        };
        (0..=most_s).map(|delay_s| at_least(delay_s) - at_least(delay_s + 1)).collect()
    }

    fn delay_s(self, chance: f64, size: f64) -> u32 {
        if chance >= self.probability {
            return 0;
        }
        // `libm`, because the system's logarithm differs between machines.
        to_whole((-self.mean_s * libm::log(1.0 - size)).min(self.most_s))
    }
}

/// Weather that closes some routes at most once a day.
#[derive(Debug, Clone)]
pub(crate) struct ClosureModel {
    probability: f64,
    routes: Vec<Route>,
    least_s: u32,
    most_s: u32,
}

impl ClosureModel {
    pub(crate) fn draw(
        &self,
        operations: &Operations,
        random: &mut ChaCha8Rng,
        closures: &mut Vec<Closure>,
    ) {
        let (happens, start, lasts_s) = (
            uniform(random),
            instant(operations, random),
            random.random_range(self.least_s..=self.most_s),
        );
        if happens < self.probability {
            let end = (start + lasts_s).min(limits::LATEST);
            let closure = |&route| Closure { route, start, end, known: false };
            closures.extend(self.routes.iter().map(closure));
        }
    }
}

/// Failures of aircraft, at most one a day for each.
#[derive(Debug, Clone)]
pub(crate) struct OutageModel {
    probability: f64,
    least_s: u32,
    most_s: u32,
}

impl OutageModel {
    pub(crate) fn draw(
        &self,
        operations: &Operations,
        fleet: usize,
        random: &mut ChaCha8Rng,
    ) -> Vec<Outage> {
        let outage = |aircraft| {
            let (happens, start) = (uniform(random), instant(operations, random));
            let lasts_s = random.random_range(self.least_s..=self.most_s);
            let end = (start + lasts_s).min(limits::LATEST);
            (happens < self.probability).then_some(Outage { aircraft, start, end })
        };
        AircraftIx::all(fleet).filter_map(outage).collect()
    }
}

/// An instant drawn uniformly from the seconds of operations.
fn instant(operations: &Operations, random: &mut ChaCha8Rng) -> Time {
    operations.start + random.random_range(0..=operations.end.since(operations.start))
}

/// `[disturbances]` of the network file.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "the members of disturbances")]
pub(crate) struct RawDisturbanceModel {
    forecast_error: Option<RawForecastError>,
    takeoff_delays: Option<RawDelayModel>,
    #[serde(default)]
    closures: Vec<RawClosureModel>,
    outages: Option<RawOutageModel>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of forecast_error")]
struct RawForecastError {
    noise: f64,
    surge_probability: f64,
    surge_factor: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of takeoff_delays")]
struct RawDelayModel {
    slot_s: f64,
    vertiports: Vec<RawLate>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a vertiport's delays")]
struct RawLate {
    at: String,
    probability: f64,
    mean_s: f64,
    most_s: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of closures")]
struct RawClosureModel {
    probability: f64,
    routes: Vec<RawRoute>,
    least_s: f64,
    most_s: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of outages")]
struct RawOutageModel {
    probability: f64,
    least_s: f64,
    most_s: f64,
}

/// The name of a disturbance model in its file.
struct Member(String);

impl Member {
    fn number(&self, value: f64, limits: &Limits, member: &str) -> Result<f64, FormatError> {
        limits.check(value, || format!("disturbances: {}: {member}", self.0))?;
        Ok(value)
    }

    fn seconds(&self, value: f64, limits: &Limits, member: &str) -> Result<u32, FormatError> {
        limits.whole_number(value, || format!("disturbances: {}: {member}", self.0))
    }

    /// Checks the shortest and the longest duration of something, and returns both.
    fn span_s(&self, least_s: f64, most_s: f64) -> Result<(u32, u32), FormatError> {
        let least_s = self.seconds(least_s, &limits::PHASE_S, "least_s")?;
        let most_s = self.seconds(most_s, &limits::PHASE_S, "most_s")?;
        if least_s <= most_s {
            return Ok((least_s, most_s));
        }
        Err(FormatError::OutOfRange {
            member: format!("disturbances: {}: least_s", self.0),
            rule: format!("at most {most_s}, which is most_s"),
            found: least_s.to_string(),
            hint: None,
        })
    }
}

impl RawDisturbanceModel {
    pub(crate) fn check(
        self,
        places: &Positions,
        vertiports: usize,
    ) -> Result<DisturbanceModel, FormatError> {
        let routes: usize = self.closures.iter().map(|closure| closure.routes.len()).sum();
        if routes > 0 {
            let member = "disturbances: closures, counted by routes,";
            check::entry_count(member, routes, limits::entries::CLOSURES)?;
        }
        let delays = self.takeoff_delays.map(|raw| raw.check(places, vertiports));
        Ok(DisturbanceModel {
            forecast_error: self.forecast_error.map(RawForecastError::check).transpose()?,
            takeoff_delays: delays.transpose()?,
            closures: each(self.closures, |raw, at| raw.check(at, places))?,
            outages: self.outages.map(RawOutageModel::check).transpose()?,
        })
    }
}

impl RawForecastError {
    fn check(self) -> Result<ForecastError, FormatError> {
        let member = Member("forecast_error".to_owned());
        Ok(ForecastError {
            noise: member.number(self.noise, &limits::NOISE, "noise")?,
            surge_probability: member.number(
                self.surge_probability,
                &limits::PROBABILITY,
                "surge_probability",
            )?,
            surge_factor: member.number(
                self.surge_factor,
                &limits::SURGE_FACTOR,
                "surge_factor",
            )?,
        })
    }
}

impl RawDelayModel {
    fn check(self, places: &Positions, vertiports: usize) -> Result<DelayModel, FormatError> {
        let member = Member("takeoff_delays".to_owned());
        let mut late = vec![None; vertiports];
        for raw in self.vertiports {
            let place = || "disturbances: takeoff_delays: at".to_owned();
            late[places.position(&raw.at, place)?] = Some(Late {
                probability: member.number(raw.probability, &limits::PROBABILITY, "probability")?,
                mean_s: member.number(raw.mean_s, &limits::PHASE_S, "mean_s")?,
                most_s: member.number(raw.most_s, &limits::PHASE_S, "most_s")?,
            });
        }
        Ok(DelayModel { slot_s: member.seconds(self.slot_s, &limits::SLOT_S, "slot_s")?, late })
    }
}

impl RawClosureModel {
    fn check(self, at: usize, places: &Positions) -> Result<ClosureModel, FormatError> {
        let member = Member(format!("closures[{at}]"));
        let (least_s, most_s) = member.span_s(self.least_s, self.most_s)?;
        let probability = member.number(self.probability, &limits::PROBABILITY, "probability")?;
        let routes = each(self.routes, |raw, route| {
            raw.check(places, &format!("disturbances: {}: routes[{route}]", member.0))
        })?;
        if let Some(route) = routes.iter().find(|route| route.from == route.to) {
            return Err(FormatError::RouteToItself {
                member: format!("disturbances: {}", member.0),
                vertiport: format!("#{}", route.from.0),
            });
        }
        Ok(ClosureModel { probability, routes, least_s, most_s })
    }
}

impl RawOutageModel {
    fn check(self) -> Result<OutageModel, FormatError> {
        let member = Member("outages".to_owned());
        let (least_s, most_s) = member.span_s(self.least_s, self.most_s)?;
        let probability = member.number(self.probability, &limits::PROBABILITY, "probability")?;
        Ok(OutageModel { probability, least_s, most_s })
    }
}

#[cfg(test)]
mod tests {
    use super::Late;

    const DRAWS: u32 = 200_000;

    #[test]
    fn probabilities_are_the_shares_of_what_is_drawn() {
        for (mean_s, most_s) in [(300.0, 900.0), (2.0, 5.4), (1.0, 0.2), (0.0, 60.0)] {
            let always = Late { probability: 1.0, mean_s, most_s };
            let mut counts = vec![0_u32; always.probabilities().len()];
            for draw in 0..DRAWS {
                let size = (f64::from(draw) + 0.5) / f64::from(DRAWS);
                counts[always.delay_s(0.0, size) as usize] += 1;
            }
            let sometimes = Late { probability: 0.25, ..always }.probabilities();
            for (delay_s, (&count, probability)) in
                counts.iter().zip(always.probabilities()).enumerate()
            {
                let share = f64::from(count) / f64::from(DRAWS);
                assert!((share - probability).abs() < 2e-5, "{delay_s} s of {always:?}: {share}");
                let on_time = f64::from(u8::from(delay_s == 0));
                let expected = 0.25 * probability + 0.75 * on_time;
                assert!((sometimes[delay_s] - expected).abs() < 1e-12, "{delay_s} s of {always:?}");
            }
        }
    }
}
