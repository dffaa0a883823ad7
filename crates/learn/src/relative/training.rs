//! A training run of `gcaps-x`: play days, try out what is decided there, learn from all so far; round by round.
//!
//! The days of a round are played by what the rounds before it learned (DAgger: S. Ross, G. Gordon, D. Bagnell, *A reduction
//! of imitation learning and structured prediction to no-regret online learning*, 2011), the first by the prices alone. A
//! share of the days are each of a random network of its own ([`random_network`]), the rest of the network that the run is for.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use vertifleet_core::{DaySeed, Network, Purpose, Scenario, random_network};
use vertifleet_policy::{DayPrices, Policy, Priced, Shortlist, Trial, draw, play};
use vertifleet_sim::{Simulation, Summary};

use crate::error::Error;
use crate::nn::{self, Architecture, Prepared};
use crate::relative::checkpoint::{self, Progress, Run};
use crate::relative::course::Course;
use crate::relative::features::{Scene, shape};
use crate::relative::fit::{Fit, Learner, Pace};
use crate::relative::judge::Judge;
use crate::relative::lessons::{Lessons, Library};
use crate::relative::policy::GcapsX;
use crate::relative::weights::{AnyModel, Source};
use crate::train::{check_finite, network_print};

/// Decisions of a day that are tried out, about; of days with more, a share.
const LESSONS_A_DAY: f64 = 400.0;
/// Decisions of an aircraft a day, about.
const DECISIONS_AN_AIRCRAFT: f64 = 11.0;

/// What a run is to do.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Network that the run is for; a share of its days are of random ones.
    pub network: Arc<Network>,
    /// The policy's kind and sizes.
    pub policy: Architecture,
    /// Settings.
    pub course: Course,
    /// First weights, days and draws follow from it.
    pub seed: u32,
    /// Commit of the program, for the weights' header.
    pub commit: String,
}

/// A run under way.
pub struct Study {
    plan: Plan,
    learner: Learner,
    library: Library,
    rounds: Vec<Round>,
    /// Validation days of the network, then of random networks; with what `prices` earns on each.
    validation: [Vec<(Arc<Scenario>, f64)>; 2],
}

/// How a round went.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
    /// Mean reward on the network's validation days.
    pub validation_reward: f64,
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
    pub fn start(plan: Plan) -> Result<Self, Error> {
        let params = plan.net()?.init(u64::from(plan.seed));
        let learner = Learner::new(plan.policy.clone(), params);
        Self::assemble(plan, learner, Library::default(), Vec::new())
    }

    /// A run that goes on from a checkpoint, bit for bit as if it had never stopped.
    ///
    /// # Errors
    /// As [`start`](Self::start), or if the checkpoint cannot be read, is damaged or of another run.
    pub fn resume(plan: Plan, checkpoint: &Path) -> Result<Self, Error> {
        let parameters = plan.net()?.layout().len();
        let Progress { rounds, params, adam, library } =
            checkpoint::read(checkpoint, &plan.run()?, parameters)?;
        let mut learner = Learner::new(plan.policy.clone(), params);
        learner.adam = adam;
        Self::assemble(plan, learner, library, rounds)
    }

    fn assemble(
        plan: Plan,
        learner: Learner,
        library: Library,
        rounds: Vec<Round>,
    ) -> Result<Self, Error> {
        plan.course.check()?;
        let days = 0..u64::from(plan.course.validation_days);
        let own = days.clone().map(|day| Ok(plan.network.draw(DaySeed::validation(day)?)));
        let random = days.map(|day| {
            Ok(random_network(Purpose::Validation, day).draw(DaySeed::validation(day)?))
        });
        let validation = [
            with_priced_profit(own.collect::<Result<_, Error>>()?),
            with_priced_profit(random.collect::<Result<_, Error>>()?),
        ];
        Ok(Self { plan, learner, library, rounds, validation })
    }

    /// Sets the run aside as it stands between two rounds; lessons and all.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_checkpoint(&self, path: &Path) -> Result<(), Error> {
        let learned = (self.learner.params.as_slice(), &self.learner.adam);
        checkpoint::write(path, self.plan.run()?, &self.rounds, learned, &self.library)
    }

    /// Whether all rounds are done.
    pub fn is_done(&self) -> bool {
        self.rounds_done() >= self.plan.course.rounds
    }

    /// How the rounds went that are done.
    pub fn rounds(&self) -> &[Round] {
        &self.rounds
    }

    fn rounds_done(&self) -> u32 {
        u32::try_from(self.rounds.len()).expect("a course has few rounds")
    }

    /// The run's settings.
    pub fn course(&self) -> &Course {
        &self.plan.course
    }

    /// Plays, learns, and looks at the validation days. `go_on` is asked after every day played and every pass; where it
    /// says no, the round is given up, nothing is returned, and the run is over.
    ///
    /// # Errors
    /// If training days run out, or the weights have left the numbers ([`Error::Diverged`]).
    pub fn round(&mut self, go_on: &(dyn Fn() -> bool + Sync)) -> Result<Option<Round>, Error> {
        let days = self.days()?;
        let actor = (!self.rounds.is_empty()).then(|| self.actor());
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
        let (course, done) = (&self.plan.course, self.rounds_done());
        for pass in 0..course.passes {
            let number = done * course.passes + pass;
            let all = f64::from(course.rounds * course.passes);
            let pace = |share: f64| Pace {
                learning_rate: course.learning_rate
                    * (1.0 - 0.9 * (f64::from(number) + share) / all) as f32,
                entropy_weight: course.entropy_weight,
            };
            let seed = u64::from(self.plan.seed) << 32 | u64::from(number);
            fit = self.learner.pass(&self.library, seed, pace);
            if !go_on() {
                return Ok(None);
            }
        }
        check_finite(&self.learner.params, u64::from(done) + 1)?;
        let [own, random] = [0, 1].map(|which| self.look(&self.validation[which]));
        let round = Round {
            round: done + 1,
            decisions: self.library.len() as u64,
            agreement: fit.agreement,
            lift: fit.lift,
            most_lift: fit.most,
            validation_reward: own.reward,
            gain: own.gain,
            random_gain: random.gain,
        };
        self.rounds.push(round);
        Ok(Some(round))
    }

    /// The policy as it stands.
    pub fn model(&self) -> AnyModel {
        AnyModel::new(
            self.plan.policy.clone(),
            self.learner.params.clone(),
            Source {
                network: self.plan.network.name().to_owned(),
                course: self.plan.course.clone(),
                seed: self.plan.seed,
                commit: self.plan.commit.clone(),
            },
            self.library.len() as u64,
        )
    }

    /// The days of the round to come.
    fn days(&self) -> Result<Vec<Arc<Scenario>>, Error> {
        let Plan { network, course, seed: run, .. } = &self.plan;
        let first = u64::from(self.rounds_done()) * u64::from(course.days);
        let random = |day: u64| {
            let share = course.random_share;
            (day as f64 * share).floor() < ((day + 1) as f64 * share).floor()
        };
        (first..first + u64::from(course.days))
            .map(|day| {
                let seed = DaySeed::training(*run, day)?;
                let drawn = if random(day) {
                    // Seeds of days are all different, so no two runs share their networks.
                    random_network(Purpose::Training, seed.get()).draw(seed)
                } else {
                    network.draw(seed)
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
            Judge::new(&self.plan.policy, Arc::clone(params), Arc::clone(prepared), vertiports)
        });
        let share = LESSONS_A_DAY / (DECISIONS_AN_AIRCRAFT * day.aircraft.len() as f64);
        let mut lessons = Lessons::new(vertiports);
        let mut shortlist = Shortlist::default();
        let mut trial = Trial::new(self.plan.course.expert.clone());
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
            let choice = if chance(2) < self.plan.course.exploration {
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

    /// How the policy does on validation days.
    fn look(&self, days: &[(Arc<Scenario>, f64)]) -> Look {
        let model = Arc::new(self.model());
        let looks: Vec<Look> = days
            .par_iter()
            .map(|(day, priced_usd)| {
                let played = played(&mut GcapsX::new(Arc::clone(&model)), day);
                Look { reward: played.reward, gain: played.profit / priced_usd - 1.0 }
            })
            .collect();
        let mean = |of: fn(&Look) -> f64| looks.iter().map(of).sum::<f64>() / looks.len() as f64;
        Look { reward: mean(|look| look.reward), gain: mean(|look| look.gain) }
    }
}

impl Plan {
    fn net(&self) -> Result<nn::Network, Error> {
        nn::Network::new(self.policy.clone(), shape(1))
            .map_err(|rule| Error::BadSetting { name: "policy".to_owned(), rule })
    }

    fn run(&self) -> Result<Run, Error> {
        Ok(Run {
            network: self.network.name().to_owned(),
            network_print: network_print(&self.network)?,
            policy: self.policy.clone(),
            course: self.course.clone(),
            seed: self.seed,
        })
    }
}

/// Means over validation days.
struct Look {
    reward: f64,
    /// Profit over that of `prices`, as a share of it.
    gain: f64,
}

fn with_priced_profit(days: Vec<Scenario>) -> Vec<(Arc<Scenario>, f64)> {
    let days: Vec<Arc<Scenario>> = days.into_iter().map(Arc::new).collect();
    days.par_iter()
        .map(|day| (Arc::clone(day), played(&mut Priced::default(), day).profit))
        .collect()
}

fn played(policy: &mut dyn Policy, day: &Arc<Scenario>) -> Summary {
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, policy, |_| ()).expect("the policy has an answer for every decision");
    simulation.summary()
}
