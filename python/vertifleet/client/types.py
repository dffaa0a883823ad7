"""What the dispatch service is asked and what it answers, as types for checkers and editors.

Written by python/tools/client_types.py from the description of the API (docs/src/reference/openapi.json): do
not edit. At run time all of these are plain dicts, so members that a newer service adds do no harm.
"""

from collections.abc import Mapping
from typing import Literal, TypeAlias

from typing_extensions import NotRequired, TypedDict


class Problem(TypedDict):
    """An error as the service answers it (RFC 9457)."""

    type: str
    """Names the kind of error: `urn:vertifleet:` and the code."""
    title: str
    """The status of HTTP in words."""
    status: int
    """The status of HTTP."""
    detail: str
    """What is wrong here."""
    code: str
    """The stable code, which the error index explains."""
    hint: NotRequired[str | None]
    """What to do."""


Role: TypeAlias = Literal["read", "dispatch", "admin"]
"""What a token permits. Each role permits what those before it do."""


class ServiceInfo(TypedDict):
    """What the service is, and what the sender may do."""

    version: str
    """The version of the program."""
    role: Role
    """What it permits: `read`, `dispatch` or `admin`."""
    policy: str
    """The policy that decides on a day if none is named."""
    token: NotRequired[str | None]
    """The name of the token that the request came with; null without tokens."""


Moment: TypeAlias = str | int
"""A time of the day, as HH:MM:SS or as seconds since midnight, before 100:00:00; or in ISO 8601 with an
offset, if the day has a date.
"""


class DayProgress(TypedDict):
    """How far a day is."""

    now: Moment
    """The latest time that it has heard of."""
    is_over: bool
    """Whether nothing is left to decide and every aircraft is on the ground."""
    waiting: int
    """Aircraft that wait for a decision."""
    profit_usd: float
    """Profit of the flights that have been sent off, less what the fleet costs all day; dollars."""


class DayInfo(TypedDict):
    """A day."""

    id: str
    """Its id."""
    name: str
    """What people call it."""
    created_ms: int
    """When it was made, milliseconds of the Unix clock."""
    archived: bool
    """Whether it is closed to writes."""
    policy: str
    """The policy that decides when none is asked for."""
    date: NotRequired[str | None]
    """Its date, if it has one."""
    progress: NotRequired[DayProgress | None]
    """How far it is, for days that are listed with their progress and are not archived."""
    seq: NotRequired[int | None]
    """The number of its events, for a day that was asked for by its id."""
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
        # Where they leave.
        "from": str,
        # Where they fly to.
        "to": str,
        # Their number.
        "passengers": int,
    },
)
"""Passengers who are expected to fly from one vertiport to another in one period."""


class NewDay(TypedDict):
    """A day to be made: from a network, or from a scenario."""

    aircraft: NotRequired[Mapping[str, str]]
    """Where aircraft stand in the morning: the vertiport of each by the id of the aircraft. The others stand
    where the network or the scenario has them.
    """
    date: NotRequired[str | None]
    """Its date, for example `2026-11-23`, from 1970 to 2199. Times may then be written in ISO 8601."""
    forecast: NotRequired[list[ForecastRow] | None]
    """The passengers who are expected, in place of those of the network or the scenario. A pair without a row
    has no passengers.
    """
    name: NotRequired[str | None]
    """What people call the day; without it, the name of its scenario, or of its network with the date."""
    network: NotRequired[str | None]
    """A network that the program ships, or that was uploaded."""
    policy: NotRequired[str | None]
    """The policy that decides when none is asked for."""
    scenario: NotRequired[Mapping[str, object] | None]
    """A whole scenario, as a scenario file has it."""
    seed: NotRequired[int | None]
    """The seed with which the day is drawn from the network: its forecast and where aircraft stand in the
    morning, unless they are given. 1 if it is absent.
    """
    time_zone: NotRequired[str | None]
    """The time zone of its clock by its name in the IANA database; without it, that of the network."""


Times: TypeAlias = Literal["clock", "iso"]
"""How times are written in an answer."""

RuleName: TypeAlias = Literal["out_of_range", "no_corridor", "closed", "no_stand_free"]
"""A rule that forbids a flight."""


class Impossible(TypedDict):
    """Why an alternative is not possible."""

    rule: RuleName
    """The rule."""
    reason: str
    """The rule in words, with its numbers."""


class Alternative(TypedDict):
    """What flying to a vertiport would bring."""

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
    """Stands there, or chargers where they are counted apart."""
    stands_taken: int
    """Aircraft that take them, standing there or on their way."""
    impossible: NotRequired[Impossible | None]
    """Why it is not possible; absent if it is."""
    passenger_price_usd: NotRequired[float | None]
    """The price of carrying one passenger there now rather than later, dollars."""
    stand_price_usd: NotRequired[float | None]
    """The price of a stand there until the aircraft is ready, dollars."""
    value: NotRequired[float | None]
    """What the policy compares its choices by: dollars for policies that price the rest of the day or roll it
    out, dollars an hour for `greedy`. Absent if the policy did not consider it.
    """
    worth_usd: NotRequired[float | None]
    """Worth at the day's bid prices, dollars: the flight's profit and what being ready there afterwards is
    worth, less the prices of its passengers and its stand. Absent if the policy has no prices.
    """


class Proposal(TypedDict):
    """What a policy proposes for an aircraft."""

    aircraft: str
    """The aircraft."""
    at: str
    """Where it stands."""
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
    """Every vertiport, in the order of the day: what flying there would bring, and why it is not possible
    where it is not.
    """
    too_late: NotRequired[str | None]
    """The policy that was asked and was not ready in time, if another decided for it."""
    weights_sha256: NotRequired[str | None]
    """SHA-256 of its weight file, if it is a learned policy."""


class NewDecision(TypedDict):
    """A decision to be taken."""

    aircraft: str
    """The aircraft."""
    deadline_ms: NotRequired[int | None]
    """Milliseconds within which the policy must answer; if it does not, a faster one decides."""
    policy: NotRequired[str | None]
    """The policy; without it, the day's."""
    reason: NotRequired[str | None]
    """Why a person chose."""
    time: NotRequired[Moment | None]
    """The time of the decision; without it, or before what has happened, now."""
    to: NotRequired[str | None]
    """The vertiport, if a person chooses; without it, the policy does."""


class TakenDecision(TypedDict):
    """A decision that was taken."""

    seq: int
    """The number of its event."""
    to: str
    """Where the aircraft flies; its own vertiport means hold."""
    proposal: NotRequired[Proposal | None]
    """What the policy proposed, with its reasons; null if a person chose."""


PairDemand = TypedDict(
    "PairDemand",
    {
        # Where they are.
        "from": str,
        # Where they want to go.
        "to": str,
        # How many of them still want to fly.
        "passengers": int,
    },
)
"""Passengers of a pair."""


class PeriodDemand(TypedDict):
    """The passengers of a demand period who still want to fly: those who wait if the period has begun, and
    those who are expected if it has not.
    """

    seq: int
    """The number of the latest event."""
    period: Moment
    """The beginning of the period."""
    has_begun: bool
    """Whether the period has begun."""
    pairs: list[PairDemand]
    """The pairs with such passengers, in the order of the day's vertiports."""


class ClockEvent(TypedDict):
    """The day is at this time; nothing else is known. Other events may not lie more than four hours after the
    latest.
    """

    type: Literal["clock"]
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class DecidedEvent(TypedDict):
    """An aircraft that is ready is to fly to a vertiport; its own vertiport means hold. The rules must permit
    it.
    """

    type: Literal["decided"]
    aircraft: str
    """The aircraft."""
    to: str
    """The vertiport."""
    instead_of: NotRequired[str | None]
    """What the policy would have chosen, if a person overruled it. The service alone says it."""
    policy: NotRequired[str | None]
    """The policy that proposed it; absent if a person chose. The service alone says it."""
    reason: NotRequired[str | None]
    """Why a person chose."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class UndoneEvent(TypedDict):
    """The latest decision of an aircraft is taken back. It must not have departed."""

    type: Literal["undone"]
    aircraft: str
    """The aircraft."""
    reason: NotRequired[str | None]
    """Why."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class DepartedEvent(TypedDict):
    """An aircraft has left its stand."""

    type: Literal["departed"]
    aircraft: str
    """The aircraft."""
    passengers: NotRequired[int | None]
    """Passengers on board, if not as many as expected."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """
    to: NotRequired[str | None]
    """Where it flies to, if that is not what was decided."""


class LandedEvent(TypedDict):
    """An aircraft is on the ground."""

    type: Literal["landed"]
    aircraft: str
    """The aircraft."""
    at: NotRequired[str | None]
    """Where it is, if that is not where it was flying to."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class ChargingEvent(TypedDict):
    """An aircraft on the ground is expected to be charged at a time."""

    type: Literal["charging"]
    aircraft: str
    """The aircraft."""
    ready: Moment
    """The expected end of charging."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class ReadyEvent(TypedDict):
    """An aircraft is charged."""

    type: Literal["ready"]
    aircraft: str
    """The aircraft."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class DelayedEvent(TypedDict):
    """What an aircraft does next is expected at another time: its departure if it has been sent off, its
    landing if it is in the air, the end of charging if it stands.
    """

    type: Literal["delayed"]
    aircraft: str
    """The aircraft."""
    until: Moment
    """The new time."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class OutOfServiceEvent(TypedDict):
    """An aircraft cannot fly before a time, or until it is back in service."""

    type: Literal["out_of_service"]
    aircraft: str
    """The aircraft."""
    reason: NotRequired[str | None]
    """Why."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """
    until: NotRequired[Moment | None]
    """Until when, if that is known."""


class BackInServiceEvent(TypedDict):
    """An aircraft can fly again."""

    type: Literal["back_in_service"]
    aircraft: str
    """The aircraft."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


RouteNamesFromTo = TypedDict(
    "RouteNamesFromTo",
    {
        # Vertiport that flights leave.
        "from": str,
        # Vertiport that flights fly to.
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
    """Routes are closed to new flights: one way between two vertiports, or all that lead to a vertiport or
    away from it.
    """

    type: Literal["closed"]
    routes: RouteNames
    """The routes."""
    reason: NotRequired[str | None]
    """Why."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """
    until: NotRequired[Moment | None]
    """First instant at which they are open again, if it is known."""


class ReopenedEvent(TypedDict):
    """Routes are open again."""

    type: Literal["reopened"]
    routes: RouteNames
    """The routes."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


class DemandEvent(TypedDict):
    """The number of passengers who still want to fly in a period has changed, actual or forecast."""

    type: Literal["demand"]
    period: Moment
    """A time in the period."""
    pairs: list[PairDemand]
    """The pairs that change."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


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
        # When it happened or became known. Without it, that is now: the latest time that the day has heard
        # of.
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
        # When it happened or became known. Without it, that is now: the latest time that the day has heard
        # of.
        "time": NotRequired[Moment | None],
    },
)
"""Passengers do not want to fly any more."""


class StandsEvent(TypedDict):
    """A vertiport has another number of stands, or of chargers where they are counted apart."""

    type: Literal["stands"]
    vertiport: str
    """The vertiport."""
    stands: int
    """The number."""
    time: NotRequired[Moment | None]
    """When it happened or became known. Without it, that is now: the latest time that the day has heard of.
    """


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
    | StandsEvent
)
"""An event: something that happened, was decided or became known, and when."""


class TakenEvent(TypedDict):
    """An event as it was taken."""

    seq: int
    """Its number."""
    mark: str
    """Its number with a sum over the log up to it. Sent as `Last-Event-ID`, it makes sure that a stream goes
    on in the same log.
    """
    at_ms: int
    """When it was taken, milliseconds of the Unix clock."""
    actor: str
    """Who sent it."""
    event: Event
    """The event."""
    notices: list[str]
    """What people should look at."""


class EventList(TypedDict):
    """Events of a day."""

    events: list[TakenEvent]
    """The events, in order."""
    next: NotRequired[int | None]
    """The number to read on after, if there may be more: a page ends at `limit`, or at about 4 MiB."""


OneOrMore: TypeAlias = list[Event] | Event
"""One event, or several that are taken all or none."""


class Taken(TypedDict):
    """What came of events."""

    seq: int
    """The number of the latest event."""
    notices: list[list[str]]
    """What people should look at."""


Entry = TypedDict(
    "Entry",
    {
        # When it was decided.
        "time": Moment,
        # The aircraft.
        "aircraft": str,
        # Where it left.
        "from": str,
        # Where it flew to.
        "to": str,
        # Whether it has been reported landed. Until then the amounts are those that are expected.
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
    """What a day has earned and cost so far."""

    seq: int
    """The number of the latest event."""
    flights: list[Entry]
    """An entry for each flight, in the order in which they were decided."""
    totals: Totals
    """The sums, and what aircraft cost whether they fly or not."""


Leg = TypedDict(
    "Leg",
    {
        # The aircraft.
        "aircraft": str,
        # Where it leaves.
        "from": str,
        # Where it flies to; a hold stays where it is.
        "to": str,
        # When it was decided, or is expected to be.
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
    },
)
"""A flight or a hold."""


class Outlook(TypedDict):
    """How a day is expected to go on if a policy takes every decision from now on."""

    seq: int
    """The number of the latest event that it takes into account."""
    now: Moment
    """The latest time that the day has heard of."""
    policy: str
    """The policy."""
    profit_so_far_usd: float
    """Profit so far, dollars: of the flights that have been sent off, less what the fleet costs all day."""
    totals: Totals
    """The numbers of the whole day as it is expected to end."""
    legs: list[Leg]
    """Every flight and hold of the day, in the order of decisions: those that were taken, then those that are
    expected.
    """
    too_late: NotRequired[str | None]
    """The policy that was asked, if it could not play the rest of the day in time. The one that is named then
    did.
    """
    upper_bound_usd: NotRequired[float | None]
    """An upper bound on the profit of the whole day, dollars, given what is known now. Proven, not estimated;
    absent if the rest of the day is too large to be bounded quickly.
    """


PhaseName: TypeAlias = Literal["standing", "sent_off", "in_the_air"]
"""What an aircraft does."""

FlightState = TypedDict(
    "FlightState",
    {
        # Where it leaves.
        "from": str,
        # Where it flies to.
        "to": str,
        # When it was decided.
        "decided": Moment,
        # Passengers on board.
        "passengers": int,
    },
)
"""A flight that has not landed."""


class AircraftState(TypedDict):
    """An aircraft."""

    id: str
    """Its id."""
    phase: PhaseName
    """What it does."""
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
    flight: NotRequired[FlightState | None]
    """The flight that it has been sent off on, until it has landed."""
    out_until: NotRequired[Moment | None]
    """When it is expected back in service, if that is known."""


class ClosedRoute(TypedDict):
    """A route that is closed to new flights."""

    to: str
    """Where it leads."""
    until: NotRequired[Moment | None]
    """When it opens, if that is known."""


class VertiportState(TypedDict):
    """A vertiport."""

    id: str
    """Its id."""
    stands: int
    """Its stands, or its chargers where they are counted apart."""
    taken: int
    """Aircraft that take them, standing there or on their way."""
    closed: list[ClosedRoute]
    """The routes from here that are closed."""


class NoticeState(TypedDict):
    """Something that people should look at."""

    text: str
    """What it is."""
    seq: NotRequired[int | None]
    """The event that it came with; null if it holds now, whatever it came from."""


class DayState(TypedDict):
    """What is known of a day."""

    seq: int
    """The number of the latest event."""
    now: Moment
    """The latest time that the day has heard of."""
    aircraft: list[AircraftState]
    """Every aircraft."""
    vertiports: list[VertiportState]
    """Every vertiport."""
    totals: Totals
    """The account so far."""
    notices: list[NoticeState]
    """What people should look at."""


class MoreAircraft(TypedDict):
    """An aircraft that the fleet might have."""

    id: str
    """Its id."""
    at: str
    """The vertiport where it would have stood in the morning."""
    type: NotRequired[str | None]
    """Its type; without it, the first of the day."""


StandCount: TypeAlias = int
"""A number of stands, or of chargers where they are counted apart."""


class WhatIf(TypedDict):
    """A day as it might be."""

    aircraft: NotRequired[list[MoreAircraft]]
    """Aircraft that the fleet would have had since the morning."""
    events: NotRequired[list[Event]]
    """Events that might happen now, in their order."""
    policy: NotRequired[str | None]
    """The policy that would decide; without it, the day's."""
    stands: NotRequired[Mapping[str, StandCount]]
    """Stands (or chargers where they are counted apart) that vertiports would have had since the morning."""


class Comparison(TypedDict):
    """What a change would lead to."""

    as_it_is: Outlook
    """The outlook as things are, by the day's policy."""
    what_if: Outlook
    """The outlook as they might be."""
    difference_usd: float
    """How much more the day would earn, dollars."""
    notices: list[str]
    """What people should look at of the events that might happen."""


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
    """Its chargers, where they are counted apart from stands."""
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
    """What is allowed but hardly meant."""
    time_zone: NotRequired[str | None]
    """The time zone of its clocks by its name in the IANA database, if it says so."""
    toml: NotRequired[str | None]
    """The network file, where one network is asked for."""


class NetworkList(TypedDict):
    """All networks."""

    networks: list[NetworkInfo]
    """Those that the program ships, then those that were uploaded, by their names."""


class NewNetwork(TypedDict):
    """A network that is uploaded."""

    toml: str
    """The text of its network file, with its table of demand in it."""


class PolicyInfo(TypedDict):
    """A policy."""

    name: str
    """The name by which requests ask for it."""
    is_shipped: bool
    """Whether the program has it; the others were uploaded."""
    kind: NotRequired[str | None]
    """What decides by uploaded weights: `gcaps-x`, `gcaps-full`, `mlp-full`, `gcaps` or `mlp`."""
    trained_on: NotRequired[str | None]
    """The network on whose days uploaded weights were trained."""
    vertiports: NotRequired[int | None]
    """Number of vertiports that uploaded weights fit; null if any number."""
    weights_sha256: NotRequired[str | None]
    """SHA-256 of an uploaded weight file."""


class PolicyList(TypedDict):
    """All policies."""

    policies: list[PolicyInfo]
    """Those that the program has, then those that were uploaded, by their names."""


Weights: TypeAlias = str
"""The bytes of a weight file."""


class WeightsInfo(TypedDict):
    """What a weight file is."""

    kind: str
    """What decides by the weights: `gcaps-x`, `gcaps-full`, `mlp-full`, `gcaps` or `mlp`."""
    weights_sha256: str
    """SHA-256 of the file."""
    trained_on: str
    """The network on whose days the weights were trained."""
    vertiports: NotRequired[int | None]
    """Number of vertiports that the weights fit; null if any number."""


Split: TypeAlias = Literal["comparison", "validation"]
"""Whose days are played. No day belongs to both."""

StudyState: TypeAlias = Literal["waiting", "playing", "finished", "failed"]
"""How far a study is."""


class Estimate(TypedDict):
    """A mean with its interval."""

    mean: float
    """The mean."""
    half_width_95: NotRequired[float | None]
    """Half the width of the 95 % interval of the mean (Student's t); null with one day."""
    standard_deviation: NotRequired[float | None]
    """The sample standard deviation between days; null with one day."""


class PlayedPolicy(TypedDict):
    """What came out for a policy while others still play."""

    name: str
    """Its name."""
    profit_usd: Estimate
    """Profit of a day, dollars."""


class StudyProgress(TypedDict):
    """How far a study has come."""

    share: float
    """The share of all that is to be played that has been, 0 to 1; every policy counts the same."""
    played: list[PlayedPolicy]
    """What came out for the policies that have played all their days."""
    doing: NotRequired[str | None]
    """The policy that plays, or `bounds` while days are bounded; absent while days are drawn."""
    left_s: NotRequired[float | None]
    """How much longer it is likely to play, seconds: the rest of this policy as quick as its days so far, the
    others as quick as those before them on the mean. Absent until a day has been played.
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
    """The chance of a difference as large as this if there were none (two-sided); null with one day."""


class PolicyResult(TypedDict):
    """What came out for one policy. Amounts and counts are means a day."""

    name: str
    """Its name."""
    description: str
    """What it does."""
    sees: str
    """What it looks at: `present`, `forecast` or `whole-day`."""
    profit_usd: Estimate
    """Profit, dollars."""
    revenue_usd: float
    """Fares, dollars."""
    passenger_cost_usd: float
    """What carrying passengers costs, dollars."""
    energy_cost_usd: float
    """What energy costs, dollars."""
    flight_cost_usd: float
    """What flights cost with or without passengers, dollars."""
    aircraft_cost_usd: float
    """What the fleet costs whatever it does, dollars."""
    site_cost_usd: float
    """What stands and chargers cost whether or not they are used, dollars."""
    passengers: float
    """Passengers who were carried."""
    spilled_passengers: float
    """Passengers who were not."""
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
    """Profit as a share of the day's upper bound, if bounds were asked for."""
    minus_first: NotRequired[Difference | None]
    """By how much it earns more than the first policy; absent for the first."""


class StudyResult(TypedDict):
    """What came out of a study. Amounts and counts are means a day."""

    program_version: str
    """The version of the program that played it."""
    first_seed: int
    """The seed of the first day; the others follow one by one."""
    policies: list[PolicyResult]
    """Every policy, in the order in which they were asked for."""
    upper_bound_usd: NotRequired[Estimate | None]
    """Upper bound of a day's profit, dollars, if bounds were asked for. No schedule earns more; proven, not
    estimated.
    """


class StudyInfo(TypedDict):
    """A study: what it was asked for, how far it is, and what came out."""

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
    """Whose days they are."""
    bounds: bool
    """Whether every day gets an upper bound."""
    command: str
    """The command that plays the same study without the service."""
    created_ms: int
    """When it was asked for, milliseconds of the Unix clock."""
    warnings: list[str]
    """What is allowed but hardly meant."""
    state: StudyState
    """How far it is."""
    problem: NotRequired[Problem | None]
    """Why it failed."""
    progress: NotRequired[StudyProgress | None]
    """How far it has come, while it plays."""
    result: NotRequired[StudyResult | None]
    """What came out, where one study that has finished is asked for."""
    took_s: NotRequired[float | None]
    """How long it played, seconds, once it has finished."""


class StudyList(TypedDict):
    """All studies."""

    studies: list[StudyInfo]
    """The latest first, without results."""


class NewStudy(TypedDict):
    """A study to be made."""

    policies: list[str]
    """The policies that play the days. The others are measured against the first. `plan` is the planner,
    which knows the days: a reference, not a policy.
    """
    days: int
    """How many days are played."""
    bounds: NotRequired[bool]
    """Whether every day gets an upper bound, which takes long on large networks."""
    network: NotRequired[str | None]
    """A network that the program ships, or that was uploaded."""
    seed: NotRequired[int | None]
    """The seed of the first day, which is that of `random` and `plan` too; with validation days, the number
    of the first. 1 if it is absent.
    """
    split: NotRequired[Split]
    """Whose days are played."""
    toml: NotRequired[str | None]
    """The text of a network file in place of a name. It is not kept."""


class Play(TypedDict):
    """What a policy did on a day."""

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
    """What each policy did."""


class StudyReplay(TypedDict):
    """The first days of a study as each policy played them."""

    days: list[ReplayedDay]
    """The days."""
