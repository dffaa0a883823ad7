"""Datasets for learning: a policy's decisions with its observations, recorded and stored as Parquet."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np
from numpy.typing import NDArray

from vertifleet import _native
from vertifleet._compare import Split
from vertifleet._errors import Error
from vertifleet.envs.days import NetworksChoice, days_of
from vertifleet.envs.observing import ObservationChoice, Observing

if TYPE_CHECKING:
    import pyarrow as pa

    from vertifleet._compare import PolicySource

FORMAT = "vertifleet-dataset/1"
OBSERVATION = "observation."
"""The prefix of the observations' columns in a file."""


@dataclass(frozen=True, eq=False, repr=False)
class Dataset:
    """Decisions in the order in which they were taken, day after day. All arrays have one entry for each."""

    observation: dict[str, NDArray[np.float32]]
    """The parts of the observation, by name [decisions, ...]."""
    action: NDArray[np.int64]
    """The vertiport that was chosen."""
    reward: NDArray[np.float64]
    """The flight's share of the day's reward (``reward="dense"``)."""
    over: NDArray[np.bool_]
    """Whether the decision was the last one of its day."""
    day: NDArray[np.str_]
    """The name of the day."""
    values: NDArray[np.float64] | None = None
    """The values by which the policy compared choices, NaN for those that it did not consider [decisions, N].

    "rolling" may choose another than the highest, if its trials found a better one; "random" and your
    policies have none."""

    def __len__(self) -> int:
        return len(self.action)

    def __repr__(self) -> str:
        parts = ", ".join(self.observation)
        return f"<Dataset: {len(self)} decisions of {int(self.over.sum())} days; observation: {parts}>"

    def days(self) -> Iterator[slice]:
        """The decisions of each day."""
        begin = 0
        for last in np.flatnonzero(self.over):
            yield slice(begin, int(last) + 1)
            begin = int(last) + 1

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a Parquet file, whose columns are named as the attributes here.

        An array with several numbers for each decision is a column of lists; the file's metadata contains its
        shape. Needs PyArrow: ``pip install vertifleet[data]``. An existing file is replaced.
        """
        import pyarrow as pa
        import pyarrow.parquet as pq

        columns: dict[str, NDArray[Any]] = {
            OBSERVATION + name: part for name, part in self.observation.items()
        }
        columns |= {"action": self.action, "reward": self.reward, "over": self.over, "day": self.day}
        if self.values is not None:
            columns["values"] = self.values
        shapes = {name: column.shape[1:] for name, column in columns.items()}
        metadata = {"vertifleet": json.dumps({"format": FORMAT, "shapes": shapes})}
        table = pa.table({name: _listed(column) for name, column in columns.items()}).replace_schema_metadata(
            metadata
        )
        part = Path(f"{os.fspath(path)}.part")
        pq.write_table(table, part, compression="zstd")
        part.replace(path)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Dataset:
        """Reads a file that `write` wrote. Needs PyArrow: ``pip install vertifleet[data]``.

        Raises:
            Error: V451 for a Parquet file of another kind.
        """
        import pyarrow.parquet as pq

        table = pq.read_table(path)
        about = json.loads((table.schema.metadata or {}).get(b"vertifleet", b"{}"))
        if about.get("format") != FORMAT:
            raise Error(
                "V451", f"{os.fspath(path)} is not a dataset of vertifleet", "Dataset.write makes one"
            )
        arrays = {
            name: _array(table.column(name).combine_chunks(), tuple(shape))
            for name, shape in about["shapes"].items()
        }
        observation = {
            name.removeprefix(OBSERVATION): arrays.pop(name)
            for name in list(arrays)
            if name.startswith(OBSERVATION)
        }
        return cls(observation, **arrays)


def _listed(column: NDArray[Any]) -> pa.Array:
    import pyarrow as pa

    if column.ndim == 1:
        return pa.array(column.tolist() if column.dtype.kind == "U" else column)
    flat = np.ascontiguousarray(column).reshape(-1)
    return pa.FixedSizeListArray.from_arrays(pa.array(flat), int(np.prod(column.shape[1:])))


def _array(column: pa.Array, shape: tuple[int, ...]) -> NDArray[Any]:
    values = column.flatten() if shape else column
    array: NDArray[Any] = values.to_numpy(zero_copy_only=False)
    array = array.astype(np.str_) if array.dtype == object else array
    return array.reshape(len(column), *shape) if shape else array


def dataset(
    policy: PolicySource | str,
    days: SupportsIndex,
    *,
    network: NetworksChoice = "paper",
    observation: ObservationChoice = "full",
    split: Split = "training",
    first: SupportsIndex = 0,
    values: bool = False,
    seed: SupportsIndex = 0,
    threads: int | None = None,
) -> Dataset:
    """Plays days with a policy, and records every decision with its observation.

    A decision of "full" on ``paper`` takes 6.7 kB, so a thousand days take 2.4 GB of memory: for more, call
    it with other days (`first`) and write a file each time.

    Args:
        policy: a name as in ``vertifleet simulate``, a model, or your policy as in `evaluate`.
        days: number of days.
        network: the source of the days, as in an environment.
        observation: the observation to record: "paper", "full", "gcaps-x", "gcaps-full", or a list of parts.
        split: the purpose of the days: "training", "validation" or "comparison".
        first: number of the first day; other numbers are other days.
        values: whether to record the values by which the policy compares choices, which takes longer.
        seed: seed of the random policy.
        threads: largest number of threads; all cores by default.

    Raises:
        Error: V451 for an `OwnObservation`; otherwise with the program's code for the error.
    """
    drawn, single = days_of(network, split)
    observing = Observing(observation, drawn)
    if observing.own is not None:
        raise Error(
            "V451", "a dataset keeps parts of the program's own observations", 'give "full", or a list'
        )
    name, source = (policy, None) if isinstance(policy, str) else ("policy", policy)
    found = _native.record(
        drawn,
        observing.layout,
        name,
        source,
        single,
        first=first,
        number=days,
        values=values,
        seed=seed,
        threads=threads,
    )
    decisions = np.array(found["decisions"])
    over = np.zeros(decisions.sum(), np.bool_)
    over[decisions.cumsum() - 1] = True
    day = np.repeat(np.array(found["days"]), decisions)
    seen = observing.of_rows(found["rows"])
    return Dataset(seen, found["action"], found["reward"], over, day, found.get("values"))
