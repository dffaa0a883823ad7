//! Replays days of the paper's authors' public environment, aircraft by aircraft. With the authors'
//! rules as settings, the simulator sells the same tickets and earns the same profit.
//!
//! The days lie outside the repository, in `../shared/data` next to it (repository
//! `iamstevepaul/UAM_fleet_Scheduling`, its first 20 committed test days, each played once with
//! feasible random decisions). Where they are absent there is nothing to compare, and the test
//! prints that. `networks/as-coded.toml` has the same settings.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;

use serde_json::Value;
use vertifleet_core::{Aircraft, DaySeed, Matrix, Network, Scenario, Time, TypeIx, VertiportIx};
use vertifleet_sim::check::check;
use vertifleet_sim::{Refusal, Simulation, Trace};

const DAYS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/authors-days.json");

/// The authors' flights carry a full cabin or no passengers: where fewer than 4 passengers are
/// left, no ticket is sold. That is equivalent to rounding demand down to whole cabins.
const SEATS: u32 = 4;

/// One aircraft's decision: origin, destination, and time in hours.
type Move = (VertiportIx, VertiportIx, f64);

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn vertiport(value: &Value) -> VertiportIx {
    VertiportIx::new(usize::try_from(value.as_u64().expect("a position")).expect("small"))
}

/// The day with the rules of the authors' environment, which are those of the network `as-coded`.
fn scenario(day: &Value, number_of_day: usize) -> Arc<Scenario> {
    let network = Network::shipped("as-coded").expect("a shipped network");
    let mut ours = network.draw(DaySeed::comparison(1).expect("a seed")).into_day();
    ours.name = format!("authors-{number_of_day}");
    let places: Vec<(f64, f64)> =
        list(&day["loc"]).iter().map(|place| (number(&place[0]), number(&place[1]))).collect();
    for (vertiport, place) in ours.vertiports.iter_mut().zip(&places) {
        (vertiport.x_mi, vertiport.y_mi) = *place;
    }
    let size = ours.vertiports.len();
    assert_eq!((size, ours.aircraft.len()), (places.len(), list(&day["init"]).len()));
    ours.distance_mi = Matrix::from_fn(size, |from, to| {
        let (from, to) = (places[from.at()], places[to.at()]);
        (from.0 - to.0).hypot(from.1 - to.1)
    });
    ours.fare_usd =
        Matrix::from_fn(size, |from, to| number(&day["fare"][from.at()][to.at()])).into();
    ours.demand = vec![Matrix::from_fn(size, |from, to| {
        let waiting = day["demand_day"][from.at()][to.at()].as_u64().expect("a count");
        let full_cabins = u32::try_from(waiting).expect("small") / SEATS;
        if from == to { 0 } else { full_cabins * SEATS }
    })];
    let starts = list(&day["init"]).iter().map(vertiport);
    ours.aircraft = (1..)
        .zip(starts)
        .map(|(number, at)| Aircraft {
            id: format!("A{number:02}"),
            kind: TypeIx(0),
            at,
            start_charge_kwh: None,
        })
        .collect();
    Arc::new(ours.check("authors' day").expect("a day within the rules"))
}

/// The result of a replay.
#[derive(Debug, Default)]
struct Replayed {
    tickets_usd: f64,
    profit_usd: f64,
    /// Number of decisions that came in another order than the authors', by our clock.
    swapped: usize,
    /// The largest difference between the two clocks at a decision, seconds.
    furthest_s: f64,
    decisions: usize,
}

/// Lets every aircraft take its own decisions in their order, when our clock asks it. Where two
/// decisions have changed places, so that one of them frees a charger too late for the other, the
/// error states at which vertiport and when.
fn replay(day: &Value, scenario: &Arc<Scenario>) -> Result<Replayed, (VertiportIx, Time)> {
    let mut moves: Vec<VecDeque<(usize, Move)>> = vec![VecDeque::new(); scenario.aircraft.len()];
    for (order, one) in list(&day["moves"]).iter().enumerate() {
        let aircraft = vertiport(&one[0]).at();
        moves[aircraft]
            .push_back((order, (vertiport(&one[1]), vertiport(&one[2]), number(&one[3]))));
    }
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut trace = Trace::default();
    let mut replayed = Replayed::default();
    let mut latest = 0;
    while let Some(decision) = simulation.next_decision() {
        let next = moves[decision.aircraft.at()].pop_front();
        let (order, (from, to, hours)) = next.expect("a decision is asked for that they took too");
        assert_eq!(from, decision.at, "aircraft are where they were");
        replayed.swapped += usize::from(order < latest);
        latest = latest.max(order);
        let apart_s = (hours * 3600.0 - f64::from(decision.time.seconds())).abs();
        replayed.furthest_s = replayed.furthest_s.max(apart_s);
        match simulation.apply(to) {
            Ok(row) => trace.rows.push(row),
            Err(Refusal::NoStandFree { .. }) => return Err((to, decision.time)),
            Err(refusal) => panic!("{}: {refusal}", decision.time),
        }
        replayed.decisions += 1;
    }
    assert!(moves.iter().all(VecDeque::is_empty), "every decision is asked for");
    let report = check(scenario, &trace);
    assert!(report.is_valid(), "{report}");
    replayed.tickets_usd = simulation.ledger().revenue_usd;
    replayed.profit_usd = simulation.ledger().profit_usd();
    Ok(replayed)
}

#[test]
fn the_authors_days_sell_their_tickets_and_earn_their_profit() {
    if !Path::new(DAYS).exists() {
        println!("skipped: {DAYS} is not here");
        return;
    }
    let text = std::fs::read(DAYS).expect("a file that is there");
    let days: Value = serde_json::from_slice(&text).expect("JSON");
    let (mut swapped, mut refused) = (0, 0);
    for (number_of_day, day) in list(&days).iter().enumerate() {
        let ours = scenario(day, number_of_day);
        let replayed = replay(day, &ours).unwrap_or_else(|(vertiport, time)| {
            println!(
                "day {number_of_day}: two decisions swapped at {time}, #{} is full",
                vertiport.0
            );
            refused += 1;
            let mut roomier = Scenario::clone(&ours).into_day();
            let chargers = &mut roomier.vertiports[vertiport.at()].chargers;
            *chargers = chargers.map(|chargers| chargers + 1);
            let roomier = Arc::new(roomier.check("roomier").expect("a day within the rules"));
            replay(day, &roomier).expect("one swap a day needs one more charger")
        });
        assert!(replayed.furthest_s < 10.0, "day {number_of_day}: the clocks agree");
        println!("day {number_of_day}: {replayed:?}, theirs {} {}", day["tickets"], day["profit"]);
        let (tickets_usd, profit_usd) = (number(&day["tickets"]), number(&day["profit"]));
        assert!((replayed.tickets_usd - tickets_usd).abs() < 1.0, "day {number_of_day}: tickets");
        assert!((replayed.profit_usd - profit_usd).abs() < 1.0, "day {number_of_day}: profit");
        swapped += replayed.swapped;
    }
    println!(
        "decisions in another order than theirs: {swapped}; days on which that matters: {refused}"
    );
    assert!(refused <= 1);
}
