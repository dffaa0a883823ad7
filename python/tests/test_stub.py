"""Editors show of the extension module what Python's `help` shows."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

STUB_DOCS = Path(__file__).resolve().parents[1] / "tools/stub_docs.py"


def test_the_stub_has_the_docstrings_of_the_extension_module(tmp_path: Path) -> None:
    command = [sys.executable, str(STUB_DOCS), "--check"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
