"""The shipped networks of cities match their source tables."""

import subprocess
import sys
from pathlib import Path

MAKE = Path(__file__).resolve().parents[2] / "networks/sources/make.py"


def test_the_networks_of_cities_match_their_sources():
    checked = subprocess.run(
        [sys.executable, "-B", MAKE, "--check"], capture_output=True, text=True, check=False
    )
    assert checked.returncode == 0, checked.stderr
