//! What is learned from: decisions of played days, each with what trying its choices out says they are worth.
//!
//! A choice is played on for a while with everybody deciding by prices. One such course says little: what happens in an hour
//! hangs on who was ready a second earlier. So a choice is played on several times, everybody's worth shaken by a little
//! noise, the same for all choices; the mean is what it is worth.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_policy::{DayPrices, Shortlist, draw, tried_out_usd};
use vertifleet_sim::{Decision, View};

use crate::relative::features::{Rows, Scene};

/// How choices are tried out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Expert {
    /// How far each is played on, seconds.
    pub horizon_s: u32,
    /// How often; the mean over all counts.
    pub courses: u32,
    /// Size of the noise, in units.
    pub noise: f64,
    /// Weight of what the choice is worth at the prices to the aircraft alone.
    pub own: f64,
}

impl Expert {
    /// What each choice of a list is worth, in units, in the list's order; `values` is filled.
    pub(crate) fn values(
        &self,
        scene: Scene<'_>,
        listed: &[(f64, VertiportIx)],
        values: &mut Vec<f64>,
    ) {
        let Scene { view, decision, prices, unit_usd } = scene;
        let noise_usd = self.noise * unit_usd;
        values.clear();
        values.extend(listed.iter().map(|&(priced_usd, to)| {
            let course_usd = |course: u32| {
                let rule = |view: View<'_>, decision: &Decision| {
                    shaken_choice(prices, (view, decision), course, noise_usd)
                };
                tried_out_usd(prices, (view, decision), to, self.horizon_s, rule)
            };
            let sum_usd: f64 = (0..self.courses).map(course_usd).sum();
            (self.own * priced_usd + sum_usd / f64::from(self.courses)) / unit_usd
        }));
    }
}

/// The choice that is worth most at the prices and a noise that belongs to course, aircraft, time and vertiport. The first
/// course has none.
fn shaken_choice(
    prices: &DayPrices,
    (view, decision): (View<'_>, &Decision),
    course: u32,
    noise_usd: f64,
) -> VertiportIx {
    if course == 0 {
        return prices.best_choice(view, decision);
    }
    let mut best = (f64::NEG_INFINITY, decision.at);
    for to in view.feasible(decision).iter() {
        let noise = noise(course, decision.aircraft, decision.time, to);
        let usd = prices.choice_usd(view, decision, to) + noise_usd * noise;
        if usd > best.0 {
            best = (usd, to);
        }
    }
    best.1
}

/// About normal, with mean 0 and deviation 1: the sum of four uniform numbers.
pub(crate) fn noise(course: u32, aircraft: AircraftIx, time: Time, to: VertiportIx) -> f64 {
    let key = u64::from(aircraft.0) << 32 | u64::from(time.seconds());
    let bits = draw(u64::from(course), key, u32::from(to.0));
    let sum: u32 = [0, 16, 32, 48].iter().map(|shift| (bits >> shift & 0xffff) as u32).sum();
    (f64::from(sum) / 65_536.0 - 2.0) * 3.0_f64.sqrt()
}

/// Decisions of days with one number of vertiports.
#[derive(Debug, Clone)]
pub(crate) struct Lessons {
    pub(crate) rows: Rows,
    /// By row and vertiport: what the choice is worth at the prices less the best, in units; what trying out says it is worth
    /// less the mean of the list. 0 for what is not on the list.
    pub(crate) priced: Vec<f32>,
    pub(crate) values: Vec<f32>,
}

impl Lessons {
    pub(crate) fn new(vertiports: usize) -> Self {
        Self { rows: Rows::new(vertiports), priced: Vec::new(), values: Vec::new() }
    }

    /// Adds a decision.
    pub(crate) fn push(&mut self, scene: Scene<'_>, listed: &[(f64, VertiportIx)], values: &[f64]) {
        let vertiports = self.rows.vertiports();
        self.rows.push(scene, listed);
        let first = self.priced.len();
        self.priced.resize(first + vertiports, 0.0);
        self.values.resize(first + vertiports, 0.0);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        for (&(priced_usd, to), value) in listed.iter().zip(values) {
            self.priced[first + to.at()] = ((priced_usd - listed[0].0) / scene.unit_usd) as f32;
            self.values[first + to.at()] = (value - mean) as f32;
        }
    }

    fn append(&mut self, other: &Self) {
        for row in 0..other.rows.len() {
            self.rows.push_copy(&other.rows, row);
        }
        self.priced.extend(&other.priced);
        self.values.extend(&other.values);
    }
}

/// Lessons of all numbers of vertiports.
#[derive(Debug, Clone, Default)]
pub(crate) struct Library(pub(crate) BTreeMap<usize, Lessons>);

impl Library {
    pub(crate) fn add(&mut self, lessons: &Lessons) {
        let vertiports = lessons.rows.vertiports();
        self.0.entry(vertiports).or_insert_with(|| Lessons::new(vertiports)).append(lessons);
    }

    pub(crate) fn len(&self) -> usize {
        self.0.values().map(|lessons| lessons.rows.len()).sum()
    }
}

/// Room to list choices and value them.
#[derive(Debug, Default)]
pub(crate) struct Desk {
    pub(crate) shortlist: Shortlist,
    pub(crate) values: Vec<f64>,
}
