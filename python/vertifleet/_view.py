"""The view of a day for a policy, an observation or a reward of the caller."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from vertifleet import _native

Numbers: TypeAlias = NDArray[np.float32]


class Decision(NamedTuple):
    """An aircraft that is ready, and needs a vertiport to fly to."""

    time_s: int
    """Time of the decision, seconds since midnight."""
    aircraft: int
    """Position of the aircraft."""
    place: int
    """Position of the vertiport where it stands; choosing it means hold."""
    step: int
    """Number of decisions taken before this one today."""


class KnownClosure(NamedTuple):
    """A time for which a route is known to be closed."""

    origin: int
    """Position of the vertiport of departure."""
    destination: int
    """Position of the destination."""
    start_s: int
    """Its beginning, seconds since midnight."""
    end_s: int
    """Its end, seconds since midnight."""


class AircraftType(NamedTuple):
    """The properties of a type of aircraft."""

    id: str
    """Its name."""
    seats: int
    """Number of passengers that a flight may carry."""
    speed_mph: float
    """Cruise speed, miles an hour."""
    battery_kwh: float
    """Capacity of the battery, kWh."""
    energy_kwh_per_mi: float
    """Energy of a mile of flight, kWh."""
    charge_kw: float
    """Charging power, kW."""
    self_discharge_per_h: float
    """Share of the capacity that is lost in an hour of flight."""
    reserve_kwh: float
    """Energy that a flight leaves in the battery, kWh."""
    turnaround_s: int
    """Seconds after a landing before which the aircraft is not ready."""
    charge_curve: list[tuple[float, float]] | None
    """Charge as a share, and charging power there, kW; None for `charge_kw` throughout."""


class Outcome(TypedDict):
    """The outcome of a choice. A hold earns and costs nothing, and its destination is its origin."""

    time_s: int
    aircraft: int
    origin: int
    destination: int
    passengers: int
    revenue_usd: float
    passenger_cost_usd: float
    energy_kwh: float
    energy_cost_usd: float
    flight_cost_usd: float
    profit_usd: float
    takeoff_s: int
    arrival_s: int
    ready_s: int
    invalid_action: bool
    over: bool


class View:
    """A decision, and the day at that moment: the present, what is known ahead, and the forecast.

    It contains every number that the program's rules read. The arrays are read-only, and each is created at
    its first use. Tables of pairs are [from, to]; N vertiports, A aircraft, T types of aircraft, P demand
    periods.
    """

    __slots__ = ("__dict__", "_native")

    action_mask: Numbers
    """[N] 1 for each feasible choice."""
    choice_profit_usd: Numbers
    """[N] profit of the flight to each vertiport if it begins now; 0 for hold and out of range."""
    choice_passengers: Numbers
    """[N] passengers who would board that flight."""
    choice_flight_time_h: Numbers
    """[N] time from the decision to the landing of that flight."""
    choice_block_time_h: Numbers
    """[N] time from the decision until the aircraft decides again."""
    choice_wait_h: Numbers
    """[N] time from the decision until the charge suffices for that flight, which takes off then."""
    choice_charge_kwh: Numbers
    """[N] charge of the battery when the aircraft decides again."""
    demand_left: Numbers
    """[N, N] passengers of this period who still want to fly."""
    demand_waiting: Numbers
    """[N, N] those of `demand_left` who have waited since the period before."""
    demand_next: Numbers
    """[N, N] forecast of the next period's passengers."""
    forecast: Numbers
    """[P, N, N] passengers of each period who still want to fly: 0 in passed periods, `demand_left` in this
    one, the forecast in later ones."""
    fare_usd: Numbers
    """[N, N] fare of a passenger in this period."""
    fare_next_usd: Numbers
    """[N, N] fare of a passenger in the next period."""
    fares_usd: Numbers
    """[P, N, N] fare of a passenger in each period."""
    passenger_cost_usd: Numbers
    """[N, N] cost of a passenger."""
    flight_cost_usd: Numbers
    """[N, N] cost of a flight without its energy."""
    distance_mi: Numbers
    """[N, N] distance."""
    flight_time_h: Numbers
    """[N, N] time from decision to landing, for the deciding aircraft's type; 0 out of range."""
    block_time_h: Numbers
    """[N, N] time from decision to the next, for the deciding aircraft's type; 0 out of range."""
    energy_kwh: Numbers
    """[N, N] energy of the flight, for the deciding aircraft's type; 0 out of range."""
    reachable: Numbers
    """[N, N] 1 where a corridor leads and a full battery lasts."""
    type_flight_time_h: Numbers
    """[T, N, N] `flight_time_h` for each type."""
    type_block_time_h: Numbers
    """[T, N, N] `block_time_h` for each type."""
    type_energy_kwh: Numbers
    """[T, N, N] `energy_kwh` for each type."""
    type_reachable: Numbers
    """[T, N, N] `reachable` for each type."""
    closed: Numbers
    """[N, N] 1 where the route is closed now."""
    closed_unexpectedly: Numbers
    """[N, N] 1 where the route is closed now by a closure that was not known before."""
    closed_ahead: Numbers
    """[N, N, 4] 1 where the route is known to be closed in 15, 30, 45 and 60 minutes."""
    delay_h: Numbers
    """[N] how late a flight that is decided now is expected to leave."""
    stands: Numbers
    """[N] stands, or chargers if they are counted separately."""
    stands_taken: Numbers
    """[N] aircraft at these or in the air towards them."""
    parking: Numbers
    """[N] stands without chargers, if chargers are counted separately."""
    parked: Numbers
    """[N] aircraft at these."""
    charger_power_kw: Numbers
    """[T, N] the highest power at which each type charges at each vertiport."""
    energy_price_usd: Numbers
    """[P] price of a kWh in each demand period."""
    fleet_ready_h: Numbers
    """[A] time until each aircraft is expected to decide."""
    fleet_flying: Numbers
    """[A] 1 for each aircraft in the air."""
    fleet_landing_h: Numbers
    """[A] time until each aircraft lands; 0 on the ground."""
    fleet_parked: Numbers
    """[A] 1 for each aircraft that waits on a stand without a charger."""
    fleet_charge_kwh: Numbers
    """[A] charge of each battery when its aircraft is expected to decide."""

    def __init__(self, native: _native.View) -> None:
        self._native = native

    def __getattr__(self, name: str) -> Numbers:
        if name.startswith("_"):
            raise AttributeError(name)
        array = self._native.array(name)
        self.__dict__[name] = array
        return array

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *type(self).__annotations__})

    def __repr__(self) -> str:
        time_s, aircraft, place, step = self.decision
        time = f"{time_s // 3600:02}:{time_s // 60 % 60:02}:{time_s % 60:02}"
        feasible = int(self.action_mask.sum())
        return (
            f"<View of decision {step} at {time}: aircraft {aircraft} at vertiport {place}, "
            f"{feasible} of {self.vertiports} choices feasible>"
        )

    @property
    def decision(self) -> Decision:
        """The pending decision; when the day is over, the last one."""
        native = self._native
        return Decision(native.time_s, native.aircraft, native.place, native.index)

    @property
    def is_over(self) -> bool:
        """Whether the day is over."""
        return self._native.is_over

    @property
    def vertiports(self) -> int:
        """N."""
        return self._native.vertiports

    @property
    def seats(self) -> int:
        """Number of seats of the deciding aircraft."""
        return self._native.seats

    @property
    def charge_kwh(self) -> float:
        """Charge of the deciding aircraft's battery; its capacity on a day that charges to full."""
        return self._native.charge_kwh

    @property
    def aircraft_type(self) -> int:
        """Position of the deciding aircraft's type."""
        return self._native.aircraft_type

    @property
    def period(self) -> int:
        """Position of the demand period."""
        return self._native.period

    @property
    def period_starts_s(self) -> list[int]:
        """Start of each demand period, seconds since midnight."""
        return self._native.period_starts_s

    @property
    def hold_s(self) -> int:
        """Duration of a hold, seconds."""
        return self._native.hold_s

    @property
    def passenger_wait_s(self) -> int:
        """Seconds for which passengers who were not carried wait into the next demand period."""
        return self._native.passenger_wait_s

    @property
    def fixed_cost_usd(self) -> float:
        """The fixed cost of the day, dollars: that of its fleet, stands and chargers."""
        return self._native.fixed_cost_usd

    @property
    def charges_as_needed(self) -> bool:
        """Whether aircraft decide before they are full."""
        return self._native.charges_as_needed

    @property
    def known_closures(self) -> list[KnownClosure]:
        """The known closures of the whole day. `closed_ahead` shows those of the next hour."""
        return [KnownClosure(*closure) for closure in self._native.known_closures]

    @property
    def types(self) -> list[AircraftType]:
        """The types of aircraft."""
        return [AircraftType(*kind) for kind in self._native.types]

    @property
    def day_start_s(self) -> int:
        """Start of operations, seconds since midnight."""
        return self._native.day_start_s

    @property
    def day_end_s(self) -> int:
        """The last instant at which decisions are taken, seconds since midnight."""
        return self._native.day_end_s

    @property
    def fleet_places(self) -> list[int]:
        """Position of the vertiport where each aircraft stands or will land."""
        return self._native.fleet_places

    @property
    def fleet_types(self) -> list[int]:
        """Position of the type of each aircraft."""
        return self._native.fleet_types
