//! Checks the steps of the proof on real days at arbitrary prices: the payments and profits of
//! aircraft, and the amount given back. The days are of `paper`, of `disrupted`, and small ones
//! with everything that a day may hold.

use std::sync::Arc;

use proptest::prelude::{ProptestConfig, any, prop_assert, prop_assert_eq, proptest};
use vertifleet_core::{AircraftIx, DaySeed, Network, Scenario, Stop, TakeoffDelays, Time};
use vertifleet_policy::{BidPricePolicy, Greedy, Policy, Random, draw, play};
use vertifleet_sim::{Simulation, Trace};
use vertifleet_testkit::{Size, any_energy_day, any_extended_day};

use super::certificate::Certificate;
use super::money;
use super::penalty::Penalty;
use super::prices::Prices;
use super::time_expanded_day::{Layer, TimeExpandedDay};

/// A day of a shipped network, cut to `hours`, with less demand so that limits bind.
fn scarce_day(name: &str, seed: u64, hours: u32) -> Arc<Scenario> {
    let network = Network::shipped(name).expect("a shipped network");
    let mut day = network.draw(DaySeed::comparison(seed).expect("a seed")).into_day();
    day.operations.end = day.operations.start + hours * 3600 + 1_234;
    for (at, price) in day.energy_price_usd.iter_mut().enumerate() {
        *price = [0.2, 0.9, 0.05][at % 3];
    }
    if let Some(delays) = &mut day.disturbances.takeoff_delays {
        let (start, end) = (day.operations.start, day.operations.end);
        delays.delay_s.truncate(TakeoffDelays::slots(delays.slot_s, start, end));
    }
    let forecast = day.disturbances.forecast.iter_mut().flatten();
    for table in day.demand.iter_mut().chain(forecast) {
        table.cells_mut().iter_mut().for_each(|passengers| *passengers /= 8);
    }
    Arc::new(day.check("scarce").expect("a day within the rules"))
}

fn traces(day: &Arc<Scenario>) -> Vec<Trace> {
    let policies: [&mut dyn Policy; 3] =
        [&mut Random::new(3), &mut Greedy, &mut BidPricePolicy::default()];
    let played = policies.into_iter().map(|policy| {
        let mut trace = Trace::default();
        let mut simulation = Simulation::new(Arc::clone(day));
        play(&mut simulation, policy, |row| trace.rows.push(*row)).expect("these always answer");
        trace
    });
    played.collect()
}

/// Arbitrary prices within their limits.
fn any_prices(expanded: &TimeExpandedDay, seed: u64) -> Prices {
    let first = Prices::first(expanded);
    let below = |at: usize, most: i64| {
        let part = draw(seed, 0, u32::try_from(at).expect("few prices")) % 1_000;
        i64::try_from(part).expect("small") * most / 1_000
    };
    let stand = (0..first.stand.len()).map(|at| below(at, 20_000_000)).collect();
    let flight = first.flight.iter().enumerate().map(|(at, &most)| below(at, most)).collect();
    let charging = (0..first.charging.len()).map(|at| below(at, 20_000)).collect();
    Prices { stand, flight, charging }.checked(expanded).expect("within their limits")
}

/// Arbitrary payments for knowing delays.
fn any_penalty(expanded: &TimeExpandedDay, delays: &TakeoffDelays, seed: u64) -> Penalty {
    let payment = |at: usize| {
        let part = draw(seed, 1, u32::try_from(at).expect("few seconds")) % 2_000;
        (i64::try_from(part).expect("small") - 1_000) * 50_000
    };
    Penalty::from_payments(expanded, delays, payment)
}

/// The payment of an aircraft for knowing delays, when it decides first in a slot.
fn payments(expanded: &TimeExpandedDay, layer: usize, trace: &Trace, aircraft: AircraftIx) -> i64 {
    let Some(penalty) = &expanded.penalty else { return 0 };
    let (mut paid, mut past_slot) = (0, 0);
    for row in trace.rows.iter().filter(|row| row.aircraft == aircraft) {
        let second = (row.time.seconds() - expanded.slices.start_s(0)) as usize;
        if second >= past_slot {
            paid += penalty.at(expanded.layers[layer].kind, row.from.at())[second];
            past_slot = penalty.past_slot(second);
        }
    }
    paid
}

/// The vertiport where an aircraft stands or flies to at the end of each slice, by its decisions
/// until then.
fn places(
    day: &Scenario,
    expanded: &TimeExpandedDay,
    trace: &Trace,
    aircraft: AircraftIx,
) -> Vec<usize> {
    let at_end = |slice| {
        let end = Time::from_seconds(expanded.slices.last_s(slice));
        let mut decided =
            trace.rows.iter().filter(|row| row.aircraft == aircraft && row.time <= end);
        decided.next_back().map_or(day.aircraft[aircraft.at()].at, |row| row.to).at()
    };
    (0..expanded.slices.len()).map(at_end).collect()
}

/// The layer that an aircraft belongs to.
fn layer_of(expanded: &TimeExpandedDay, aircraft: AircraftIx) -> usize {
    let group = expanded.group_of[aircraft.at()];
    let mut groups = 0;
    let own = |layer: &Layer| {
        groups += layer.starts.len();
        group < groups
    };
    expanded.layers.iter().position(own).expect("every aircraft has a layer")
}

/// Plays a day by several rules, and checks each aircraft, and all of them together, against the
/// proof.
fn takes_each_step_of_the_proof(day: &Arc<Scenario>, step_s: u32, mix: u64) {
    let mut expanded = TimeExpandedDay::of(day, &[], step_s, 1).expect("a small day");
    let delays = day.disturbances.takeoff_delays.as_ref();
    expanded.penalty = delays.map(|delays| any_penalty(&expanded, delays, mix));
    let prices = any_prices(&expanded, mix);
    let mut certificate = Certificate::new(&expanded);
    let never = Stop::default();
    let bound = certificate.evaluate(&expanded, &prices, &never).expect("it is not stopped");
    for trace in traces(day) {
        let mut taken = vec![0; prices.stand.len()];
        let (mut profit, mut surplus) = (0, 0);
        for aircraft in AircraftIx::all(day.aircraft.len()) {
            let mut left = 0;
            for (slice, place) in places(day, &expanded, &trace, aircraft).into_iter().enumerate() {
                taken[slice * expanded.size() + place] += 1;
                left -= prices.stand[slice * expanded.size() + place];
            }
            let layer = layer_of(&expanded, aircraft);
            for row in
                trace.rows.iter().filter(|row| row.aircraft == aircraft && row.to != row.from)
            {
                let slice = expanded.slices.containing(row.time.seconds());
                let flights = expanded.flights(slice, layer, row.from.at());
                let flight =
                    flights.iter().find(|flight| flight.to == row.to).expect("it is flown");
                let sold_for = prices.flight[flight.sold_at as usize];
                let period = expanded.slices.period(slice);
                let size = expanded.size();
                let cell = (period * size + row.from.at()) * size + row.to.at();
                // The amount is rounded down, because the proof must not depend on the rounding of
                // a real day's amounts.
                let earned = money::down(row.profit_usd());
                let brought = i64::from(row.passengers) * expanded.market.margin(cell);
                profit += i128::from(earned);
                left += sold_for - (brought - earned);
                surplus += i128::from(brought - sold_for);
            }
            // An aircraft earns no more than the longest path.
            let start = day.aircraft[aircraft.at()].at.at();
            left -= payments(&expanded, layer, &trace, aircraft);
            let worth = certificate.worth_less_paid(&expanded, layer, start, 0);
            assert!(
                left <= worth,
                "aircraft {aircraft:?} has {left} left, its best itinerary {worth}"
            );
        }
        // What is paid for stands, and what passengers bring beyond what they pay, is no more than
        // the amount given back.
        for (at, &count) in taken.iter().enumerate() {
            assert!(count <= expanded.stands[at]);
        }
        let most = expanded.market.surplus(&prices.flight);
        assert!(surplus <= most, "passengers have {surplus} left, at most {most}");
        let penalties = AircraftIx::all(day.aircraft.len()).map(|aircraft| {
            i128::from(payments(&expanded, layer_of(&expanded, aircraft), &trace, aircraft))
        });
        let left = profit - penalties.sum::<i128>();
        assert!(left <= bound, "{left} is earned after the penalty, the bound is {bound}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_real_day_takes_each_step_of_the_proof(
        seed in 0_u64..1_000, minutes in 1_u32..60, hours in 1_u32..5, mix in any::<u64>()
    ) {
        takes_each_step_of_the_proof(&scarce_day("paper", seed, hours), 60 * minutes, mix);
    }

    #[test]
    fn a_disturbed_day_takes_each_step_of_the_proof(
        seed in 0_u64..1_000, minutes in 1_u32..60, hours in 1_u32..12, mix in any::<u64>()
    ) {
        takes_each_step_of_the_proof(&scarce_day("disrupted", seed, hours), 60 * minutes, mix);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_day_of_any_kind_takes_each_step_of_the_proof(
        number in any::<u32>(), minutes in 1_u32..60, mix in any::<u64>()
    ) {
        let day = any_extended_day(number.into(), Size { vertiports: 6, fleet: 12, hours: 6 });
        takes_each_step_of_the_proof(&day, 60 * minutes, mix);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_day_that_charges_as_needed_earns_no_more_than_any_prices_prove(
        number in any::<u32>(), minutes in 1_u32..60, levels in 1_u16..9, mix in any::<u64>()
    ) {
        let day = any_energy_day(number.into(), Size { vertiports: 5, fleet: 6, hours: 6 });
        let expanded = TimeExpandedDay::of(&day, &[], 60 * minutes, levels).expect("a small day");
        let prices = any_prices(&expanded, mix);
        let never = Stop::default();
        let bound = Certificate::new(&expanded).evaluate(&expanded, &prices, &never);
        let bound = bound.expect("it is not stopped");
        for trace in traces(&day) {
            let rows = trace.rows.iter().filter(|row| row.to != row.from);
            let profit: i128 = rows.map(|row| i128::from(money::down(row.profit_usd()))).sum();
            prop_assert!(profit <= bound, "{profit} is earned, the bound is {bound}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    // Without a penalty, passes leave out choices that cannot be the best. A penalty of nothing
    // changes no worth, but makes them compare all.
    #[test]
    fn choices_that_are_left_out_change_no_worth(
        number in any::<u32>(), minutes in 1_u32..60, levels in 1_u16..9, mix in any::<u64>()
    ) {
        let day = any_energy_day(number.into(), Size { vertiports: 5, fleet: 6, hours: 6 });
        let fast = TimeExpandedDay::of(&day, &[], 60 * minutes, levels).expect("a small day");
        let kinds = fast.layers.iter().map(|layer| layer.kind).collect();
        let day_s = fast.slices.day_s();
        let mut slow = fast.clone();
        slow.penalty = Some(Penalty::of_nothing(kinds, fast.size(), day_s));
        let prices = any_prices(&fast, mix);
        let [one, other] = [&fast, &slow].map(|day| {
            let mut certificate = Certificate::new(day);
            let proven = certificate.evaluate(day, &prices, &Stop::default());
            (proven.expect("it is not stopped"), certificate)
        });
        prop_assert_eq!(one.0, other.0);
        for layer in 0..fast.layers.len() {
            for &place in fast.reached(layer) {
                for second in 0..day_s as usize {
                    let worth = one.1.worth_less_paid(&fast, layer, place, second);
                    prop_assert_eq!(worth, other.1.worth_less_paid(&slow, layer, place, second));
                }
            }
        }
    }
}

/// The bound that arbitrary prices prove for a day, micro-dollars.
fn proven(day: &Scenario, step_s: u32, mix: u64) -> (i128, Prices) {
    let expanded = TimeExpandedDay::of(day, &[], step_s, 1).expect("a small day");
    let prices = any_prices(&expanded, mix);
    let never = Stop::default();
    let micro_usd = Certificate::new(&expanded).evaluate(&expanded, &prices, &never);
    (micro_usd.expect("it is not stopped"), prices)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn one_more_stand_raises_what_prices_prove_by_its_price(
        number in any::<u32>(), minutes in 1_u32..60, mix in any::<u64>()
    ) {
        let day = any_extended_day(number.into(), Size { vertiports: 6, fleet: 12, hours: 6 });
        let (before, prices) = proven(&day, 60 * minutes, mix);
        let size = day.vertiports.len();
        let at = (number % u32::try_from(size).expect("few")) as usize;
        let mut more = Scenario::clone(&day).into_day();
        more.vertiports[at].stands += 1;
        let more = more.check("one more").expect("a day within the rules");
        let (after, _) = proven(&more, 60 * minutes, mix);
        let worth: i64 = prices.stand.iter().skip(at).step_by(size).sum();
        assert_eq!(after, before + i128::from(worth));
    }

    #[test]
    fn shorter_slices_prove_no_less_with_the_same_prices_at_their_ends(
        number in any::<u32>(), mix in any::<u64>()
    ) {
        let day = any_extended_day(number.into(), Size { vertiports: 6, fleet: 12, hours: 6 });
        let (longer_proves, prices) = proven(&day, 900, mix);
        let (longer, shorter) = (TimeExpandedDay::of(&day, &[], 900, 1), TimeExpandedDay::of(&day, &[], 180, 1));
        let (longer, shorter) = (longer.expect("a small day"), shorter.expect("a small day"));
        let mut same = Prices::first(&shorter);
        same.flight.clone_from(&prices.flight);
        for slice in 0..longer.slices.len() {
            let last = shorter.slices.containing(longer.slices.last_s(slice));
            let size = longer.size();
            same.stand[last * size..][..size].copy_from_slice(&prices.stand[slice * size..][..size]);
        }
        let never = Stop::default();
        let shorter_proves = Certificate::new(&shorter).evaluate(&shorter, &same, &never);
        assert!(shorter_proves.expect("it is not stopped") <= longer_proves);
    }
}
