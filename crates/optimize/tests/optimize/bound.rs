//! Properties of the bound, on small days of every kind and on days of the `paper` network.

use std::fs;
use std::sync::Arc;

use crate::exhaustive::best_of_all;
use rayon::prelude::*;
use vertifleet_core::{
    AircraftIx, Coded, DaySeed, Matrix, Network, Outage, Scenario, Stop, TakeoffDelays, Time,
    TypeIx, VertiportIx,
};
use vertifleet_optimize::{Error, Rolling, Step, kept_upper_bound, upper_bound};
use vertifleet_policy::{BidPricePolicy, Greedy, Policy, Random, play};
use vertifleet_sim::Simulation;
use vertifleet_testkit::{Size, any_day, any_extended_day, paper_day};

fn minutes(minutes: u32) -> Step {
    Step::from_minutes(minutes).expect("a step")
}

fn bound_usd(day: &Scenario, step: u32) -> f64 {
    upper_bound(day, minutes(step)).expect("a small day").upper_bound_usd()
}

fn earned_usd(day: &Arc<Scenario>, policy: &mut dyn Policy) -> f64 {
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, policy, |_| ()).expect("these policies always answer");
    simulation.ledger().profit_usd()
}

#[test]
fn no_sequence_of_decisions_of_a_tiny_day_earns_more_than_its_bound() {
    let compared = (0..200_u32).into_par_iter().filter(|&number| {
        let day = any_day(number.into(), Size { vertiports: 3, fleet: 3, hours: 2 });
        let Some(best) = best_of_all(&mut Simulation::new(Arc::clone(&day)), &mut 3_000) else {
            return false;
        };
        let bound = bound_usd(&day, [1, 5, 13, 60][number as usize % 4]);
        assert!(bound >= best, "day {number}: bound {bound}, possible {best}");
        true
    });
    assert!(compared.count() >= 40, "enough days have few sequences");
}

#[test]
fn no_sequence_of_decisions_of_a_tiny_disturbed_day_earns_more_than_its_bound() {
    let excess_usd: Vec<f64> = (0..200_u32)
        .into_par_iter()
        .filter_map(|number| {
            let day = any_extended_day(number.into(), Size { vertiports: 3, fleet: 3, hours: 2 });
            let best = best_of_all(&mut Simulation::new(Arc::clone(&day)), &mut 3_000)?;
            let bounds = [1, [5, 13, 60][number as usize % 3]].map(|step| bound_usd(&day, step));
            for bound in bounds {
                assert!(bound >= best, "day {number}: bound {bound}, possible {best}");
            }
            (best > 0.0).then_some(bounds[0] - best)
        })
        .collect();
    let compared = excess_usd.len();
    assert!(compared >= 40, "{compared} days have few sequences");
    // On the other days, prices leave a gap because of stands, passengers or outages.
    let exact = excess_usd.iter().filter(|&&excess_usd| excess_usd < 0.01).count();
    assert!(3 * exact >= compared, "{exact} of {compared} bounds are the optimum");
}

#[test]
fn where_nothing_is_scarce_the_bound_is_the_optimum() {
    let mut compared = 0;
    for number in 0..100 {
        let day = any_day(number, Size { vertiports: 3, fleet: 1, hours: 4 });
        let mut ample = Scenario::clone(&day).into_day();
        for table in &mut ample.demand {
            let size = table.size();
            *table = Matrix::from_fn(size, |from, to| if from == to { 0 } else { 1_000 });
        }
        ample.energy_price_usd.fill(0.25);
        let day = Arc::new(ample.check("ample").expect("a day within the rules"));
        let Some(best) = best_of_all(&mut Simulation::new(Arc::clone(&day)), &mut 20_000) else {
            continue;
        };
        let bound = bound_usd(&day, 60);
        assert!((bound - best).abs() < 0.01, "day {number}: bound {bound}, optimum {best}");
        compared += 1;
    }
    assert!(compared >= 40, "{compared} days have few enough sequences");
}

/// A day on which the bound equals the optimum: one aircraft, passengers for every flight who all
/// pay more than they cost, electricity at one price, no outages, and routes that close and open
/// only when a demand period begins.
fn ample_disturbed_day(number: u64) -> Arc<Scenario> {
    let day = any_extended_day(number, Size { vertiports: 3, fleet: 1, hours: 4 });
    let mut ample = Scenario::clone(&day).into_day();
    for table in &mut ample.demand {
        let size = table.size();
        *table = Matrix::from_fn(size, |from, to| if from == to { 0 } else { 1_000 });
    }
    ample.energy_price_usd.fill(0.25);
    ample.passenger_cost_usd.cells_mut().fill(0.0);
    ample.disturbances.outages.clear();
    let changes = ample.periods.clone();
    let over = ample.operations.end + 2 * 3600;
    let next = |time| changes.iter().copied().find(|&change| change >= time).unwrap_or(over);
    for closure in &mut ample.disturbances.closures {
        (closure.start, closure.end) = (next(closure.start), next(closure.end));
    }
    Arc::new(ample.check("ample").expect("a day within the rules"))
}

#[test]
fn where_nothing_is_scarce_the_bound_of_a_disturbed_day_is_the_optimum() {
    let compared = (0..400_u32).into_par_iter().filter(|&number| {
        let day = ample_disturbed_day(number.into());
        let Some(best) = best_of_all(&mut Simulation::new(Arc::clone(&day)), &mut 20_000) else {
            return false;
        };
        let bound = bound_usd(&day, 60);
        assert!((bound - best).abs() < 0.01, "day {number}: bound {bound}, optimum {best}");
        best > 0.0
    });
    assert!(compared.count() >= 40, "enough days have few sequences");
}

#[test]
fn no_policy_earns_more_than_the_bound_on_200_networks() {
    (1_000..1_200_u32).into_par_iter().for_each(|number| {
        let day = any_day(number.into(), Size { vertiports: 6, fleet: 12, hours: 5 });
        let bound = bound_usd(&day, [5, 7, 15, 30, 60][number as usize % 5]);
        let policies: [&mut dyn Policy; 4] = [
            &mut Random::new(1),
            &mut Greedy,
            &mut BidPricePolicy::default(),
            &mut Rolling::default(),
        ];
        for policy in policies {
            let earned = earned_usd(&day, policy);
            assert!(bound >= earned, "day {number}: bound {bound}, earned {earned}");
        }
    });
}

#[test]
fn no_policy_earns_more_than_the_bound_on_200_disturbed_networks() {
    (2_000..2_200_u32).into_par_iter().for_each(|number| {
        let day = any_extended_day(number.into(), Size { vertiports: 6, fleet: 12, hours: 5 });
        let bound = bound_usd(&day, [5, 7, 15, 30, 60][number as usize % 5]);
        let policies: [&mut dyn Policy; 4] = [
            &mut Random::new(1),
            &mut Greedy,
            &mut BidPricePolicy::default(),
            &mut Rolling::default(),
        ];
        for policy in policies {
            let earned = earned_usd(&day, policy);
            assert!(bound >= earned, "day {number}: bound {bound}, earned {earned}");
        }
    });
}

#[test]
fn a_bound_of_paper_is_near_what_can_be_earned_and_the_same_each_time() {
    let day = Arc::new(paper_day(1));
    let bound = bound_usd(&day, 15);
    let earned = earned_usd(&day, &mut Greedy);
    assert!(earned < bound && bound < 1.2 * earned, "greedy earns {earned}, the bound is {bound}");
    assert_eq!(bound, bound_usd(&day, 15));
}

#[test]
fn a_day_without_anything_to_earn_has_a_bound_of_nothing() {
    let nothing = |day: Result<Scenario, _>| {
        let bound = bound_usd(&day.expect("a day within the rules"), 60);
        assert!((0.0..0.01).contains(&bound), "{bound}");
    };
    let mut idle = Scenario::clone(&paper_day(4)).into_day();
    idle.demand.iter_mut().for_each(|table| table.cells_mut().fill(0));
    nothing(idle.check("no demand"));

    let mut stuck = Scenario::clone(&paper_day(4)).into_day();
    let size = stuck.vertiports.len();
    stuck.distance_mi = Matrix::from_fn(size, |from, to| if from == to { 0.0 } else { 900.0 });
    nothing(stuck.check("out of range"));

    let mut dear = Scenario::clone(&paper_day(4)).into_day();
    dear.passenger_cost_usd = dear.fare_usd.in_period(0).clone();
    nothing(dear.check("nothing left of a fare"));
}

#[test]
fn a_day_of_one_instant_is_bounded_by_its_only_flights() {
    let mut day = Scenario::clone(&paper_day(5)).into_day();
    day.operations.end = day.operations.start;
    let day = Arc::new(day.check("one instant").expect("a day within the rules"));
    let (bound, earned) = (bound_usd(&day, 5), earned_usd(&day, &mut Greedy));
    assert!(0.0 < earned && earned <= bound, "greedy earns {earned}, the bound is {bound}");
}

#[test]
fn stands_and_passengers_have_prices_where_they_are_scarce() {
    let day = paper_day(6);
    let bound = upper_bound(&day, minutes(15)).expect("a small day");
    assert_eq!(bound.step_s(), 900);
    let size = day.vertiports.len();
    let worth: f64 = VertiportIx::all(size).map(|place| bound.stand_shadow_price_usd(place)).sum();
    assert!(worth > 0.0, "48 stands for 40 aircraft are scarce");

    let mut scarce = Scenario::clone(&day).into_day();
    for table in &mut scarce.demand {
        table.cells_mut().iter_mut().for_each(|passengers| *passengers = (*passengers).min(1));
    }
    let scarce = scarce.check("one passenger a period").expect("a day within the rules");
    let bound = upper_bound(&scarce, minutes(15)).expect("a small day");
    let pairs =
        VertiportIx::all(size).flat_map(|from| VertiportIx::all(size).map(move |to| (from, to)));
    let dearest =
        pairs.map(|(from, to)| bound.passenger_shadow_price_usd(0, from, to)).fold(0.0, f64::max);
    assert!(dearest > 0.0, "single passengers are scarce");
}

#[test]
fn a_kept_bound_is_the_bound_and_a_damaged_one_is_found_anew() {
    let day = any_day(7, Size { vertiports: 5, fleet: 9, hours: 4 });
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path().join("bounds");
    let files = || -> Vec<_> {
        let entries = fs::read_dir(&folder).expect("a folder of ours");
        entries.map(|entry| entry.expect("an entry").path()).collect()
    };
    let kept = |day: &Scenario, step| {
        let bound = kept_upper_bound(&Stop::default(), day, minutes(step), &folder);
        bound.expect("a folder of ours").expect("it is not stopped").upper_bound_usd()
    };
    let found = bound_usd(&day, 30);
    assert_eq!(kept(&day, 30), found);
    assert_eq!(kept(&day, 30), found);
    let file = &files()[0];
    let whole = fs::read(file).expect("the file is there");
    for damaged in [&b""[..], &whole[..whole.len() / 2], br#"{"stand":[1],"flight":[]}"#] {
        fs::write(file, damaged).expect("a folder of ours");
        assert_eq!(kept(&day, 30), found);
        assert_eq!(fs::read(file).expect("the file is there"), whole);
    }
    // Prices of zero are valid prices; the bound that they prove is loose but true.
    let nothing = String::from_utf8(whole).expect("text");
    let numbers = |c: char| c.is_ascii_digit();
    let nothing: Vec<&str> = nothing.split(numbers).collect();
    fs::write(file, nothing.join("0")).expect("a folder of ours");
    assert!(kept(&day, 30) >= found);
    assert_eq!(files().len(), 1);

    kept(&any_day(8, Size { vertiports: 5, fleet: 9, hours: 4 }), 30);
    kept(&day, 60);
    assert_eq!(files().len(), 3, "another day and another step have separate files");
}

#[test]
fn a_proof_that_is_stopped_leaves_nothing() {
    let day = any_day(7, Size { vertiports: 5, fleet: 9, hours: 4 });
    let folder = tempfile::tempdir().expect("a folder");
    let stopped = Stop::default();
    stopped.request();
    let bound = kept_upper_bound(&stopped, &day, minutes(30), folder.path()).expect("a small day");
    assert!(bound.is_none());
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn a_shorter_step_never_gives_a_looser_bound() {
    (3_000..3_012_u32).into_par_iter().for_each(|number| {
        let day = any_extended_day(number.into(), Size { vertiports: 6, fleet: 12, hours: 6 });
        // Steps between these give the slices of the next shorter one.
        let bounds = [60, 44, 15, 5, 3, 1].map(|step| bound_usd(&day, step));
        assert!(bounds.is_sorted_by(|longer, shorter| shorter <= longer), "{number}: {bounds:?}");
    });
}

#[test]
fn a_shorter_step_never_gives_a_looser_bound_on_larger_networks() {
    for network in ["paper", "new-york"] {
        let network = Network::find(network).expect("a network");
        let mut day = network.draw(DaySeed::comparison(5).expect("a seed")).into_day();
        day.operations.end = day.operations.start + 3 * 3600;
        if let Some(delays) = &mut day.disturbances.takeoff_delays {
            let (start, end) = (day.operations.start, day.operations.end);
            delays.delay_s.truncate(TakeoffDelays::slots(delays.slot_s, start, end));
        }
        let day = day.check("a morning").expect("a day within the rules");
        let bounds = [60, 15, 5, 3, 1].map(|step| bound_usd(&day, step));
        assert!(bounds.is_sorted_by(|longer, shorter| shorter <= longer), "{bounds:?}");
        // Bounds of these networks fall by one percent and more.
        assert!(bounds[4] < bounds[0], "{bounds:?}");
    }
}

#[test]
fn a_bound_does_not_depend_on_the_number_of_threads() {
    let day = any_extended_day(17, Size { vertiports: 6, fleet: 12, hours: 6 });
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| bound_usd(&day, 3)).to_bits()
    };
    assert_eq!(on(1), on(3));
}

/// The day with one more stand at a vertiport.
fn with_one_more_stand(day: &Scenario, vertiport: VertiportIx) -> Arc<Scenario> {
    let mut more = day.clone().into_day();
    more.vertiports[vertiport.at()].stands += 1;
    Arc::new(more.check("one more stand").expect("a day within the rules"))
}

/// The day with one more passenger.
fn with_one_more_passenger(
    day: &Scenario,
    period: usize,
    pair: (VertiportIx, VertiportIx),
) -> Arc<Scenario> {
    let mut more = day.clone().into_day();
    more.disturbances.forecast = None;
    more.demand[period][pair] += 1;
    Arc::new(more.check("one more passenger").expect("a day within the rules"))
}

#[test]
fn with_one_more_stand_or_passenger_no_sequence_earns_more_than_the_bound_and_its_worth() {
    let compared = (0..300_u32).into_par_iter().filter(|&number| {
        let size = Size { vertiports: 3, fleet: 3, hours: 2 };
        // On every other day, passengers may wait.
        let day = [any_day, any_extended_day][number as usize % 2](number.into(), size);
        let bound = upper_bound(&day, minutes(5)).expect("a small day");
        let size = day.vertiports.len();
        let mut compared = 0;
        let mut holds = |more: Arc<Scenario>, worth_usd: f64| {
            if let Some(best) = best_of_all(&mut Simulation::new(more), &mut 3_000) {
                let most = bound.upper_bound_usd() + worth_usd + 1e-6;
                assert!(most >= best, "day {number}: at most {most}, possible {best}");
                compared += 1;
            }
        };
        for at in VertiportIx::all(size) {
            holds(with_one_more_stand(&day, at), bound.stand_shadow_price_usd(at));
            for to in VertiportIx::all(size).filter(|to| *to != at) {
                for period in 0..day.periods.len().min(2) {
                    let worth_usd = bound.passenger_shadow_price_usd(period, at, to);
                    holds(with_one_more_passenger(&day, period, (at, to)), worth_usd);
                }
            }
        }
        compared > 0
    });
    assert!(compared.count() >= 60, "enough days have few sequences");
}

#[test]
fn a_day_with_one_more_stand_solved_again_is_bounded_by_the_bound_and_the_worth_of_the_stand() {
    let day = paper_day(7);
    let step = minutes(5);
    let bound = upper_bound(&day, step).expect("a small day");
    for at in VertiportIx::all(day.vertiports.len()).step_by(3) {
        let more = with_one_more_stand(&day, at);
        let again = upper_bound(&more, step).expect("a small day").upper_bound_usd();
        let most = bound.upper_bound_usd() + bound.stand_shadow_price_usd(at);
        // The search does not reach the very lowest bound, so a small tolerance is needed.
        assert!(again <= 1.003 * most, "{at:?}: {again} is proven again, {most} by the worth");
        let earned = earned_usd(&more, &mut BidPricePolicy::default());
        assert!(earned <= most, "{at:?}: {earned} is earned, {most} is proven");
    }
}

#[test]
fn a_step_is_a_whole_number_of_minutes_up_to_an_hour() {
    for wrong in [0, 61] {
        let error = Step::from_minutes(wrong).expect_err("no step");
        assert_eq!(error.code().to_string(), "V501");
        assert!(error.to_string().contains(&wrong.to_string()));
    }
    assert_eq!(minutes(5), Step::default());
}

#[test]
fn a_day_too_large_is_refused_with_what_helps() {
    let mut large = Scenario::clone(&paper_day(1)).into_day();
    let kinds: Vec<_> = (0..64)
        .map(|number| {
            let mut kind = large.aircraft_types[0].clone();
            kind.id = format!("T{number}");
            kind
        })
        .collect();
    for (number, aircraft) in large.aircraft.iter_mut().enumerate() {
        aircraft.kind = TypeIx::new(number);
    }
    large.aircraft_types = kinds;
    large.operations.end = Time::from_seconds(36 * 3600);
    let size = 40;
    let first = large.vertiports[0].clone();
    large.vertiports = (0..size)
        .map(|number| {
            let mut vertiport = first.clone();
            vertiport.id = format!("V{number}");
            vertiport.stands = 40;
            vertiport
        })
        .collect();
    let flat = Matrix::from_fn(size, |from, to| if from == to { 0.0 } else { 10.0 });
    large.flight_cost_usd = Matrix::from_fn(size, |_, _| 0.0);
    (large.distance_mi, large.fare_usd, large.passenger_cost_usd) =
        (flat.clone(), flat.clone().into(), flat);
    large.demand.iter_mut().for_each(|table| *table = Matrix::from_fn(size, |_, _| 0));
    let large = large.check("large").expect("a day within the rules");
    let error = upper_bound(&large, minutes(1)).expect_err("too large");
    assert!(matches!(error, Error::TooManyFlights { .. }));
    assert_eq!(error.code().to_string(), "V502");
    assert!(error.hint().is_some());
}

/// On `paper` the shortest flight takes half an hour and some minutes, and operations last from
/// 6:00 to 18:00.
#[test]
fn an_outage_that_cannot_happen_does_not_loosen_the_bound() {
    for day in [paper_day(3), Arc::new(shipped_day("paper-quick", 3))] {
        let with = |start: &str, end: &str| {
            let mut day = Scenario::clone(&day).into_day();
            let time = |text: &str| text.parse::<Time>().expect("a time");
            let (start, end) = (time(start), time(end));
            let outages = (0..20).map(|at| Outage { aircraft: AircraftIx::new(at), start, end });
            day.disturbances.outages = outages.collect();
            bound_usd(&day.check("a day with outages").expect("a day"), 60)
        };
        let bound = bound_usd(&day, 60);
        for (start, end) in
            [("06:00:00", "06:30:00"), ("05:00:00", "06:00:01"), ("18:00:01", "20:00:00")]
        {
            assert!((with(start, end) - bound).abs() < 1e-9, "{start} to {end}");
        }
        assert!(with("08:00:00", "12:00:00") > bound, "an outage that may happen loosens it");
    }
    // Charging takes longer than this outage.
    let mut day = Scenario::clone(&paper_day(3)).into_day();
    let bound = bound_usd(&paper_day(3), 60);
    let (start, end) = (Time::from_seconds(9 * 3600), Time::from_seconds(9 * 3600 + 60));
    day.disturbances.outages = vec![Outage { aircraft: AircraftIx::new(0), start, end }];
    let with_short = bound_usd(&day.check("a day with an outage").expect("a day"), 60);
    assert!((with_short - bound).abs() < 1e-9, "{with_short} and {bound}");
}

fn shipped_day(network: &str, seed: u64) -> Scenario {
    let network = Network::find(network).expect("a shipped network");
    network.draw(DaySeed::validation(seed).expect("a seed"))
}
