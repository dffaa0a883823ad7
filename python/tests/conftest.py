"""Common fixtures of the tests."""

from __future__ import annotations

import signal

import pytest

import vertifleet


def pytest_configure() -> None:
    # Tests of Ctrl-C need a handler, even if this process was started with SIGINT ignored, as in
    # the background of a script. Processes that tests start inherit an ignored signal, but not a
    # handled one.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def paper() -> vertifleet.Network:
    return vertifleet.Network("paper")


@pytest.fixture(scope="session")
def day(paper: vertifleet.Network) -> vertifleet.Scenario:
    return paper.draw(1)
