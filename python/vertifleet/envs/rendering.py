"""Renders environments: a map of the fleet as pixels, or a table as text."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias

from vertifleet._errors import Error
from vertifleet._native import Environment

RenderMode: TypeAlias = Literal["rgb_array", "ansi"]

METADATA: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 30}
"""The metadata of an environment about its rendering."""


def mode_of(render_mode: str | None) -> str | None:
    """Checks a render mode."""
    if render_mode is not None and render_mode not in METADATA["render_modes"]:
        known = ", ".join(f'"{mode}"' for mode in METADATA["render_modes"])
        raise Error("V451", f"there is no render_mode {render_mode!r}", f"there are {known}")
    return render_mode


def rendered(environment: Environment, render_mode: str | None) -> Any:
    """The fleet at the current decision: for "rgb_array" a map of 640 by 480 pixels, an array of bytes
    [480, 640, 3], and for "ansi" a text. None without a mode.
    """
    if render_mode is None:
        return None
    shown = environment.frame() if render_mode == "rgb_array" else environment.text()
    if shown is None:
        raise Error("V451", "no day is being played: call reset first")
    return shown
