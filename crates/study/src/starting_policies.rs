//! The policies from whose days a plan may start, besides the rules that the planner includes.

use vertifleet_core::Scenario;
use vertifleet_optimize::StartingPolicy;

use crate::policy_spec::{PolicySpec, ResolveFor};

/// The learned policies that the program ships for a day's network and for every network. Together
/// with the rules, these are the policies from whose days a search for a plan can start.
pub fn starting_policies(scenario: &Scenario) -> Vec<StartingPolicy> {
    let names = ["gcaps-x", "gcaps", "mlp"];
    let shipped = names.into_iter().filter_map(|name| {
        let spec = PolicySpec::parse(name).ok()?;
        let policy = spec.resolve(None, ResolveFor::Day(scenario), 0).ok()?;
        policy.check_fits(scenario).is_ok().then(|| StartingPolicy::new(name, policy.build()))
    });
    shipped.collect()
}
