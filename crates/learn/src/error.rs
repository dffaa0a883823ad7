//! Errors in settings, weights and checkpoints: codes V301 and up.

use vertifleet_core::{Code, Coded, Exit, Stopped};

/// An expected failure of training, or of loading what a training run wrote.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// V301 unknown preset. There is no training preset of that name.
    ///
    /// Fix: use `default` or `evolution`; for `gcaps` and `mlp` also `paper` or `imitation`.
    #[error("there is no preset {name:?}: presets of this policy are {known}")]
    UnknownPreset {
        /// The requested name.
        name: String,
        /// All names of presets.
        known: &'static str,
    },
    /// V302 unknown setting. There is no training setting of the name given to `--set`, or to
    /// `vertifleet.settings` in Python.
    ///
    /// Fix: use a name from the list in the message; [Training](../concepts/training.md#presets)
    /// explains each.
    #[error("there is no setting {name:?}: settings are {known}")]
    UnknownSetting {
        /// The requested name.
        name: String,
        /// All names of settings.
        known: String,
    },
    /// V303 setting with a bad value. A setting's value is of the wrong kind, or outside the bounds
    /// that the message states; or the weights to begin with (`begin_with`) are not of the run's
    /// policy, sizes or network.
    ///
    /// Fix: give a value within the bounds, or weights that fit.
    #[error("setting {name:?}: {rule}")]
    BadSetting {
        /// The name of the setting.
        name: String,
        /// The rule that the value breaks.
        rule: String,
    },
    /// V304 unusable weights. A weight file is damaged, the file is not a weight file, or its
    /// tensors are not those of the policy that its header names. The message names the difference.
    ///
    /// Fix: use a file that `vertifleet train` wrote, or fetch the shipped weights again.
    #[error("{origin}: no usable weights: {rule}")]
    BadWeights {
        /// The name of the file.
        origin: String,
        /// What is wrong with the file.
        rule: String,
    },
    /// V305 weights of another network. The weights were trained on a network whose number of
    /// vertiports differs from the day's.
    ///
    /// Fix: use weights that were trained on this network, or train such weights. Or use those of
    /// `gcaps-x` or `gcaps-full`, which fit any network.
    #[error(
        "the weights were trained on network {network:?} with {trained} vertiports, but {scenario:?} has {found}"
    )]
    WrongNetwork {
        /// The network of the weights.
        network: String,
        /// The number of vertiports that the weights fit.
        trained: usize,
        /// The name of the day.
        scenario: String,
        /// The number of vertiports of the day.
        found: usize,
    },
    /// V306 checkpoint that does not fit. A checkpoint is damaged, or it belongs to a run with
    /// another network, policy, seed or other settings than those given with `train --resume`.
    ///
    /// Fix: resume with the arguments that the run was started with, or start a new run in another
    /// folder.
    #[error("the checkpoint does not fit: {rule}")]
    BadCheckpoint {
        /// What is wrong with the checkpoint.
        rule: String,
    },
    /// V307 no shipped policy of that name. A policy is neither a rule nor shipped for that
    /// network: the name is mistyped, the network is your own, or a scenario's name does not
    /// contain its network. The message lists the available policies, and the hint suggests the
    /// most similar name.
    ///
    /// Fix: use `random`, `greedy`, `prices` or `rolling`, or give weights with `--model`; those of
    /// `gcaps-x` and `gcaps-full` fit every network.
    #[error("no policy {policy:?} is shipped for network {network:?}: shipped are {known}")]
    NotShipped {
        /// The requested policy.
        policy: String,
        /// The requested network.
        network: String,
        /// All shipped policies.
        known: String,
    },
    /// V308 damaged learning curve. The learning curve in the folder of a weight file
    /// (`gcaps-curve.csv` with `gcaps.safetensors`) is not one that `train` wrote. `compare` reads
    /// it for its figure.
    ///
    /// Fix: restore the file, or remove it to have the report without this curve.
    #[error("{origin}: line {line}: no row of a learning curve: {rule}")]
    BadCurve {
        /// The name of the file.
        origin: String,
        /// The line, counted from 1.
        line: u64,
        /// The cause.
        rule: String,
    },
    /// V309 training diverged. A training run diverged: some weight became infinite or not a
    /// number, mostly because the steps were too large.
    ///
    /// Fix: train with a smaller `learning_rate`, from the last checkpoint or from the start. The
    /// checkpoint is from before the update that failed.
    #[error(
        "training diverged: after update or round {update}, a weight is infinite or not a number"
    )]
    Diverged {
        /// The update of PPO, or the round of imitation, counted from 1.
        update: u64,
    },
    /// V311 earlier run in the folder. A training run was to begin in a folder with the checkpoint
    /// of an earlier run of the same policy. That checkpoint would be lost.
    ///
    /// Fix: continue that run with `--resume` (in Python `resume=True`), name another folder, or
    /// remove the checkpoint.
    #[error("{checkpoint} is there already, of an earlier run")]
    EarlierRun {
        /// The checkpoint of the earlier run.
        checkpoint: String,
    },
    /// V408 stopped. A comparison or a training was stopped before all its days were played. In
    /// Python this is a `KeyboardInterrupt`.
    ///
    /// Fix: none needed; nothing was written. Bounds that were proven by then are kept.
    #[error("{Stopped}")]
    Stopped,
    /// An error in a file, a network or a seed.
    #[error(transparent)]
    Core(#[from] vertifleet_core::Error),
}

impl From<Stopped> for Error {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl Coded for Error {
    fn code(&self) -> Code {
        match self {
            Self::UnknownPreset { .. } => Code(301),
            Self::UnknownSetting { .. } => Code(302),
            Self::BadSetting { .. } => Code(303),
            Self::BadWeights { .. } => Code(304),
            Self::WrongNetwork { .. } => Code(305),
            Self::BadCheckpoint { .. } => Code(306),
            Self::NotShipped { .. } => Code(307),
            Self::BadCurve { .. } => Code(308),
            Self::Diverged { .. } => Code(309),
            Self::EarlierRun { .. } => Code(311),
            Self::Stopped => Code(408),
            Self::Core(error) => error.code(),
        }
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::UnknownPreset { .. }
            | Self::UnknownSetting { .. }
            | Self::BadSetting { .. }
            | Self::Stopped => None,
            Self::EarlierRun { .. } => {
                Some("go on with it by --resume, name another folder, or remove the file")
            }
            Self::BadWeights { .. } => Some(
                "`vertifleet train` writes weights that load; a file of another policy needs that policy's name",
            ),
            Self::WrongNetwork { .. } => {
                Some("this policy's weights fit one network only; train it on this one")
            }
            Self::BadCheckpoint { .. } => Some(
                "resume with the settings the run was started with, or start a new run in another folder",
            ),
            Self::NotShipped { .. } => Some(
                "name a rule (random, greedy, prices, rolling), gcaps-x, or give weights with --model",
            ),
            Self::BadCurve { .. } => Some(
                "`vertifleet train` writes the curve next to the weights; remove the file to do without",
            ),
            Self::Diverged { .. } => Some("lower learning_rate; the last checkpoint is as it was"),
            Self::Core(error) => error.hint(),
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::Core(error) => error.exit(),
            Self::Diverged { .. } | Self::Stopped => Exit::Failed,
            _ => Exit::Input,
        }
    }
}
