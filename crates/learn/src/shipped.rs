//! The trained policies that come with the program, inside it, so that it runs from any folder.

use crate::curve::{self, CurveRow};
use crate::error::Error;
use crate::relative::{AnyModel, Round};
use crate::weights::Model;

/// A trained policy and how its training went.
#[derive(Debug, Clone)]
pub struct Trained {
    /// The policy.
    pub model: Model,
    /// Its learning curve; empty if none was kept beside the weights.
    pub curve: Vec<CurveRow>,
}

struct Files {
    network: &'static str,
    policy: &'static str,
    weights: &'static [u8],
    curve: &'static str,
}

macro_rules! files {
    ($network:literal, $policy:literal) => {
        Files {
            network: $network,
            policy: $policy,
            weights: include_bytes!(concat!(
                "../../../models/",
                $network,
                "/",
                $policy,
                ".safetensors"
            )),
            curve: include_str!(concat!("../../../models/", $network, "/", $policy, "-curve.csv")),
        }
    };
}

const SHIPPED: &[Files] = &[files!("paper", "gcaps"), files!("paper", "mlp")];

/// The shipped policy of that name for a network.
///
/// # Errors
/// [`Error::NotShipped`] if there is none.
pub fn shipped(network: &str, policy: &str) -> Result<Trained, Error> {
    let files = SHIPPED.iter().find(|files| files.network == network && files.policy == policy);
    let Some(files) = files else {
        let names: Vec<String> =
            SHIPPED.iter().map(|files| format!("{} on {}", files.policy, files.network)).collect();
        return Err(Error::NotShipped {
            policy: policy.to_owned(),
            network: network.to_owned(),
            known: names.join(", "),
        });
    };
    let origin = format!("shipped {policy} of {network}");
    Ok(Trained {
        model: Model::from_bytes(files.weights, &origin)?,
        curve: curve::from_csv(files.curve, &origin)?,
    })
}

/// The shipped `gcaps-x`, which decides on every network.
#[derive(Debug, Clone)]
pub struct TrainedAny {
    /// The policy.
    pub model: AnyModel,
    /// Its learning curve, then those of runs with other seeds.
    pub curves: Vec<Vec<Round>>,
}

const ANY: &[u8] = include_bytes!("../../../models/any/gcaps-x.safetensors");
const ANY_CURVES: [&str; 3] = [
    include_str!("../../../models/any/gcaps-x-curve.csv"),
    include_str!("../../../models/any/gcaps-x-seed-2-curve.csv"),
    include_str!("../../../models/any/gcaps-x-seed-3-curve.csv"),
];

/// The shipped policy for networks of any size.
///
/// # Errors
/// None, unless the files inside the program are not what they should be.
pub fn shipped_any() -> Result<TrainedAny, Error> {
    let origin = "shipped gcaps-x";
    let curves = ANY_CURVES.iter().map(|text| curve::from_csv(text, origin));
    Ok(TrainedAny {
        model: AnyModel::from_bytes(ANY, origin)?,
        curves: curves.collect::<Result<_, _>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::{SHIPPED, shipped, shipped_any};

    #[test]
    fn the_shipped_policy_for_any_network_lies_on_its_curve() {
        let trained = shipped_any().expect("a shipped policy");
        let header = trained.model.header();
        let ends = trained.curves.iter().map(|rounds| rounds.last().expect("rounds").decisions);
        let ends: Vec<u64> = ends.collect();
        assert_eq!(ends[0], header.decisions);
        assert!(ends[1] != ends[0] && ends[2] != ends[1], "each curve is of a run of its own");
    }

    #[test]
    fn every_shipped_policy_loads_and_is_what_it_is_called() {
        for files in SHIPPED {
            let trained = shipped(files.network, files.policy).expect("a shipped policy");
            let header = trained.model.header();
            assert_eq!(
                (header.network.as_str(), header.policy.name()),
                (files.network, files.policy)
            );
            assert!(
                trained.curve.iter().any(|row| row.steps == header.steps),
                "weights lie on their curve"
            );
        }
    }

    #[test]
    fn what_is_not_shipped_is_named_with_what_is() {
        let error = shipped("paper", "fastest").expect_err("no such policy");
        assert_eq!(error.code().to_string(), "V307");
        assert!(error.to_string().contains("gcaps on paper, mlp on paper"));
    }
}
