//! Errors in settings, weights and checkpoints: codes V301 and up.

use vertifleet_core::{Code, Coded, Exit, Stopped};

/// An expected failure of training, or of loading what a training run wrote.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// V301: the policy has no preset with this name.
    #[error("there is no preset {name:?}: presets of this policy are {known}")]
    UnknownPreset {
        /// The name that was asked for.
        name: String,
        /// All names of presets.
        known: &'static str,
    },
    /// V302: there is no setting with this name.
    #[error("there is no setting {name:?}: settings are {known}")]
    UnknownSetting {
        /// The name that was asked for.
        name: String,
        /// All names of settings.
        known: String,
    },
    /// V303: a value does not fit its setting.
    #[error("setting {name:?}: {rule}")]
    BadSetting {
        /// The name of the setting.
        name: String,
        /// The rule that the value breaks.
        rule: String,
    },
    /// V304: a weight file is damaged or of another kind.
    #[error("{origin}: no usable weights: {rule}")]
    BadWeights {
        /// The name of the file.
        origin: String,
        /// What is wrong with the file.
        rule: String,
    },
    /// V305: the weights and the day belong to different networks.
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
    /// V306: a checkpoint is damaged or belongs to another run.
    #[error("the checkpoint does not fit: {rule}")]
    BadCheckpoint {
        /// What is wrong with the checkpoint.
        rule: String,
    },
    /// V307: no trained policy with this name is shipped for the network.
    #[error("no policy {policy:?} is shipped for network {network:?}: shipped are {known}")]
    NotShipped {
        /// The policy that was asked for.
        policy: String,
        /// The network that was asked for.
        network: String,
        /// All shipped policies.
        known: String,
    },
    /// V308: a learning curve is damaged.
    #[error("{origin}: line {line}: no row of a learning curve: {rule}")]
    BadCurve {
        /// The name of the file.
        origin: String,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong.
        rule: String,
    },
    /// V309: training diverged, and a weight is infinite or NaN. Fix: train with a smaller
    /// `learning_rate`, from the last checkpoint or from the start.
    #[error(
        "training diverged: after update or round {update}, a weight is no finite number any more"
    )]
    Diverged {
        /// The update of PPO, or the round of imitation, counted from 1.
        update: u64,
    },
    /// V311: a run was to start in a folder that holds the checkpoint of an earlier run of the same
    /// policy. Fix: resume that run with `--resume` (in Python `resume=True`), name another folder,
    /// or remove the checkpoint.
    #[error("{checkpoint} is there already, of an earlier run")]
    EarlierRun {
        /// The checkpoint of the earlier run.
        checkpoint: String,
    },
    /// V408: the work was asked to stop before it was done.
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
                "resume with the settings the run was started with, or start anew in another folder",
            ),
            Self::NotShipped { .. } => Some(
                "name a rule (random, greedy, prices, rolling), gcaps-x, or give weights with --model",
            ),
            Self::BadCurve { .. } => Some(
                "`vertifleet train` writes the curve beside the weights; remove the file to go without",
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
