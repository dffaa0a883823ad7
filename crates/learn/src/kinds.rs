//! How the files that a training leaves are known again: each says first what it is.

use vertifleet_core::OutputKind;

/// The beginning of a safetensors file whose header says first that it has this format. A macro, since texts are put together
/// while the program is compiled.
macro_rules! opening {
    ($format:literal) => {
        concat!(r#"{"__metadata__":{"vertifleet":"{\"format\":\""#, $format, "/")
    };
}

const fn tensors(name: &'static str, opening: &'static str) -> OutputKind {
    // The length of the header comes first.
    OutputKind { name, skipped: 8, opening }
}

/// Weights for networks of one size.
pub const WEIGHTS: OutputKind = tensors("weight file", opening!("vertifleet-weights"));
/// Weights for networks of any size.
pub const WEIGHTS_ANY: OutputKind = tensors("weight file", opening!("vertifleet-weights-any"));
/// What a training for networks of one size goes on from.
pub const CHECKPOINT: OutputKind = tensors("checkpoint", opening!("vertifleet-checkpoint"));
/// What a training for networks of any size goes on from.
pub const CHECKPOINT_ANY: OutputKind = tensors("checkpoint", opening!("vertifleet-checkpoint-any"));
/// The learning curve of a training for networks of one size.
pub const CURVE: OutputKind =
    OutputKind { name: "learning curve", skipped: 0, opening: "update,steps,days,mean_reward," };
/// The learning curve of a training for networks of any size.
pub const CURVE_ANY: OutputKind =
    OutputKind { name: "learning curve", skipped: 0, opening: "round,decisions,agreement,lift," };

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};
    use std::sync::Arc;

    use vertifleet_core::{Network, OutputKind};

    use super::{CHECKPOINT, CHECKPOINT_ANY, CURVE, CURVE_ANY, WEIGHTS, WEIGHTS_ANY};
    use crate::nn::Architecture;
    use crate::relative::{Course, Plan, Study};
    use crate::{Settings, Training, train};

    const ALL: [OutputKind; 6] =
        [WEIGHTS, WEIGHTS_ANY, CHECKPOINT, CHECKPOINT_ANY, CURVE, CURVE_ANY];

    /// The kinds that a file is taken for.
    fn kinds(path: &Path) -> Vec<OutputKind> {
        let is_of = |kind: &OutputKind| kind.is_of(path).expect("a file of the project");
        ALL.into_iter().filter(is_of).collect()
    }

    #[test]
    fn the_shipped_files_are_of_the_kinds_that_a_training_leaves() {
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
        for (file, kind) in [
            ("paper/gcaps.safetensors", WEIGHTS),
            ("paper/mlp-curve.csv", CURVE),
            ("any/gcaps-x.safetensors", WEIGHTS_ANY),
            ("any/gcaps-x-seed-2-curve.csv", CURVE_ANY),
        ] {
            assert_eq!(kinds(&models.join(file)), [kind], "{file}");
        }
    }

    #[test]
    fn written_checkpoints_are_known_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| -> PathBuf { folder.path().join(name) };
        let network = Arc::new(Network::shipped("paper").expect("a shipped network"));
        let policy = |name| Architecture::named(name).expect("a policy with sizes");
        let commit = String::new();
        let plan = train::Plan {
            network: Arc::clone(&network),
            policy: policy("mlp"),
            settings: Settings::preset("default").expect("a preset"),
            seed: 1,
            commit: commit.clone(),
        };
        let training = Training::start(plan).expect("a training");
        training.checkpoint().write(&path("one")).expect("a free name");
        let course = Course::default();
        let plan = Plan { network, policy: policy("gcaps-x"), course, seed: 1, commit };
        Study::start(plan).expect("a training").write_checkpoint(&path("any")).expect("a name");
        assert_eq!(kinds(&path("one")), [CHECKPOINT]);
        assert_eq!(kinds(&path("any")), [CHECKPOINT_ANY]);
    }
}
