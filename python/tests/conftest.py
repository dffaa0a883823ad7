"""What the tests share."""

from __future__ import annotations

import pytest

import vertifleet


@pytest.fixture(scope="session")
def paper() -> vertifleet.Network:
    return vertifleet.Network("paper")


@pytest.fixture(scope="session")
def day(paper: vertifleet.Network) -> vertifleet.Scenario:
    return paper.draw(1)
