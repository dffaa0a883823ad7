//! Events in JSON: everything that is reported to a live day, with ids instead of positions.

mod of_report;

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{DeserializeSeed, IntoDeserializer as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, de};
use utoipa::ToSchema;
use vertifleet_sim::live::{Booking, Report, Routes};

use crate::error::Error;
use crate::ids::Ids;
use crate::moment::Moment;

/// An event: something that happened, was decided or became known, and when.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub(crate) struct Event {
    /// When it happened or became known. Without it, that is now: the latest time that was
    /// reported.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) time: Option<Moment>,
    /// The kind of event, with its members.
    #[serde(flatten)]
    pub(crate) what: EventKind,
}

impl<'de> Deserialize<'de> for Event {
    /// Reads the members one by one, because a flattened member would let unknown members pass.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Members;
        impl<'de> Visitor<'de> for Members {
            type Value = Event;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Event, A::Error> {
                let (mut time, mut other) = (None, None);
                let members = WithoutTime { map, time: &mut time, other: &mut other };
                let what = EventKind::deserialize(MapAccessDeserializer::new(members))?;
                // A variant without members would let any pass.
                if what == EventKind::Clock
                    && let Some(unknown) = other
                {
                    let rule = format!("unknown member `{unknown}` of a clock");
                    return Err(de::Error::custom(rule));
                }
                Ok(Event { time, what })
            }
        }
        deserializer.deserialize_map(Members)
    }
}

/// The members of an event without its time.
struct WithoutTime<'a, A> {
    map: A,
    time: &'a mut Option<Moment>,
    /// The name of the first member that is neither the time nor the type.
    other: &'a mut Option<String>,
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for WithoutTime<'_, A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, A::Error> {
        while let Some(name) = self.map.next_key::<String>()? {
            if name != "time" {
                if name != "type" && self.other.is_none() {
                    *self.other = Some(name.clone());
                }
                return seed.deserialize(name.into_deserializer()).map(Some);
            }
            if self.time.is_some() {
                return Err(de::Error::duplicate_field("time"));
            }
            *self.time = self.map.next_value()?;
        }
        Ok(None)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, A::Error> {
        self.map.next_value_seed(seed)
    }
}

/// Largest number of characters in a reason.
const LONGEST_REASON: usize = 1_000;

/// Reads a reason. The service sends it to every reader of the day, so its length is limited.
pub(crate) fn reason<'de, D: Deserializer<'de>>(from: D) -> Result<Option<String>, D::Error> {
    let reason = Option::<String>::deserialize(from)?;
    if reason.as_ref().is_some_and(|reason| reason.chars().count() > LONGEST_REASON) {
        let rule = format!("`reason` has at most {LONGEST_REASON} characters");
        return Err(de::Error::custom(rule));
    }
    Ok(reason)
}

/// Largest number of characters in the name of an alert.
const LONGEST_ALERT: usize = 200;

/// Reads the name of an alert.
fn alert_name<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let alert = String::deserialize(from)?;
    if (1..=LONGEST_ALERT).contains(&alert.chars().count()) {
        return Ok(alert);
    }
    Err(de::Error::custom(format!("`alert` has 1 to {LONGEST_ALERT} characters")))
}

/// The kind of an event, with its members.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum EventKind {
    /// The day has reached this time; nothing else is known. Other events may be at most four hours
    /// later than the latest time.
    #[schema(title = "ClockEvent")]
    Clock,
    /// A ready aircraft flies to a vertiport; its own vertiport means hold. The rules must permit
    /// it.
    #[schema(title = "DecidedEvent")]
    Decided {
        /// The aircraft.
        aircraft: String,
        /// The vertiport.
        to: String,
        /// The policy that proposed it; absent if a person chose. Only the service sets it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        policy: Option<String>,
        /// The choice of the policy, if a person overruled it. Only the service sets it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        instead_of: Option<String>,
        /// Why a person chose.
        #[serde(default, deserialize_with = "reason", skip_serializing_if = "Option::is_none")]
        #[schema(max_length = 1_000)]
        reason: Option<String>,
    },
    /// The latest decision of an aircraft is cancelled. It must not have departed.
    #[schema(title = "UndoneEvent")]
    Undone {
        /// The aircraft.
        aircraft: String,
        /// Why.
        #[serde(default, deserialize_with = "reason", skip_serializing_if = "Option::is_none")]
        #[schema(max_length = 1_000)]
        reason: Option<String>,
    },
    /// An aircraft has left its stand.
    #[schema(title = "DepartedEvent")]
    Departed {
        /// The aircraft.
        aircraft: String,
        /// The destination, if it differs from the decision.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<String>,
        /// Passengers on board, if their number differs from the expected one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schema(maximum = 65_535)]
        passengers: Option<u16>,
    },
    /// An aircraft is on the ground.
    #[schema(title = "LandedEvent")]
    Landed {
        /// The aircraft.
        aircraft: String,
        /// The vertiport, if it is not the planned destination.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<String>,
        /// The charge of the battery, kWh, if it is not what was expected. Only on days that charge
        /// as needed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        charge_kwh: Option<f64>,
    },
    /// An aircraft on the ground is expected to be ready at a time.
    #[schema(title = "ChargingEvent")]
    Charging {
        /// The aircraft.
        aircraft: String,
        /// The expected time.
        ready: Moment,
    },
    /// An aircraft is ready.
    #[schema(title = "ReadyEvent")]
    Ready {
        /// The aircraft.
        aircraft: String,
    },
    /// The next step of an aircraft is expected at another time: its departure if it has been
    /// dispatched, its landing if it is in the air, the time at which it is ready if it stands.
    #[schema(title = "DelayedEvent")]
    Delayed {
        /// The aircraft.
        aircraft: String,
        /// The new time.
        until: Moment,
    },
    /// An aircraft cannot fly before a time, or until it is back in service.
    #[schema(title = "OutOfServiceEvent")]
    OutOfService {
        /// The aircraft.
        aircraft: String,
        /// Until when, if that is known.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        until: Option<Moment>,
        /// Why.
        #[serde(default, deserialize_with = "reason", skip_serializing_if = "Option::is_none")]
        #[schema(max_length = 1_000)]
        reason: Option<String>,
    },
    /// An aircraft can fly again.
    #[schema(title = "BackInServiceEvent")]
    BackInService {
        /// The aircraft.
        aircraft: String,
    },
    /// Routes are closed to new flights: one direction between two vertiports, or all routes to or
    /// from a vertiport.
    #[schema(title = "ClosedEvent")]
    Closed {
        /// The routes.
        routes: RouteNames,
        /// First instant at which they are open again, if it is known.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        until: Option<Moment>,
        /// Why.
        #[serde(default, deserialize_with = "reason", skip_serializing_if = "Option::is_none")]
        #[schema(max_length = 1_000)]
        reason: Option<String>,
    },
    /// Routes are open again.
    #[schema(title = "ReopenedEvent")]
    Reopened {
        /// The routes.
        routes: RouteNames,
    },
    /// The number of passengers who still want to fly in a period has changed, actual or forecast.
    #[schema(title = "DemandEvent")]
    Demand {
        /// A time in the period.
        period: Moment,
        /// The pairs that change.
        pairs: Vec<PairDemand>,
    },
    /// More passengers want to fly.
    #[schema(title = "BookedEvent")]
    Booked {
        /// A time in the period in which they want to fly.
        period: Moment,
        /// Where they are.
        from: String,
        /// Where they want to go.
        to: String,
        /// Their number.
        #[schema(format = Int64, maximum = 4_294_967_295u32)]
        passengers: u32,
    },
    /// Passengers no longer want to fly.
    #[schema(title = "CancelledEvent")]
    Cancelled {
        /// A time in the period in which they wanted to fly.
        period: Moment,
        /// Where they are.
        from: String,
        /// Where they wanted to go.
        to: String,
        /// Their number.
        #[schema(format = Int64, maximum = 4_294_967_295u32)]
        passengers: u32,
    },
    /// An earlier event is taken back: the day is as if it had never been reported. The clock of
    /// the day may run back then. Later events must be possible without it.
    #[schema(title = "CorrectedEvent")]
    Corrected {
        /// The number of the event.
        #[schema(minimum = 1)]
        event: u64,
        /// Why.
        #[serde(default, deserialize_with = "reason", skip_serializing_if = "Option::is_none")]
        #[schema(max_length = 1_000)]
        reason: Option<String>,
    },
    /// People have seen an alert. The state lists it for all clients.
    #[schema(title = "AcknowledgedEvent")]
    Acknowledged {
        /// The alert, by a name that clients agree on.
        #[serde(deserialize_with = "alert_name")]
        #[schema(min_length = 1, max_length = 200)]
        alert: String,
        /// A comment.
        #[serde(default, deserialize_with = "reason", skip_serializing_if = "Option::is_none")]
        #[schema(max_length = 1_000)]
        reason: Option<String>,
    },
    /// The number of stands of a vertiport changes, or of chargers if they are counted separately.
    #[schema(title = "StandsEvent")]
    Stands {
        /// The vertiport.
        vertiport: String,
        /// The number.
        #[schema(maximum = 65535)]
        stands: u16,
    },
}

/// Routes that close and open together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(
    untagged,
    expecting = "a route, as `from` and `to`, or all of a `vertiport`",
    deny_unknown_fields
)]
pub(crate) enum RouteNames {
    /// From one vertiport to another.
    #[schema(title = "OneWayRoute")]
    Way {
        /// The vertiport of departure.
        from: String,
        /// The vertiport of destination.
        to: String,
    },
    /// All routes of a vertiport.
    #[schema(title = "VertiportRoutes")]
    Of {
        /// The vertiport.
        vertiport: String,
    },
}

/// Passengers of a pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PairDemand {
    /// Where they are.
    pub(crate) from: String,
    /// Where they want to go.
    pub(crate) to: String,
    /// The number of them who still want to fly.
    #[schema(format = Int64, maximum = 4_294_967_295u32)]
    pub(crate) passengers: u32,
}

impl EventKind {
    /// The aircraft that it names, if it names one.
    pub(crate) fn aircraft(&self) -> Option<&str> {
        match self {
            Self::Decided { aircraft, .. }
            | Self::Undone { aircraft, .. }
            | Self::Departed { aircraft, .. }
            | Self::Landed { aircraft, .. }
            | Self::Charging { aircraft, .. }
            | Self::Ready { aircraft }
            | Self::Delayed { aircraft, .. }
            | Self::OutOfService { aircraft, .. }
            | Self::BackInService { aircraft } => Some(aircraft),
            _ => None,
        }
    }

    /// The event as a report to the simulator.
    ///
    /// # Errors
    /// Returns [`Error::UnknownId`] if the day has no such aircraft or vertiport.
    pub(crate) fn report(&self, ids: &Ids) -> Result<Report, Error> {
        Ok(match self {
            Self::Clock => Report::Clock,
            Self::Decided { aircraft, to, .. } => {
                Report::Decided { aircraft: ids.aircraft(aircraft)?, to: ids.vertiport(to)? }
            }
            Self::Undone { aircraft, .. } => Report::Undone { aircraft: ids.aircraft(aircraft)? },
            Self::Departed { aircraft, to, passengers, .. } => Report::Departed {
                aircraft: ids.aircraft(aircraft)?,
                to: ids.vertiport_if_any(to.as_ref())?,
                passengers: *passengers,
            },
            Self::Landed { aircraft, at, charge_kwh } => Report::Landed {
                aircraft: ids.aircraft(aircraft)?,
                at: ids.vertiport_if_any(at.as_ref())?,
                charge_kwh: *charge_kwh,
            },
            Self::Charging { aircraft, ready, .. } => {
                Report::Charging { aircraft: ids.aircraft(aircraft)?, ready: ready.time() }
            }
            Self::Ready { aircraft, .. } => Report::Ready { aircraft: ids.aircraft(aircraft)? },
            Self::Delayed { aircraft, until, .. } => {
                Report::Delayed { aircraft: ids.aircraft(aircraft)?, until: until.time() }
            }
            Self::OutOfService { aircraft, until, .. } => Report::OutOfService {
                aircraft: ids.aircraft(aircraft)?,
                until: until.map(Moment::time),
            },
            Self::BackInService { aircraft, .. } => {
                Report::BackInService { aircraft: ids.aircraft(aircraft)? }
            }
            Self::Closed { routes, until, .. } => {
                Report::Closed { routes: ids.routes(routes)?, until: until.map(Moment::time) }
            }
            Self::Reopened { routes, .. } => Report::Reopened { routes: ids.routes(routes)? },
            Self::Demand { period, pairs, .. } => Report::Demand {
                period: ids.period(period.time())?,
                pairs: pairs
                    .iter()
                    .map(|pair| {
                        let ends = (ids.vertiport(&pair.from)?, ids.vertiport(&pair.to)?);
                        Ok((ends.0, ends.1, pair.passengers))
                    })
                    .collect::<Result<_, Error>>()?,
            },
            Self::Booked { period, from, to, passengers, .. } => {
                Report::Booked { booking: ids.booking(*period, (from, to), *passengers)? }
            }
            Self::Cancelled { period, from, to, passengers, .. } => {
                Report::Cancelled { booking: ids.booking(*period, (from, to), *passengers)? }
            }
            Self::Acknowledged { .. } => Report::Acknowledged,
            Self::Corrected { event, .. } => Report::Corrected { event: *event },
            Self::Stands { vertiport, stands, .. } => {
                Report::Stands { vertiport: ids.vertiport(vertiport)?, stands: *stands }
            }
        })
    }
}

impl Ids {
    fn routes(&self, routes: &RouteNames) -> Result<Routes, Error> {
        Ok(match routes {
            RouteNames::Way { from, to } => {
                Routes::Way { from: self.vertiport(from)?, to: self.vertiport(to)? }
            }
            RouteNames::Of { vertiport } => Routes::Of(self.vertiport(vertiport)?),
        })
    }

    fn booking(
        &self,
        period: Moment,
        (from, to): (&str, &str),
        passengers: u32,
    ) -> Result<Booking, Error> {
        let (from, to) = (self.vertiport(from)?, self.vertiport(to)?);
        Ok(Booking { period: self.period(period.time())?, from, to, passengers })
    }
}
