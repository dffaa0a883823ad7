//! A view as text, with everything that it shows.

use vertifleet_core::{AircraftIx, Time, TypeIx, VertiportIx};
use vertifleet_sim::{Decision, Departures, Imagined, View};

/// Everything that a view shows at a decision, as text.
pub(crate) fn shown(view: View<'_>, decision: &Decision) -> Vec<String> {
    let mut shown = vec![format!(
        "{decision:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        view.feasible(decision),
        view.places(),
        view.stands_taken(),
        view.period(),
        view.period_starts(),
        view.energy_price_usd(),
        view.energy_prices_usd(),
        view.aircraft_types(),
        (view.day_start(), view.day_end(), view.hold_s(), view.passenger_wait_s(), view.day_seed()),
        view.vertiports(),
        view.period_at(decision.time + 1800),
        (view.day() == view.day(), view.route_changes(), view.fixed_cost_usd()),
    )];
    shown.push(format!("{:?}", view.known_closures()));
    let refusal = |to| view.refusal(decision, to);
    shown.push(format!(
        "{:?}",
        VertiportIx::all(view.vertiports()).map(refusal).collect::<Vec<_>>()
    ));
    for aircraft in AircraftIx::all(view.places().len()) {
        let kind = view.kind(aircraft);
        let times = (view.ready_at(aircraft), view.arrives_at(aircraft));
        let charge_kwh = view.charge_kwh(aircraft);
        if view.charges_as_needed() {
            assert_eq!(view.charge_mwh(aircraft) as f64 / 1e6, charge_kwh);
        }
        let times = (times, view.is_parked(aircraft));
        let of_it = (view.aircraft_id(aircraft), times, view.aircraft_type(kind), charge_kwh);
        shown.push(format!("{of_it:?}"));
    }
    if view.charges_as_needed() {
        let Decision { aircraft, time, .. } = *decision;
        let (mwh, full_s) = (view.charge_mwh_at(decision), view.to_full_s(aircraft, time));
        shown.push(format!("{mwh} {full_s}"));
    }
    for to in VertiportIx::all(view.vertiports()) {
        shown.push(format!("{:?}", view.outcome(decision, to)));
    }
    for from in VertiportIx::all(view.vertiports()) {
        shown.push(format!("{:?} {:?}", view.stands(from), (view.parked(from), view.closed(from))));
        let delay_s = view.known_delay_s(decision.time, from);
        shown.push(format!("{:?} {delay_s}", view.closed_unexpectedly(from)));
        let waiting = VertiportIx::all(view.vertiports()).map(|to| view.demand_waiting(from, to));
        shown.push(format!("{:?}", waiting.collect::<Vec<_>>()));
        shown.push(format!("{:?}", view.passenger_costs_usd(from)));
        shown.push(format!("{:?} {:?}", view.flight_costs_usd(from), view.distances_mi(from)));
        for kind in TypeIx::all(view.aircraft_types().len()) {
            shown.push(format!(
                "{:?} {:?}",
                view.legs_from(kind, from),
                view.within_range(kind, from)
            ));
            shown.push(format!("{}", view.charging_power_kw(kind, from)));
            if view.charges_as_needed() {
                shown.push(format!("{:?}", view.charge_rate(kind, from)));
            }
            let departures = view.departures(decision.time + 3600, kind, from);
            for to in VertiportIx::all(view.vertiports()) {
                let profit = view.flight_profit_usd(decision.time + 3600, kind, (from, to), 3);
                let leg = view.leg(kind, from, to);
                // A lookup for all destinations at once gives the same as one for each.
                assert_eq!(departures.profit_usd(to, 3).to_bits(), profit.to_bits());
                assert_eq!(departures.block_s(to), leg.block_s());
                shown.push(format!("{leg:?} {profit}"));
            }
            assert_profits_are_steady(view, departures, kind, from);
        }
        for period in 0..view.period_starts().len() {
            shown.push(format!("{:?}", view.fares_usd(period, from)));
            for to in VertiportIx::all(view.vertiports()) {
                shown.push(format!("{}", view.demand_left(period, from, to)));
            }
        }
    }
    for period in 0..view.period_starts().len() {
        shown.push(format!("{:?}", view.demand_left_in(period)));
    }
    shown.push(played_out(view));
    // A snapshot that is read later is unchanged.
    assert_eq!(played_out(view.snapshot().view()), shown[shown.len() - 1]);
    shown
}

/// While departures report steady profits, profits are steady.
fn assert_profits_are_steady(
    view: View<'_>,
    departures: Departures<'_>,
    kind: TypeIx,
    from: VertiportIx,
) {
    let destinations = view.within_range(kind, from);
    let steady = departures.steady(destinations);
    let last = Time::from_seconds(steady.end.seconds().min(48 * 3600) - 1);
    for other in [steady.start, last].map(|time| view.departures(time, kind, from)) {
        for to in destinations.iter() {
            assert_eq!(departures.profit_usd(to, 3).to_bits(), other.profit_usd(to, 3).to_bits());
        }
    }
}

/// The rest of the day as it can be imagined, with the choices made by a fixed rule.
fn played_out(view: View<'_>) -> String {
    let mut fresh = view.imagined();
    let rest = played_on(&mut fresh);
    // It is the same when it is imagined in the memory of an earlier imagined day.
    assert_eq!(played_on(view.imagined_in(&mut Some(fresh))), rest);
    rest
}

fn played_on(imagined: &mut Imagined) -> String {
    let mut rows = Vec::new();
    while let Some(decision) = imagined.next_decision() {
        let mask = imagined.view().feasible(&decision);
        let choice = mask.nth(decision.index % mask.len()).expect("a rank within the mask");
        rows.push(imagined.apply(choice).expect("a choice from the mask"));
    }
    format!("{rows:?} {:?}", imagined.ledger())
}
