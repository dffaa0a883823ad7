//! Whole days through HTTP: what the operator reports makes the simulated day, to the cent.

use std::sync::Arc;

use vertifleet_core::{DaySeed, Network, Scenario, Stop};
use vertifleet_policy::play;
use vertifleet_serve::{Operation, OperationReport, operate};
use vertifleet_sim::{DayTotals, Simulation};
use vertifleet_study::{PolicySpec, ResolveFor};

use crate::running::Running;

pub(crate) fn day(network: &str, seed: u64) -> Arc<Scenario> {
    let network = Network::shipped(network).expect("a shipped network");
    Arc::new(network.draw(DaySeed::validation(seed).expect("a seed of validation")))
}

pub(crate) fn simulated(day: &Arc<Scenario>, policy: &str) -> DayTotals {
    let spec = PolicySpec::parse(policy).expect("a policy");
    let resolved = spec.resolve(None, ResolveFor::Day(day), day.seed).expect("a policy");
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, resolved.build().as_mut(), |_| ()).expect("a day");
    simulation.totals()
}

pub(crate) fn operated(service: &Running, day: &Arc<Scenario>, policy: &str) -> OperationReport {
    let (url, policy) = (service.url.clone(), policy.to_owned());
    let day = Arc::clone(day);
    let operation = Operation { url, day, policy, token: None, trusted: None, speed: None };
    let report = operate(&operation, &Stop::default(), |_, _| ()).expect("the service answers");
    report.expect("nobody stops it")
}

#[test]
fn a_live_day_is_the_simulated_day_to_the_cent() {
    let folder = tempfile::tempdir().expect("a folder");
    let service = Running::start(folder.path());
    for network in ["paper", "disrupted", "new-york"] {
        for policy in ["greedy", "gcaps-x"] {
            let day = day(network, 2001);
            let report = operated(&service, &day, policy);
            assert_eq!(report.totals, simulated(&day, policy), "{network} {policy}");
            assert_eq!(report.sent_again, 0);
        }
    }
}
