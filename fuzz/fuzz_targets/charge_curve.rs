//! Plays days with any charge curve that a file may contain. Playing must end, and the checker,
//! which shares no code with the simulator, must find that the schedule keeps every rule.

#![no_main]

use std::sync::Arc;

use libfuzzer_sys::fuzz_target;
use vertifleet_core::{ChargeCurve, ChargeRate, Charging, CurvePoint, Scenario};
use vertifleet_policy::{Greedy, play};
use vertifleet_sim::check::check;
use vertifleet_sim::{Simulation, Trace};

const DAY: &str = include_str!("../../crates/core/tests/data/small.json");

/// Two powers and a capacity, and then the points of a curve: a charge and a power each.
fuzz_target!(|numbers: Vec<f64>| {
    let [charge_kw, charger_kw, battery_kwh, ref points @ ..] = numbers[..] else { return };
    let mut day = Scenario::from_json(DAY.as_bytes(), "small.json").expect("a day").into_day();
    day.operations.charging = Charging::AsNeeded;
    day.vertiports[0].charger_kw = Some(charger_kw);
    let points = points.chunks_exact(2).map(|pair| CurvePoint { charge: pair[0], kw: pair[1] });
    let mut inner: Vec<CurvePoint> = points.collect();
    if let [first, .., last] = &mut inner[..] {
        (first.charge, last.charge) = (0.0, 1.0);
    }
    let kind = &mut day.aircraft_types[0];
    kind.energy_kwh_per_mi *= battery_kwh / kind.battery_kwh;
    (kind.charge_kw, kind.battery_kwh) = (charge_kw, battery_kwh);
    kind.charge_curve = Some(ChargeCurve::through(inner));
    let Ok(day) = day.check("any day").map(Arc::new) else { return };
    for kind in &day.aircraft_types {
        for vertiport in &day.vertiports {
            assert!(ChargeRate::of(kind, vertiport).full_s() <= 2e7);
        }
    }
    let (mut simulation, mut trace) = (Simulation::new(Arc::clone(&day)), Trace::default());
    play(&mut simulation, &mut Greedy, |row| trace.rows.push(*row)).expect("greedy answers");
    let report = check(&day, &trace);
    assert!(report.is_valid(), "{report}");
});
