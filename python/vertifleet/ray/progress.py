"""A line on the terminal that shows the progress of a long call."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import TracebackType

PATIENCE_S = 2.0
"""Calls that take less than this, in seconds, show no progress."""
CLEAR = "\r\x1b[K"


class Progress:
    """Shows days done and time left while a block runs, if standard error is a terminal.

    Args:
        days: total number of days.
    """

    def __init__(self, days: int) -> None:
        self.days = days
        self.begun = time.monotonic()
        self.shown = False

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.shown:
            print(CLEAR, end="", file=sys.stderr, flush=True)

    def show(self, done: int) -> None:
        """Shows that this many days are done."""
        elapsed_s = time.monotonic() - self.begun
        if elapsed_s < PATIENCE_S or not sys.stderr.isatty():
            return
        left = f", {_duration(elapsed_s * (self.days - done) / done)} left" if done else ""
        print(f"{CLEAR}{done:,} of {self.days:,} days{left}", end="", file=sys.stderr, flush=True)
        self.shown = True


def _duration(seconds: float) -> str:
    """A duration such as `40 s`, `12 min` or `3 h 05 min`."""
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60:02} min"
