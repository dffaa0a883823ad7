//! What can go wrong with settings, weights and checkpoints: codes V301 and on.

use vertifleet_core::{Code, Coded, Exit, Stopped};

/// An expected failure of training or of loading what training left.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// V301: there is no preset of that name for the policy.
    #[error("there is no preset {name:?}: presets of this policy are {known}")]
    UnknownPreset {
        /// The name asked for.
        name: String,
        /// All names.
        known: &'static str,
    },
    /// V302: there is no setting of that name.
    #[error("there is no setting {name:?}: settings are {known}")]
    UnknownSetting {
        /// The name asked for.
        name: String,
        /// All names.
        known: String,
    },
    /// V303: a setting's value does not fit it.
    #[error("setting {name:?}: {rule}")]
    BadSetting {
        /// The setting.
        name: String,
        /// What its value breaks.
        rule: String,
    },
    /// V304: a weight file is damaged or of another kind.
    #[error("{origin}: no usable weights: {rule}")]
    BadWeights {
        /// The file.
        origin: String,
        /// What differs.
        rule: String,
    },
    /// V305: weights and day are of different networks.
    #[error(
        "the weights were trained on network {network:?} with {trained} vertiports, but {scenario:?} has {found}"
    )]
    WrongNetwork {
        /// Network of the weights.
        network: String,
        /// Its number of vertiports.
        trained: usize,
        /// The day.
        scenario: String,
        /// The day's number of vertiports.
        found: usize,
    },
    /// V306: a checkpoint is damaged or of another run.
    #[error("the checkpoint does not fit: {rule}")]
    BadCheckpoint {
        /// What differs.
        rule: String,
    },
    /// V307: no trained policy of that name comes with the program for that network.
    #[error("no policy {policy:?} is shipped for network {network:?}: shipped are {known}")]
    NotShipped {
        /// The policy asked for.
        policy: String,
        /// The network.
        network: String,
        /// All that are shipped.
        known: String,
    },
    /// V308: a learning curve is damaged.
    #[error("{origin}: line {line}: no row of a learning curve: {rule}")]
    BadCurve {
        /// The file.
        origin: String,
        /// Line, from 1.
        line: u64,
        /// What is wrong.
        rule: String,
    },
    /// V309: a training run left the numbers: some weight is infinite or no number. Fix: train with a smaller
    /// `learning_rate`, from the last checkpoint or anew.
    #[error("training diverged in update {update}: a weight is no finite number any more")]
    Diverged {
        /// The update, from 1.
        update: u64,
    },
    /// V311: a run is to begin in a folder where an earlier one of the same policy was set aside. Fix: go on with it by `--resume` (in
    /// Python `resume=True`), name another folder, or remove the checkpoint.
    #[error("{checkpoint} is there already, of an earlier run")]
    EarlierRun {
        /// The earlier run's checkpoint.
        checkpoint: String,
    },
    /// V408: the work was asked to stop before it was done.
    #[error("{Stopped}")]
    Stopped,
    /// A file, a network or a seed.
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
                "name a rule (random, greedy, lookahead, prices, rolling), gcaps-x, or give weights with --model",
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
