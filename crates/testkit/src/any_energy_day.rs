//! Days with reserves, turnarounds, charge curves, weak chargers, start charges, and aircraft that
//! leave before they are full (page Model, section Energy).

use std::sync::Arc;

use proptest::prelude::{Strategy, any};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use vertifleet_core::{ChargeCurve, Charging, CurvePoint, Day, Scenario};

use crate::{Size, any_day, any_extended_day, extended_day};

/// Days of [`extended_day`] with the members of energy, each of them on some days only.
pub fn energy_day() -> impl Strategy<Value = Arc<Scenario>> {
    (extended_day(), any::<u64>()).prop_map(|(day, seed)| with_energy(&day, seed))
}

/// A day of [`any_day`], or for every other number of [`any_extended_day`], with the members of
/// energy.
pub fn any_energy_day(number: u64, most: Size) -> Arc<Scenario> {
    let day = if number.is_multiple_of(2) {
        any_day(number, most)
    } else {
        any_extended_day(number, most)
    };
    with_energy(&day, number)
}

/// A day with members of energy that are drawn from a seed. Three of four days charge as needed.
pub fn with_energy(day: &Scenario, seed: u64) -> Arc<Scenario> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed ^ 0x656e_6572_6779);
    let mut day = day.clone().into_day();
    draw_energy(&mut day, &mut random);
    Arc::new(day.check("energy day").expect("a day within the rules"))
}

fn draw_energy(day: &mut Day, random: &mut Xoshiro256PlusPlus) {
    if random.random_range(0..4) > 0 {
        day.operations.charging = Charging::AsNeeded;
    }
    for kind in &mut day.aircraft_types {
        if random.random() {
            let kwh: f64 = random.random_range(0.0..0.4 * kind.battery_kwh);
            kind.reserve_kwh = kwh.round();
        }
        if random.random() {
            kind.turnaround_s = random.random_range(0..900);
        }
        if random.random() {
            kind.charge_curve = Some(draw_curve(random));
        }
    }
    for vertiport in &mut day.vertiports {
        vertiport.charger_kw = random.random::<bool>().then(|| random.random_range(20.0..200.0));
    }
    for aircraft in &mut day.aircraft {
        let battery_kwh = day.aircraft_types[aircraft.kind.at()].battery_kwh;
        let share: f64 = random.random_range(0.0..1.0);
        aircraft.start_charge_kwh = random.random::<bool>().then_some(share * battery_kwh);
    }
}

/// A curve of two to four points, which rises or falls anywhere.
fn draw_curve(random: &mut Xoshiro256PlusPlus) -> ChargeCurve {
    let mut charges = vec![0.0, 1.0];
    charges.extend((0..random.random_range(0..3)).map(|_| random.random_range(0.05..0.95)));
    charges.sort_by(f64::total_cmp);
    charges.dedup();
    let point = |charge| CurvePoint { charge, kw: random.random_range(10.0..250.0) };
    ChargeCurve::through(charges.into_iter().map(point).collect())
}
