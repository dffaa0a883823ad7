"""Recorded decisions as a PyTorch dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from vertifleet import Dataset


class Decisions(torch.utils.data.Dataset[dict[str, Tensor]]):
    """The decisions of a `vertifleet.Dataset`, as ``torch.utils.data`` expects them.

    An item is a dict with the parts of the observation by their names, "action", "reward", "over", and
    "values" where they were recorded. A list of positions gives many items at once [B, ...], which is how a
    ``DataLoader`` is fast::

        batches = BatchSampler(RandomSampler(decisions), batch_size=256, drop_last=False)
        DataLoader(decisions, sampler=batches, batch_size=None)
    """

    def __init__(self, dataset: Dataset) -> None:
        arrays: dict[str, NDArray[Any]] = dict(dataset.observation)
        arrays |= {"action": dataset.action, "reward": dataset.reward, "over": dataset.over}
        if dataset.values is not None:
            arrays["values"] = dataset.values
        # Arrays that were read from a file are read-only. PyTorch has no such tensors, so they are
        # copied.
        self._tensors = {
            name: torch.as_tensor(np.require(array, requirements=("C_CONTIGUOUS", "WRITEABLE")))
            for name, array in arrays.items()
        }

    def __len__(self) -> int:
        return len(self._tensors["action"])

    def __getitem__(self, positions: int | Sequence[int] | Tensor) -> dict[str, Tensor]:
        return {name: tensor[positions] for name, tensor in self._tensors.items()}
