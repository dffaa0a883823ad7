//! How the program recognises the files that a training run writes: each begins with its own
//! format.

use vertifleet_core::OutputKind;

use crate::settings::TrainingSettings;

/// The beginning of a safetensors file whose header starts with a format of this name, in any
/// version. It is a macro because the text is put together at compile time.
macro_rules! opening {
    ($format:literal) => {
        concat!(r#"{"__metadata__":{"vertifleet":"{\"format\":\""#, $format)
    };
}

const fn tensors(name: &'static str, opening: &'static str) -> OutputKind {
    // The first 8 bytes are the length of the header.
    OutputKind { name, skipped: 8, opening }
}

/// The weight file of a policy.
pub const WEIGHTS: OutputKind = tensors("weight file", opening!("vertifleet-weights"));
/// The file from which a run is resumed.
pub(crate) const CHECKPOINT: OutputKind = tensors("checkpoint", opening!("vertifleet-checkpoint"));
/// The learning curves, of a run by PPO, by imitation and by evolution.
const PPO_CURVE: OutputKind =
    OutputKind { name: "learning curve", skipped: 0, opening: "update,steps,days,mean_reward," };
const IMITATION_CURVE: OutputKind =
    OutputKind { name: "learning curve", skipped: 0, opening: "round,decisions,agreement,lift," };
const EVOLUTION_CURVE: OutputKind =
    OutputKind { name: "learning curve", skipped: 0, opening: "generation,decisions,difference," };

/// The kind of learning curve that a run with these settings writes.
pub(crate) fn curve(settings: &TrainingSettings) -> &'static OutputKind {
    match settings {
        TrainingSettings::Ppo(_) => &PPO_CURVE,
        TrainingSettings::Imitation(_) => &IMITATION_CURVE,
        TrainingSettings::Evolution(_) => &EVOLUTION_CURVE,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use vertifleet_core::OutputKind;

    use super::{CHECKPOINT, EVOLUTION_CURVE, IMITATION_CURVE, PPO_CURVE, WEIGHTS};

    /// The kinds of output that a file of the repository is recognised as.
    fn kinds(file: &str) -> Vec<OutputKind> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let is_of = |kind: &OutputKind| kind.is_of(&path).expect("a file of the project");
        let kinds = [WEIGHTS, CHECKPOINT, PPO_CURVE, IMITATION_CURVE, EVOLUTION_CURVE];
        kinds.into_iter().filter(is_of).collect()
    }

    #[test]
    fn files_of_runs_are_recognised_by_their_beginning() {
        for (file, kind) in [
            ("../../models/paper/gcaps.safetensors", WEIGHTS),
            ("../../models/paper/mlp-curve.csv", PPO_CURVE),
            ("../../models/any/gcaps-x.safetensors", WEIGHTS),
            ("../../models/any/gcaps-x-seed-2-curve.csv", IMITATION_CURVE),
            ("../../models/any/gcaps-full-curve.csv", EVOLUTION_CURVE),
        ] {
            assert_eq!(kinds(file), [kind], "{file}");
        }
    }
}
