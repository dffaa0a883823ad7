//! A training run: its request, its progress and its files.
//!
//! There are three ways to learn, [PPO](crate::ppo), for `gcaps` and `mlp`,
//! [imitation](crate::imitation) and [evolution](crate::evolution). All of them have one interface:
//! a caller advances a [`TrainingRun`] until it is done, and can save and resume it. A
//! [`RunFolder`] does that and writes the files.
//!
//! Training days, validation days and comparison days come from disjoint ranges of seeds
//! (`DaySeed`), so no run can ever learn or choose on a day that it is later compared on.

pub(crate) mod begin;
pub(crate) mod checkpoint;
mod curve;
mod event_file;
mod folder;

use std::path::Path;

use serde::{Deserialize, Serialize};
use vertifleet_core::{DaySeed, Purpose, Stop, World};

pub use curve::{Cell, Curve};
pub use folder::{RunFolder, TrainingWatch};

use crate::error::Error;
use crate::model::Model;
use crate::nn::{Architecture, NeuralNetwork};
use crate::settings::TrainingSettings;

/// The inputs of a training run.
#[derive(Debug, Clone)]
pub struct TrainingRequest {
    /// The source of the training days; imitation also learns from days of random networks.
    pub world: World,
    /// The kind of the policy, with its sizes.
    pub policy: Architecture,
    /// The settings of the way to learn that this policy uses.
    pub settings: TrainingSettings,
    /// The seed of the run; initial weights, days and choices follow from it.
    pub seed: u32,
    /// The initial weights; without them, they are drawn from the seed.
    pub begin_with: Option<Model>,
    /// The commit of the program, for the header of the weights.
    pub commit: String,
}

/// A run in progress. It advances by one update of PPO, one round of imitation or one generation of
/// evolution at a time.
pub trait TrainingRun: Send {
    /// Whether the run has learned everything that was requested.
    fn is_done(&self) -> bool;

    /// How much of the work is done.
    fn work(&self) -> Work;

    /// Learns one update, round or generation, and adds a row to the curve. `worked` is called with
    /// the number of units of work done since its last call.
    ///
    /// # Errors
    /// Returns [`Error::Stopped`] soon after `stop` is requested, [`Error::Diverged`] if a weight
    /// is infinite or NaN, or an error if the training days run out. After a stop the run is in the
    /// state before the call.
    fn advance(&mut self, stop: &Stop, worked: &(dyn Fn(u64) + Sync)) -> Result<(), Error>;

    /// The learning curve so far.
    fn curve(&self) -> Curve;

    /// The current policy. With PPO and with evolution, it has the weights that did best on the
    /// validation days so far.
    fn model(&self) -> Model;

    /// Writes a checkpoint, completely or not at all.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    fn write_checkpoint(&self, path: &Path) -> Result<(), Error>;
}

/// How much of a run's work is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Work {
    /// Number of units done.
    pub done: u64,
    /// Number of units of the whole run.
    pub total: u64,
    /// The name of the units.
    pub units: &'static str,
}

/// The sizes of a run's policy of this kind: those of the initial weights if they are given, or
/// else the defaults. `None` if there is no such kind.
pub fn sizes(kind: &str, begin_with: Option<&Model>) -> Option<Architecture> {
    let begun = begin_with.filter(|model| model.kind() == kind);
    begun.map_or_else(|| Architecture::named(kind), |model| Some(model.header().policy.clone()))
}

impl TrainingRequest {
    /// Starts a run.
    ///
    /// # Errors
    /// Returns an error if settings and policy do not go together, if a setting is out of its
    /// bounds, if the policy's sizes do not fit, or if the seed is out of range.
    pub fn start(self) -> Result<Box<dyn TrainingRun>, Error> {
        self.begin(None)
    }

    /// Resumes a run from a checkpoint, bit for bit as if it had never stopped.
    ///
    /// # Errors
    /// The same as those of [`start`](Self::start), and an error if the checkpoint cannot be read,
    /// is damaged or belongs to another run.
    pub fn resume(self, checkpoint: &Path) -> Result<Box<dyn TrainingRun>, Error> {
        self.begin(Some(checkpoint))
    }

    fn begin(self, checkpoint: Option<&Path>) -> Result<Box<dyn TrainingRun>, Error> {
        self.settings.check()?;
        let bad = |name: &str, rule| Error::BadSetting { name: name.to_owned(), rule };
        self.policy.check_graph().map_err(|rule| bad("adjacency", rule))?;
        self.policy.check_charge().map_err(|rule| bad("charge", rule))?;
        let asked = RunIdentity {
            network: self.world.name(),
            network_fingerprint: network_fingerprint(&self.world)?,
            policy: self.policy.clone(),
            settings: self.settings.clone(),
            seed: self.seed,
            begun_with: self.begun_with(),
        };
        self.check_begin()?;
        self.settings.learner().begin(&self, asked, checkpoint)
    }

    /// Refuses initial weights that belong to another policy, or whose observation has other
    /// numbers than that of this run.
    fn check_begin(&self) -> Result<(), Error> {
        let Some(model) = &self.begin_with else { return Ok(()) };
        let bad = |rule: &str| {
            let (name, rule) = ("begin_with".to_owned(), rule.to_owned());
            Err(Error::BadSetting { name, rule })
        };
        let header = model.header();
        if header.policy != self.policy && header.policy != self.policy.without_charge() {
            return bad("the weights must be of the same policy with the same sizes as the run");
        }
        if let Some(trained) = header.shape.vertiports
            && self.world.vertiports() != Some(trained)
        {
            return bad("the weights must be for as many vertiports as the network has");
        }
        let scales = || self.world.network(Purpose::Training, 0).feature_scales();
        if header.feature_scales.is_some_and(|of_weights| of_weights != scales()) {
            return bad("the weights must be of a network with the same feature_scales");
        }
        Ok(())
    }

    /// The hash of the initial weights.
    pub(crate) fn begun_with(&self) -> Option<String> {
        self.begin_with.as_ref().map(Model::sha256)
    }

    /// The weights before the first step. A run that observes charge may begin with weights that do
    /// not: the weights of the new features are 0, so that it begins with the same decisions.
    pub(crate) fn first_params(&self, net: &NeuralNetwork) -> Vec<f32> {
        let Some(model) = &self.begin_with else { return net.init(u64::from(self.seed)) };
        let mut params = Vec::with_capacity(net.layout().len());
        for (before, now) in model.layout().tensors().iter().zip(net.layout().tensors()) {
            // New features come after the others, and the inputs of a matrix are its rows.
            params.extend(&model.params()[before.offset..][..before.len()]);
            params.resize(params.len() + now.len() - before.len(), 0.0);
        }
        params
    }
}

/// What identifies a run: a checkpoint can be resumed only if all of this is the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunIdentity {
    pub(crate) network: String,
    /// A number that changes when the network's days do.
    pub(crate) network_fingerprint: u32,
    pub(crate) policy: Architecture,
    pub(crate) settings: TrainingSettings,
    pub(crate) seed: u32,
    /// The hash of the initial weights of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) begun_with: Option<String>,
}

/// A number that changes when the network's days do: a checksum of one of them and of the feature
/// scales.
fn network_fingerprint(world: &World) -> Result<u32, Error> {
    let network = world.network(Purpose::Validation, 0);
    let day = network.draw(DaySeed::validation(0)?);
    let scales = serde_json::to_string(&network.feature_scales()).expect("numbers");
    Ok(crc32c::crc32c_append(crc32c::crc32c(day.to_json().as_bytes()), scales.as_bytes()))
}

/// Refuses weights that are infinite or NaN after an update, a round or a generation, which is
/// counted from 1.
pub(crate) fn check_finite(params: &[f32], update: u64) -> Result<(), Error> {
    if params.iter().all(|weight| weight.is_finite()) {
        return Ok(());
    }
    Err(Error::Diverged { update })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use vertifleet_core::{Coded, DaySeed, Network, World};

    use super::{TrainingRequest, check_finite, sizes};
    use crate::header::{FeatureShape, Header};
    use crate::model::Model;
    use crate::nn::NeuralNetwork;
    use crate::settings::{TrainingSettings, set};
    use crate::shipped::shipped;
    use crate::validation::played;

    /// A run with the features of charge that begins with the shipped weights of a kind.
    fn with_charge(kind: &str) -> TrainingRequest {
        let begin_with = shipped(kind, "paper").expect("shipped weights").model;
        let mut policy = sizes(kind, Some(&begin_with)).expect("a kind");
        let mut settings = TrainingSettings::preset(&policy, "default").expect("a preset");
        set(&mut policy, &mut settings, [("charge", "true")]).expect("a setting");
        TrainingRequest {
            world: World::find("paper-quick").expect("a world"),
            policy,
            settings,
            seed: 1,
            begin_with: Some(begin_with),
            commit: String::new(),
        }
    }

    /// As-needed days too: the shipped weights do not read charge, and neither do these at first.
    #[test]
    fn a_run_with_the_features_of_charge_begins_with_the_decisions_of_weights_without_them() {
        let seed = DaySeed::validation(1).expect("a seed");
        let day = Network::shipped("paper-quick").expect("a shipped network").draw(seed);
        let day = Arc::new(day);
        for (kind, features) in [("gcaps-x", (27, 13)), ("gcaps-full", (40, 14))] {
            let plan = with_charge(kind);
            plan.check_begin().expect("weights that fit");
            let shape = plan.policy.shape(8);
            assert_eq!((shape.node_features, shape.aircraft_features), features);
            let net = NeuralNetwork::new(plan.policy.clone(), shape).expect("sizes within bounds");
            let shipped = plan.begin_with.clone().expect("shipped weights");
            let header = Header {
                policy: plan.policy.clone(),
                shape: FeatureShape { vertiports: None, ..shape.into() },
                ..shipped.header().clone()
            };
            let widened = Model::new(header, plan.first_params(&net)).expect("as many weights");
            assert!(widened.params().len() > shipped.params().len());
            let read = Model::from_bytes(&widened.to_bytes(), "memory").expect("a weight file");
            assert_eq!(read.header().policy, plan.policy);
            let [before, after] =
                [&shipped, &read].map(|model| played(&mut *model.policy(1), &day));
            assert_eq!(before, after);
        }
    }

    #[test]
    fn only_policies_that_can_observe_charge_read_it() {
        let mut policy = sizes("gcaps", None).expect("a kind");
        let mut settings = TrainingSettings::preset(&policy, "default").expect("a preset");
        set(&mut policy, &mut settings, [("charge", "true")]).expect("a setting of the kind");
        let plan = TrainingRequest { policy, settings, begin_with: None, ..with_charge("gcaps-x") };
        let error = plan.start().err().expect("no such run").to_string();
        assert!(error.contains("must be false for gcaps"), "{error}");
        let mut plan = with_charge("gcaps-x");
        let error = set(&mut plan.policy, &mut plan.settings, [("charge", "maybe")]);
        assert!(error.expect_err("no value").to_string().contains("true or false"));
    }

    #[test]
    fn a_diverging_run_returns_an_error() {
        check_finite(&[1.0, -2.0], 3).expect("numbers");
        for lost in [f32::NAN, f32::INFINITY] {
            let error = check_finite(&[1.0, lost], 3).expect_err("no number");
            assert_eq!(error.code().to_string(), "V309");
        }
    }
}
