//! Compares rows of observations with the view, on any day and at every decision.

use std::sync::Arc;

use proptest::prelude::*;
use vertifleet_core::{
    AircraftIx, DaySeed, Network, Purpose, Scenario, VertiportIx, random_network,
};
use vertifleet_observe::{
    Layout, Observation, Observer, PRESETS, Part, Row, Scene, Shape, Sizes, Writer, preset,
};
use vertifleet_sim::{Decision, Simulation, View};

/// All parts, padded by the sizes in `extra`.
fn layout(day: &Scenario, extra: usize) -> Layout {
    let sizes = Sizes::of_day(day);
    let padded = Sizes {
        vertiports: sizes.vertiports + extra,
        aircraft: sizes.aircraft + extra,
        types: sizes.types + extra,
        periods: sizes.periods + extra,
    };
    let parts = Part::all().filter(|part| extra == 0 || !part.is_of_one_size());
    Layout::new(parts.collect(), padded)
}

fn part<'a>(layout: &Layout, row: &'a [f32], part: Part) -> &'a [f32] {
    let placed = layout.parts().iter().find(|placed| placed.part == part).expect("it is there");
    &row[placed.first..placed.first + placed.len]
}

/// Plays a day, flying in turn to each feasible vertiport, and calls `each` at every decision.
pub(crate) fn play(day: &Arc<Scenario>, mut each: impl FnMut(View<'_>, &Decision)) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(day));
    while let Some(decision) = simulation.next_decision() {
        each(simulation.view(), &decision);
        let feasible = simulation.view().feasible(&decision);
        let choice = feasible.nth(decision.index % feasible.len()).expect("it is never empty");
        simulation.apply(choice).expect("it is feasible");
    }
    simulation
}

fn check_against_the_view(layout: &Layout, row: &[f32], view: View<'_>, decision: &Decision) {
    let get = |name| part(layout, row, name);
    let (size, stride) = (view.vertiports(), layout.sizes().vertiports);
    let close = |found: f32, expected: f64, what: &str| {
        let allowed = 1e-5 * expected.abs().max(1.0);
        assert!((f64::from(found) - expected).abs() <= allowed, "{what}: {found}, {expected}");
    };
    let (kind, period) = (view.kind(decision.aircraft), view.period());
    let reach = |from| view.within_range(kind, from);
    for from in VertiportIx::all(size) {
        let feasible = view.feasible(decision).contains(from);
        assert_eq!(get(Part::ActionMask)[from.at()], f32::from(feasible));
        assert_eq!(get(Part::VertiportMask)[from.at()], 1.0);
        close(get(Part::Stands)[from.at()], f64::from(view.stands(from)) / 10.0, "stands");
        close(
            get(Part::StandsTaken)[from.at()],
            f64::from(view.stands_taken()[from.at()]) / 10.0,
            "taken",
        );
        check_the_choice(get, view, decision, from);
        for to in VertiportIx::all(size) {
            let at = from.at() * stride + to.at();
            let left = view.demand_left(period, from, to);
            close(get(Part::DemandLeft)[at], f64::from(left) / 10.0, "left");
            let next = if period + 1 < view.period_starts().len() {
                view.demand_left(period + 1, from, to)
            } else {
                0
            };
            close(get(Part::DemandNext)[at], f64::from(next) / 10.0, "next");
            close(get(Part::Fare)[at], view.fares_usd(period, from)[to.at()] / 100.0, "fare");
            close(get(Part::Distance)[at], view.distances_mi(from)[to.at()] / 10.0, "distance");
            assert_eq!(get(Part::Reachable)[at], f32::from(reach(from).contains(to)));
            assert_eq!(get(Part::Closed)[at], f32::from(view.closed(from).contains(to)));
            let energy =
                if reach(from).contains(to) { view.leg(kind, from, to).energy_kwh } else { 0.0 };
            close(get(Part::Energy)[at], energy / 100.0, "energy");
            let soon = view.known_closures().is_closed(from, to, decision.time + 1_800);
            assert_eq!(get(Part::ClosedAhead)[4 * at + 1], f32::from(soon));
        }
    }
    check_the_full(get, view, decision, stride);
    for aircraft in AircraftIx::all(view.places().len()) {
        let at = aircraft.at();
        assert_eq!(get(Part::FleetPlace)[at * stride + view.places()[at].at()], 1.0);
        let ready_s = view.ready_at(aircraft).since(decision.time);
        close(get(Part::FleetReady)[at], f64::from(ready_s) / 3600.0, "ready");
        let flies = view.arrives_at(aircraft) > decision.time;
        assert_eq!(get(Part::FleetFlying)[at], f32::from(flies));
        close(get(Part::FleetCharge)[at], view.charge_kwh(aircraft) / 100.0, "charge");
        assert_eq!(get(Part::FleetDeciding)[at], f32::from(aircraft == decision.aircraft));
    }
    assert_eq!(get(Part::FleetPlace).iter().sum::<f32>(), view.places().len() as f32);
    assert_eq!(get(Part::FleetMask).iter().sum::<f32>(), view.places().len() as f32);
}

/// Compares the parts about a choice with what follows from it.
fn check_the_choice<'a>(
    get: impl Fn(Part) -> &'a [f32],
    view: View<'_>,
    decision: &Decision,
    to: VertiportIx,
) {
    let (kind, here) = (view.kind(decision.aircraft), decision.at);
    let full_kwh = view.aircraft_type(kind).battery_kwh;
    let is_reached = view.within_range(kind, here).contains(to);
    let (mut profit_usd, mut wait_s, mut flight_s, mut block_s, mut kwh) = (0.0, 0, 0, 0, 0.0);
    if is_reached || to == here {
        let outcome = view.outcome(decision, to);
        wait_s = outcome.takeoff.since(decision.time);
        flight_s = outcome.arrival.since(decision.time);
        block_s = outcome.ready.since(decision.time);
        let as_needed = view.charges_as_needed();
        kwh = if as_needed { outcome.charge_mwh as f64 / 1e6 } else { full_kwh };
        assert!(as_needed || wait_s == 0, "full aircraft wait for no charge");
        assert!((0.0..=full_kwh).contains(&kwh), "a battery holds {kwh} kWh of {full_kwh}");
    }
    if is_reached {
        let waiting = view.demand_left(view.period(), here, to);
        let departures = view.departures(decision.time, kind, here);
        profit_usd = departures.profit_from_usd(decision.time + wait_s, to, waiting);
        let leg = view.leg(kind, here, to);
        assert_eq!((flight_s, block_s), (wait_s + leg.flight_s, wait_s + leg.block_s()));
    }
    let hours = |seconds: u32| f64::from(seconds) / 3600.0;
    for (of, expected) in [
        (Part::ChoiceProfit, profit_usd / 100.0),
        (Part::ChoiceWait, hours(wait_s)),
        (Part::ChoiceFlightTime, hours(flight_s)),
        (Part::ChoiceBlockTime, hours(block_s)),
        (Part::ChoiceCharge, kwh / 100.0),
    ] {
        let found = f64::from(get(of)[to.at()]);
        let allowed = 1e-5 * expected.abs().max(1.0);
        assert!((found - expected).abs() <= allowed, "{of:?}: {found}, {expected}");
    }
}

/// Compares the observation of full policies with the other parts.
fn check_the_full<'a>(
    get: impl Fn(Part) -> &'a [f32],
    view: View<'_>,
    decision: &Decision,
    stride: usize,
) {
    let here = decision.at.at();
    for (to, node) in get(Part::FullNodes).chunks_exact(37).enumerate() {
        let [is_possible, is_own, is_in_range, _, _, profit_per_h] = node[..6] else {
            panic!("a node has 37 features");
        };
        if to >= view.vertiports() {
            assert!(node.iter().all(|&feature| feature == 0.0), "padding");
            continue;
        }
        let at = here * stride + to;
        assert_eq!(is_possible, get(Part::ActionMask)[to]);
        assert_eq!(is_own, f32::from(to == here));
        let distance = get(Part::DistanceEdges)[at];
        let expected = if get(Part::Reachable)[at] == 1.0 {
            assert!(is_in_range == 1.0, "what can be reached is in range");
            1.0 / (1.0 + get(Part::FlightTime)[at])
        } else {
            0.0
        };
        assert!((distance - expected).abs() < 1e-6, "{distance}, {expected}");
        let open = get(Part::Adjacency)[at] == 1.0 && to != here;
        let expected = if open { profit_per_h.clamp(0.0, 3.0) } else { 0.0 };
        let profit = get(Part::ProfitEdges)[at];
        // Edges show the flight of an aircraft that has the charge for it.
        let is_charged = get(Part::ChoiceWait)[to] == 0.0;
        assert!(!is_charged || (profit - expected).abs() < 1e-6, "{profit}, {expected}");
    }
}

pub(crate) fn days() -> Vec<Arc<Scenario>> {
    let seed = |number| DaySeed::training_number(number).expect("a number");
    let shipped = ["paper", "disrupted", "new-york", "paper-quick", "new-york-quick"]
        .map(|name| Arc::new(Network::shipped(name).expect("a shipped network").draw(seed(3))));
    let random =
        (0..3).map(|number| Arc::new(random_network(Purpose::Training, number).draw(seed(number))));
    shipped.into_iter().chain(random).collect()
}

#[test]
fn rows_equal_the_view_padded_or_not() {
    let network = Network::shipped("paper").expect("a shipped network");
    for day in days() {
        for extra in [0, 3] {
            let layout = layout(&day, extra);
            let mut observer = Observer::of(&network);
            let mut row = vec![f32::NAN; layout.width()];
            let mut decisions = 0;
            play(&day, |view, decision| {
                decisions += 1;
                if decisions % 7 == 0 {
                    layout.write(&mut row, &Scene::of(view, decision), &mut observer);
                    check_against_the_view(&layout, &row, view, decision);
                    for placed in layout.parts() {
                        let (low, high) = placed.part.info().bounds;
                        let numbers = &row[placed.first..placed.first + placed.len];
                        assert!(numbers.iter().all(|&x| (low..=high).contains(&x)), "{placed:?}");
                    }
                }
            });
            assert!(decisions > 50);
        }
    }
}

#[test]
fn policies_observe_the_values_of_the_parts() {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::training_number(1).expect("a number")));
    let parts = vec![Part::Nodes, Part::Aircraft, Part::Clock, Part::ActionMask];
    let layout = Layout::new(parts, Sizes::of(&network));
    let scales = Some(network.feature_scales());
    let mut writer = Writer::new(Observation::Paper, scales, None);
    let Shape { node_features, aircraft_features, .. } = Observation::Paper.shape(8);
    let (mut nodes, mut aircraft) = (vec![0.0; 8 * node_features], vec![0.0; aircraft_features]);
    let mut row = vec![0.0; layout.width()];
    play(&day, |view, decision| {
        layout.write(&mut row, &Scene::of(view, decision), &mut Observer::of(&network));
        let (mut mask, mut clock) = (vec![0; 8], 0.0);
        writer.write(
            view,
            decision,
            None,
            &mut Row {
                nodes: &mut nodes,
                aircraft: &mut aircraft,
                mask: &mut mask,
                edges: &mut [],
                clock: &mut clock,
            },
        );
        let mask = mask.into_iter().map(f32::from);
        let all: Vec<f32> =
            nodes.iter().chain(&aircraft).copied().chain([clock]).chain(mask).collect();
        assert_eq!(row, all);
    });
}

/// The features of charge come after the others, which stay as they are: weights that do not read
/// charge decide as before.
#[test]
fn features_of_charge_come_after_the_others() {
    let pairs = [
        (Part::PricedNodes, Part::PricedChargeNodes),
        (Part::PricedAircraft, Part::PricedChargeAircraft),
        (Part::FullNodes, Part::FullChargeNodes),
        (Part::FullAircraft, Part::FullChargeAircraft),
    ];
    let mut waits = 0;
    for day in days() {
        let layout = layout(&day, 0);
        let (mut row, mut observer) = (vec![0.0; layout.width()], Observer::default());
        play(&day, |view, decision| {
            if !decision.index.is_multiple_of(11) {
                return;
            }
            layout.write(&mut row, &Scene::of(view, decision), &mut observer);
            let get = |name| part(&layout, &row, name);
            for (without, with) in pairs {
                let columns = |part: Part| *part.shape(layout.sizes()).last().expect("an axis");
                let rows = get(without).chunks_exact(columns(without));
                for (without, with) in rows.zip(get(with).chunks_exact(columns(with))) {
                    assert_eq!(with[..without.len()], *without);
                    assert_eq!(with.len(), without.len() + 3);
                }
            }
            let kind = view.aircraft_type(view.kind(decision.aircraft));
            let full_kwh = kind.battery_kwh;
            for to in 0..view.vertiports() {
                let node = &get(Part::FullChargeNodes)[40 * to..][37..40];
                let after = 100.0 * f64::from(get(Part::ChoiceCharge)[to]) / full_kwh;
                assert!((f64::from(node[2]) - after).abs() < 1e-5, "{node:?}, {after}");
                assert_eq!(node[0], get(Part::ChoiceWait)[to].min(2.0));
                waits += u32::from(node[0] > 0.0);
                assert!((0.0..=1.0).contains(&node[1]), "{node:?}");
            }
            let aircraft = &get(Part::PricedChargeAircraft)[10..];
            let charge_kwh = 100.0 * f64::from(get(Part::FleetCharge)[decision.aircraft.at()]);
            let charge = charge_kwh / full_kwh;
            assert!((f64::from(aircraft[0]) - charge).abs() < 1e-5, "{aircraft:?}, {charge}");
            assert_eq!(aircraft[2] == 1.0, view.charges_as_needed());
            assert!(view.charges_as_needed() || aircraft == [1.0, 0.0, 0.0]);
        });
    }
    assert!(waits > 100, "{waits} choices wait for their charge");
}

#[test]
fn only_the_first_version_of_the_full_observation_depends_on_charge_beyond_that_of_the_paper() {
    let of_charge = |part: &&Part| part.is_of_charge();
    assert_eq!(Part::all().filter(|part| of_charge(&part)).count(), 3);
    for name in PRESETS {
        let parts = preset(name).expect("an observation of ours");
        let expected = if name == "full-v1" { 3 } else { 0 };
        assert_eq!(parts.iter().filter(of_charge).count(), expected, "{name}");
    }
}

/// A policy that was trained on the observation reads its arrays at the same places.
#[test]
fn the_full_observation_has_kept_its_parts() {
    let names = |name| {
        let parts = preset(name).expect("an observation of ours");
        parts.into_iter().map(|part| part.info().name).collect::<Vec<_>>()
    };
    let kept = "action_mask vertiport_mask fleet_mask time place aircraft_type types choice_profit \
                choice_passengers choice_flight_time choice_block_time demand_left demand_next fare \
                fare_next passenger_cost flight_cost distance flight_time block_time energy reachable \
                closed closed_ahead stands stands_taken parking parked period energy_price fleet_place \
                fleet_type fleet_ready fleet_flying fleet_deciding";
    assert_eq!(names("full").join(" "), kept);
    let of_v1 = names("full-v1");
    assert!(kept.split(' ').all(|part| of_v1.contains(&part)));
    assert!(of_v1.contains(&"forecast") && of_v1.contains(&"fares"));
}

#[test]
fn a_row_takes_no_memory_after_the_first_of_a_day() {
    for name in ["disrupted", "paper-quick"] {
        rows_take_no_memory_after_the_first(name);
    }
}

fn rows_take_no_memory_after_the_first(name: &str) {
    let network = Network::shipped(name).expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::training_number(1).expect("a number")));
    let parts = Part::all().filter(|part| !part.is_priced()).collect();
    let layout = Layout::new(parts, Sizes::of(&network));
    let mut row = vec![0.0; layout.width()];
    let mut observer = Observer::of(&network);
    let mut rows = 0;
    play(&day, |view, decision| {
        let write = || layout.write(&mut row, &Scene::of(view, decision), &mut observer);
        let taken = allocation_counter::measure(write).count_total;
        rows += 1;
        assert!(taken == 0 || rows == 1, "the first row of a day may take memory, row {rows} did");
    });
}

#[test]
fn a_day_that_is_over_has_no_time_left_and_only_hold() {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::training_number(1).expect("a number")));
    let mut last = None;
    let simulation = play(&day, |_, decision| last = Some(*decision));
    let last = last.expect("a day has decisions");
    let layout = layout(&day, 0);
    let mut row = vec![0.0; layout.width()];
    let scene = Scene::over(simulation.view(), &last);
    layout.write(&mut row, &scene, &mut Observer::of(&network));
    assert_eq!(part(&layout, &row, Part::ActionMask).iter().sum::<f32>(), 1.0);
    assert_eq!(part(&layout, &row, Part::Time)[..2], [0.0, 0.0]);
    assert_eq!(part(&layout, &row, Part::Clock), [0.0]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Changes the demand of later periods and expects the same rows: before a period begins,
    /// observations contain its forecast only.
    #[test]
    fn observations_do_not_depend_on_the_future(number in 0_u64..1_000, shift in 1_u32..50) {
        let network = Network::shipped("disrupted").expect("a shipped network");
        let own = network.draw(DaySeed::training_number(number).expect("a number"));
        let last = own.periods.len() - 1;
        let mut other = own.clone().into_day();
        for from in VertiportIx::all(own.vertiports.len()) {
            for to in VertiportIx::all(own.vertiports.len()) {
                other.demand[last][(from, to)] += if from == to { 0 } else { shift };
            }
        }
        let other = other.check("another day").expect("it is a day too");
        let begins = own.periods[last];
        let layout = layout(&own, 0);
        let (mut rows, mut observer) = (Vec::new(), Observer::of(&network));
        let mut row = vec![0.0; layout.width()];
        play(&Arc::new(own), |view, decision| {
            if decision.time < begins {
                layout.write(&mut row, &Scene::of(view, decision), &mut observer);
                rows.push(row.clone());
            }
        });
        let (mut at, mut observer) = (0, Observer::of(&network));
        play(&Arc::new(other), |view, decision| {
            if decision.time < begins {
                layout.write(&mut row, &Scene::of(view, decision), &mut observer);
                assert_eq!(row, rows[at], "decision {at}");
                at += 1;
            }
        });
        prop_assert_eq!(at, rows.len());
    }
}
