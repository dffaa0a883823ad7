//! Decisions with their reasons: the choice of a policy for an aircraft, the value of every
//! alternative, and the reasons why some are infeasible.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::{Scenario, Time, VertiportIx};
use vertifleet_policy::{DayPrices, Policy};
use vertifleet_sim::{Decision, Outcome, Refusal, Simulation, View};

use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::moment::Moment;
use crate::policies::Policies;
use crate::renewals::{Renewals, Renewing};
use crate::turns::Key;

/// A policy's proposal for an aircraft.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct Proposal {
    /// The aircraft.
    pub(crate) aircraft: String,
    /// The vertiport where it stands.
    pub(crate) at: String,
    /// The time of the decision.
    pub(crate) time: Moment,
    /// The number of the latest event that the proposal takes into account.
    pub(crate) seq: u64,
    /// The vertiport to fly to; its own means hold.
    pub(crate) to: String,
    /// The policy that decided.
    pub(crate) policy: String,
    /// SHA-256 of its weight file, if it is a learned policy.
    pub(crate) weights_sha256: Option<String>,
    /// The requested policy, if it was not ready in time and another decided for it.
    pub(crate) too_late: Option<String>,
    /// How long the decision took, microseconds.
    pub(crate) took_us: u64,
    /// Every vertiport, in the order of the day: the result of flying there, or the reason why that
    /// is not possible.
    pub(crate) alternatives: Vec<Alternative>,
}

/// The result of flying to a vertiport.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct Alternative {
    /// The vertiport; the aircraft's own means hold.
    pub(crate) to: String,
    /// The reason why it is not possible; absent if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) impossible: Option<Impossible>,
    /// The value that the policy compares its choices by; the proposed one has the highest. Dollars
    /// for policies that price the rest of the day or roll it out, dollars an hour for `greedy`,
    /// without a unit for neural networks that do not price the day. Absent if the policy did not
    /// consider this choice. With roll-outs it is their mean; `rolling` subtracts a margin for
    /// chance from the means of all choices but the best one at the prices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) value: Option<f64>,
    /// Worth at the day's bid prices, dollars: the flight's profit and the worth of being ready
    /// there, less the prices of its passengers and its stand. Absent if the policy has no prices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) worth_usd: Option<f64>,
    /// Profit of the flight itself, dollars; 0 for a hold.
    pub(crate) flight_profit_usd: f64,
    /// Passengers on board.
    pub(crate) passengers: u32,
    /// When it would take off, on days that charge as needed; absent on others, and for a hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) takeoff: Option<Moment>,
    /// What the battery needs for it to take off: the energy of the flight and the reserve, kWh; on
    /// days that charge as needed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) needs_kwh: Option<f64>,
    /// When it would land.
    pub(crate) arrival: Moment,
    /// When it would be ready again.
    pub(crate) ready: Moment,
    /// Stands there, or chargers if they are counted separately.
    pub(crate) stands: u16,
    /// Aircraft that occupy them, standing there or on their way.
    pub(crate) stands_taken: u16,
    /// The price of a stand there until the aircraft is ready, dollars.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) stand_price_usd: Option<f64>,
    /// The price of carrying one passenger there now rather than later, dollars.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) passenger_price_usd: Option<f64>,
}

/// The reason why an alternative is not possible.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct Impossible {
    /// The rule.
    pub(crate) rule: RuleName,
    /// The rule in words, with its numbers.
    pub(crate) reason: String,
}

/// A rule that forbids a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RuleName {
    /// A full battery does not last for the flight and the reserve.
    OutOfRange,
    /// No corridor leads there.
    NoCorridor,
    /// The route is closed.
    Closed,
    /// Every stand there is taken or promised.
    NoStandFree,
    /// The charge suffices only after the end of operations.
    ChargedTooLate,
}

/// A policy that decides on a day, shared by all requests.
pub(crate) struct SharedDecider {
    decider: Mutex<Decider>,
    has_decided: AtomicBool,
}

impl SharedDecider {
    /// Whether it has not decided on the day yet.
    pub(crate) fn is_new(&self) -> bool {
        !self.has_decided.load(Ordering::Acquire)
    }

    /// The key of its turns: its evaluations are serialised, and requests wait for their turn
    /// without a lock, so that a dispatcher does not wait for readers who came first.
    pub(crate) fn key(&self) -> Key {
        std::ptr::from_ref(self).addr()
    }

    /// Proposes a decision by [`Decider::propose`].
    ///
    /// # Errors
    /// Returns the errors of [`Decider::propose`].
    pub(crate) fn propose<'day>(
        &self,
        state: impl FnOnce() -> MutexGuard<'day, DispatchDay>,
        aircraft: &str,
        time: Option<Time>,
        policy: &str,
        busy: Option<&Renewals>,
    ) -> Result<Proposal, Error> {
        let mut decider = self.decider.lock().unwrap_or_else(PoisonError::into_inner);
        let proposal = decider.propose(state(), aircraft, time, policy, busy);
        if decider.room.is_some() {
            self.has_decided.store(true, Ordering::Release);
        }
        proposal
    }
}

/// The policies that decide on a day, each with its state for the day.
#[derive(Default)]
pub(crate) struct Deciders(Mutex<HashMap<String, Arc<SharedDecider>>>);

/// A policy with its state.
pub(crate) struct Decider {
    policy: Box<dyn Policy>,
    weights_sha256: Option<String>,
    room: Option<Simulation>,
    values: Vec<f64>,
    renewing: Renewing,
}

impl Deciders {
    /// Largest number of policies with a state for a day.
    const MOST: usize = 16;

    /// The policy with this name, with its state for the day.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, or if it does not fit the day.
    pub(crate) async fn get(
        &self,
        name: &str,
        day: &Scenario,
        policies: &Policies,
    ) -> Result<Arc<SharedDecider>, Error> {
        if let Some(decider) = self.lock().get(name) {
            return Ok(Arc::clone(decider));
        }
        let resolved = policies.resolve(name, day).await?;
        let mut deciders = self.lock();
        if deciders.len() >= Self::MOST
            && let Some(other) = deciders.keys().next().cloned()
        {
            // It recomputes its prices at its next decision.
            deciders.remove(&other);
        }
        let decider = Decider {
            policy: resolved.build(),
            weights_sha256: resolved.weights_sha256(),
            room: None,
            values: vec![f64::NAN; day.vertiports.len()],
            renewing: Renewing::default(),
        };
        // Another request may have added it in the meantime.
        let decider = deciders.entry(name.to_owned()).or_insert_with(|| Arc::new(decider.into()));
        Ok(Arc::clone(decider))
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<String, Arc<SharedDecider>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl From<Decider> for SharedDecider {
    fn from(decider: Decider) -> Self {
        Self { decider: Mutex::new(decider), has_decided: AtomicBool::new(false) }
    }
}

impl Decider {
    /// Proposes a decision for an aircraft that is ready. If the service is `busy`, prices that are
    /// a quarter of an hour old are recomputed in the background.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`] if there is no such aircraft, and [`Error::ReportError`] if it
    /// cannot decide now.
    fn propose(
        &mut self,
        mut state: MutexGuard<'_, DispatchDay>,
        aircraft: &str,
        time: Option<Time>,
        policy: &str,
        busy: Option<&Renewals>,
    ) -> Result<Proposal, Error> {
        let begun = Instant::now();
        let (seq, ix) = (state.seq(), state.ids().aircraft(aircraft)?);
        let live = state.live_mut();
        let decision = match live.decision(ix, time.unwrap_or_default()) {
            Ok(decision) => decision,
            Err(refused) => return Err(state.latest().explain_decision(refused.into(), aircraft)),
        };
        let live = state.live_mut();
        let refusals = refusals(live.view_at(&decision, &mut self.room), &decision);
        // The policy evaluates a copy, so that events can be applied in the meantime.
        drop(state);
        let day = self.room.as_ref().expect("the view was written into it");
        self.renewing.before(&mut *self.policy, day, &decision, busy);
        let (view, scenario) = (day.view(), Arc::clone(day.scenario()));
        let to = self.policy.choose_with_values(&decision, &view, &mut self.values);
        let to = to.map_err(|error| Error::of_policy(policy, &error))?;
        let prices = self.policy.prices(&decision, &view);
        let weighed = Weighed { view, decision: &decision, prices, values: &self.values };
        let every = VertiportIx::all(view.vertiports()).zip(refusals);
        let alternatives =
            every.map(|(to, impossible)| weighed.alternative(&scenario, to, impossible)).collect();
        let id = |vertiport: VertiportIx| scenario.vertiports[vertiport.at()].id.clone();
        Ok(Proposal {
            aircraft: aircraft.to_owned(),
            at: id(decision.at),
            time: decision.time.into(),
            seq,
            to: id(to),
            policy: policy.to_owned(),
            weights_sha256: self.weights_sha256.clone(),
            too_late: None,
            took_us: u64::try_from(begun.elapsed().as_micros()).unwrap_or(u64::MAX),
            alternatives,
        })
    }
}

/// A decision with the values that its alternatives are compared by.
struct Weighed<'a> {
    view: View<'a>,
    decision: &'a Decision,
    prices: Option<&'a DayPrices>,
    /// The value that the policy compares its choices by.
    values: &'a [f64],
}

impl Weighed<'_> {
    fn alternative(
        &self,
        scenario: &Scenario,
        to: VertiportIx,
        impossible: Option<Impossible>,
    ) -> Alternative {
        let Self { view, decision, prices, values } = self;
        let Decision { time, aircraft, at, .. } = **decision;
        let (kind, period) = (view.kind(aircraft), view.period());
        let stays = to == at;
        let departures = view.departures(time, kind, at);
        let waits = view.charges_as_needed() && !stays;
        let Outcome { takeoff, arrival, ready, .. } = view.outcome(decision, to);
        let (passengers, flight_profit_usd) = if stays {
            (0, 0.0)
        } else {
            let waiting = view.demand_left(period, at, to);
            let seats = u32::from(view.aircraft_type(kind).seats);
            (waiting.min(seats), departures.profit_from_usd(takeoff, to, waiting))
        };
        let open = prices.filter(|_| impossible.is_none());
        let passenger_usd = |prices: &DayPrices| prices.passenger_usd(period, at, to);
        Alternative {
            to: scenario.vertiports[to.at()].id.clone(),
            value: Some(values[to.at()]).filter(|value| value.is_finite()).map(to_cents),
            worth_usd: open.map(|prices| to_cents(prices.choice_usd(*view, decision, to))),
            flight_profit_usd: to_cents(flight_profit_usd),
            passengers,
            takeoff: waits.then(|| takeoff.into()),
            needs_kwh: waits.then(|| needs_kwh(*view, decision, to)),
            arrival: arrival.into(),
            ready: ready.into(),
            stands: view.stands(to),
            stands_taken: view.stands_taken()[to.at()],
            stand_price_usd: open.map(|prices| to_cents(prices.rent_usd(to, time, ready))),
            passenger_price_usd: open
                .filter(|_| !stays)
                .map(|prices| to_cents(passenger_usd(prices))),
            impossible,
        }
    }
}

/// What a battery needs before a flight takes off, kWh.
fn needs_kwh(view: View<'_>, decision: &Decision, to: VertiportIx) -> f64 {
    let kind = view.kind(decision.aircraft);
    view.leg(kind, decision.at, to).energy_kwh + view.aircraft_type(kind).reserve_kwh
}

/// An amount rounded to cents: the precision that people need, and much shorter than a float.
fn to_cents(amount: f64) -> f64 {
    // Normalise -0.0 to 0.0.
    (amount * 100.0).round() / 100.0 + 0.0
}

/// The reason why each vertiport cannot be chosen, in the order of the day.
fn refusals(view: View<'_>, decision: &Decision) -> Vec<Option<Impossible>> {
    let reason = |to| {
        let refusal = view.refusal(decision, to)?;
        let rule = match refusal {
            Refusal::OutOfRange { .. } => RuleName::OutOfRange,
            Refusal::NoCorridor { .. } => RuleName::NoCorridor,
            Refusal::Closed { .. } => RuleName::Closed,
            Refusal::NoStandFree { .. } => RuleName::NoStandFree,
            Refusal::ChargedTooLate { .. } => RuleName::ChargedTooLate,
            Refusal::DayOver | Refusal::NoSuchVertiport { .. } => return None,
        };
        let numbers = if rule == RuleName::NoStandFree {
            format!(" ({} of {})", view.stands_taken()[to.at()], view.stands(to))
        } else {
            String::new()
        };
        Some(Impossible { rule, reason: format!("{refusal}{numbers}") })
    };
    VertiportIx::all(view.vertiports()).map(reason).collect()
}
