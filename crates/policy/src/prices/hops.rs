//! The flights that aircraft of each type may make from each vertiport, and their profit in each
//! interval of the day.

use vertifleet_core::{TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::clock::{Clock, SLOT_S};
use super::intervals::Intervals;
use super::quads::Quads;

/// Number of demand periods for which a route that is closed unexpectedly is assumed to stay
/// closed: the current one and the next. The actual duration is not known. On 60 days of
/// `disrupted`, 1, 3 and all periods earned a little less, within chance.
const CLOSED_PERIODS: usize = 2;

/// A flight or a hold, measured in slots from its decision until the aircraft is ready again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stay {
    /// Whole slots, and in `share` the remaining part of a slot. A stay of less than a slot counts
    /// as one slot, because the worth at the boundary before it is not known yet.
    pub(super) slots: usize,
    pub(super) share: f64,
    /// The first boundary from which the stay ends past the end of operations.
    pub(super) first_late: usize,
}

impl Stay {
    pub(super) fn of(block_s: u32, clock: &Clock) -> Self {
        let block_s = block_s.max(SLOT_S);
        let last_s = clock.end_s - clock.start_s;
        let first_late = last_s.checked_sub(block_s).map_or(0, |latest_s| latest_s / SLOT_S + 1);
        Self {
            slots: ((block_s / SLOT_S) as usize).min(clock.slots),
            share: f64::from(block_s % SLOT_S) / f64::from(SLOT_S),
            first_late: first_late as usize,
        }
    }
}

/// A flight from one vertiport to another.
#[derive(Debug, Clone, Copy)]
struct Hop {
    to: VertiportIx,
    block_s: u32,
    stay: Stay,
    flight_s: u32,
    energy_kwh: f64,
    flight_cost_usd: f64,
    seats: u32,
    /// Position of the pair among all pairs of vertiports.
    pair: usize,
}

/// The parts of a hop that are needed to follow an aircraft.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flight {
    pub(super) block_s: u32,
    /// Position of the hop among all hops, or [`NONE`].
    pub(super) hop: u32,
}

/// In place of the position of a hop: no aircraft of the type makes it.
const NONE: u32 = u32::MAX;

/// All hops of a day, by type, then from.
#[derive(Debug, Clone)]
pub(super) struct Hops {
    vertiports: usize,
    all: Vec<Hop>,
    /// The position at which the hops of each type and vertiport begin, and at the end the number
    /// of hops.
    begins: Vec<usize>,
    /// By type, then pair.
    flights: Vec<Flight>,
    pub(super) quads: Quads,
    /// By hop: the position of its gain among the gains of an interval.
    gain_at: Vec<u32>,
    pub(super) intervals: Intervals,
    /// By interval, then hop: its profit in dollars before its passengers are paid for, and in
    /// `passengers` the number of its passengers.
    profit_usd: Vec<f64>,
    passengers: Vec<f64>,
    /// By interval, then hop in the order of quads: its profit in dollars at the latest prices of
    /// passengers.
    gain_usd: Vec<f64>,
}

impl Hops {
    pub(super) fn of(view: View<'_>, clock: &Clock) -> Self {
        let vertiports = view.vertiports();
        let (mut hops, mut begins) = (Vec::new(), vec![0]);
        for kind in TypeIx::all(view.aircraft_types().len()) {
            let seats = view.aircraft_type(kind).seats.into();
            for from in VertiportIx::all(vertiports) {
                hops.extend(view.within_range(kind, from).iter().map(|to| {
                    let leg = view.leg(kind, from, to);
                    let block_s = leg.block_s();
                    Hop {
                        to,
                        block_s,
                        stay: Stay::of(block_s, clock),
                        flight_s: leg.flight_s,
                        energy_kwh: leg.energy_kwh,
                        flight_cost_usd: view.flight_costs_usd(from)[to.at()],
                        seats,
                        pair: from.at() * vertiports + to.at(),
                    }
                }));
                begins.push(hops.len());
            }
        }
        let intervals = Intervals::of(view, clock);
        let cells = intervals.all.len() * hops.len();
        let kinds = view.aircraft_types().len();
        let flights = flights(&hops, &begins, vertiports);
        let quads = Quads::of((kinds, vertiports), |kind, from, to| {
            let flight = flights[(kind.at() * vertiports + from.at()) * vertiports + to.at()];
            (flight.hop != NONE).then(|| hops[flight.hop as usize].stay)
        });
        let mut made = Self {
            vertiports,
            gain_at: Vec::with_capacity(hops.len()),
            gain_usd: vec![f64::NEG_INFINITY; intervals.all.len() * quads.gains()],
            flights,
            quads,
            all: hops,
            begins,
            intervals,
            profit_usd: vec![0.0; cells],
            passengers: vec![0.0; cells],
        };
        made.place_gains();
        made
    }

    /// Finds the place of every gain.
    fn place_gains(&mut self) {
        let kinds = (self.begins.len() - 1) / self.vertiports;
        for kind in TypeIx::all(kinds) {
            let all = kind.at() * self.vertiports;
            for hop in &self.all[self.begins[all]..self.begins[all + self.vertiports]] {
                let from = VertiportIx::new(hop.pair / self.vertiports);
                let at = self.quads.gain_at(kind, self.vertiports, (from, hop.to));
                self.gain_at.push(u32::try_from(at).expect("a day has few hops"));
                for gains_usd in self.gain_usd.chunks_exact_mut(self.quads.gains()) {
                    gains_usd[at] = 0.0;
                }
            }
        }
    }

    /// Reads the passengers and the profit of every flight from now on.
    pub(super) fn load(&mut self, view: View<'_>) {
        let count = self.all.len();
        let closed_until = view.period() + CLOSED_PERIODS;
        let known = view.known_closures();
        for at in self.intervals.first_of(view.period())..self.intervals.all.len() {
            let interval = self.intervals.all[at];
            let period = interval.period;
            for (cell, hop) in (at * count..).zip(&self.all) {
                let from = VertiportIx::new(hop.pair / self.vertiports);
                if period < closed_until && view.closed_unexpectedly(from).contains(hop.to)
                    || interval.is_closed(known, from, hop.to)
                {
                    self.passengers[cell] = 0.0;
                    self.profit_usd[cell] = f64::NEG_INFINITY;
                    continue;
                }
                let waiting = view.demand_left(period, from, hop.to);
                let passengers = f64::from(waiting.min(hop.seats));
                let margin_usd = view.fares_usd(period, from)[hop.to.at()]
                    - view.passenger_costs_usd(from)[hop.to.at()];
                self.passengers[cell] = passengers;
                self.profit_usd[cell] = passengers * margin_usd
                    - hop.energy_kwh * energy_price_usd(view, period, hop.flight_s)
                    - hop.flight_cost_usd;
            }
        }
    }

    /// Deducts the price of a passenger of a pair from its flights of a demand period.
    #[inline]
    pub(super) fn charge(&mut self, period: usize, pair: usize, price_usd: f64) {
        let pairs = self.vertiports * self.vertiports;
        for interval in self.intervals.of_period(period) {
            for flights in self.flights.chunks_exact(pairs) {
                if flights[pair].hop != NONE {
                    let hop = flights[pair].hop as usize;
                    let cell = interval * self.all.len() + hop;
                    let gain_at = interval * self.quads.gains() + self.gain_at[hop] as usize;
                    self.gain_usd[gain_at] =
                        self.profit_usd[cell] - self.passengers[cell] * price_usd;
                }
            }
        }
    }

    /// Deducts the prices of passengers, given by period and then pair, from all flights of the
    /// demand periods from `first` on.
    pub(super) fn charge_all(&mut self, first: usize, price_usd: &[f64]) {
        let (count, pairs) = (self.all.len(), self.vertiports * self.vertiports);
        let first = self.intervals.first_of(first);
        for (at, interval) in self.intervals.all.iter().enumerate().skip(first) {
            let price_usd = &price_usd[interval.period * pairs..][..pairs];
            let row = at * count..(at + 1) * count;
            let earned = self.profit_usd[row.clone()].iter().zip(&self.passengers[row.clone()]);
            let gains_usd = &mut self.gain_usd[at * self.quads.gains()..][..self.quads.gains()];
            for ((hop, &gain_at), (profit_usd, passengers)) in
                self.all.iter().zip(&self.gain_at).zip(earned)
            {
                gains_usd[gain_at as usize] = profit_usd - passengers * price_usd[hop.pair];
            }
        }
    }

    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    /// The flight of a type from one vertiport to another.
    #[inline]
    pub(super) fn flight(&self, kind: TypeIx, pair: usize) -> Flight {
        self.flights[kind.at() * self.vertiports * self.vertiports + pair]
    }

    /// The gains of all hops in an interval, in the order of quads.
    #[inline]
    pub(super) fn gains_usd(&self, interval: usize) -> &[f64] {
        &self.gain_usd[interval * self.quads.gains()..][..self.quads.gains()]
    }

    /// Number of passengers of a hop in an interval.
    #[inline]
    pub(super) fn passengers(&self, interval: usize, at: usize) -> f64 {
        self.passengers[interval * self.all.len() + at]
    }
}

/// The flight of every type and pair.
fn flights(hops: &[Hop], begins: &[usize], vertiports: usize) -> Vec<Flight> {
    let (pairs, kinds) = (vertiports * vertiports, (begins.len() - 1) / vertiports);
    let mut flights = vec![Flight { block_s: 0, hop: NONE }; kinds * pairs];
    for kind in 0..kinds {
        for at in begins[kind * vertiports]..begins[(kind + 1) * vertiports] {
            let hop = u32::try_from(at).expect("a day has few hops");
            flights[kind * pairs + hops[at].pair] = Flight { block_s: hops[at].block_s, hop };
        }
    }
    flights
}

/// Price of the energy of flights of a given duration that take off in a period, dollars per kWh:
/// the mean, over the take-offs, of the price at arrival.
fn energy_price_usd(view: View<'_>, period: usize, flight_s: u32) -> f64 {
    let (starts, prices) = (view.period_starts(), view.energy_prices_usd());
    let (begin, price_usd) = (starts[period], prices[period]);
    let Some(&end) = starts.get(period + 1) else { return price_usd };
    let (first, last) = (begin + flight_s, end + flight_s);
    let later = (period + 1..starts.len()).take_while(|&later| starts[later] < last);
    let mean_rise_usd = |later: usize| {
        let until = starts.get(later + 1).map_or(last, |&until| until.min(last));
        let arriving_s = until.since(starts[later].max(first));
        f64::from(arriving_s) / f64::from(end.since(begin)) * (prices[later] - price_usd)
    };
    price_usd + later.map(mean_rise_usd).sum::<f64>()
}
