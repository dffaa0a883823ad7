//! A proof in progress: its best bound so far, how it is stopped, and when it ends unasked.

use std::sync::Arc;
use std::time::{Duration, Instant};

use vertifleet_core::{Matrix, Scenario, Vertiport};
use vertifleet_optimize::{Proof, Step, upper_bound};
use vertifleet_policy::{Greedy, play};
use vertifleet_sim::Simulation;
use vertifleet_testkit::paper_day;

fn greedy_usd(day: &Arc<Scenario>) -> f64 {
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, &mut Greedy, |_| ()).expect("greedy always answers");
    simulation.ledger().profit_usd()
}

/// A day of `paper` with `copies` copies of every vertiport, close to each other.
fn large_day(copies: usize) -> Arc<Scenario> {
    let mut day = Scenario::clone(&paper_day(1)).into_day();
    let size = day.vertiports.len();
    let original =
        |at: vertifleet_core::VertiportIx| vertifleet_core::VertiportIx::new(at.at() % size);
    let wide = |table: &Matrix<f64>| {
        Matrix::from_fn(copies * size, |from, to| {
            let (one, other) = (original(from), original(to));
            if from == to {
                0.0
            } else if one == other {
                1.0
            } else {
                table[(one, other)]
            }
        })
    };
    day.distance_mi = wide(&day.distance_mi);
    day.passenger_cost_usd = wide(&day.passenger_cost_usd);
    day.flight_cost_usd = wide(&day.flight_cost_usd);
    day.fare_usd = wide(day.fare_usd.in_period(0)).into();
    for table in &mut day.demand {
        *table = Matrix::from_fn(copies * size, |from, to| {
            if from == to { 0 } else { table[(original(from), original(to))] }
        });
    }
    day.vertiports = (0..copies * size)
        .map(|at| Vertiport { id: format!("P{at}"), ..day.vertiports[at % size].clone() })
        .collect();
    Arc::new(day.check("large").expect("a day within the rules"))
}

/// Waits until a proof has found a bound.
fn first_bound_usd(proof: &Proof) -> f64 {
    let begun = Instant::now();
    loop {
        if let Some(bound) = proof.best() {
            return bound.upper_bound_usd();
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "a first bound comes soon");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_proof_has_a_bound_from_the_first_moments_on_and_only_ever_a_better_one() {
    let day = paper_day(2);
    let proof = Proof::begin(&day);
    let mut bounds = vec![first_bound_usd(&proof)];
    let mut shares = vec![proof.share()];
    while !proof.wait(Duration::from_millis(5)) {
        bounds.push(proof.best().expect("there was one before").upper_bound_usd());
        shares.push(proof.share());
    }
    let last = proof.best().expect("a bound").upper_bound_usd();
    bounds.push(last);
    assert!(bounds.is_sorted_by(|before, after| after <= before), "{bounds:?}");
    assert!(shares.is_sorted(), "{shares:?}");
    assert!(last < bounds[0] && greedy_usd(&day) <= last);
    assert!(proof.has_ended() && proof.share() == 1.0);
    let step = Step::from_minutes(1).expect("a step");
    assert_eq!(last, upper_bound(&day, step).expect("a small day").upper_bound_usd());
}

#[test]
fn a_proof_that_is_stopped_ends_soon_and_keeps_its_best_bound() {
    let day = large_day(8);
    let proof = Proof::begin(&day);
    let first = first_bound_usd(&proof);
    proof.stop();
    assert!(proof.wait(Duration::from_mins(1)));
    assert!(proof.share() < 1.0);
    let kept = proof.outcome().expect("a bound");
    assert!(!kept.is_final());
    let kept = kept.upper_bound_usd();
    assert!(greedy_usd(&day) <= kept && kept <= first);
}

#[test]
fn a_proof_ends_as_soon_as_its_bound_is_known_to_be_reached() {
    let mut idle = Scenario::clone(&paper_day(3)).into_day();
    idle.demand.iter_mut().for_each(|table| table.cells_mut().fill(0));
    let day = Arc::new(idle.check("no demand").expect("a day within the rules"));
    let proof = Proof::begin(&day);
    proof.record_profit(0.0);
    assert!(proof.wait(Duration::from_mins(1)));
    let bound = proof.outcome().expect("a bound");
    assert!(bound.is_final());
    assert_eq!(bound.upper_bound_usd(), 0.0);

    let day = paper_day(3);
    let proof = Proof::begin(&day);
    // No schedule earns this much, but the search has to believe it.
    proof.record_profit(1e9);
    assert!(proof.wait(Duration::from_mins(1)));
    assert!(proof.share() < 0.5);
}
