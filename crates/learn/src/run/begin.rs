//! The common beginning of runs: the sizes of a policy's observation, and, for imitation and
//! evolution, the days that a round learns from.

use std::path::Path;
use std::sync::Arc;

use serde::de::DeserializeOwned;
use vertifleet_core::{DaySeed, Purpose, Scenario, World, random_city};

use crate::adam::Adam;
use crate::error::Error;
use crate::header::{FORMAT, FeatureShape, Header};
use crate::nn;
use crate::run::checkpoint::{self, Checkpoint};
use crate::run::{RunIdentity, TrainingRequest};

/// The policy of a run before it has learned anything, or where it was resumed.
pub(crate) struct Begin<Progress> {
    pub(crate) net: nn::NeuralNetwork,
    /// The number of vertiports that `net` is for. Weights that fit any size have the same shapes
    /// for every number.
    pub(crate) vertiports: usize,
    /// The header of the run's models, except for the number of steps.
    pub(crate) header: Header,
    pub(crate) params: Vec<f32>,
    pub(crate) adam: Adam,
    /// The checkpoint from which the run is resumed.
    pub(crate) checkpoint: Option<Checkpoint<Progress>>,
}

impl<Progress: DeserializeOwned> Begin<Progress> {
    /// The beginning of a run in which `random_share` of the training days come from random
    /// networks.
    ///
    /// # Errors
    /// [`Error::BadSetting`] if policy, world and share do not go together, or an error if the
    /// checkpoint is damaged or belongs to another run.
    pub(crate) fn of(
        plan: &TrainingRequest,
        identity: &RunIdentity,
        random_share: f64,
        from: Option<&Path>,
    ) -> Result<Self, Error> {
        let bad = |name: &str, rule: String| Error::BadSetting { name: name.to_owned(), rule };
        let fits_any = plan.policy.fits_any_size();
        if !fits_any && random_share > 0.0 {
            let rule = format!("must be 0 for {}, which fits one size", plan.policy.name());
            return Err(bad("random_share", rule));
        }
        let vertiports = match plan.world.vertiports() {
            Some(vertiports) => vertiports,
            None if fits_any => 2,
            None => {
                let rule = format!("{} learns on networks of one size", plan.policy.name());
                return Err(bad("network", rule));
            }
        };
        let shape = plan.policy.shape(vertiports);
        let net = nn::NeuralNetwork::new(plan.policy.clone(), shape)
            .map_err(|rule| bad("policy", rule))?;
        let shape = FeatureShape { vertiports: (!fits_any).then_some(vertiports), ..shape.into() };
        let scales = || plan.world.network(Purpose::Training, 0).feature_scales();
        let scales = plan.policy.learns_by_ppo().then(scales);
        let header = Header {
            format: FORMAT,
            network: plan.world.name(),
            policy: plan.policy.clone(),
            shape,
            feature_scales: scales,
            settings: Some(plan.settings.clone()),
            seed: Some(plan.seed),
            commit: plan.commit.clone(),
            steps: 0,
            begun_with: plan.begun_with(),
        };
        let checkpoint = from.map(|path| checkpoint::read(path, identity, net.layout().len()));
        let checkpoint = checkpoint.transpose()?;
        let (params, adam) = if let Some(Checkpoint { params, adam, .. }) = &checkpoint {
            (params.clone(), adam.clone())
        } else {
            let params = plan.first_params(&net);
            let adam = Adam::new(params.len());
            (params, adam)
        };
        Ok(Self { net, vertiports, header, params, adam, checkpoint })
    }
}

/// The training days of a round or a generation, given its number, counted from 0, and its number
/// of days. A share of them come from random networks and from [`random_city`], in turns and each
/// from a different network; the others come from the world.
pub(crate) fn training_days(
    world: &World,
    run_seed: u32,
    random_share: f64,
    (round, days): (u32, u32),
) -> Result<Vec<Arc<Scenario>>, Error> {
    // The number of random days before a day.
    let random_before = |day: u64| (day as f64 * random_share).floor();
    let first = u64::from(round) * u64::from(days);
    (first..first + u64::from(days))
        .map(|day| {
            let seed = DaySeed::training(run_seed, day)?;
            let number = random_before(day);
            let is_random = number < random_before(day + 1);
            // Every day has its own seed, so no two runs share a network that is drawn.
            let network = match (is_random, number % 2.0 == 0.0) {
                (false, _) => world.network(Purpose::Training, seed.get()),
                (true, true) => World::Random.network(Purpose::Training, seed.get()),
                (true, false) => Arc::new(random_city(Purpose::Training, seed.get())),
            };
            Ok(Arc::new(network.draw(seed)))
        })
        .collect()
}
