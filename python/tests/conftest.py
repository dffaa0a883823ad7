"""What the tests share."""

from __future__ import annotations

import signal

import pytest

import vertifleet


def pytest_configure() -> None:
    # Tests of Ctrl-C need it heard, also where this process was told to ignore it, as the
    # background of a script is. What is heard here
    # is not ignored by processes that tests start.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def paper() -> vertifleet.Network:
    return vertifleet.Network("paper")


@pytest.fixture(scope="session")
def day(paper: vertifleet.Network) -> vertifleet.Scenario:
    return paper.draw(1)
