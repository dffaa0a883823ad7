"""Types of the extension module, whose source is `python/src`."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, SupportsIndex, TypeAlias, final

import numpy as np
import pandas as pd
import polars as pl
from numpy.typing import ArrayLike, NDArray

_Path: TypeAlias = str | PathLike[str]
_Float: TypeAlias = NDArray[np.float64]
_Float32: TypeAlias = NDArray[np.float32]
_Shown: TypeAlias = tuple[_Float32, NDArray[np.int8]]

__all__ = [
    "Batch",
    "Board",
    "Bound",
    "Comparison",
    "Days",
    "Environment",
    "Evaluation",
    "Layout",
    "Model",
    "Network",
    "Picture",
    "Plan",
    "Played",
    "Policy",
    "Scenario",
    "Sweep",
    "Trace",
    "Training",
    "View",
    "board",
    "bound",
    "check",
    "check_comparison",
    "compare",
    "evaluate",
    "find_policy",
    "find_suite",
    "plan",
    "read_days",
    "record",
    "settings",
    "simulate",
    "suite_names",
    "train",
    "verify",
]

@final
class Network:
    """A network: vertiports, fleet, tariffs, and the models that days are drawn from.

    `Network("paper")` is the shipped network with that name (`Network.shipped` lists the names),
    `Network("random:7")` is the random network with that number, by which policies are compared;
    `Network("random-training:7")` is one to learn from, and `Network("random-validation:7")` one to choose
    settings by. `Network("mine.toml")` is read from the network file at that path. A `Network` never
    changes. A pickle of it contains the whole network.
    """
    def __new__(cls, name_or_path: _Path) -> Network: ...
    @staticmethod
    def from_toml(text: str, origin: str = "<text>") -> Network:
        """Reads a network from the text of a network file. `origin` is the name of the file in messages."""
    @staticmethod
    def shipped() -> list[str]:
        """The names of the shipped networks."""
    def changed(self, changes: Mapping[str, Any]) -> Network:
        """The same network with some members of its network file changed: `network.changed({"fleet.0.count":
        52, "vertiports.V3.stands": 8})`.

        A path names members from the outside in. An entry of a list is named by its `id` or by its
        position, counted from 0, and `*` stands for all entries. The result is checked like any network
        file.
        """
    @property
    def name(self) -> str:
        """The name of the network. The days that are drawn from it are called `{name}-{seed}`."""
    @property
    def split(self) -> Literal["training", "validation", "comparison"] | None:
        """The split that a random network was drawn for: "training", "validation" or "comparison". None
        for other networks, which serve every split.
        """
    @property
    def toml(self) -> str:
        """The text of the network file."""
    @property
    def vertiports(self) -> list[str]:
        """Ids of the vertiports, in the order that all arrays use."""
    @property
    def fleet_size(self) -> int:
        """Number of aircraft."""
    @property
    def feature_scales(self) -> dict[str, float]:
        """The numbers that the features of learned policies are divided by, as in the headers of weight
        files.
        """
    @property
    def mean_demand(self) -> _Float:
        """Mean demand, passengers [periods, vertiports, vertiports]. The demand of the drawn days scatters
        around it.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> Network: ...
    def __deepcopy__(self, _memo: Any) -> Network: ...
    @staticmethod
    def restored(text: str, source: str) -> Network:
        """Restores a pickled network."""
    @property
    def source(self) -> str:
        """The Python expression that made the network, for people to read. A report contains it in its
        command.
        """
    def draw(
        self, seed: SupportsIndex, purpose: Literal["comparison", "validation", "training"] = "comparison"
    ) -> Scenario:
        """Draws the day of a seed. The same seed gives the same day everywhere.

        Days for different purposes ("comparison", "validation", "training") are never the same, so that no
        policy is judged on a day that it learned from.
        """

@final
class Scenario:
    """One operating day with all that happens to the fleet from outside: network, fleet, demand, tariffs
    and disturbances. A `Scenario` never changes, and neither do its arrays. To get a different day,
    draw it from a changed network, or change the text of this day (`to_json`, `from_json`).
    """
    def plot(self) -> Picture:
        """The day as a picture: its vertiports, and its demand by pair and by time."""
    def _repr_svg_(self) -> str: ...
    @staticmethod
    def read(path: _Path) -> Scenario:
        """Reads a scenario file."""
    @staticmethod
    def from_json(text: str, origin: str = "<text>") -> Scenario:
        """Reads a day from the text of a scenario file. `origin` is the name of the file in messages."""
    def write(self, path: _Path, *, force: bool = False) -> None:
        """Writes the day as a scenario file. An existing file that is read-only or not a scenario file is
        replaced only with `force`.
        """
    def to_json(self) -> str:
        """The text of the scenario file."""
    @property
    def name(self) -> str:
        """The name of the day, for example `paper-7`."""
    @property
    def seed(self) -> int:
        """The seed that the day was drawn with. The seeds of training, validation and comparison days have
        separate ranges.
        """
    @property
    def split(self) -> Literal["training", "validation", "comparison"]:
        """The split of the day: "training", "validation" or "comparison". It is that of its seed, or that
        of its network if the network was drawn for a stricter one: every day of "random:7" is a
        comparison day.
        """
    @property
    def vertiports(self) -> list[str]:
        """Ids of the vertiports, in the order that all arrays use."""
    @property
    def aircraft(self) -> list[str]:
        """Ids of the aircraft."""
    @property
    def start_positions(self) -> NDArray[np.int64]:
        """The initial place of each aircraft, as positions of vertiports [aircraft]."""
    @property
    def stands(self) -> NDArray[np.int64]:
        """Number of stands at each vertiport [vertiports]."""
    @property
    def positions_mi(self) -> _Float:
        """Positions of the vertiports, miles east and north [vertiports, 2]."""
    @property
    def distance_mi(self) -> _Float:
        """Distances, miles [vertiports, vertiports]."""
    @property
    def periods_s(self) -> NDArray[np.int64]:
        """Start of each demand period, seconds since midnight [periods]."""
    @property
    def demand(self) -> NDArray[np.int64]:
        """Demand, passengers [periods, vertiports, vertiports]. Where it differs from the forecast, no
        policy observes it.
        """
    @property
    def fare_usd(self) -> _Float:
        """Fares, dollars per passenger [periods, vertiports, vertiports]."""
    @property
    def passenger_cost_usd(self) -> _Float:
        """Passenger cost: the cost of carrying a passenger, dollars per passenger [vertiports,
        vertiports].
        """
    @property
    def flight_cost_usd(self) -> _Float:
        """Flight cost: the cost of a flight with or without passengers, energy excluded, dollars
        [vertiports, vertiports].
        """
    @property
    def aircraft_cost_usd(self) -> float:
        """Aircraft cost: the fixed cost of each aircraft, dollars per day."""
    @property
    def energy_price_usd(self) -> _Float:
        """Price of electricity, dollars per kWh [periods]."""
    @property
    def potential_usd(self) -> float:
        """Potential: the revenue if every passenger flew, dollars. It is the denominator of the reward."""

@final
class Trace:
    """Every decision of a day with its outcome, one row each, in the order in which they were taken. It is
    a complete schedule.
    """
    def plot(self) -> Picture:
        """The trace as a picture: the passengers by pair, the schedule of every aircraft, the occupancy of
        the vertiports, and the demand served and spilled.
        """
    def _repr_svg_(self) -> str: ...
    @property
    def scenario(self) -> Scenario:
        """The day."""
    @staticmethod
    def read(path: _Path, scenario: Scenario) -> Trace:
        """Reads a trace of a day from a CSV file."""
    @staticmethod
    def from_csv(text: str, scenario: Scenario, origin: str = "<text>") -> Trace:
        """Reads a trace from the text of a CSV file. `origin` is the name of the file in messages."""
    def write(self, path: _Path, *, force: bool = False) -> None:
        """Writes the trace as a CSV file. An existing file that is read-only or not a trace is replaced
        only with `force`.
        """
    def to_csv(self) -> str:
        """The trace as the text of a CSV file."""
    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns as numpy arrays, with the same names as in the file. Times are in seconds since
        midnight, money in dollars and energy in kWh. `aircraft`, `from` and `to` are positions in
        `Scenario.aircraft` and `Scenario.vertiports`. A hold goes from a vertiport to itself. Only days
        that charge as needed have columns `charge_kwh`, at the decision, and `takeoff`.
        """
    def to_pandas(self) -> pd.DataFrame:
        """The columns as a pandas `DataFrame`."""
    def to_polars(self) -> pl.DataFrame:
        """The columns as a polars `DataFrame`."""
    def __len__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Training:
    """The result of a training run: the model, the learning curve, and whether the run is complete."""
    @property
    def model(self) -> Model:
        """The weights. After PPO, these are the weights that did best on the validation days; after
        imitation, the last ones.
        """
    @property
    def is_done(self) -> bool:
        """Whether the run has completed all the training that was requested."""
    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The learning curve as numpy arrays, with the same names as in its CSV file. Entries are NaN
        where nothing was measured.
        """
    def to_pandas(self) -> pd.DataFrame:
        """The learning curve as a pandas `DataFrame`."""
    def to_polars(self) -> pl.DataFrame:
        """The learning curve as a polars `DataFrame`."""

@final
class Played:
    """A day that was played to its end."""
    def plot(self) -> Picture:
        """The trace as a picture."""
    def _repr_svg_(self) -> str: ...
    @staticmethod
    def of_trace(trace: Trace) -> Played:
        """Restores a pickled object by replaying a trace of a whole day."""
    @property
    def profit_usd(self) -> float:
        """Profit of the day, dollars."""
    @property
    def summary(self) -> dict[str, Any]:
        """The results of the day, as `vertifleet simulate --json` prints them, in dollars, kWh and counts."""
    @property
    def trace(self) -> Trace:
        """The trace with every decision of the day."""

@final
class Bound:
    """A proven upper bound on the profit of every schedule of a day."""
    @staticmethod
    def of_numbers(
        scenario: Scenario,
        step: int,
        upper_bound_usd: float,
        is_final: bool,
        stand_shadow_price_usd: Sequence[float],
        passenger_shadow_price_usd: Sequence[float],
    ) -> Bound:
        """Restores a pickled object."""
    @property
    def scenario(self) -> Scenario:
        """The day."""
    @property
    def upper_bound_usd(self) -> float:
        """The upper bound, dollars. No schedule of the day earns more."""
    @property
    def is_final(self) -> bool:
        """Whether the search for the bound is complete. If not, a longer search may find a lower bound."""
    @property
    def step(self) -> int:
        """Longest interval, in minutes, for which the prices of the bound stay the same. This may be more
        than requested, if longer slices prove a lower bound.
        """
    @property
    def stand_shadow_price_usd(self) -> _Float:
        """Shadow price of one more stand all day, dollars [vertiports]. With one more stand, no schedule
        earns more than the bound plus this price.
        """
    @property
    def passenger_shadow_price_usd(self) -> _Float:
        """Shadow price of one more passenger, dollars [periods, vertiports, vertiports]. With one more
        passenger, no schedule earns more than the bound plus this price.
        """
    def gap(self, profit_usd: float) -> float:
        """The gap: the distance of a profit below the bound, as a share of the bound. Both are taken
        before the costs of aircraft and sites, which no decision changes.
        """

@final
class Plan:
    """A schedule for a day that is known."""
    @staticmethod
    def of_parts(
        trace: Trace,
        profit_usd: float,
        best_policy: str,
        best_policy_usd: float,
        steps: int,
        bound: Bound | None,
    ) -> Plan:
        """Restores a pickled object."""
    @property
    def trace(self) -> Trace:
        """Every decision of the day."""
    @property
    def profit_usd(self) -> float:
        """Profit of the day, as the simulator computes it, dollars."""
    @property
    def best_policy(self) -> str:
        """Name of the best of the policies that finished the day in time."""
    @property
    def best_policy_usd(self) -> float:
        """Profit of that policy, dollars. The plan never earns less."""
    @property
    def steps(self) -> int:
        """Number of steps of each search."""
    @property
    def bound(self) -> Bound | None:
        """The upper bound of the day, or `None` if the day is too large for a bound or the time was too
        short to prove one.
        """
    @property
    def gap(self) -> float | None:
        """The distance of the plan's profit below the bound, as a share of the bound. The best schedule is
        at most this much better.
        """

@final
class Model:
    """The weights of a learned policy: `gcaps`, `mlp` or `mlp-full` for one number of vertiports, or
    `gcaps-x` or `gcaps-full` for any network. A `Model` never changes.
    """
    @staticmethod
    def read(path: _Path) -> Model:
        """Reads a weight file of any learned policy, which is a safetensors file."""
    @staticmethod
    def from_bytes(bytes: bytes, origin: str = "<bytes>") -> Model:  # noqa: A002
        """Reads the weights from the bytes of a weight file. `origin` is the name of the file in messages."""
    @staticmethod
    def shipped(policy: str = "gcaps-x", network: str = "paper") -> Model:
        """The shipped weights of a policy for a network."""
    def write(self, path: _Path, *, force: bool = False) -> None:
        """Writes the weights as a weight file. An existing file that is read-only or not a weight file is
        replaced only with `force`.
        """
    def to_bytes(self) -> bytes:
        """The weights as the bytes of a weight file."""
    @property
    def sha256(self) -> str:
        """SHA-256 of the weight file in hexadecimal digits, which identifies the weights in result files."""
    @property
    def kind(self) -> Literal["gcaps", "mlp", "gcaps-x", "gcaps-full", "mlp-full"]:
        """The name of the policy: gcaps, mlp, gcaps-x, gcaps-full or mlp-full."""
    @property
    def header(self) -> dict[str, Any]:
        """The header of the weight file, as a dict. It contains the task and the origin of the weights."""
    @property
    def tensors(self) -> dict[str, _Float32]:
        """Copies of the tensors by name."""
    def forward(
        self,
        nodes: ArrayLike,
        aircraft: ArrayLike,
        mask: ArrayLike,
        clock: ArrayLike,
        edges: ArrayLike | None = None,
    ) -> tuple[_Float32, _Float32]:
        """The logits [B, N], minus infinity where the mask is 0, and the values [B] of a batch of
        decisions, as the policy in Rust computes them. The inputs `nodes` [B, N * F] or [B, N, F],
        `aircraft` [B, G], `mask` [B, N] and `clock` [B] or [B, 1], which is the share of the day that
        is left, are the same as in the observations of the vector environment. `edges` [B, N, N] or [B,
        N * N] are the weights of edges, if the weights' graph has observed ones. For gcaps-x this is
        the output of the layers alone, without the day's prices.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Comparison:
    """The results of many policies on the same days: one row for each policy and day, and statistics."""
    def _repr_html_(self) -> str: ...
    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """A row for each policy and day, as a dict of numpy arrays, one for each column, in dollars, kWh
        and counts. `upper_bound_usd` and `bound_share` are present only if bounds were requested.
        """
    @property
    def summary(self) -> dict[str, Any]:
        """The statistics, as `vertifleet compare --json` prints them: means with confidence intervals,
        paired tests, times per decision.
        """
    def to_pandas(self) -> pd.DataFrame:
        """The rows as a pandas `DataFrame`."""
    def to_polars(self) -> pl.DataFrame:
        """The rows as a polars `DataFrame`."""
    @property
    def warnings(self) -> list[str]:
        """Warnings about what is allowed but probably not intended, such as shipped weights on a changed
        copy of their network.
        """
    def report(self, folder: _Path, *, force: bool = False) -> Path:
        """Writes a table, figures and a report page into a folder, and returns the path of the page. An
        earlier report in the folder is replaced, but a read-only one only with `force`. A folder that
        holds anything else is refused, or, with `force`, kept under another name.
        """
    @staticmethod
    def join(parts: Sequence[Comparison]) -> Comparison:
        """Joins comparisons of the same policies into one. Each part must begin with the day after the
        last day of the part before it. Each time per decision in the result is the highest one among
        the parts.
        """
    @staticmethod
    def from_json(text: str, warnings: Sequence[str] = ...) -> Comparison:
        """Restores a comparison from the text that `pickle` keeps."""

@final
class Picture:
    """A picture. Notebooks show it; `save` writes it."""
    @property
    def svg(self) -> str:
        """The picture as SVG."""
    def png(self) -> bytes:
        """The picture as PNG, twice as large."""
    def save(self, path: _Path) -> None:
        """Writes the picture into a file, whose name ends in `.svg` or `.png`. An existing file is
        replaced.
        """
    def _repr_svg_(self) -> str: ...

@final
class Evaluation:
    """The results of policies on one or more suites: shares of the certified bounds, and one row for each
    suite, policy and day.
    """
    def _repr_html_(self) -> str: ...
    @property
    def bound_share(self) -> dict[str, dict[str, float]]:
        """The mean share of the certified bound, by suite and policy."""
    @property
    def summary(self) -> dict[str, Any]:
        """The statistics, as `vertifleet evaluate --json` prints them."""
    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """A row for each suite, policy and day, as a dict of numpy arrays, one for each column, in
        dollars, kWh and counts.
        """
    def to_pandas(self) -> pd.DataFrame:
        """The rows as a pandas `DataFrame`."""
    def to_polars(self) -> pl.DataFrame:
        """The rows as a polars `DataFrame`."""
    @property
    def warnings(self) -> list[str]:
        """Warnings about what is allowed but probably not intended, such as a policy that cannot play a
        suite.
        """
    def save(
        self,
        folder: _Path,
        *,
        about: Mapping[str, str] = ...,
        runs: Mapping[str, tuple[str, int | None]] = ...,
        force: bool = False,
    ) -> list[Path]:
        """Writes a result file for each suite and policy into a folder, and returns their paths. `about`
        is what you say about the policy, as ``{"training": "none"}``; the protocol lists what is
        expected. `runs` names the training run that a policy is, for `board`, as ``{"mine-2": ("mine",
        2)}``: its method and its seed, which may be None where weights of Vertifleet state it. An
        existing file that is read-only or not a result is replaced only with `force`.
        """

def evaluate(
    suite: Sequence[str],
    policies: Sequence[str],
    models: Mapping[str, Any],
    *,
    threads: SupportsIndex | None,
    command: str,
) -> Evaluation:
    """Plays a suite with policies; the others are measured against the first."""

@final
class Board:
    """The methods behind result files, suite by suite: by what they see, then by share of the certified
    bound, with intervals over training runs and days.
    """
    def _repr_html_(self) -> str: ...
    @property
    def summary(self) -> dict[str, Any]:
        """All numbers, as `vertifleet board --json` prints them."""
    def report(self, folder: _Path, *, force: bool = False) -> Path:
        """Writes a page with tables and figures, and the same page in Markdown, into a folder, and returns
        the path of the page. An earlier report in the folder is replaced, but a read-only one only with
        `force`. A folder that holds anything else is refused, or, with `force`, kept under another
        name.
        """

def board(paths: Sequence[_Path], command: str) -> Board:
    """Reads and verifies result files; `command` is the call that reports show."""

def verify(path: _Path) -> dict[str, Any]:
    """Verifies a result file, and returns what was found as plain data."""

def suite_names() -> list[str]:
    """The names of all suites."""

def find_suite(name: str) -> tuple[str, str | None, list[Scenario], list[float], int]:
    """A suite: its description, its network if it has one, its days, their bounds in dollars, and the
    minutes of the bounds' slices.
    """

@final
class Days:
    """The source of days: given networks, or a new network for each day. Every number names a day."""
    def __new__(cls, source: str | Sequence[Network], split: str) -> Days: ...
    @staticmethod
    def are_drawn(name: str) -> bool:
        """Whether a name stands for a source that draws a new network for each day."""
    @property
    def sizes(self) -> tuple[int, int, int, int]:
        """Largest numbers of vertiports, aircraft, types and periods of a day."""
    @property
    def are_of_one_size(self) -> bool:
        """Whether all days have the same vertiports, aircraft, types and periods."""
    @property
    def count(self) -> int:
        """Number of days; their numbers are below it."""

@final
class Layout:
    """The parts of an observation in one row of numbers."""
    def __new__(cls, parts: Sequence[str], sizes: tuple[int, int, int, int]) -> Layout: ...
    @staticmethod
    def preset(name: str) -> list[str] | None:
        """The parts of a preset by name, or `None` if there is no such preset."""
    @property
    def parts(self) -> list[tuple[str, int, list[int], float, float]]:
        """Name, position of the first number, shape, and least and greatest number of each part."""
    @property
    def width(self) -> int:
        """Number of numbers in a row."""
    @property
    def shows_present_only(self) -> bool:
        """Whether all parts describe the present alone, without forecasts or announcements."""

@final
class View:
    """A decision, and the policy's view of the day at that moment."""
    def array(self, name: str) -> _Float32:
        """The array of a part in its unit, read-only; it belongs to the caller."""
    def observe(self, layout: Layout) -> _Shown:
        """The numbers of an observation, and its mask."""
    @property
    def aircraft(self) -> int:
        """Position of the aircraft that decides, or, when the day is over, of the aircraft that decided
        last.
        """
    @property
    def aircraft_type(self) -> int:
        """Position of that aircraft's type."""
    @property
    def place(self) -> int:
        """Position of the vertiport where that aircraft stands."""
    @property
    def seats(self) -> int:
        """Number of seats of that aircraft."""
    @property
    def charge_kwh(self) -> float:
        """What the battery of that aircraft holds, kWh; its capacity on a day that charges to full."""
    @property
    def index(self) -> int:
        """Number of decisions taken before this one today."""
    @property
    def time_s(self) -> int:
        """Time of the decision, seconds since midnight."""
    @property
    def day_start_s(self) -> int:
        """Start of operations, seconds since midnight."""
    @property
    def day_end_s(self) -> int:
        """The last instant at which decisions are taken, seconds since midnight."""
    @property
    def period_starts_s(self) -> list[int]:
        """Start of each demand period, seconds since midnight."""
    @property
    def hold_s(self) -> int:
        """Duration of a hold, seconds."""
    @property
    def passenger_wait_s(self) -> int:
        """Seconds for which passengers who were not carried wait into the next demand period."""
    @property
    def fixed_cost_usd(self) -> float:
        """The fixed cost of the day, dollars: that of its fleet, stands and chargers."""
    @property
    def charges_as_needed(self) -> bool:
        """Whether aircraft decide before they are full."""
    @property
    def known_closures(self) -> list[tuple[int, int, int, int]]:
        """The times of known closures over the whole day: origin, destination, and the seconds since
        midnight at which each begins and ends.
        """
    @property
    def types(
        self,
    ) -> list[
        tuple[
            str,
            int,
            float,
            float,
            float,
            float,
            float,
            float,
            int,
            list[tuple[float, float]] | None,
        ]
    ]:
        """The properties of each type of aircraft: name, seats, speed, battery, energy a mile, charging
        power, self-discharge an hour, reserve, turnaround, and the points of its curve.
        """
    @property
    def period(self) -> int:
        """Position of the demand period."""
    @property
    def is_over(self) -> bool:
        """Whether the day is over."""
    @property
    def vertiports(self) -> int:
        """Number of vertiports."""
    @property
    def fleet_places(self) -> list[int]:
        """Position of the vertiport where each aircraft stands or will land."""
    @property
    def fleet_types(self) -> list[int]:
        """Position of the type of each aircraft."""

@final
class Policy:
    """One of the program's policies, which can be called for any decision:
    `vertifleet.policy("rolling").values(env.view)`.

    Called for the decisions of a day in order, it keeps the day's bid prices as in play, so it makes the
    choices of `vertifleet simulate`.
    """
    @property
    def name(self) -> str:
        """The policy's name."""
    @property
    def sees(self) -> str:
        """The information that it uses: "present", "forecast" or "whole day"."""
    def choose(self, view: View) -> int:
        """The position of the vertiport that it chooses."""
    def values(self, view: View) -> _Float:
        """The values by which it compares choices, the higher the better; NaN for a choice that it does
        not consider [N].
        """

def find_policy(name: str, network: str, seed: SupportsIndex, model: _Path | Model | None) -> Policy:
    """Finds a policy by its name, as `simulate` does. `network` is the name of the network whose shipped
    weights are used, `seed` that of the random policy, and `model` a weight file or a `Model`.
    """

@final
class Environment:
    """Plays one day at a time. It can be copied and pickled in the middle of a day."""
    def __new__(cls, days: Days, layout: Layout, reward: str) -> Environment: ...
    @staticmethod
    def resumed(
        days: Days,
        layout: Layout,
        reward: str,
        number: int | None,
        scenario: Scenario | None,
        choices: Sequence[int],
    ) -> Environment:
        """Restores a pickled environment: begins its day again and repeats its choices."""
    def reset(self, number: int) -> _Shown:
        """Begins the day with this number, and returns the observation of its first decision."""
    def begin(self, day: Scenario) -> _Shown:
        """Begins a given day, and returns the observation of its first decision."""
    def __copy__(self) -> Environment: ...
    def __deepcopy__(self, _memo: Any) -> Environment: ...
    def observe(self, aircraft: int) -> _Shown:
        """The observation of an aircraft at the current time. For an aircraft that does not decide now,
        only hold is feasible.
        """
    def step(self, action: int) -> tuple[_Shown, float, bool, bool]:
        """Takes the current decision. Returns the observation of the next one, the reward, whether the day
        is over, and whether the action was infeasible.
        """
    def frame(self) -> NDArray[np.uint8] | None:
        """A map of the fleet: [height, width, 3], 0 to 255. None before the first day."""
    def text(self) -> str | None:
        """A table of the fleet as text. None before the first day."""
    def mask(self) -> NDArray[np.bool_]:
        """The feasible actions, as booleans [N]. Before the first day all of them are false."""
    @property
    def view(self) -> View | None:
        """The view of the current decision."""
    @property
    def outcome(self) -> Any:
        """The outcome of the latest choice."""
    @property
    def aircraft(self) -> int | None:
        """Position of the aircraft that decides, or, when the day is over, of the aircraft that decided
        last.
        """
    @property
    def time_s(self) -> int | None:
        """The current time, seconds since midnight."""
    @property
    def scenario(self) -> Scenario | None:
        """The day that is being played."""
    @property
    def summary(self) -> dict[str, Any] | None:
        """The results of the day so far, as `vertifleet simulate --json` prints them."""

@final
class Batch:
    """Many days in parallel."""
    def __new__(
        cls,
        days: Days,
        layout: Layout,
        reward: str,
        slots: SupportsIndex,
        autoreset: str,
        threads: SupportsIndex | None = None,
    ) -> Batch: ...
    def arrays(self) -> list[tuple[NDArray[Any], ...]]:
        """The arrays of the three sets of observations, of the final observations, and of the latest
        outcomes.
        """
    def reset(
        self,
        which: NDArray[np.bool_],
        numbers: NDArray[np.uint64],
        scenarios: Sequence[Scenario] | None,
    ) -> int:
        """Begins a day at each slot for which `which` is true: the day with the slot's number in
        `numbers`, or its scenario if these are given. Writes the observations of all slots, and returns
        the index of their set.
        """
    def step(self, actions: NDArray[np.int64], numbers: NDArray[np.uint64]) -> tuple[int, bool]:
        """Takes one decision at every slot. Where a new day is due, the day with the slot's number in
        `numbers` begins. Returns the index of the set of the observations, and whether any day is over
        or has begun.
        """
    def scenario(self, slot: int) -> Scenario | None:
        """The day that is being played at a slot."""
    def view(self, slot: int) -> View | None:
        """The view of the current decision of a slot."""
    def outcome(self, slot: int) -> Any:
        """The outcome of the latest step's choice at a slot; `None` if the step began a day there instead."""
    def summary(self, slot: int) -> dict[str, Any] | None:
        """The results of the day that the latest step ended at a slot, as `vertifleet simulate --json`
        prints them, or `None` if it ended no day there.
        """

def simulate(
    scenario: Scenario,
    policy: object = "greedy",
    *,
    seed: SupportsIndex = 0,
    model: _Path | Model | None = None,
    network: Network | None = None,
) -> Played:
    """Plays a day to its end with a policy. The policy is one of the following: a name as in `vertifleet
    simulate`, with `seed` for the random policy and `model` for a weight file or a `Model` to use
    instead of the shipped weights; a `Model`; a `Trace` of this day, which is replayed; or a function
    as for `compare`, which observes the day as in the environment of `network`.
    """

def bound(scenario: Scenario, *, step: SupportsIndex = 5, levels: SupportsIndex = 64) -> Bound:
    """Proves an upper bound on the profit of every schedule of a day. `step` is the length of the bound's
    slices in minutes, 1 to 60, and `levels` the number of levels of charge on days that charge as
    needed, 4 to 64. Shorter slices and more levels never give a looser bound, but take longer.
    """

def plan(
    scenario: Scenario,
    *,
    time_limit: float | None = None,
    steps: SupportsIndex | None = None,
    gap: float | None = None,
    seed: SupportsIndex = 0,
    threads: SupportsIndex | None = None,
) -> Plan:
    """Searches for a good schedule of a known day, and proves an upper bound of the day at the same time.

    The search takes `time_limit` seconds, 60 by default, or `steps` steps in each search if `steps` is
    given; the plan then depends only on the day, `seed`, `steps` and `threads`. It ends early when the gap
    to the bound is at most `gap`, for example 0.03. The bound is the best one that is proven when the time
    is over. With `steps`, the call waits for the whole proof.
    """

def check(scenario: Scenario, trace: Trace) -> dict[str, Any]:
    """Checks a schedule against the rules, independently of the simulator. Returns the report as a dict:
    `valid`, `totals` (the results of the day, computed again), `broken` (how often each rule is broken)
    and `findings` (where it is broken). A schedule of another day is matched by the ids of its
    vertiports and aircraft, like a file.
    """

def check_comparison(network: Network | None, arguments: Mapping[str, Any]) -> list[str]:
    """Checks everything about a comparison that can be checked before its days are played, and returns the
    warnings.
    """

def compare(
    network: Network | None,
    arguments: Mapping[str, Any],
    *,
    threads: SupportsIndex | None,
    command: str,
) -> Comparison:
    """Plays days with every policy; all policies play the same days. A policy that is a function sees the
    caller's own days as days of `network`. `command` is the command that the report says it was made
    with. The `warnings` of the result name what is allowed but probably not intended.
    """

def record(
    days: Days,
    layout: Layout,
    policy: str,
    source: Any,
    network: Network | None,
    *,
    first: SupportsIndex,
    number: SupportsIndex,
    values: bool,
    seed: SupportsIndex,
    threads: SupportsIndex | None,
) -> dict[str, Any]:
    """Plays the days with these numbers, and returns a dict: `days` (names), `decisions` (number of each
    day), `rows` [D, W], `mask` [D, N], `action` [D], `reward` [D] (each flight's share of the day's
    reward), and `values` [D, N] if they are requested. `policy` is a name, or with `source` the name of
    a model or of a policy of the caller, which observes the days as days of `network`.
    """

def read_days(paths: Sequence[_Path]) -> tuple[list[Scenario], str]:
    """Reads the scenario files for a comparison, and returns the days and a text that says where they came
    from. A folder stands for all files in it whose names end in `.json`.
    """

@final
class Sweep:
    """The cells of a sweep, and the results of those that are finished. The values of a path in `changes`
    are a list, or a text as the program's `--vary` takes it. With `latin`, this many cells are drawn
    with the seed of the days; otherwise every combination is one. Finished cells are kept in the file
    `journal`, and those that it holds are not played again.
    """
    def __new__(
        cls,
        network: Network,
        changes: Mapping[str, Any],
        arguments: Mapping[str, Any],
        latin: SupportsIndex | None = None,
        journal: _Path | None = None,
    ) -> Sweep: ...
    def cells(self) -> list[tuple[dict[str, Any], str | None]]:
        """What is changed in each cell, and the reason if it is left out."""
    def network(self, cell: int) -> Network:
        """The network of a cell that is not left out."""
    @property
    def warnings(self) -> list[str]:
        """Warnings about what is allowed but probably not intended, each once."""
    def missing(self) -> list[int]:
        """The numbers of the cells that are still to be played."""
    def run(self, *, threads: SupportsIndex | None) -> None:
        """Plays the cells that are missing."""
    def add(self, cell: int, comparison: Comparison) -> None:
        """Adds a cell that was played elsewhere."""
    def comparisons(self, commands: Sequence[str]) -> list[Comparison | None]:
        """The comparison in each cell, which records its command; None for a cell that is not finished."""
    def report(self, folder: _Path, *, force: bool, command: str) -> Path:
        """Writes tables, figures and a report page of the finished cells into a folder, and returns the
        path of the page.
        """
    def __getnewargs__(self) -> tuple[Network, dict[str, Any], dict[str, Any], int | None]: ...
    def __getstate__(self) -> str: ...
    def __setstate__(self, finished: str, /) -> None: ...

def settings(preset: str = "default", **changes: Any) -> dict[str, Any]:
    """The settings of a training preset of `gcaps` and `mlp` as a dict: `default`, `paper` (Table 2),
    `imitation` or `evolution`. Settings can be changed: `settings("paper", ent_coef=0.4)`. Changed
    settings are checked in the same way as by `vertifleet train --set`.
    """

def train(
    network: str | Network,
    policy: str,
    *,
    out: _Path,
    preset: str = "default",
    settings: Mapping[str, Any] | None = None,
    seed: SupportsIndex | None = None,
    begin_with: Model | _Path | None = None,
    resume: bool = False,
    force: bool = False,
    threads: SupportsIndex | None = None,
    watch: Callable[[dict[str, Any]], object] | None = None,
) -> Training:
    """Trains a policy on a network, or on networks drawn for each day. Ctrl-C ends the run with a
    checkpoint, from which `resume` continues it.
    """
