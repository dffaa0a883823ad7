//! How the program recognises the files that a training run writes: each begins with its own
//! format.

use vertifleet_core::OutputKind;

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
/// A learning curve that begins with these columns.
pub(crate) const fn curve(opening: &'static str) -> OutputKind {
    OutputKind { name: "learning curve", skipped: 0, opening }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use vertifleet_core::OutputKind;

    use super::{CHECKPOINT, WEIGHTS, curve};
    use crate::settings::Learner;
    use crate::{EvolutionSettings, ImitationSettings, PpoSettings};

    /// The learning curves of PPO, imitation and evolution.
    fn curves() -> [OutputKind; 3] {
        let (imitation, evolution) = (ImitationSettings::default(), EvolutionSettings::default());
        let ways: [&dyn Learner; 3] = [&PpoSettings::tuned(), &imitation, &evolution];
        ways.map(|way| curve(way.curve_opening()))
    }

    /// The kinds of output that the program recognises a file of the repository as.
    fn kinds(file: &str) -> Vec<OutputKind> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let is_of = |kind: &OutputKind| kind.is_of(&path).expect("a file of the project");
        [WEIGHTS, CHECKPOINT].into_iter().chain(curves()).filter(is_of).collect()
    }

    #[test]
    fn files_of_runs_are_recognised_by_their_beginning() {
        let [of_ppo, of_imitation, of_evolution] = curves();
        for (file, kind) in [
            ("../../models/paper/gcaps.safetensors", WEIGHTS),
            ("../../models/paper/mlp-curve.csv", of_ppo),
            ("../../models/any/gcaps-x.safetensors", WEIGHTS),
            ("../../models/any/gcaps-x-seed-2-curve.csv", of_imitation),
            ("../../models/any/gcaps-full-curve.csv", of_evolution),
        ] {
            assert_eq!(kinds(file), [kind], "{file}");
        }
    }
}
