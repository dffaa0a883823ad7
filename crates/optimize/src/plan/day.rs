//! The duration, energy and profit of every flight of a day, in the form that the search reads
//! fastest.

use vertifleet_core::{AircraftIx, Scenario, TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::batteries::Batteries;
use super::foresight::Foresight;
use super::hop::{Arrival, Hop, Landing, Standing};

/// The numbers of a day, by aircraft type and vertiport.
#[derive(Debug)]
pub(super) struct Day {
    pub(super) vertiports: usize,
    /// First second of operations.
    pub(super) first_s: u32,
    /// Last second at which aircraft decide, inclusive.
    pub(super) end_s: u32,
    pub(super) hold_s: u32,
    /// Seconds for which passengers who were not carried wait into the next period.
    pub(super) passenger_wait_s: u32,
    /// First second of each demand period.
    pub(super) period_starts_s: Vec<u32>,
    pub(super) energy_price_usd: Vec<f64>,
    /// Cost of the fleet, whether or not it flies, dollars.
    pub(super) fixed_cost_usd: f64,
    /// U_max of each vertiport: the number of its stands, or of its chargers where it has waiting
    /// stands too.
    pub(super) stands: Vec<u16>,
    /// Number of waiting stands of each vertiport that has chargers too.
    waiting_stands: Vec<Option<u16>>,
    /// The type of each aircraft.
    kind_of: Vec<TypeIx>,
    seats: Vec<u16>,
    /// By type, then from: the flights within range.
    hops: Vec<Vec<Hop>>,
    /// Fare less passenger cost by period, from, to; dollars a passenger.
    margins_usd: Vec<f64>,
    foresight: Option<Foresight>,
    /// Only on a day that charges as needed.
    pub(super) batteries: Option<Batteries>,
    /// The second at which each aircraft decides first.
    first_ready_s: Vec<u32>,
}

impl Day {
    /// Takes the numbers of a scenario from a view of its start, with what is known of the day
    /// beyond it.
    pub(super) fn of(scenario: &Scenario, view: View<'_>) -> Self {
        let foresight = Foresight::of(scenario);
        let vertiports = view.vertiports();
        let types = view.aircraft_types();
        let mut hops = Vec::with_capacity(types.len() * vertiports);
        for kind in TypeIx::all(types.len()) {
            for from in VertiportIx::all(vertiports) {
                let hop = |to: VertiportIx| {
                    let leg = view.leg(kind, from, to);
                    Hop {
                        to,
                        flight_s: leg.flight_s,
                        block_s: leg.block_s(),
                        energy_kwh: leg.energy_kwh,
                        flight_cost_usd: view.flight_costs_usd(from)[to.at()],
                    }
                };
                hops.push(view.within_range(kind, from).iter().map(hop).collect());
            }
        }
        let fleet = AircraftIx::all(view.places().len());
        Self {
            vertiports,
            first_s: view.day_start().seconds(),
            end_s: view.day_end().seconds(),
            hold_s: view.hold_s(),
            passenger_wait_s: view.passenger_wait_s(),
            period_starts_s: view.period_starts().iter().map(|start| start.seconds()).collect(),
            energy_price_usd: view.energy_prices_usd().to_vec(),
            fixed_cost_usd: view.fixed_cost_usd(),
            stands: VertiportIx::all(vertiports).map(|vertiport| view.stands(vertiport)).collect(),
            waiting_stands: scenario
                .vertiports
                .iter()
                .map(|one| one.chargers.map(|_| one.stands))
                .collect(),
            kind_of: fleet.clone().map(|aircraft| view.kind(aircraft)).collect(),
            seats: types.iter().map(|kind| kind.seats).collect(),
            hops,
            margins_usd: margins_usd(view),
            foresight,
            batteries: Batteries::of(scenario),
            first_ready_s: fleet.map(|aircraft| view.ready_at(aircraft).seconds()).collect(),
        }
    }

    pub(super) fn fleet(&self) -> impl ExactSizeIterator<Item = AircraftIx> + use<> {
        AircraftIx::all(self.kind_of.len())
    }

    pub(super) fn types(&self) -> impl ExactSizeIterator<Item = TypeIx> + use<> {
        TypeIx::all(self.seats.len())
    }

    #[inline]
    pub(super) fn kind(&self, aircraft: AircraftIx) -> TypeIx {
        self.kind_of[aircraft.at()]
    }

    #[inline]
    pub(super) fn seats_of(&self, kind: TypeIx) -> u16 {
        self.seats[kind.at()]
    }

    #[inline]
    pub(super) fn seats(&self, aircraft: AircraftIx) -> i64 {
        i64::from(self.seats_of(self.kind(aircraft)))
    }

    /// Number of stands of a vertiport that also has chargers; `None` where stands are the only
    /// places.
    #[inline]
    pub(super) fn waiting_stands(&self, vertiport: VertiportIx) -> Option<u16> {
        self.waiting_stands[vertiport.at()]
    }

    /// The flights that aircraft of a type can make from a vertiport.
    #[inline]
    pub(super) fn hops(&self, kind: TypeIx, from: VertiportIx) -> &[Hop] {
        &self.hops[kind.at() * self.vertiports + from.at()]
    }

    /// The flight of a type between two vertiports within range.
    pub(super) fn hop(&self, kind: TypeIx, from: VertiportIx, to: VertiportIx) -> &Hop {
        let hops = self.hops(kind, from);
        let at = hops.binary_search_by_key(&to, |hop| hop.to);
        &hops[at.expect("only pairs within range are flown")]
    }

    /// The shortest time from one decision of an aircraft to the next, seconds.
    pub(super) fn shortest_s(&self) -> u32 {
        let blocks_s = self.hops.iter().flatten().map(|hop| hop.block_s);
        blocks_s.fold(self.hold_s, u32::min)
    }

    /// The aircraft at the start of the day, as if it had landed then.
    pub(super) fn start(&self, aircraft: AircraftIx) -> Landing {
        let mwh = self.batteries.as_ref().map_or(0, |batteries| batteries.start_mwh(aircraft));
        let arrival = Arrival { second: self.first_s, mwh };
        Landing { ready_s: self.first_ready_s[aircraft.at()], arrival }
    }

    /// An aircraft that has landed at a vertiport and decides there at a second.
    #[inline]
    pub(super) fn standing(
        &self,
        aircraft: AircraftIx,
        at: VertiportIx,
        decided_s: u32,
        arrival: Arrival,
    ) -> Standing {
        let late_s = self.foresight.as_ref().map_or(0, |known| known.late_s(at, decided_s));
        let charge = self.batteries.as_ref().map(|batteries| {
            batteries.charge((self.kind(aircraft), at), arrival, (decided_s, late_s))
        });
        Standing { decided_s, late_s, charge }
    }

    /// The end of a flight that an aircraft decides at a vertiport; `None` if its
    /// charge suffices only after the end of operations.
    #[inline]
    pub(super) fn landing(
        &self,
        aircraft: AircraftIx,
        from: VertiportIx,
        hop: &Hop,
        Standing { decided_s, late_s, charge }: Standing,
    ) -> Option<Landing> {
        let mut leaves_s = decided_s + late_s;
        let mut mwh = 0;
        if let (Some(batteries), Some(charge)) = (&self.batteries, charge) {
            let kind = self.kind(aircraft);
            let (takeoff_s, lands_mwh) =
                batteries.fly((kind, from, hop.to), charge, (decided_s, late_s));
            if takeoff_s > self.end_s {
                return None;
            }
            (leaves_s, mwh) = (takeoff_s + late_s, lands_mwh);
        }
        let (arrival_s, charged_s) = (leaves_s + hop.flight_s, leaves_s + hop.block_s);
        let foresight = self.foresight.as_ref();
        let ready_s =
            foresight.map_or(charged_s, |known| known.ready_s(aircraft, arrival_s, charged_s));
        Some(Landing { ready_s, arrival: Arrival { second: arrival_s, mwh } })
    }

    /// Whether a route is known to be closed at a second.
    #[inline]
    pub(super) fn is_closed(&self, from: VertiportIx, to: VertiportIx, time_s: u32) -> bool {
        let foresight = self.foresight.as_ref();
        foresight.is_some_and(|foresight| foresight.is_closed(from, to, time_s))
    }

    /// The demand period that contains a second, which must not be before the period `earliest`.
    #[inline]
    pub(super) fn period_from(&self, earliest: usize, time_s: u32) -> usize {
        let mut period = earliest;
        while self.period_starts_s.get(period + 1).is_some_and(|&start| start <= time_s) {
            period += 1;
        }
        period
    }

    /// Position of a pair in a period in the table of the remaining demand.
    #[inline]
    pub(super) fn cell(&self, period: usize, from: VertiportIx, to: VertiportIx) -> usize {
        (period * self.vertiports + from.at()) * self.vertiports + to.at()
    }

    /// Fare less passenger cost of a [cell](Self::cell) of the demand, dollars a passenger.
    #[inline]
    pub(super) fn margin_usd(&self, cell: usize) -> f64 {
        self.margins_usd[cell]
    }

    /// Cost of a flight that takes off in `period` and lands at `arrival_s`, with or without
    /// passengers, dollars: charging after it, and its own cost.
    #[inline]
    pub(super) fn flying_cost_usd(&self, hop: &Hop, period: usize, arrival_s: u32) -> f64 {
        self.energy_cost_usd(hop, period, arrival_s) + hop.flight_cost_usd
    }

    /// Cost of charging after a flight that takes off in `period` and lands at `arrival_s`,
    /// dollars.
    #[inline]
    pub(super) fn energy_cost_usd(&self, hop: &Hop, period: usize, arrival_s: u32) -> f64 {
        hop.energy_kwh * self.energy_price_usd[self.period_from(period, arrival_s)]
    }
}

/// Fare less passenger cost by period, from, to; dollars a passenger.
fn margins_usd(view: View<'_>) -> Vec<f64> {
    let mut margins_usd = Vec::new();
    for period in 0..view.period_starts().len() {
        for from in VertiportIx::all(view.vertiports()) {
            let fares_usd = view.fares_usd(period, from).iter();
            let costs_usd = view.passenger_costs_usd(from);
            margins_usd.extend(fares_usd.zip(costs_usd).map(|(fare, cost)| fare - cost));
        }
    }
    margins_usd
}
