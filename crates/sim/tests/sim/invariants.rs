//! Properties that hold on every day under any decisions.

use std::sync::Arc;

use proptest::prelude::{any, prop, prop_assert, prop_assert_eq, proptest};
use vertifleet_core::{AircraftIx, Charging, Matrix, Scenario, Vertiport, VertiportIx, Warning};
use vertifleet_sim::{Decision, Refusal, Simulation, TraceRow, first_decision};

use vertifleet_testkit::{energy_day, paper_day};

/// Plays a day, with each draw choosing among the feasible vertiports; the draws are used
/// cyclically. `each` is called after every step.
fn play(
    day: &Arc<Scenario>,
    draws: &[u32],
    mut each: impl FnMut(&mut Simulation, &TraceRow),
) -> (Simulation, Vec<TraceRow>) {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut rows = Vec::new();
    while let Some(decision) = simulation.next_decision() {
        let mask = simulation.view().feasible(&decision);
        let rank = draws[rows.len() % draws.len()] % mask.len();
        let choice = mask.nth(rank).expect("a rank below the number of members");
        let row = simulation.apply(choice).expect("a choice from the mask");
        each(&mut simulation, &row);
        rows.push(row);
    }
    (simulation, rows)
}

fn draws() -> impl proptest::strategy::Strategy<Value = Vec<u32>> {
    prop::collection::vec(any::<u32>(), 1..40)
}

proptest! {
    #[test]
    fn stands_are_never_overbooked_and_no_aircraft_is_lost(day in energy_day(), draws in draws()) {
        play(&day, &draws, |simulation, _| {
            let view = simulation.view();
            let mut counted = vec![0; view.vertiports()];
            for place in view.places() {
                counted[place.at()] += 1;
            }
            for vertiport in VertiportIx::all(view.vertiports()) {
                let (taken, (parked, parking)) = (view.stands_taken()[vertiport.at()], view.parked(vertiport));
                assert_eq!(taken + parked, counted[vertiport.at()], "each aircraft at or towards it has a place");
                assert!(taken <= view.stands(vertiport) && parked <= parking);
            }
            assert_eq!(view.places().len(), day.aircraft.len());
        });
    }

    #[test]
    fn decisions_come_in_order_and_within_operations(day in energy_day(), draws in draws()) {
        let (_, rows) = play(&day, &draws, |_, _| ());
        prop_assert!(rows.iter().all(|row| (day.operations.start..=day.operations.end).contains(&row.time)));
        prop_assert!(rows.is_sorted_by_key(|row| (row.time, row.aircraft)));
        for aircraft in AircraftIx::all(day.aircraft.len()) {
            let own: Vec<&TraceRow> = rows.iter().filter(|row| row.aircraft == aircraft).collect();
            let due = first_decision(&day, aircraft);
            let Some(first) = own.first() else {
                prop_assert!(due > day.operations.end, "it is full too late");
                continue;
            };
            prop_assert_eq!(first.time, due);
            prop_assert_eq!(own[0].from, day.aircraft[aircraft.at()].at);
            for pair in own.windows(2) {
                prop_assert_eq!((pair[1].time, pair[1].from), (pair[0].ready, pair[0].to));
            }
            prop_assert!(own[own.len() - 1].ready > day.operations.end, "no aircraft stops early");
        }
    }

    #[test]
    fn aircraft_that_can_never_leave_are_warned_about(day in energy_day(), draws in draws()) {
        let (_, rows) = play(&day, &draws, |_, _| ());
        let warnings = day.warnings();
        let (simulation, end) = (Simulation::new(Arc::clone(&day)), day.operations.end);
        let view = simulation.view();
        for aircraft in AircraftIx::all(day.aircraft.len()) {
            let own = &day.aircraft[aircraft.at()];
            let decision = Decision { time: view.day_start(), aircraft, at: own.at, index: 0 };
            let reached = view.within_range(own.kind, own.at);
            let is_late = match day.operations.charging {
                Charging::ToFull => first_decision(&day, aircraft) > end,
                Charging::AsNeeded => {
                    reached.iter().all(|to| view.outcome(&decision, to).takeoff > end)
                }
            };
            let is_warned_about = warnings.iter().any(|warning| {
                matches!(warning, Warning::ChargedTooLate { aircraft, .. } if *aircraft == own.id)
            });
            prop_assert_eq!(is_warned_about, is_late && !reached.is_empty(), "{:?}", own);
            let mut flights = rows.iter().filter(|row| row.aircraft == aircraft && row.to != row.from);
            prop_assert!(!is_late || flights.next().is_none());
        }
    }

    #[test]
    fn batteries_and_cabins_hold_what_they_are_asked_to(day in energy_day(), draws in draws()) {
        let (_, rows) = play(&day, &draws, |_, _| ());
        let pairs = day.vertiports.len().pow(2);
        let mut carried = vec![vec![0_u32; pairs]; day.periods.len()];
        let mut carried_late = carried.clone();
        let wait_s = day.operations.passenger_wait_s;
        for row in &rows {
            let kind = &day.aircraft_types[day.aircraft[row.aircraft.at()].kind.at()];
            prop_assert!(row.energy_kwh >= 0.0 && kind.lasts_for(row.energy_kwh));
            prop_assert!((0.0..=kind.battery_kwh).contains(&row.charge_kwh));
            prop_assert!((row.time..=day.operations.end).contains(&row.takeoff));
            prop_assert!(row.passengers <= kind.seats);
            let pair = row.from.at() * day.vertiports.len() + row.to.at();
            let period = day.period_at(row.time);
            carried[period][pair] += u32::from(row.passengers);
            if row.time >= day.periods[period] + wait_s {
                carried_late[period][pair] += u32::from(row.passengers);
            }
        }
        for pair in 0..pairs {
            let (mut all_carried, mut all_demand, mut before) = (0, 0, 0);
            for (period, table) in day.demand.iter().enumerate() {
                let (carried, demand) = (carried[period][pair], table.cells()[pair]);
                let waits = if wait_s > 0 { before } else { 0 };
                (all_carried, all_demand, before) = (all_carried + carried, all_demand + demand, demand);
                prop_assert!(carried <= demand + waits && carried_late[period][pair] <= demand);
                prop_assert!(all_carried <= all_demand, "no passenger is carried twice");
            }
        }
    }

    #[test]
    fn the_ledger_adds_up(day in energy_day(), draws in draws()) {
        let (simulation, rows) = play(&day, &draws, |_, _| ());
        let summary = simulation.totals();
        let sum = |part: fn(&TraceRow) -> f64| rows.iter().map(part).sum::<f64>();
        prop_assert_eq!(summary.revenue_usd, sum(|row| row.revenue_usd));
        prop_assert_eq!(summary.passenger_cost_usd, sum(|row| row.passenger_cost_usd));
        prop_assert_eq!(summary.energy_cost_usd, sum(|row| row.energy_cost_usd));
        prop_assert_eq!(summary.energy_kwh, sum(|row| row.energy_kwh));
        prop_assert_eq!(summary.flight_cost_usd, sum(|row| row.flight_cost_usd));
        let flown = rows.iter().filter(|row| row.from != row.to);
        let due: f64 = flown.map(|row| day.flight_cost_usd[(row.from, row.to)]).sum();
        prop_assert_eq!(summary.flight_cost_usd, due);
        let fleet_cost = day.aircraft_cost_usd * day.aircraft.len() as f64;
        prop_assert_eq!(summary.aircraft_cost_usd, fleet_cost);
        let site = |one: &Vertiport| {
            let chargers = f64::from(one.chargers.unwrap_or(0));
            f64::from(one.stands) * one.stand_cost_usd + chargers * one.charger_cost_usd
        };
        let site_cost: f64 = day.vertiports.iter().map(site).sum();
        prop_assert_eq!(summary.site_cost_usd, site_cost);
        let earned = summary.revenue_usd - summary.passenger_cost_usd - summary.energy_cost_usd;
        let left = earned - summary.flight_cost_usd - fleet_cost - site_cost;
        prop_assert_eq!(summary.profit_usd, left);
        let flights = rows.iter().filter(|row| row.from != row.to).count();
        prop_assert_eq!(summary.flights as usize, flights);
        prop_assert_eq!(summary.decisions as usize, rows.len());
        prop_assert_eq!(summary.holds as usize, rows.len() - flights);
        let demanded: u64 = day.demand.iter().flat_map(Matrix::cells).map(|&q| u64::from(q)).sum();
        let carried: u64 = rows.iter().map(|row| u64::from(row.passengers)).sum();
        prop_assert_eq!((summary.passengers, summary.spilled_passengers), (carried, demanded - carried));
        prop_assert!((0.0..=1.0).contains(&summary.load_factor));
    }

    #[test]
    fn rewards_paid_by_the_flight_sum_to_the_reward_of_the_day(day in energy_day(), draws in draws()) {
        let (simulation, rows) = play(&day, &draws, |_, _| ());
        if simulation.potential_usd() > 0.0 {
            let flights: f64 = rows.iter().map(TraceRow::profit_usd).sum();
            let dense = (flights - day.fixed_cost_usd()) / simulation.potential_usd();
            prop_assert!((dense - simulation.totals().reward).abs() < 1e-9);
        }
    }

    #[test]
    fn the_same_decisions_leave_the_same_trace(day in energy_day(), draws in draws()) {
        let (_, once) = play(&day, &draws, |_, _| ());
        let again = std::thread::scope(|scope| {
            let others: Vec<_> =
                (0..2).map(|_| scope.spawn(|| play(&day, &draws, |_, _| ()).1)).collect();
            others.into_iter().map(|other| other.join().expect("a day plays")).collect::<Vec<_>>()
        });
        prop_assert!(again.iter().all(|rows| *rows == once));
    }

    #[test]
    fn a_refused_decision_changes_nothing(day in energy_day(), draws in draws(), odd in any::<u16>()) {
        play(&day, &draws, |simulation, _| {
            let Some(decision) = simulation.next_decision() else { return };
            let mask = simulation.view().feasible(&decision);
            assert!(mask.contains(decision.at), "hold is always feasible");
            for choice in VertiportIx::all(day.vertiports.len() + 1).chain([VertiportIx(odd)]) {
                if mask.contains(choice) {
                    continue;
                }
                let before = format!("{simulation:?}");
                let refusal = simulation.apply(choice).expect_err("the choice is outside the mask");
                assert_eq!(format!("{simulation:?}"), before);
                let exists = choice.at() < day.vertiports.len();
                assert_eq!(matches!(refusal, Refusal::NoSuchVertiport { .. }), !exists);
                let id = day.vertiports.get(choice.at()).map(|to| format!("{:?}", to.id));
                let message = refusal.to_string();
                assert!(id.is_none_or(|id| message.contains(&id)), "{message}");
            }
        });
    }

    #[test]
    fn after_the_day_every_decision_is_refused(day in energy_day(), draws in draws()) {
        let (mut simulation, _) = play(&day, &draws, |_, _| ());
        prop_assert_eq!(simulation.apply(VertiportIx(0)), Err(Refusal::DayOver));
    }
}

/// Flights of `paper` take 2.2 kWh a mile.
#[test]
fn a_refusal_out_of_range_has_the_energy_the_reserve_and_the_battery() {
    let refused = |reserve_kwh| {
        let mut day = paper_day(1).as_ref().clone().into_day();
        (day.aircraft_types[0].battery_kwh, day.aircraft_types[0].reserve_kwh) =
            (45.0, reserve_kwh);
        (day.aircraft[0].at, day.vertiports[1].stands) = (VertiportIx(0), 48);
        day.distance_mi[(VertiportIx(0), VertiportIx(1))] = 20.0;
        day.vertiports[0].stands = 48;
        let mut simulation = Simulation::new(Arc::new(day.check("a day").expect("a valid day")));
        simulation.apply(VertiportIx(1)).map_err(|refusal| refusal.to_string())
    };
    let text = |needs: &str| format!(r#"aircraft "A01" cannot fly to vertiport "V2": {needs}"#);
    assert!(refused(1.0).is_ok(), "44 kWh and the reserve fit");
    assert_eq!(
        refused(10.0),
        Err(text(
            "the flight needs 44.0 kWh and a reserve of 10.0 kWh, and a full battery has 45.0 kWh"
        ))
    );
}
