//! Days with reserves, turnarounds, charge curves, weak chargers, start charges, and aircraft that
//! leave before they are full (page Model, section Energy).
//!
//! Extreme days have batteries, powers and curves at the limits of what files may contain: a
//! curve with neighbouring numbers for charges, from the least to the greatest power and back.

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

/// Days of [`energy_day`] whose batteries, powers and curves are extreme but admitted.
pub fn extreme_energy_day() -> impl Strategy<Value = Arc<Scenario>> {
    (energy_day(), any::<u64>()).prop_map(|(day, seed)| with_extreme_energy(&day, seed))
}

/// A day of [`any_energy_day`] whose batteries, powers and curves are extreme but admitted.
pub fn any_extreme_energy_day(number: u64, most: Size) -> Arc<Scenario> {
    with_extreme_energy(&any_energy_day(number, most), number)
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

/// A day with batteries, powers and curves at the limits of what files may contain, drawn from a
/// seed. Flights take the same share of a battery as before.
fn with_extreme_energy(day: &Scenario, seed: u64) -> Arc<Scenario> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed ^ 0x0065_7874_7265_6d65);
    let mut day = day.clone().into_day();
    for at in 0..day.aircraft_types.len() {
        let kind = &mut day.aircraft_types[at];
        let battery_kwh = match random.random_range(0..4) {
            0 => 5_000.0,
            1 => 10_f64.powf(random.random_range(-8.0..3.7)),
            2 => 1e-6 * f64::from(random.random_range(1..4)),
            _ => kind.battery_kwh,
        };
        let factor = battery_kwh / kind.battery_kwh;
        kind.battery_kwh = battery_kwh;
        kind.reserve_kwh *= factor;
        kind.energy_kwh_per_mi = (kind.energy_kwh_per_mi * factor).clamp(f64::MIN_POSITIVE, 1e3);
        kind.charge_kw = extreme_kw(&mut random);
        kind.charge_curve = (random.random_range(0..8) > 0).then(|| extreme_curve(&mut random));
        for aircraft in day.aircraft.iter_mut().filter(|aircraft| aircraft.kind.at() == at) {
            let curve = day.aircraft_types[at].charge_curve.as_ref();
            let points = curve.map_or(&[][..], ChargeCurve::points);
            let share = match random.random_range(0..=points.len()) {
                0 => random.random_range(0.0..1.0),
                point => points[point - 1].charge,
            };
            aircraft.start_charge_kwh = random.random::<bool>().then_some(share * battery_kwh);
        }
    }
    for vertiport in &mut day.vertiports {
        vertiport.charger_kw = random.random::<bool>().then(|| extreme_kw(&mut random));
    }
    Arc::new(day.check("extreme day").expect("a day within the rules"))
}

/// A power at the limits, next to them, or of any size between them.
fn extreme_kw(random: &mut Xoshiro256PlusPlus) -> f64 {
    match random.random_range(0..6) {
        0 => 1.0,
        1 => 1.0_f64.next_up(),
        2 => 1e5,
        3 => 1e5_f64.next_down(),
        _ => 10_f64.powf(random.random_range(0.0..5.0)),
    }
}

/// A curve of 2 to 32 points, many of which are neighbouring numbers.
fn extreme_curve(random: &mut Xoshiro256PlusPlus) -> ChargeCurve {
    let mut charges = vec![0.0, 1.0];
    let most = random.random_range(2..=32);
    while charges.len() < most {
        let near = match random.random_range(0..4) {
            0 => random.random_range(0.0..1.0),
            1 => 10_f64.powf(random.random_range(-320.0..0.0)),
            _ => charges[random.random_range(0..charges.len())],
        };
        let charge = match random.random_range(0..3) {
            0 => near.next_up(),
            1 => near.next_down(),
            _ => near,
        };
        charges.push(charge.clamp(0.0, 1.0));
    }
    charges.sort_by(f64::total_cmp);
    charges.dedup();
    let mut kw = extreme_kw(random);
    let points = charges.into_iter().map(|charge| {
        kw = match random.random_range(0..4) {
            0 => kw,
            1 => kw.next_down().max(1.0),
            _ => extreme_kw(random),
        };
        CurvePoint { charge, kw }
    });
    ChargeCurve::through(points.collect())
}
