"""Long calls release Python for its other threads, and end after Ctrl-C."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import vertifleet

LONG = {
    "compare": "vertifleet.compare(vertifleet.Network('paper'), ['rolling'], days=2000)",
    "function": (
        "vertifleet.compare('paper', ['f'], days=9000, models={'f': lambda o: o['action_mask'].argmax()})"
    ),
    "bounds": "vertifleet.compare(vertifleet.Network('paper'), ['random'], days=500, seed=70000, bound=True)",
    "plans": "vertifleet.compare(vertifleet.Network('paper'), ['plan'], days=20)",
    "days": "vertifleet.compare('paper', ['random'], days=1_000_000)",
    "bound": "vertifleet.bound(vertifleet.Network('random:20').draw(1), step=1)",
    "proof": "vertifleet.plan(vertifleet.Network('random:20').draw(1), steps=1)",
    "simulate": "vertifleet.simulate(vertifleet.Network('new-york').draw(1), 'gcaps-x:rollouts=5')",
    "plan": "vertifleet.plan(vertifleet.Network('paper').draw(1), time_limit=600)",
}


@pytest.mark.parametrize("call", LONG)
def test_ctrl_c_ends_a_long_call(call: str, tmp_path: Path) -> None:
    program = f"import vertifleet\nprint('begun', flush=True)\n{LONG[call]}\nprint('done', flush=True)"
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        # Outside the source tree, which contains no extension module.
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    # Each of the calls would take far longer than this.
    out, errors = process.communicate(timeout=15)
    assert out == ""
    assert "KeyboardInterrupt" in errors
    assert "panicked" not in errors
    assert process.returncode in (1, 130, -signal.SIGINT), "the exception ended the process, not a crash"


def test_where_ctrl_c_is_ignored_a_call_goes_on_to_its_end(tmp_path: Path) -> None:
    program = (
        "import vertifleet\nprint('begun', flush=True)\n"
        "vertifleet.plan(vertifleet.Network('paper').draw(1), time_limit=3)\nprint('done', flush=True)"
    )
    # A shell without job control starts background processes like this: a child inherits an ignored
    # signal.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        command = [sys.executable, "-c", program]
        process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate()
    assert (out, process.returncode) == ("done\n", 0)


@pytest.mark.parametrize(
    ("call", "units"),
    [
        ("vertifleet.plan(vertifleet.Network('paper').draw(1), time_limit=600)", b"% of the time"),
        ("vertifleet.compare('paper', ['greedy', 'plan'], days=20)", b"days of plan (2 of 2 policies)"),
    ],
)
def test_a_terminal_shows_how_far_a_long_call_is(call: str, units: bytes, tmp_path: Path) -> None:
    terminal, end = pty.openpty()
    command = [sys.executable, "-c", f"import vertifleet\n{call}"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=end)
    os.close(end)
    shown = b""
    # If the call ends without a bar, the read fails with an error.
    while units not in shown:
        shown += os.read(terminal, 4096)
    process.kill()
    process.wait()
    os.close(terminal)


def test_other_threads_go_on_meanwhile(day: vertifleet.Scenario) -> None:
    ticks = 0
    stop = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not stop.is_set():
            ticks += 1
            time.sleep(0.001)

    clock = threading.Thread(target=tick)
    clock.start()
    vertifleet.plan(day, time_limit=1.0)
    stop.set()
    clock.join()
    assert ticks > 20, "a call that holds Python's lock would have allowed only a few ticks"
