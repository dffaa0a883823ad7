//! Writes each part from the view of the day.

use vertifleet_core::{AircraftIx, Time, TypeIx, VertiportIx};
use vertifleet_sim::{Leg, Outcome};

use crate::charge;
use crate::column::hours;
use crate::full::{self, Edges};
use crate::pairs::Pairs;
use crate::paper::Scales;
use crate::{Part, Scene, Sizes, priced};

/// Seconds from now to each of the times of [`Part::ClosedAhead`].
const AHEAD_S: [u32; 4] = [900, 1_800, 2_700, 3_600];
/// The divisors of the properties in [`Part::Types`].
const TYPE_SCALES: [f64; 6] = [10.0, 100.0, 100.0, 10.0, 100.0, 1.0];

/// Writes the parts of one decision.
pub(crate) struct Writer<'a> {
    pub(crate) scene: &'a Scene<'a>,
    /// The sizes of the arrays, at least those of the day.
    pub(crate) sizes: Sizes,
    pub(crate) scales: &'a Scales,
    /// The decision at the day's bid prices, if a part needs them and the day is not over.
    pub(crate) priced: Option<priced::Look<'a>>,
    /// The decision in the full observation, if a part needs it and the day is not over.
    pub(crate) full: Option<full::Look<'a>>,
    /// Whether numbers stay in their units, instead of being divided by their scales.
    pub(crate) natural: bool,
}

impl Writer<'_> {
    /// Writes a part into its array, which is filled with zeros.
    #[rustfmt::skip]
    pub(crate) fn write(&self, part: Part, to: &mut [f32]) {
        let view = self.scene.view;
        let factor = if self.natural { 1.0 } else { 1.0 / part.info().scale };
        let pairs = || Pairs { vertiports: view.vertiports(), stride: self.sizes.vertiports, factor };
        match part {
            Part::ActionMask => self.scene.feasible.iter().for_each(|at| to[at.at()] = 1.0),
            Part::VertiportMask => to[..view.vertiports()].fill(1.0),
            Part::FleetMask => to[..view.places().len()].fill(1.0),
            Part::Time => to.copy_from_slice(&self.time()),
            Part::Place => to[self.scene.decision.at.at()] = 1.0,
            Part::Type => to[self.scene.kind().at()] = 1.0,
            Part::Types => self.types(to),
            Part::ChoiceProfit => self.choices(to, factor, |to| self.profit_usd(to)),
            Part::ChoicePassengers => self.choices(to, factor, |to| f64::from(self.boarding(to))),
            Part::ChoiceFlightTime => self.choices(to, factor, |to| self.hours_to(self.outcome(to).arrival)),
            Part::ChoiceBlockTime => {
                self.choices(to, factor, |to| self.hours_to(self.outcome(to).ready));
                to[self.scene.decision.at.at()] = (hours(view.hold_s()) * factor) as f32;
            }
            Part::ChoiceWait => self.choices(to, factor, |to| self.hours_to(self.outcome(to).takeoff)),
            Part::ChoiceCharge => {
                self.choices(to, factor, |to| self.charge_kwh(to));
                let own = self.scene.decision.at;
                to[own.at()] = (self.charge_kwh(own) * factor) as f32;
            }
            Part::DemandLeft => pairs().counts(to, view.demand_left_in(view.period())),
            Part::DemandWaiting => self.waiting(&pairs(), to),
            Part::DemandNext => self.next_period(|period| pairs().counts(to, view.demand_left_in(period))),
            Part::Forecast => self.forecast(&pairs(), to),
            Part::Fare => pairs().rows(to, |from| view.fares_usd(view.period(), from)),
            Part::FareNext => self.next_period(|period| pairs().rows(to, |from| view.fares_usd(period, from))),
            Part::Fares => self.fares(&pairs(), to),
            Part::PassengerCost => pairs().rows(to, |from| view.passenger_costs_usd(from)),
            Part::FlightCost => pairs().rows(to, |from| view.flight_costs_usd(from)),
            Part::Distance => pairs().rows(to, |from| view.distances_mi(from)),
            Part::FlightTime => self.legs(&pairs(), self.scene.kind(), to, |leg| hours(leg.flight_s)),
            Part::BlockTime => self.legs(&pairs(), self.scene.kind(), to, |leg| hours(leg.block_s())),
            Part::Energy => self.legs(&pairs(), self.scene.kind(), to, |leg| leg.energy_kwh),
            Part::Reachable => pairs().sets(to, |from| *view.within_range(self.scene.kind(), from)),
            Part::TypeFlightTime => self.each_type(&pairs(), to, |kind, to| {
                self.legs(&pairs(), kind, to, |leg| hours(leg.flight_s));
            }),
            Part::TypeBlockTime => self.each_type(&pairs(), to, |kind, to| {
                self.legs(&pairs(), kind, to, |leg| hours(leg.block_s()));
            }),
            Part::TypeEnergy => self.each_type(&pairs(), to, |kind, to| {
                self.legs(&pairs(), kind, to, |leg| leg.energy_kwh);
            }),
            Part::TypeReachable => self.each_type(&pairs(), to, |kind, to| {
                pairs().sets(to, |from| *view.within_range(kind, from));
            }),
            Part::Closed => pairs().sets(to, |from| view.closed(from)),
            Part::ClosedUnexpectedly => pairs().sets(to, |from| view.closed_unexpectedly(from)),
            Part::ClosedAhead => self.closed_ahead(to),
            Part::Delay => self.vertiports(to, factor, |at| hours(view.known_delay_s(self.now(), at))),
            Part::Stands => self.vertiports(to, factor, |at| f64::from(view.stands(at))),
            Part::StandsTaken => self.vertiports(to, factor, |at| f64::from(view.stands_taken()[at.at()])),
            Part::Parking => self.vertiports(to, factor, |at| f64::from(view.parked(at).1)),
            Part::Parked => self.vertiports(to, factor, |at| f64::from(view.parked(at).0)),
            Part::ChargerPower => self.charger_power(to, factor),
            Part::Period => to[view.period()] = 1.0,
            Part::EnergyPrice => scaled(to, view.energy_prices_usd(), factor),
            Part::FleetPlace => self.mark_fleet(to, self.sizes.vertiports, |at| view.places()[at.at()].at()),
            Part::FleetType => self.mark_fleet(to, self.sizes.types, |at| view.kind(at).at()),
            Part::FleetReady => self.fleet(to, |at| hours(view.ready_at(at).since(self.now())) * factor),
            Part::FleetFlying => self.fleet(to, |at| f64::from(u8::from(view.arrives_at(at) > self.now()))),
            Part::FleetLanding => self.fleet(to, |at| hours(view.arrives_at(at).since(self.now())) * factor),
            Part::FleetParked => self.fleet(to, |at| f64::from(u8::from(view.is_parked(at)))),
            Part::FleetCharge => self.fleet(to, |at| view.charge_kwh(at) * factor),
            Part::FleetDeciding => to[self.scene.decision.aircraft.at()] = 1.0,
            Part::Nodes => self.scales.write_nodes(to, view),
            Part::Aircraft => self.scales.write_aircraft(to, self.scene.decision, view),
            Part::Clock => to[0] = self.day_left() as f32,
            Part::Adjacency => pairs().sets(to, |from| {
                view.within_range(self.scene.kind(), from).without(&view.closed(from))
            }),
            Part::PricedNodes => self.at_prices(|look| look.write_nodes(priced::NODES.len(), to)),
            Part::PricedAircraft => self.at_prices(|look| look.write_aircraft(to)),
            Part::PricedWorth => self.at_prices(|look| look.write_worth(to)),
            Part::PricedChargeNodes => self.at_prices(|look| {
                self.charge_of_nodes(part, to);
                look.write_nodes(part.columns(), to);
            }),
            Part::PricedChargeAircraft => self.at_prices(|look| {
                charge::write_aircraft(view, self.scene.decision, to);
                look.write_aircraft(&mut to[..priced::AIRCRAFT.len()]);
            }),
            Part::FullNodes => self.in_full(|look| look.write_nodes(full::NODES.len(), to)),
            Part::FullAircraft => self.in_full(|look| look.write_aircraft(to)),
            Part::FullChargeNodes => self.in_full(|look| {
                self.charge_of_nodes(part, to);
                look.write_nodes(part.columns(), to);
            }),
            Part::FullChargeAircraft => self.in_full(|look| {
                charge::write_aircraft(view, self.scene.decision, to);
                look.write_aircraft(&mut to[..full::AIRCRAFT.len()]);
            }),
            Part::DistanceEdges => self.in_full(|look| look.write_edges(Edges::Distance, self.sizes.vertiports, to)),
            Part::ProfitEdges => self.in_full(|look| look.write_edges(Edges::Profit, self.sizes.vertiports, to)),
        }
    }

    fn now(&self) -> Time {
        self.scene.decision.time
    }

    fn day_left(&self) -> f64 {
        let view = self.scene.view;
        let day_s = view.day_end().since(view.day_start()).max(1);
        let left_s = if self.scene.over { 0 } else { view.day_end().since(self.now()) };
        f64::from(left_s) / f64::from(day_s)
    }

    /// The shares of day and period that are left, and the time of day.
    fn time(&self) -> [f32; 3] {
        let view = self.scene.view;
        let starts = view.period_starts();
        let begin = starts[view.period()].max(view.day_start());
        let end =
            starts.get(view.period() + 1).map_or(view.day_end(), |&end| end.min(view.day_end()));
        let left = f64::from(end.since(self.now())) / f64::from(end.since(begin).max(1));
        let left = if self.scene.over { 0.0 } else { left };
        let of_day = f64::from(self.now().seconds()) / f64::from(24 * 3600);
        [self.day_left() as f32, left.min(1.0) as f32, of_day.min(1.0) as f32]
    }

    fn types(&self, to: &mut [f32]) {
        let types = self.scene.view.aircraft_types();
        for (row, kind) in to.chunks_exact_mut(TYPE_SCALES.len()).zip(types) {
            let properties = [
                f64::from(kind.seats),
                kind.speed_mph,
                kind.battery_kwh,
                kind.energy_kwh_per_mi,
                kind.charge_kw,
                kind.self_discharge_per_h,
            ];
            for ((to, property), scale) in row.iter_mut().zip(properties).zip(TYPE_SCALES) {
                *to = (property / scale) as f32;
            }
        }
    }

    /// Writes a number for each vertiport that the deciding aircraft could fly to.
    fn choices(&self, to: &mut [f32], factor: f64, number: impl Fn(VertiportIx) -> f64) {
        let Scene { view, decision, .. } = *self.scene;
        for at in view.within_range(self.scene.kind(), decision.at).iter() {
            to[at.at()] = (number(at) * factor) as f32;
        }
    }

    /// Passengers who want to fly from here to a vertiport in this period and find a seat.
    fn boarding(&self, to: VertiportIx) -> u32 {
        let Scene { view, decision, .. } = *self.scene;
        let seats = u32::from(view.aircraft_type(self.scene.kind()).seats);
        view.demand_left(view.period(), decision.at, to).min(seats)
    }

    fn outcome(&self, to: VertiportIx) -> Outcome {
        self.scene.view.outcome(self.scene.decision, to)
    }

    fn hours_to(&self, time: Time) -> f64 {
        hours(time.since(self.now()))
    }

    /// What the battery of the deciding aircraft holds after a choice, when it decides again.
    fn charge_kwh(&self, to: VertiportIx) -> f64 {
        let Scene { view, decision, .. } = *self.scene;
        if view.charges_as_needed() {
            return self.outcome(to).charge_mwh as f64 / 1e6;
        }
        view.charge_kwh(decision.aircraft)
    }

    fn profit_usd(&self, to: VertiportIx) -> f64 {
        let Scene { view, decision, .. } = *self.scene;
        let waiting = view.demand_left(view.period(), decision.at, to);
        let takeoff = self.outcome(to).takeoff;
        let departures = view.departures(decision.time, self.scene.kind(), decision.at);
        departures.profit_from_usd(takeoff, to, waiting)
    }

    /// Writes the table of each type.
    fn each_type(&self, pairs: &Pairs, to: &mut [f32], table: impl Fn(TypeIx, &mut [f32])) {
        let types = TypeIx::all(self.scene.view.aircraft_types().len());
        for (kind, to) in types.zip(to.chunks_exact_mut(pairs.stride * pairs.stride)) {
            table(kind, to);
        }
    }

    /// Writes the passengers of this period and of later ones. Those of passed periods who were not
    /// carried cannot fly any more, so their tables stay 0.
    fn forecast(&self, pairs: &Pairs, to: &mut [f32]) {
        let view = self.scene.view;
        let tables = to.chunks_exact_mut(pairs.stride * pairs.stride);
        for (period, to) in (0..view.period_starts().len()).zip(tables).skip(view.period()) {
            pairs.counts(to, view.demand_left_in(period));
        }
    }

    fn fares(&self, pairs: &Pairs, to: &mut [f32]) {
        let view = self.scene.view;
        let tables = to.chunks_exact_mut(pairs.stride * pairs.stride);
        for (period, to) in (0..view.period_starts().len()).zip(tables) {
            pairs.rows(to, |from| view.fares_usd(period, from));
        }
    }

    fn waiting(&self, pairs: &Pairs, to: &mut [f32]) {
        let view = self.scene.view;
        if view.passenger_wait_s() == 0 {
            return;
        }
        for from in VertiportIx::all(pairs.vertiports) {
            let row = pairs.row(to, from);
            for (at, to) in VertiportIx::all(pairs.vertiports).zip(row) {
                *to = (f64::from(view.demand_waiting(from, at)) * pairs.factor) as f32;
            }
        }
    }

    fn charger_power(&self, to: &mut [f32], factor: f64) {
        let view = self.scene.view;
        let types = TypeIx::all(view.aircraft_types().len());
        for (kind, row) in types.zip(to.chunks_exact_mut(self.sizes.vertiports)) {
            self.vertiports(row, factor, |at| view.charging_power_kw(kind, at));
        }
    }

    fn legs(&self, pairs: &Pairs, kind: TypeIx, to: &mut [f32], number: impl Fn(&Leg) -> f64) {
        let view = self.scene.view;
        for from in VertiportIx::all(pairs.vertiports) {
            let legs = view.legs_from(kind, from);
            let row = pairs.row(to, from);
            for at in view.within_range(kind, from).iter() {
                row[at.at()] = (number(&legs[at.at()]) * pairs.factor) as f32;
            }
        }
    }

    /// Writes the features of charge into the last columns of each vertiport's row.
    fn charge_of_nodes(&self, part: Part, to: &mut [f32]) {
        charge::write_nodes(self.scene.view, self.scene.decision, part.columns(), to);
    }

    fn at_prices(&self, write: impl FnOnce(priced::Look<'_>)) {
        if let Some(look) = self.priced {
            write(look);
        }
    }

    fn in_full(&self, write: impl FnOnce(full::Look<'_>)) {
        if let Some(look) = self.full {
            write(look);
        }
    }

    fn closed_ahead(&self, to: &mut [f32]) {
        let view = self.scene.view;
        let known = view.known_closures();
        if known.is_empty() {
            return;
        }
        let stride = self.sizes.vertiports * AHEAD_S.len();
        for (from, row) in VertiportIx::all(view.vertiports()).zip(to.chunks_exact_mut(stride)) {
            let ports = VertiportIx::all(view.vertiports());
            for (at, closed) in ports.zip(row.chunks_exact_mut(AHEAD_S.len())) {
                for (closed, ahead_s) in closed.iter_mut().zip(AHEAD_S) {
                    *closed = f32::from(known.is_closed(from, at, self.now() + ahead_s));
                }
            }
        }
    }

    fn vertiports(&self, to: &mut [f32], factor: f64, number: impl Fn(VertiportIx) -> f64) {
        for at in VertiportIx::all(self.scene.view.vertiports()) {
            to[at.at()] = (number(at) * factor) as f32;
        }
    }

    fn next_period(&self, write: impl FnOnce(usize)) {
        let next = self.scene.view.period() + 1;
        if next < self.scene.view.period_starts().len() {
            write(next);
        }
    }

    fn fleet(&self, to: &mut [f32], number: impl Fn(AircraftIx) -> f64) {
        for at in AircraftIx::all(self.scene.view.places().len()) {
            to[at.at()] = number(at) as f32;
        }
    }

    fn mark_fleet(&self, to: &mut [f32], stride: usize, position: impl Fn(AircraftIx) -> usize) {
        for at in AircraftIx::all(self.scene.view.places().len()) {
            to[at.at() * stride + position(at)] = 1.0;
        }
    }
}

fn scaled(to: &mut [f32], from: &[f64], factor: f64) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = (from * factor) as f32;
    }
}
