//! The outlook of a day: its expected rest, now or under changed conditions.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use serde::{Deserialize, Serialize};
use utoipa::openapi::schema::{ObjectBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};
use vertifleet_core::{Aircraft, Charging, Scenario, Stop, TypeIx, VertiportIx};
use vertifleet_optimize::{Step, upper_bound_of_rest};
use vertifleet_sim::live::{LiveDay, RemainingDay};
use vertifleet_sim::{DayNumber, DayTotals, TraceRow};
use vertifleet_study::ResolvedPolicy;

use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::event::Event;
use crate::ids::Ids;
use crate::moment::Moment;
use crate::notice::EventNotice;
use crate::optional::or_default;

/// The expected rest of a day if a policy takes every decision from now on.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct Outlook {
    /// The number of the latest event that it takes into account.
    pub(crate) seq: u64,
    /// The latest time that was reported.
    pub(crate) now: Moment,
    /// The policy.
    pub(crate) policy: String,
    /// The requested policy, if it could not play the rest of the day in time. The policy in
    /// `policy` then did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) too_late: Option<String>,
    /// Profit so far, dollars: that of the flights that have been dispatched, less the fixed costs
    /// of the fleet.
    pub(crate) profit_so_far_usd: f64,
    /// The numbers of the whole day at its expected end.
    #[schema(value_type = Totals)]
    pub(crate) totals: DayTotals,
    /// An upper bound on the profit of the whole day, dollars, given what is known now. Proven, not
    /// estimated; absent if the rest of the day is too large to be bounded quickly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) upper_bound_usd: Option<f64>,
    /// Every flight and hold of the day, in the order of decisions: first those that were taken,
    /// then the expected ones.
    pub(crate) legs: Vec<Leg>,
}

/// The numbers of a day in the description: dollars, kilowatt-hours, shares and counts, as their
/// names say.
pub(crate) struct Totals;

impl PartialSchema for Totals {
    fn schema() -> RefOr<Schema> {
        let object = ObjectBuilder::new().schema_type(Type::Object).description(Some(
            "The numbers of a day: dollars, kilowatt-hours, shares and counts, as their names say. \
             Passengers who have not been carried yet count as spilled.",
        ));
        let numbers = DayTotals::default().numbers();
        numbers
            .into_iter()
            .fold(object, |object, (name, number)| {
                let kind = match number {
                    DayNumber::Amount(_) => Type::Number,
                    DayNumber::Count(_) => Type::Integer,
                };
                object.property(name, ObjectBuilder::new().schema_type(kind)).required(name)
            })
            .into()
    }
}

impl ToSchema for Totals {}

/// A flight or a hold.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct Leg {
    /// The aircraft.
    pub(crate) aircraft: String,
    /// The vertiport of departure.
    pub(crate) from: String,
    /// The destination; that of a hold is the same vertiport.
    pub(crate) to: String,
    /// When the decision was taken, or is expected.
    pub(crate) time: Moment,
    /// When the battery suffices, so that it takes off unless it is delayed; only of flights on
    /// days that charge as needed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) takeoff: Option<Moment>,
    /// When it lands.
    pub(crate) arrival: Moment,
    /// When the aircraft is ready again.
    pub(crate) ready: Moment,
    /// Passengers on board.
    pub(crate) passengers: u16,
    /// Fares less all costs of the flight, dollars.
    pub(crate) profit_usd: f64,
    /// Whether the decision has been taken.
    pub(crate) is_taken: bool,
}

/// A changed day.
#[derive(Debug, Clone, Default, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct WhatIf {
    /// Events that might happen now, in order.
    #[serde(default, deserialize_with = "or_default")]
    #[schema(max_items = 1_000, nullable)]
    pub(crate) events: Vec<Event>,
    /// The policy that would decide; without it, the day's.
    pub(crate) policy: Option<String>,
    /// Numbers of stands (or of chargers if they are counted separately) of vertiports from the
    /// morning on.
    #[serde(default, deserialize_with = "or_default")]
    #[schema(value_type = BTreeMap<String, StandCount>, nullable)]
    pub(crate) stands: BTreeMap<String, u16>,
    /// Additional aircraft of the fleet from the morning on.
    #[serde(default, deserialize_with = "or_default")]
    #[schema(nullable)]
    pub(crate) aircraft: Vec<MoreAircraft>,
}

/// A number of stands, or of chargers if they are counted separately.
#[derive(ToSchema)]
#[schema(maximum = 65_535)]
#[expect(dead_code, reason = "it stands for a number in the description")]
pub(crate) struct StandCount(u16);

/// An additional aircraft of the fleet.
#[derive(Debug, Clone, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MoreAircraft {
    /// Its id.
    id: String,
    /// Its type; without it, the first of the day.
    #[serde(rename = "type")]
    kind: Option<String>,
    /// The vertiport where it would have stood in the morning.
    at: String,
}

/// The effect of a change.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct Comparison {
    /// The outlook without the change, by the day's policy.
    pub(crate) as_it_is: Outlook,
    /// The outlook with the change.
    pub(crate) what_if: Outlook,
    /// The increase of the day's profit, dollars.
    pub(crate) difference_usd: f64,
    /// Notices about the hypothetical events.
    pub(crate) notices: Vec<EventNotice>,
}

/// A policy with the name that it was asked for by.
#[derive(Debug, Clone)]
pub(crate) struct NamedPolicy {
    /// The name.
    pub(crate) name: String,
    /// The policy.
    pub(crate) resolved: ResolvedPolicy,
}

/// How long a policy may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patience<'a> {
    /// Requested when the client has disconnected, or the request has timed out.
    pub(crate) stop: &'a Stop,
    /// When a faster policy must replace it.
    pub(crate) until: Instant,
}

impl Patience<'_> {
    fn is_over(self) -> bool {
        self.stop.is_requested() || Instant::now() >= self.until
    }
}

impl Outlook {
    /// Plays the rest of a day, with `quick` in place of a policy that takes too long.
    ///
    /// # Errors
    /// Returns an error if a policy cannot play the day, or if the client has disconnected.
    pub(crate) fn in_time(
        day: &mut DispatchDay,
        policy: &NamedPolicy,
        quick: &NamedPolicy,
        patience: Patience<'_>,
    ) -> Result<Self, Error> {
        if let Some(outlook) = Self::of(day, policy, || patience.is_over())? {
            return Ok(outlook);
        }
        let outlook = Self::of(day, quick, || patience.stop.is_requested())?;
        // The client has disconnected, so this answer is discarded.
        let gone = || Error::Internal { cause: "the client has gone".to_owned() };
        let outlook = outlook.ok_or_else(gone)?;
        Ok(Self { too_late: Some(policy.name.clone()), ..outlook })
    }

    /// Plays the rest of a day; `None` if it is interrupted.
    fn of(
        day: &mut DispatchDay,
        policy: &NamedPolicy,
        gives_up: impl Fn() -> bool,
    ) -> Result<Option<Self>, Error> {
        let seq = day.seq();
        let live = day.live_mut();
        let scenario = Arc::clone(live.scenario());
        let mut decider = policy.resolved.build();
        let profit_so_far_usd = live.totals().profit_usd;
        let taken = live.trace().rows;
        let mut legs: Vec<Leg> = taken.iter().map(|row| Leg::of(row, &scenario, true)).collect();
        let upper_bound_usd = upper_bound_usd(live)?;
        let mut rest = live.rest();
        while let Some(decision) = rest.next_decision() {
            if gives_up() {
                return Ok(None);
            }
            let choice = decider.choose(&decision, &rest.view());
            let choice = choice.map_err(|error| Error::of_policy(&policy.name, &error))?;
            let row = rest.apply(choice).expect("policies choose from the mask");
            legs.push(Leg::of(&row, &scenario, false));
        }
        Ok(Some(Self {
            seq,
            now: live.now().into(),
            policy: policy.name.clone(),
            too_late: None,
            profit_so_far_usd,
            totals: rest.totals(),
            upper_bound_usd,
            legs,
        }))
    }
}

/// The slices of the bound, minutes, by the size of the rest of the day: vertiports times
/// vertiports times aircraft types times hours left. A bound then takes at most half a second;
/// larger days have none.
const STEPS: [(usize, u32); 2] = [(1_000, 15), (4_000, 60)];
/// The most levels of charge of the bound on days that charge as needed, for the same reason.
const MOST_LEVELS: u16 = 4;

/// Upper bound on the profit of the whole day from now on.
fn upper_bound_usd(live: &mut LiveDay) -> Result<Option<f64>, Error> {
    let so_far = live.totals().profit_usd;
    let scenario = live.scenario();
    let hours = scenario.operations.end.since(live.now()).div_ceil(3_600) as usize;
    let size = scenario.vertiports.len().pow(2) * scenario.aircraft_types.len() * hours;
    let Some(&(_, minutes)) = STEPS.iter().find(|(most, _)| size <= *most) else {
        return Ok(None);
    };
    let Some(RemainingDay { day, ready }) = live.remaining_day()? else { return Ok(Some(so_far)) };
    let internal = |error: vertifleet_optimize::Error| Error::Internal { cause: error.to_string() };
    let step = Step::from_minutes(minutes).and_then(|step| step.with_levels(MOST_LEVELS));
    let step = step.map_err(internal)?;
    let bound = upper_bound_of_rest(&Stop::default(), &day, &ready, step).map_err(internal)?;
    Ok(bound.map(|bound| so_far + bound.upper_bound_usd()))
}

impl Leg {
    fn of(row: &TraceRow, scenario: &Scenario, is_taken: bool) -> Self {
        let id = |vertiport: VertiportIx| scenario.vertiports[vertiport.at()].id.clone();
        let waits = scenario.operations.charging == Charging::AsNeeded && row.from != row.to;
        Self {
            aircraft: scenario.aircraft[row.aircraft.at()].id.clone(),
            from: id(row.from),
            to: id(row.to),
            time: row.time.into(),
            takeoff: waits.then(|| row.takeoff.into()),
            arrival: row.arrival.into(),
            ready: row.ready.into(),
            passengers: row.passengers,
            profit_usd: row.profit_usd(),
            is_taken,
        }
    }
}

impl WhatIf {
    /// Whether the change concerns the beginning of the day, and not only its rest.
    pub(crate) fn begins_otherwise(&self) -> bool {
        !self.stands.is_empty() || !self.aircraft.is_empty()
    }

    /// The changed scenario.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`], or an error of the scenario's check.
    pub(crate) fn scenario(&self, scenario: &Scenario) -> Result<Scenario, Error> {
        let ids = Ids::of(scenario);
        let mut day = scenario.clone().into_day();
        for (vertiport, &stands) in &self.stands {
            let vertiport = &mut day.vertiports[ids.vertiport(vertiport)?.at()];
            match &mut vertiport.chargers {
                Some(chargers) => *chargers = stands,
                None => vertiport.stands = stands,
            }
        }
        for MoreAircraft { id, kind, at } in &self.aircraft {
            let at = ids.vertiport(at)?;
            let position = kind.as_ref().map_or(Some(0), |kind| {
                day.aircraft_types.iter().position(|known| &known.id == kind)
            });
            let unknown = || Error::unknown("aircraft type", kind.as_deref().unwrap_or_default());
            let kind = TypeIx::new(position.ok_or_else(unknown)?);
            day.aircraft.push(Aircraft { id: id.clone(), kind, at, start_charge_kwh: None });
        }
        Ok(day.check("what-if")?)
    }

    /// Compares a day with a changed one. `otherwise` is the day with another beginning, if it has
    /// one. The first policy decides on the unchanged day, the second on the changed one. If either
    /// takes too long, the third decides on both.
    ///
    /// # Errors
    /// Returns an error if an event is invalid, if a policy cannot play the day, or if the client
    /// has disconnected.
    pub(crate) fn compare(
        self,
        day: &mut DispatchDay,
        otherwise: Option<DispatchDay>,
        [ours, theirs, quick]: [&NamedPolicy; 3],
        patience: Patience<'_>,
    ) -> Result<Comparison, Error> {
        let mut changed = otherwise.unwrap_or_else(|| day.clone());
        let before = changed.notices().filter(|(seq, _)| seq.is_some()).count();
        for event in self.events {
            changed.take(event, "", 0)?;
        }
        let told = changed.notices().filter(|(seq, _)| seq.is_some()).skip(before);
        let notices = told.map(|(_, notice)| notice).collect();
        let mut as_it_is = Outlook::in_time(day, ours, quick, patience)?;
        let what_if = Outlook::in_time(&mut changed, theirs, quick, patience)?;
        // With two different policies, the difference would not be the effect of the change.
        if what_if.too_late.is_some() && as_it_is.too_late.is_none() {
            let over = Patience { until: Instant::now(), ..patience };
            as_it_is = Outlook::in_time(day, ours, quick, over)?;
        }
        let difference_usd = what_if.totals.profit_usd - as_it_is.totals.profit_usd;
        Ok(Comparison { as_it_is, what_if, difference_usd, notices })
    }
}
