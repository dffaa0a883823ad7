"""The frames of environments, and the pictures of days and traces."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import vertifleet
from vertifleet import Network, Scenario
from vertifleet.pettingzoo import FleetAEC


def test_frames_show_the_fleet_and_change_with_it(paper: Network) -> None:
    env = gymnasium.make("vertifleet/Fleet-v0", network=paper, render_mode="rgb_array")
    env.reset(seed=1)
    frames = [env.render()]
    for _ in range(40):
        mask = env.unwrapped.action_masks()  # type: ignore[attr-defined]
        env.step(np.flatnonzero(mask)[0])
        frames.append(env.render())
    assert all(frame.shape == (480, 640, 3) and frame.dtype == np.uint8 for frame in frames)
    assert not np.array_equal(frames[0], frames[-1])
    again = gymnasium.make("vertifleet/Fleet-v0", network=paper, render_mode="rgb_array")
    again.reset(seed=1)
    assert np.array_equal(again.render(), frames[0])


def test_a_finished_day_can_still_be_rendered(day: Scenario) -> None:
    env = vertifleet.envs.FleetEnv(render_mode="ansi")
    env.reset(options={"scenario": day})
    assert "> V" in env.render()
    over = False
    while not over:
        _, _, over, _, info = env.step(int(np.flatnonzero(env.action_masks())[-1]))
    assert "> V" not in env.render()
    assert f"{info['summary']['passengers']:,} passengers" in env.render()


def test_rendering_is_asked_for_by_name(paper: Network) -> None:
    with pytest.raises(vertifleet.Error, match="rgb_array"):
        vertifleet.envs.FleetEnv(render_mode="human")  # type: ignore[arg-type]
    env = vertifleet.envs.FleetEnv(render_mode="rgb_array")
    with pytest.raises(vertifleet.Error, match="reset first"):
        env.render()
    assert vertifleet.envs.FleetEnv().render() is None
    agents = FleetAEC(paper, render_mode="ansi")
    agents.reset(seed=1)
    assert "waiting" in agents.render()


def test_days_and_traces_are_pictures(day: Scenario, tmp_path: Path) -> None:
    played = vertifleet.simulate(day, "greedy")
    for shown in (day, played, played.trace):
        picture = shown.plot()
        assert ET.fromstring(picture.svg).tag.endswith("svg")
        assert shown._repr_svg_() == picture.svg == picture._repr_svg_()
    picture.save(tmp_path / "trace.svg")
    picture.save(tmp_path / "trace.png")
    assert (tmp_path / "trace.svg").read_text() == picture.svg
    assert (tmp_path / "trace.png").read_bytes() == picture.png()
    assert picture.png().startswith(b"\x89PNG")


def test_results_are_tables_in_notebooks(paper: Network) -> None:
    compared = vertifleet.compare(paper, ["greedy", "random"], days=3)
    evaluated = vertifleet.evaluate("greedy")
    swept = vertifleet.sweep(paper, {"fleet.0.count": [30, 40]}, ["greedy"], days=3)
    for result in (compared, evaluated, swept):
        html = result._repr_html_()
        assert html.count("<table>") >= 1
        assert "greedy" in html
        ET.fromstring(f"<div>{html}</div>")
