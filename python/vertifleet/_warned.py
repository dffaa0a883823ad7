"""Warnings that many calls would repeat, gathered so that each is said once."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def gathered() -> Iterator[list[str]]:
    """Says no warning: what it gives has the text of each, once, when the block ends."""
    texts: list[str] = []
    with warnings.catch_warnings(record=True) as records:
        warnings.simplefilter("always")
        yield texts
    texts.extend(dict.fromkeys(str(record.message) for record in records))
