"""The requests and answers of the dispatch service, as types for checkers and editors.

Written by python/tools/client_types.py from the description of the API (docs/src/reference/openapi.json): do
not edit. At run time all of these are plain dicts, so members that a newer service adds do no harm.
"""

from collections.abc import Mapping
from typing import Literal, TypeAlias

from typing_extensions import NotRequired, TypedDict

Moment: TypeAlias = str | int
"""A time of the day, as HH:MM:SS or as seconds since midnight, before 100:00:00; or in ISO 8601 with an
offset, if the day has a date.
"""


class ClockEvent(TypedDict):
    """The day has reached this time; nothing else is known. Other events may be at most four hours later than
    the latest time.
    """

    type: Literal["clock"]
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class DecidedEvent(TypedDict):
    """A ready aircraft flies to a vertiport; its own vertiport means hold. The rules must permit it."""

    type: Literal["decided"]
    aircraft: str
    """The aircraft."""
    to: str
    """The vertiport."""
    instead_of: NotRequired[str | None]
    """The choice of the policy, if a person overruled it. Only the service sets it."""
    policy: NotRequired[str | None]
    """The policy that proposed it; absent if a person chose. Only the service sets it."""
    reason: NotRequired[str | None]
    """Why a person chose."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class UndoneEvent(TypedDict):
    """The latest decision of an aircraft is cancelled. It must not have departed."""

    type: Literal["undone"]
    aircraft: str
    """The aircraft."""
    reason: NotRequired[str | None]
    """Why."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class DepartedEvent(TypedDict):
    """An aircraft has left its stand."""

    type: Literal["departed"]
    aircraft: str
    """The aircraft."""
    passengers: NotRequired[int | None]
    """Passengers on board, if their number differs from the expected one."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""
    to: NotRequired[str | None]
    """The destination, if it differs from the decision."""


class LandedEvent(TypedDict):
    """An aircraft is on the ground."""

    type: Literal["landed"]
    aircraft: str
    """The aircraft."""
    at: NotRequired[str | None]
    """The vertiport, if it is not the planned destination."""
    charge_kwh: NotRequired[float | None]
    """The charge of the battery, kWh, if it is not what was expected. Only on days that charge as needed."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class ChargingEvent(TypedDict):
    """An aircraft on the ground is expected to be ready at a time."""

    type: Literal["charging"]
    aircraft: str
    """The aircraft."""
    ready: Moment
    """The expected time."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class ReadyEvent(TypedDict):
    """An aircraft is ready."""

    type: Literal["ready"]
    aircraft: str
    """The aircraft."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class DelayedEvent(TypedDict):
    """The next step of an aircraft is expected at another time: its departure if it has been dispatched, its
    landing if it is in the air, the time at which it is ready if it stands.
    """

    type: Literal["delayed"]
    aircraft: str
    """The aircraft."""
    until: Moment
    """The new time."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class OutOfServiceEvent(TypedDict):
    """An aircraft cannot fly before a time, or until it is back in service."""

    type: Literal["out_of_service"]
    aircraft: str
    """The aircraft."""
    reason: NotRequired[str | None]
    """Why."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""
    until: NotRequired[Moment | None]
    """Until when, if that is known."""


class BackInServiceEvent(TypedDict):
    """An aircraft can fly again."""

    type: Literal["back_in_service"]
    aircraft: str
    """The aircraft."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


RouteNamesFromTo = TypedDict(
    "RouteNamesFromTo",
    {
        # The vertiport of departure.
        "from": str,
        # The vertiport of destination.
        "to": str,
    },
)
"""From one vertiport to another."""


class RouteNamesVertiport(TypedDict):
    """All routes of a vertiport."""

    vertiport: str
    """The vertiport."""


RouteNames: TypeAlias = RouteNamesFromTo | RouteNamesVertiport
"""Routes that close and open together."""


class ClosedEvent(TypedDict):
    """Routes are closed to new flights: one direction between two vertiports, or all routes to or from a
    vertiport.
    """

    type: Literal["closed"]
    routes: RouteNames
    """The routes."""
    reason: NotRequired[str | None]
    """Why."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""
    until: NotRequired[Moment | None]
    """First instant at which they are open again, if it is known."""


class ReopenedEvent(TypedDict):
    """Routes are open again."""

    type: Literal["reopened"]
    routes: RouteNames
    """The routes."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


PairDemand = TypedDict(
    "PairDemand",
    {
        # Where they are.
        "from": str,
        # Where they want to go.
        "to": str,
        # The number of them who still want to fly.
        "passengers": int,
    },
)
"""Passengers of a pair."""


class DemandEvent(TypedDict):
    """The number of passengers who still want to fly in a period has changed, actual or forecast."""

    type: Literal["demand"]
    period: Moment
    """A time in the period."""
    pairs: list[PairDemand]
    """The pairs that change."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


BookedEvent = TypedDict(
    "BookedEvent",
    {
        "type": Literal["booked"],
        # A time in the period in which they want to fly.
        "period": Moment,
        # Where they are.
        "from": str,
        # Where they want to go.
        "to": str,
        # Their number.
        "passengers": int,
        # When it happened or became known. Without it, that is now: the latest time that was
        # reported.
        "time": NotRequired[Moment | None],
    },
)
"""More passengers want to fly."""

CancelledEvent = TypedDict(
    "CancelledEvent",
    {
        "type": Literal["cancelled"],
        # A time in the period in which they wanted to fly.
        "period": Moment,
        # Where they are.
        "from": str,
        # Where they wanted to go.
        "to": str,
        # Their number.
        "passengers": int,
        # When it happened or became known. Without it, that is now: the latest time that was
        # reported.
        "time": NotRequired[Moment | None],
    },
)
"""Passengers no longer want to fly."""


class CorrectedEvent(TypedDict):
    """An earlier event is taken back: the day is as if it had never been reported. The clock of the day may
    run back then. Later events must be possible without it.
    """

    type: Literal["corrected"]
    event: int
    """The number of the event."""
    reason: NotRequired[str | None]
    """Why."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class AcknowledgedEvent(TypedDict):
    """People have seen an alert. The state lists it for all clients."""

    type: Literal["acknowledged"]
    alert: str
    """The alert, by a name that clients agree on."""
    reason: NotRequired[str | None]
    """A comment."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


class StandsEvent(TypedDict):
    """The number of stands of a vertiport changes, or of chargers if they are counted separately."""

    type: Literal["stands"]
    vertiport: str
    """The vertiport."""
    stands: int
    """The number."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that was reported."""


Event: TypeAlias = (
    ClockEvent
    | DecidedEvent
    | UndoneEvent
    | DepartedEvent
    | LandedEvent
    | ChargingEvent
    | ReadyEvent
    | DelayedEvent
    | OutOfServiceEvent
    | BackInServiceEvent
    | ClosedEvent
    | ReopenedEvent
    | DemandEvent
    | BookedEvent
    | CancelledEvent
    | CorrectedEvent
    | AcknowledgedEvent
    | StandsEvent
)
"""An event: something that happened, was decided or became known, and when."""


class Happened(TypedDict):
    """The event that made a request impossible."""

    seq: int
    """Its number."""
    actor: str
    """The name of the sender's token; empty without tokens."""
    at_ms: int
    """When the service stored it, milliseconds of the Unix clock."""
    text: str
    """The event in words."""
    event: Event
    """The event."""


class Problem(TypedDict):
    """An error in an answer (RFC 9457)."""

    type: str
    """Names the kind of error: `urn:vertifleet:` and the code."""
    title: str
    """The HTTP status in words."""
    status: int
    """The HTTP status."""
    detail: str
    """The cause of this error."""
    code: str
    """The stable code, which the index of errors explains."""
    blocked_by: NotRequired[int | None]
    """The number of the later event that depends on it."""
    event: NotRequired[int | None]
    """The number of the event that was to be corrected."""
    happened: NotRequired[Happened | None]
    """The event of another client that came first, if there is one."""
    hint: NotRequired[str | None]
    """The remedy."""


Role: TypeAlias = Literal["read", "dispatch", "admin"]
"""The role of a token. Each role includes the ones before it."""


class ServiceInfo(TypedDict):
    """The properties of the service, and the rights of the sender."""

    version: str
    """The version of the program."""
    role: Role
    """The role of the token: `read`, `dispatch` or `admin`."""
    policy: str
    """The policy that decides on a day if none is named."""
    token: NotRequired[str | None]
    """The name of the token that the request came with; null without tokens."""


class DayProgress(TypedDict):
    """The progress of a day."""

    now: Moment
    """The latest time that was reported."""
    is_over: bool
    """Whether nothing is left to decide and every aircraft is on the ground."""
    waiting: int
    """Aircraft that wait for a decision."""
    profit_usd: float
    """Profit of the flights that have been dispatched, less the fixed costs of the fleet; dollars."""


class DayInfo(TypedDict):
    """A day."""

    id: str
    """Its id."""
    name: str
    """Its display name."""
    created_ms: int
    """When it was made, milliseconds of the Unix clock."""
    archived: bool
    """Whether it is closed to writes."""
    policy: str
    """The default policy of its decisions."""
    date: NotRequired[str | None]
    """Its date, if it has one."""
    progress: NotRequired[DayProgress | None]
    """Its progress, for days that are listed with it and are not archived."""
    seq: NotRequired[int | None]
    """The number of its events, for a request that names the day."""
    time_zone: NotRequired[str | None]
    """The time zone of its clock, if it has a date."""


class DayList(TypedDict):
    """A list of days."""

    days: list[DayInfo]
    """The days, in the order in which they were made."""
    next: NotRequired[str | None]
    """The cursor of the next page, if there is one."""


ForecastRow = TypedDict(
    "ForecastRow",
    {
        # A time within the period, without a date.
        "period": Moment,
        # The vertiport of departure.
        "from": str,
        # The vertiport of destination.
        "to": str,
        # Their number.
        "passengers": int,
    },
)
"""Passengers who are expected to fly from one vertiport to another in one period."""


class NewDay(TypedDict):
    """A day to make, from a network or from a scenario."""

    aircraft: NotRequired[Mapping[str, str] | None]
    """The vertiports of aircraft in the morning, by the ids of the aircraft. The others stand where the
    network or the scenario places them.
    """
    date: NotRequired[str | None]
    """Its date, for example `2026-11-23`, from 1970 to 2199. Times may then be written in ISO 8601."""
    forecast: NotRequired[list[ForecastRow] | None]
    """The expected passengers, in place of those of the network or the scenario. A pair without a row has no
    passengers.
    """
    name: NotRequired[str | None]
    """The display name of the day; without it, the name of its scenario, or of its network with the date."""
    network: NotRequired[str | None]
    """A network that the program ships, or that was uploaded."""
    policy: NotRequired[str | None]
    """The default policy of its decisions."""
    scenario: NotRequired[Mapping[str, object] | None]
    """A whole scenario, in the format of scenario files."""
    seed: NotRequired[int | None]
    """The seed that draws the day from the network: its forecast, and the vertiports of aircraft in the
    morning, unless they are given. 1 if it is absent.
    """
    time_zone: NotRequired[str | None]
    """The time zone of its clock by its name in the IANA database; without it, that of the network."""


Times: TypeAlias = Literal["clock", "iso"]
"""The format of times in an answer."""

RuleName: TypeAlias = Literal["out_of_range", "no_corridor", "closed", "no_stand_free", "charged_too_late"]
"""A rule that forbids a flight."""


class Impossible(TypedDict):
    """The reason why an alternative is not possible."""

    rule: RuleName
    """The rule."""
    reason: str
    """The rule in words, with its numbers."""


class Alternative(TypedDict):
    """The result of flying to a vertiport."""

    to: str
    """The vertiport; the aircraft's own means hold."""
    flight_profit_usd: float
    """Profit of the flight itself, dollars; 0 for a hold."""
    passengers: int
    """Passengers on board."""
    arrival: Moment
    """When it would land."""
    ready: Moment
    """When it would be ready again."""
    stands: int
    """Stands there, or chargers if they are counted separately."""
    stands_taken: int
    """Aircraft that occupy them, standing there or on their way."""
    impossible: NotRequired[Impossible | None]
    """The reason why it is not possible; absent if it is."""
    needs_kwh: NotRequired[float | None]
    """What the battery needs for it to take off: the energy of the flight and the reserve, kWh; on days that
    charge as needed.
    """
    passenger_price_usd: NotRequired[float | None]
    """The price of carrying one passenger there now rather than later, dollars."""
    stand_price_usd: NotRequired[float | None]
    """The price of a stand there until the aircraft is ready, dollars."""
    takeoff: NotRequired[Moment | None]
    """When it would take off, on days that charge as needed; absent on others, and for a hold."""
    value: NotRequired[float | None]
    """The value that the policy compares its choices by; the proposed one has the highest. Dollars for
    policies that price the rest of the day or roll it out, dollars an hour for `greedy`, without a unit
    for neural networks that do not price the day. Absent if the policy did not consider this choice. With
    roll-outs it is their mean; `rolling` subtracts a margin for chance from the means of all choices but
    the best one at the prices.
    """
    worth_usd: NotRequired[float | None]
    """Worth at the day's bid prices, dollars: the flight's profit and the worth of being ready there, less
    the prices of its passengers and its stand. Absent if the policy has no prices.
    """


class Proposal(TypedDict):
    """A policy's proposal for an aircraft."""

    aircraft: str
    """The aircraft."""
    at: str
    """The vertiport where it stands."""
    time: Moment
    """The time of the decision."""
    seq: int
    """The number of the latest event that the proposal takes into account."""
    to: str
    """The vertiport to fly to; its own means hold."""
    policy: str
    """The policy that decided."""
    took_us: int
    """How long the decision took, microseconds."""
    alternatives: list[Alternative]
    """Every vertiport, in the order of the day: the result of flying there, or the reason why that is not
    possible.
    """
    too_late: NotRequired[str | None]
    """The requested policy, if it was not ready in time and another decided for it."""
    weights_sha256: NotRequired[str | None]
    """SHA-256 of its weight file, if it is a learned policy."""


class NewDecision(TypedDict):
    """A decision to be taken."""

    aircraft: str
    """The aircraft."""
    deadline_ms: NotRequired[int | None]
    """Time limit of the policy, milliseconds. If it is not ready then, a faster one decides."""
    policy: NotRequired[str | None]
    """The policy; without it, the day's."""
    reason: NotRequired[str | None]
    """Why a person chose."""
    time: NotRequired[Moment | None]
    """The time of the decision; without it, or if it is in the past, now."""
    to: NotRequired[str | None]
    """The vertiport, if a person chooses; without it, the policy does."""


class EventNotice(TypedDict):
    """A notice for people: a part of an event that they should look at. The event was accepted."""

    code: str
    """The kind: `more_than_stands`, `against_the_rules`, `departed_out_of_service`, `departed_unready`,
    `departed_before_landing`, `without_energy`, `below_reserve`, `too_fast`, `charge_too_high`,
    `ready_too_soon`, `diverted`, `not_flown`, `overdue`, or `other` in logs of earlier versions. Later
    versions may add kinds.
    """
    text: str
    """The notice in words."""
    aircraft: NotRequired[str | None]
    """The aircraft, if it is about one."""
    vertiport: NotRequired[str | None]
    """The vertiport, if it is about one."""


class TakenDecision(TypedDict):
    """A decision that was taken."""

    seq: int
    """The number of its event."""
    to: str
    """The destination of the aircraft; its own vertiport means hold."""
    notices: list[EventNotice]
    """Notices for people."""
    proposal: NotRequired[Proposal | None]
    """The proposal of the policy, with its reasons; null if a person chose."""


class PeriodDemand(TypedDict):
    """The passengers of a demand period who still want to fly: waiting ones if the period has begun, and
    expected ones if it has not.
    """

    seq: int
    """The number of the latest event."""
    period: Moment
    """The beginning of the period."""
    has_begun: bool
    """Whether the period has begun."""
    pairs: list[PairDemand]
    """The pairs with such passengers, in the order of the day's vertiports."""


class TakenEvent(TypedDict):
    """A stored event."""

    seq: int
    """Its number."""
    mark: str
    """Its number with a checksum over the log up to it. Sent as `Last-Event-ID`, it ensures that a stream
    continues in the same log.
    """
    at_ms: int
    """When the service stored it, milliseconds of the Unix clock."""
    actor: str
    """The name of the sender's token."""
    event: Event
    """The event."""
    notices: list[EventNotice]
    """Notices for people."""


class EventList(TypedDict):
    """Events of a day."""

    events: list[TakenEvent]
    """The events, in order."""
    next: NotRequired[int | None]
    """The number to read on after, if there may be more: a page ends at `limit`, or at about 4 MiB."""


OneOrMore: TypeAlias = list[Event] | Event
"""One event, or several that are applied together or not at all."""


class Taken(TypedDict):
    """The result of appending events."""

    seq: int
    """The number of the latest event."""
    notices: list[list[EventNotice]]
    """Notices for people."""


Entry = TypedDict(
    "Entry",
    {
        # When the decision was taken.
        "time": Moment,
        # The aircraft.
        "aircraft": str,
        # The vertiport of departure.
        "from": str,
        # The vertiport of destination.
        "to": str,
        # Whether it has landed. Until then the amounts are expected ones.
        "has_landed": bool,
        # Passengers on board.
        "passengers": int,
        # Fares, dollars.
        "revenue_usd": float,
        # Cost of carrying the passengers, dollars.
        "passenger_cost_usd": float,
        # Energy, kWh.
        "energy_kwh": float,
        # Cost of charging it again, dollars.
        "energy_cost_usd": float,
        # Cost of the flight without its energy, with or without passengers; dollars.
        "flight_cost_usd": float,
        # Fares less all costs of the flight, dollars.
        "profit_usd": float,
    },
)
"""A flight in the account."""


class Totals(TypedDict):
    """The numbers of a day: dollars, kilowatt-hours, shares and counts, as their names say. Passengers who
    have not been carried yet count as spilled.
    """

    profit_usd: float
    revenue_usd: float
    passenger_cost_usd: float
    energy_cost_usd: float
    flight_cost_usd: float
    aircraft_cost_usd: float
    site_cost_usd: float
    energy_kwh: float
    potential_usd: float
    reward: float
    flights: int
    repositioning_flights: int
    holds: int
    decisions: int
    passengers: int
    spilled_passengers: int
    load_factor: float


class Ledger(TypedDict):
    """The earnings and costs of a day so far."""

    seq: int
    """The number of the latest event."""
    flights: list[Entry]
    """An entry for each flight, in the order in which they were decided."""
    totals: Totals
    """The sums, including the fixed costs of aircraft."""


Leg = TypedDict(
    "Leg",
    {
        # The aircraft.
        "aircraft": str,
        # The vertiport of departure.
        "from": str,
        # The destination; that of a hold is the same vertiport.
        "to": str,
        # When the decision was taken, or is expected.
        "time": Moment,
        # When it lands.
        "arrival": Moment,
        # When the aircraft is ready again.
        "ready": Moment,
        # Passengers on board.
        "passengers": int,
        # Fares less all costs of the flight, dollars.
        "profit_usd": float,
        # Whether the decision has been taken.
        "is_taken": bool,
        # When the battery suffices, so that it takes off unless it is delayed; only of flights on
        # days that charge as needed.
        "takeoff": NotRequired[Moment | None],
    },
)
"""A flight or a hold."""


class Outlook(TypedDict):
    """The expected rest of a day if a policy takes every decision from now on."""

    seq: int
    """The number of the latest event that it takes into account."""
    now: Moment
    """The latest time that was reported."""
    policy: str
    """The policy."""
    profit_so_far_usd: float
    """Profit so far, dollars: that of the flights that have been dispatched, less the fixed costs of the
    fleet.
    """
    totals: Totals
    """The numbers of the whole day at its expected end."""
    legs: list[Leg]
    """Every flight and hold of the day, in the order of decisions: first those that were taken, then the
    expected ones.
    """
    too_late: NotRequired[str | None]
    """The requested policy, if it could not play the rest of the day in time. The policy in `policy` then
    did.
    """
    upper_bound_usd: NotRequired[float | None]
    """An upper bound on the profit of the whole day, dollars, given what is known now. Proven, not estimated;
    absent if the rest of the day is too large to be bounded quickly.
    """


PhaseName: TypeAlias = Literal["standing", "sent_off", "in_the_air"]
"""The phase of an aircraft."""

FlightState = TypedDict(
    "FlightState",
    {
        # The vertiport of departure.
        "from": str,
        # The vertiport of destination.
        "to": str,
        # When the decision was taken.
        "decided": Moment,
        # Passengers on board.
        "passengers": int,
        # When the battery suffices, so that it takes off unless it is delayed; only on days that
        # charge as needed.
        "takeoff": NotRequired[Moment | None],
    },
)
"""A flight that has not landed."""


class AircraftState(TypedDict):
    """An aircraft."""

    id: str
    """Its id."""
    phase: PhaseName
    """Its current phase."""
    place: str
    """The vertiport where it stands or will land."""
    arrival: Moment
    """When it landed there or is expected to."""
    ready: Moment
    """When it is expected to be ready."""
    needs_decision: bool
    """Whether it waits for a decision."""
    out_of_service: bool
    """Whether it is out of service."""
    charge_kwh: NotRequired[float | None]
    """What its battery holds now, kWh; only on the ground, on days that charge as needed."""
    flight: NotRequired[FlightState | None]
    """The flight that it was dispatched on, until it has landed."""
    lands_with_kwh: NotRequired[float | None]
    """What its battery will hold when it lands, kWh, if it was dispatched; below 0 if it lacks energy for its
    flight. Only on days that charge as needed.
    """
    out_until: NotRequired[Moment | None]
    """When it is expected back in service, if that is known."""


class ClosedRoute(TypedDict):
    """A route that is closed to new flights."""

    to: str
    """Its destination."""
    until: NotRequired[Moment | None]
    """When it opens, if that is known."""


class VertiportState(TypedDict):
    """A vertiport."""

    id: str
    """Its id."""
    stands: int
    """Its stands, or its chargers if they are counted separately."""
    taken: int
    """Aircraft that occupy them, standing there or on their way."""
    closed: list[ClosedRoute]
    """The routes from here that are closed."""


ClosureState = TypedDict(
    "ClosureState",
    {
        # The vertiport of departure.
        "from": str,
        # The vertiport of destination.
        "to": str,
        # Since when it is closed, or when it will close.
        "start": Moment,
        # When it opens; null if only a report opens it.
        "until": NotRequired[Moment | None],
    },
)
"""A time in which a route is closed, in one direction."""


class Acknowledgement(TypedDict):
    """An alert that people have seen."""

    alert: str
    """The alert."""
    seq: int
    """The number of the event."""
    actor: str
    """The name of the sender's token; empty without tokens."""
    time: Moment
    """The time of the event."""
    reason: NotRequired[str | None]
    """The comment."""


class NoticeState(TypedDict):
    """A notice for people."""

    code: str
    """The kind, as in the notices of events."""
    text: str
    """The notice in words."""
    aircraft: NotRequired[str | None]
    """The aircraft, if it is about one."""
    seq: NotRequired[int | None]
    """The event that it came with; null if it describes the current state."""
    vertiport: NotRequired[str | None]
    """The vertiport, if it is about one."""


class DayState(TypedDict):
    """The state of a day."""

    seq: int
    """The number of the latest event."""
    now: Moment
    """The latest time that was reported."""
    aircraft: list[AircraftState]
    """Every aircraft."""
    vertiports: list[VertiportState]
    """Every vertiport."""
    totals: Totals
    """The account so far."""
    closures: list[ClosureState]
    """The routes that are closed now, and those that are known to close later."""
    acknowledged: list[Acknowledgement]
    """The alerts that people have seen, each by its latest acknowledgement, the oldest first; the latest
    1,000.
    """
    notices: list[NoticeState]
    """Notices for people."""


class MoreAircraft(TypedDict):
    """An additional aircraft of the fleet."""

    id: str
    """Its id."""
    at: str
    """The vertiport where it would have stood in the morning."""
    type: NotRequired[str | None]
    """Its type; without it, the first of the day."""


StandCount: TypeAlias = int
"""A number of stands, or of chargers if they are counted separately."""


class WhatIf(TypedDict):
    """A changed day."""

    aircraft: NotRequired[list[MoreAircraft] | None]
    """Additional aircraft of the fleet from the morning on."""
    events: NotRequired[list[Event] | None]
    """Events that might happen now, in order."""
    policy: NotRequired[str | None]
    """The policy that would decide; without it, the day's."""
    stands: NotRequired[Mapping[str, StandCount] | None]
    """Numbers of stands (or of chargers if they are counted separately) of vertiports from the morning on."""


class Comparison(TypedDict):
    """The effect of a change."""

    as_it_is: Outlook
    """The outlook without the change, by the day's policy."""
    what_if: Outlook
    """The outlook with the change."""
    difference_usd: float
    """The increase of the day's profit, dollars."""
    notices: list[EventNotice]
    """Notices about the hypothetical events."""


class VertiportInfo(TypedDict):
    """A vertiport of a network."""

    id: str
    """Its id."""
    x_mi: float
    """Position east, miles."""
    y_mi: float
    """Position north, miles."""
    stands: int
    """Its stands."""
    chargers: NotRequired[int | None]
    """Its chargers, if they are counted separately from stands."""
    latitude: NotRequired[float | None]
    """Latitude in degrees, if it is known."""
    longitude: NotRequired[float | None]
    """Longitude in degrees, if it is known."""


class NetworkInfo(TypedDict):
    """A network."""

    name: str
    """Its name."""
    is_shipped: bool
    """Whether the program ships it; the others were uploaded."""
    vertiports: list[VertiportInfo]
    """Its vertiports, in the order of its file."""
    aircraft_types: list[str]
    """The types of its aircraft."""
    aircraft: int
    """Number of aircraft."""
    start: Moment
    """When operations start."""
    end: Moment
    """The last time at which an aircraft may decide."""
    periods: list[Moment]
    """The start of each period of demand."""
    passengers: float
    """Mean passengers of a day."""
    warnings: list[str]
    """Settings that are allowed but probably not intended."""
    time_zone: NotRequired[str | None]
    """The time zone of its clocks by its name in the IANA database, if it has one."""
    toml: NotRequired[str | None]
    """The network file, if one network is read."""


class NetworkList(TypedDict):
    """All networks."""

    networks: list[NetworkInfo]
    """Those that the program ships, then those that were uploaded, by their names."""


class NewNetwork(TypedDict):
    """A network to upload."""

    toml: str
    """The text of its network file, including its table of demand."""


class PolicyInfo(TypedDict):
    """A policy."""

    name: str
    """Its name in requests."""
    is_shipped: bool
    """Whether it belongs to the program; the others were uploaded."""
    kind: NotRequired[str | None]
    """The kind of uploaded weights: `gcaps-x`, `gcaps-full`, `mlp-full`, `gcaps` or `mlp`."""
    trained_on: NotRequired[str | None]
    """The network on whose days uploaded weights were trained."""
    vertiports: NotRequired[int | None]
    """Number of vertiports that uploaded weights fit; null if any number."""
    weights_sha256: NotRequired[str | None]
    """SHA-256 of an uploaded weight file."""


class PolicyList(TypedDict):
    """All policies."""

    policies: list[PolicyInfo]
    """Those of the program, then those that were uploaded, by their names."""


Weights: TypeAlias = str
"""The bytes of a weight file."""


class WeightsInfo(TypedDict):
    """The properties of a weight file."""

    kind: str
    """The kind of the weights: `gcaps-x`, `gcaps-full`, `mlp-full`, `gcaps` or `mlp`."""
    weights_sha256: str
    """SHA-256 of the file."""
    trained_on: str
    """The network on whose days the weights were trained."""
    vertiports: NotRequired[int | None]
    """Number of vertiports that the weights fit; null if any number."""


Split: TypeAlias = Literal["comparison", "validation"]
"""The purpose of days. No day has both."""

StudyState: TypeAlias = Literal["waiting", "playing", "finished", "failed"]
"""The state of a study."""


class Estimate(TypedDict):
    """A mean with its interval."""

    mean: float
    """The mean."""
    half_width_95: NotRequired[float | None]
    """Half the width of the 95 % interval of the mean (Student's t); null with one day."""
    standard_deviation: NotRequired[float | None]
    """The sample standard deviation between days; null with one day."""


class PlayedPolicy(TypedDict):
    """The result of a policy while others still play."""

    name: str
    """Its name."""
    profit_usd: Estimate
    """Profit of a day, dollars."""


class StudyProgress(TypedDict):
    """The progress of a study."""

    share: float
    """The share of the work that is done, 0 to 1; every policy counts the same."""
    played: list[PlayedPolicy]
    """The results of the policies that have played all their days."""
    doing: NotRequired[str | None]
    """The policy that plays, or `bounds` while days are bounded; absent while days are drawn."""
    left_s: NotRequired[float | None]
    """Expected remaining time, seconds. It assumes that the rest of this policy takes as long per day as its
    days so far, and the others as long as the mean of those before. Absent until a day has been played.
    """


class Difference(TypedDict):
    """A difference of two policies, day by day: their daily profit, dollars, with the paired t-test of
    whether its mean is 0.
    """

    profit_usd: Estimate
    """The difference."""
    days_ahead: int
    """Days on which it earned more."""
    days_behind: int
    """Days on which it earned less."""
    p_value: NotRequired[float | None]
    """The p-value: the probability of a difference at least as large as this if there were none (two-sided);
    null with one day. day.
    """


class PolicyResult(TypedDict):
    """The result of one policy. Amounts and counts are means per day."""

    name: str
    """Its name."""
    description: str
    """A description of the policy."""
    sees: str
    """The information that it uses: `present`, `forecast` or `whole-day`."""
    profit_usd: Estimate
    """Profit, dollars."""
    revenue_usd: float
    """Fares, dollars."""
    passenger_cost_usd: float
    """Cost of carrying passengers, dollars."""
    energy_cost_usd: float
    """Cost of energy, dollars."""
    flight_cost_usd: float
    """Cost of flights, with or without passengers, dollars."""
    aircraft_cost_usd: float
    """Fixed cost of the fleet, dollars."""
    site_cost_usd: float
    """Fixed cost of stands and chargers, dollars."""
    passengers: float
    """Passengers who were carried."""
    spilled_passengers: float
    """Passengers who were not carried."""
    load_factor: float
    """Passenger-miles over seat-miles, 0 to 1."""
    flights: float
    """Flights, with and without passengers."""
    repositioning_flights: float
    """Flights without passengers."""
    holds: float
    """Decisions to hold."""
    daily_profit_usd: list[float]
    """The profit of each day, dollars, in the order of the days' seeds."""
    bound_share: NotRequired[Estimate | None]
    """Profit as a share of the day's upper bound, if bounds were requested."""
    minus_first: NotRequired[Difference | None]
    """Its lead over the first policy; absent for the first."""


class StudyResult(TypedDict):
    """The result of a study. Amounts and counts are means per day."""

    program_version: str
    """The version of the program that played it."""
    first_seed: int
    """The seed of the first day; the others have the following seeds."""
    policies: list[PolicyResult]
    """Every policy, in the order of the request."""
    upper_bound_usd: NotRequired[Estimate | None]
    """Upper bound of a day's profit, dollars, if bounds were requested. No schedule earns more; it is proven,
    not estimated.
    """


class StudyInfo(TypedDict):
    """A study: its request, its progress and its result."""

    id: str
    """Its id."""
    network: str
    """The name of its network."""
    network_origin: str
    """Whether that is a shipped network (`shipped`), a network with such a name that draws other days
    (`changed`), or neither (`own`).
    """
    policies: list[str]
    """Its policies. The others are measured against the first."""
    days: int
    """Its number of days."""
    seed: int
    """The seed of its first day, or its number among the validation days."""
    split: Split
    """The purpose of its days."""
    bounds: bool
    """Whether an upper bound is proven for every day."""
    command: str
    """The command that runs the same study without the service."""
    created_ms: int
    """When it was requested, milliseconds of the Unix clock."""
    warnings: list[str]
    """Settings that are allowed but probably not intended."""
    state: StudyState
    """Its state."""
    problem: NotRequired[Problem | None]
    """The reason why it failed."""
    progress: NotRequired[StudyProgress | None]
    """Its progress, while it plays."""
    result: NotRequired[StudyResult | None]
    """The result, if a finished study is read."""
    took_s: NotRequired[float | None]
    """How long it played, seconds, once it has finished."""


class StudyList(TypedDict):
    """All studies."""

    studies: list[StudyInfo]
    """The latest first, without results."""


class NewStudy(TypedDict):
    """A study to make."""

    policies: list[str]
    """The policies that play the days. The others are compared with the first. `plan` is the planner, which
    knows the days in advance: a reference, not a policy.
    """
    days: int
    """The number of days."""
    bounds: NotRequired[bool | None]
    """Whether to prove an upper bound for every day, which takes long on large networks."""
    network: NotRequired[str | None]
    """A network that the program ships, or that was uploaded."""
    seed: NotRequired[int | None]
    """The seed of the first day, which is that of `random` and `plan` too; with validation days, the number
    of the first. 1 if it is absent.
    """
    split: NotRequired[Split | None]
    """The purpose of the days."""
    toml: NotRequired[str | None]
    """The text of a network file in place of a name. It is not stored."""


class Play(TypedDict):
    """A day as a policy played it."""

    policy: str
    """The policy."""
    trace: str
    """The trace, as its file has it, with amounts to the cent."""
    profit_usd: float
    """The profit of the day, dollars."""


class ReplayedDay(TypedDict):
    """A day that policies played."""

    name: str
    """The name of its scenario."""
    scenario: Mapping[str, object]
    """The scenario, as its file has it."""
    plays: list[Play]
    """The day as each policy played it."""


class StudyReplay(TypedDict):
    """The first days of a study as each policy played them."""

    days: list[ReplayedDay]
    """The days."""
