//! Writes weight files to begin fuzzing with, the smallest there are of each kind: `cargo run --example seeds -- FOLDER`.

use std::path::PathBuf;
use std::sync::Arc;

use vertifleet_core::Network;
use vertifleet_learn::nn::{self, Architecture, GcapsSettings, MlpSettings};
use vertifleet_learn::relative::{Course, Plan, Study};
use vertifleet_learn::{Model, Origin, Settings, shape};

const VERTIPORTS: usize = 3;

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).expect("a folder to write to"));
    std::fs::create_dir_all(&folder).expect("a folder that can be made");
    let network = Network::shipped("paper").expect("a shipped network");
    let tiny = || GcapsSettings { width: 2, heads: 1 };
    let kinds = [
        Architecture::Gcaps(tiny()),
        Architecture::Mlp(MlpSettings { width: 2, layers: 1, value_width: 2 }),
    ];
    for kind in kinds {
        let origin = Origin {
            network: "small".to_owned(),
            feature_scales: network.feature_scales(),
            settings: Settings::tuned(),
            seed: 1,
            commit: String::new(),
        };
        let path = folder.join(kind.name());
        let net = nn::Network::new(kind, shape(VERTIPORTS)).expect("sizes that fit together");
        let params = net.init(1);
        Model::new(net, params, origin, 0).write(&path).expect("a folder of ours");
    }
    let plan = Plan {
        network: Arc::new(network),
        policy: Architecture::GcapsX(tiny()),
        course: Course { validation_days: 1, ..Course::default() },
        seed: 1,
        commit: String::new(),
    };
    let study = Study::start(plan);
    let model = study.expect("settings within their bounds").model();
    model.write(&folder.join("gcaps-x")).expect("a folder of ours");
}
