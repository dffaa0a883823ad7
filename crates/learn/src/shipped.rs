//! The trained policies that are shipped inside the program, so that it runs from any folder.

use crate::error::Error;
use crate::model::Model;
use crate::run::Curve;

/// A trained policy with the learning curves of its training.
#[derive(Debug, Clone)]
pub struct Shipped {
    /// The policy.
    pub model: Model,
    /// Its learning curve, followed by those of runs with other seeds.
    pub curves: Vec<Curve>,
}

struct Files {
    /// `None` if the policy decides on every network.
    network: Option<&'static str>,
    policy: &'static str,
    weights: &'static [u8],
    curves: &'static [&'static str],
}

const FILES: [Files; 4] = [
    Files {
        network: Some("paper"),
        policy: "gcaps",
        weights: include_bytes!("../../../models/paper/gcaps.safetensors"),
        curves: &[include_str!("../../../models/paper/gcaps-curve.csv")],
    },
    Files {
        network: Some("paper"),
        policy: "mlp",
        weights: include_bytes!("../../../models/paper/mlp.safetensors"),
        curves: &[include_str!("../../../models/paper/mlp-curve.csv")],
    },
    Files {
        network: None,
        policy: "gcaps-x",
        weights: include_bytes!("../../../models/any/gcaps-x.safetensors"),
        curves: &[
            include_str!("../../../models/any/gcaps-x-curve.csv"),
            include_str!("../../../models/any/gcaps-x-seed-2-curve.csv"),
            include_str!("../../../models/any/gcaps-x-seed-3-curve.csv"),
        ],
    },
    Files {
        network: None,
        policy: "gcaps-full",
        weights: include_bytes!("../../../models/any/gcaps-full.safetensors"),
        curves: &[include_str!("../../../models/any/gcaps-full-curve.csv")],
    },
];

/// The shipped policy with this name for a network; `gcaps-x` and `gcaps-full` are shipped for all
/// networks.
///
/// # Errors
/// Returns [`Error::NotShipped`] if there is none.
pub fn shipped(policy: &str, network: &str) -> Result<Shipped, Error> {
    let is_meant =
        |files: &&Files| files.policy == policy && files.network.is_none_or(|only| only == network);
    let files = FILES.iter().find(is_meant).ok_or_else(|| not_shipped(policy, network))?;
    let origin = format!("shipped {policy}");
    let curves = files.curves.iter().map(|text| Curve::from_csv(text, &origin));
    Ok(Shipped {
        model: Model::from_bytes(files.weights, &origin)?,
        curves: curves.collect::<Result<_, _>>()?,
    })
}

fn not_shipped(policy: &str, network: &str) -> Error {
    let names: Vec<String> = FILES
        .iter()
        .map(|files| format!("{} on {}", files.policy, files.network.unwrap_or("any")))
        .collect();
    let (policy, network) = (policy.to_owned(), network.to_owned());
    Error::NotShipped { policy, network, known: names.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::{FILES, shipped};
    use vertifleet_core::Coded;

    #[test]
    fn every_shipped_policy_loads_has_its_name_and_lies_on_its_curve() {
        for files in &FILES {
            let network = files.network.unwrap_or("new-york");
            let trained = shipped(files.policy, network).expect("a shipped policy");
            let header = trained.model.header();
            assert_eq!(trained.model.kind(), files.policy);
            assert!(files.network.is_none_or(|network| network == header.network));
            let curve = trained.curves[0].validation_rewards();
            assert!(curve.iter().any(|&(steps, _)| steps == header.steps), "{}", files.policy);
        }
    }

    #[test]
    fn curves_of_other_seeds_belong_to_other_runs() {
        let curves = shipped("gcaps-x", "paper").expect("a shipped policy").curves;
        assert!(curves.len() == 3 && curves[0] != curves[1] && curves[1] != curves[2]);
    }

    #[test]
    fn the_error_for_an_unknown_policy_lists_the_shipped_ones() {
        let error = shipped("fastest", "paper").expect_err("no such policy");
        assert_eq!(error.code().to_string(), "V307");
        let known = "gcaps on paper, mlp on paper, gcaps-x on any, gcaps-full on any";
        assert!(error.to_string().contains(known));
    }
}
