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

    It contains the same information as the views of the program's policies. The arrays are read-only, and
    each is created at its first use. Tables of pairs are [from, to]; N vertiports, A aircraft, P demand
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
    demand_next: Numbers
    """[N, N] forecast of the next period's passengers."""
    fare_usd: Numbers
    """[N, N] fare of a passenger in this period."""
    fare_next_usd: Numbers
    """[N, N] fare of a passenger in the next period."""
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
    closed: Numbers
    """[N, N] 1 where the route is closed now."""
    closed_ahead: Numbers
    """[N, N, 4] 1 where the route is known to be closed in 15, 30, 45 and 60 minutes."""
    stands: Numbers
    """[N] stands, or chargers if they are counted separately."""
    stands_taken: Numbers
    """[N] aircraft at these or in the air towards them."""
    parking: Numbers
    """[N] stands without chargers, if chargers are counted separately."""
    parked: Numbers
    """[N] aircraft at these."""
    energy_price_usd: Numbers
    """[P] price of a kWh in each demand period."""
    fleet_ready_h: Numbers
    """[A] time until each aircraft is expected to decide."""
    fleet_flying: Numbers
    """[A] 1 for each aircraft in the air."""
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
