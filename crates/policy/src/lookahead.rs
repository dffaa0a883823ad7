//! `lookahead`: takes the first flight of the two in a row that together earn the most per hour.

use vertifleet_core::{Time, TypeIx, VertiportIx};
use vertifleet_sim::{Decision, View};

use crate::{Policy, PolicyError};

/// Looks two flights ahead: this flight, and the best one from its destination, with the demand forecast for that time.
///
/// The occupancy of stands by then is not known, so the second flight goes to a vertiport that has a free stand now, or
/// back to the one that this flight leaves. Its route must not be closed unexpectedly now, nor be known to be closed by
/// then. Holds if no flight earns anything. Of equally good flights, it takes the one to the vertiport listed first.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lookahead;

/// The profit of one or more flights, and the time they take.
#[derive(Clone, Copy)]
struct Prospect {
    profit_usd: f64,
    seconds: f64,
}

impl Prospect {
    fn of_flight(
        view: View<'_>,
        time: Time,
        kind: TypeIx,
        pair: (VertiportIx, VertiportIx),
    ) -> Self {
        let waiting = view.demand_left(view.period_at(time), pair.0, pair.1);
        Self {
            profit_usd: view.flight_profit_usd(time, kind, pair, waiting),
            seconds: f64::from(view.leg(kind, pair.0, pair.1).block_s()),
        }
    }

    fn then(self, next: Self) -> Self {
        Self { profit_usd: self.profit_usd + next.profit_usd, seconds: self.seconds + next.seconds }
    }

    fn rate(self) -> f64 {
        self.profit_usd / self.seconds
    }
}

/// The profit per second of a flight and the best one after it, or of the flight alone if that is higher or the day is
/// over by then.
fn best_rate(view: View<'_>, kind: TypeIx, decision: &Decision, to: VertiportIx) -> f64 {
    let first = Prospect::of_flight(view, decision.time, kind, (decision.at, to));
    let ready = decision.time + view.leg(kind, decision.at, to).block_s();
    if ready > view.day_end() {
        return first.rate();
    }
    let has_room = |next: &VertiportIx| {
        *next == decision.at || view.stands_taken()[next.at()] < view.stands(*next)
    };
    let (closed, known) = (view.closed_unexpectedly(to), view.known_closures());
    let is_open =
        |next: &VertiportIx| !closed.contains(*next) && !known.is_closed(to, *next, ready);
    let next_flights = view.within_range(kind, to).iter().filter(is_open).filter(has_room);
    next_flights
        .map(|next| first.then(Prospect::of_flight(view, ready, kind, (to, next))).rate())
        .fold(first.rate(), f64::max)
}

impl Policy for Lookahead {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let kind = view.kind(decision.aircraft);
        let mut best = (decision.at, 0.0);
        for to in view.feasible(decision).iter().filter(|&to| to != decision.at) {
            let rate = best_rate(*view, kind, decision, to);
            if rate > best.1 {
                best = (to, rate);
            }
        }
        Ok(best.0)
    }

    /// Profit per hour of the best two flights in a row, dollars; 0 for hold.
    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        let kind = view.kind(decision.aircraft);
        values.fill(f64::NAN);
        values[decision.at.at()] = 0.0;
        for to in view.feasible(decision).iter().filter(|&to| to != decision.at) {
            values[to.at()] = 3_600.0 * best_rate(*view, kind, decision, to);
        }
        Ok(())
    }
}
