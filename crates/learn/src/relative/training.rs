//! A training run of `gcaps-x`: play days, try out what is decided there, learn from all so far; round by round.
//!
//! The days of a round are played by what the rounds before it learned (DAgger: S. Ross, G. Gordon, D. Bagnell, *A reduction
//! of imitation learning and structured prediction to no-regret online learning*, 2011), the first by the prices alone. A
//! share of the days are each of a random network of its own ([`random_network`]), the rest of the network that the run is for.

use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use vertifleet_core::{DaySeed, Network, Purpose, Scenario};
use vertifleet_policy::{DayPrices, Policy, Priced, Shortlist, Trial, draw, play};
use vertifleet_sim::Simulation;

use crate::error::Error;
use crate::nn::{self, Architecture, Prepared};
use crate::random_network::random_network;
use crate::relative::course::Course;
use crate::relative::features::{Scene, shape};
use crate::relative::fit::{Fit, Learner, Pace};
use crate::relative::judge::Judge;
use crate::relative::lessons::{Lessons, Library};
use crate::relative::policy::GcapsX;
use crate::relative::weights::{AnyModel, Source};
use crate::train::check_finite;

/// Decisions of a day that are tried out, about; of days with more, a share.
const LESSONS_A_DAY: f64 = 400.0;
/// Decisions of an aircraft a day, about.
const DECISIONS_AN_AIRCRAFT: f64 = 11.0;

/// A run under way.
pub struct Study {
    course: Course,
    network: Arc<Network>,
    architecture: Architecture,
    seed: u32,
    commit: String,
    learner: Learner,
    library: Library,
    rounds: u32,
    /// Validation days of the network, then of random networks; with what `prices` earns on each.
    validation: [Vec<(Arc<Scenario>, f64)>; 2],
}

/// The curve as a CSV text, one column a member of [`Round`].
pub fn to_csv(rounds: &[Round]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for round in rounds {
        writer.serialize(round).expect("rows of numbers go into memory");
    }
    let bytes = writer.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("numbers are text")
}

/// How a round went.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Round {
    /// Rounds done.
    pub round: u32,
    /// Decisions learned from so far.
    pub decisions: u64,
    /// Share of decisions whose best choice is the expert's, in the last pass.
    pub agreement: f64,
    /// What choices are better than those at the prices by the expert's values, in units; and what the expert's are.
    pub lift: f64,
    /// What the expert's choices are better.
    pub most_lift: f64,
    /// Profit over that of `prices`: on the network's validation days, on random networks.
    pub gain: f64,
    /// The same on random networks.
    pub random_gain: f64,
}

impl Study {
    /// A run before its first round.
    ///
    /// # Errors
    /// If a setting is out of its bounds, the policy's sizes do not fit together, or the seed is out of range.
    pub fn start(
        network: Arc<Network>,
        architecture: Architecture,
        course: Course,
        (seed, commit): (u32, String),
    ) -> Result<Self, Error> {
        course.check()?;
        let params = nn::Network::new(architecture.clone(), shape(1))
            .map_err(|rule| Error::BadSetting { name: "policy".to_owned(), rule })?
            .init(u64::from(seed));
        let learner = Learner::new(architecture.clone(), params);
        let days = 0..u64::from(course.validation_days);
        let own = days.clone().map(|day| Ok(network.draw(DaySeed::validation(day)?)));
        let random = days.map(|day| {
            Ok(random_network(Purpose::Validation, day).draw(DaySeed::validation(day)?))
        });
        let validation = [
            with_priced_profit(own.collect::<Result<_, Error>>()?),
            with_priced_profit(random.collect::<Result<_, Error>>()?),
        ];
        let library = Library::default();
        Ok(Self {
            course,
            network,
            architecture,
            seed,
            commit,
            learner,
            library,
            rounds: 0,
            validation,
        })
    }

    /// Whether all rounds are done.
    pub fn is_done(&self) -> bool {
        self.rounds >= self.course.rounds
    }

    /// The run's settings.
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// Plays, learns, and looks at the validation days. `go_on` is asked after every day played and every pass; where it
    /// says no, the round is given up, nothing is returned, and the run is over.
    ///
    /// # Errors
    /// If training days run out, or the weights have left the numbers ([`Error::Diverged`]).
    pub fn round(&mut self, go_on: &(dyn Fn() -> bool + Sync)) -> Result<Option<Round>, Error> {
        let days = self.days()?;
        let actor = (self.rounds > 0).then(|| self.actor());
        let lessons: Option<Vec<Lessons>> = days
            .par_iter()
            .map(|day| {
                let lessons = self.lessons(day, actor.as_ref());
                go_on().then_some(lessons)
            })
            .collect();
        let Some(lessons) = lessons else { return Ok(None) };
        for lessons in &lessons {
            self.library.add(lessons);
        }
        let mut fit = Fit::default();
        for pass in 0..self.course.passes {
            let number = self.rounds * self.course.passes + pass;
            let all = f64::from(self.course.rounds * self.course.passes);
            let course = &self.course;
            let pace = |share: f64| Pace {
                learning_rate: course.learning_rate
                    * (1.0 - 0.9 * (f64::from(number) + share) / all) as f32,
                entropy_weight: course.entropy_weight,
            };
            let seed = u64::from(self.seed) << 32 | u64::from(number);
            fit = self.learner.pass(&self.library, seed, pace);
            if !go_on() {
                return Ok(None);
            }
        }
        check_finite(&self.learner.params, u64::from(self.rounds) + 1)?;
        self.rounds += 1;
        let [gain, random_gain] = [0, 1].map(|which| self.gain(&self.validation[which]));
        Ok(Some(Round {
            round: self.rounds,
            decisions: self.library.len() as u64,
            agreement: fit.agreement,
            lift: fit.lift,
            most_lift: fit.most,
            gain,
            random_gain,
        }))
    }

    /// The policy as it stands.
    pub fn model(&self) -> AnyModel {
        AnyModel::new(
            self.architecture.clone(),
            self.learner.params.clone(),
            Source {
                network: self.network.name().to_owned(),
                course: self.course.clone(),
                seed: self.seed,
                commit: self.commit.clone(),
            },
            self.library.len() as u64,
        )
    }

    /// The days of the round to come.
    fn days(&self) -> Result<Vec<Arc<Scenario>>, Error> {
        let first = u64::from(self.rounds) * u64::from(self.course.days);
        let random = |day: u64| {
            let share = self.course.random_share;
            (day as f64 * share).floor() < ((day + 1) as f64 * share).floor()
        };
        (first..first + u64::from(self.course.days))
            .map(|day| {
                let seed = DaySeed::training(self.seed, day)?;
                let drawn = if random(day) {
                    // Seeds of days are all different, so no two runs share their networks.
                    random_network(Purpose::Training, seed.get()).draw(seed)
                } else {
                    self.network.draw(seed)
                };
                Ok(Arc::new(drawn))
            })
            .collect()
    }

    fn actor(&self) -> (Arc<[f32]>, Arc<Prepared>) {
        (self.learner.params.as_slice().into(), Arc::new(self.learner.prepared.clone()))
    }

    /// Plays a day and tries out what is decided.
    fn lessons(&self, day: &Arc<Scenario>, actor: Option<&(Arc<[f32]>, Arc<Prepared>)>) -> Lessons {
        let vertiports = day.vertiports.len();
        let mut judge = actor.map(|(params, prepared)| {
            Judge::new(&self.architecture, Arc::clone(params), Arc::clone(prepared), vertiports)
        });
        let share = LESSONS_A_DAY / (DECISIONS_AN_AIRCRAFT * day.aircraft.len() as f64);
        let mut lessons = Lessons::new(vertiports);
        let mut shortlist = Shortlist::default();
        let mut trial = Trial::new(self.course.expert.clone());
        let mut simulation = Simulation::new(Arc::clone(day));
        let mut prices: Option<DayPrices> = None;
        while let Some(decision) = simulation.next_decision() {
            let view = simulation.view();
            let prices = prices.get_or_insert_with(|| DayPrices::of(view, decision.time));
            prices.keep_up(view, decision.time);
            let listed = shortlist.rank(prices, view, &decision);
            let scene = Scene::of(view, &decision, prices);
            let bits = |what: u64| draw(what, day.seed, decision.index) >> 11;
            let chance = |what: u64| bits(what) as f64 / (1_u64 << 53) as f64;
            if listed.len() > 1 && chance(1) < share {
                let values_usd = trial.values_usd(prices, (view, &decision), listed);
                lessons.push(scene, listed, values_usd);
            }
            let choice = if chance(2) < self.course.exploration {
                listed[((u128::from(bits(3)) * listed.len() as u128) >> 53) as usize].1
            } else if let Some(judge) = &mut judge {
                judge.best(scene, listed)
            } else {
                listed[0].1
            };
            simulation.apply(choice).expect("lists are of feasible choices");
        }
        lessons
    }

    /// Mean profit over that of `prices`, as a share of it.
    fn gain(&self, days: &[(Arc<Scenario>, f64)]) -> f64 {
        let model = Arc::new(self.model());
        let gains: Vec<f64> = days
            .par_iter()
            .map(|(day, priced_usd)| {
                profit_usd(&mut GcapsX::new(Arc::clone(&model)), day) / priced_usd - 1.0
            })
            .collect();
        gains.iter().sum::<f64>() / gains.len().max(1) as f64
    }
}

fn with_priced_profit(days: Vec<Scenario>) -> Vec<(Arc<Scenario>, f64)> {
    let days: Vec<Arc<Scenario>> = days.into_iter().map(Arc::new).collect();
    days.par_iter().map(|day| (Arc::clone(day), profit_usd(&mut Priced::default(), day))).collect()
}

fn profit_usd(policy: &mut dyn Policy, day: &Arc<Scenario>) -> f64 {
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, policy, |_| ()).expect("the policy has an answer for every decision");
    simulation.ledger().profit_usd()
}
