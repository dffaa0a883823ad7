"""Runs every example of the package's pages."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PAGES = [
    "README.md",
    "docs/src/guide/python.md",
    "docs/src/guide/cluster.md",
    "docs/src/reference/protocol.md",
    "docs/src/reference/observations.md",
    "python/README.md",
]
EXAMPLES = [
    (page, number, code)
    for page in PAGES
    for number, code in enumerate(
        re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(encoding="utf-8"), re.M | re.S)
    )
]


def test_the_pages_have_examples() -> None:
    assert {page for page, _, _ in EXAMPLES} == set(PAGES)


@pytest.mark.parametrize(("page", "number", "code"), EXAMPLES, ids=[f"{p}-{n}" for p, n, _ in EXAMPLES])
def test_an_example_runs(page: str, number: int, code: str, tmp_path: Path) -> None:
    for needed in ("torch", "pandas", "ray"):
        if needed in code:
            pytest.importorskip(needed)
    file = tmp_path / f"{Path(page).stem}_{number}.py"
    file.write_text(code, encoding="utf-8")
    command = [sys.executable, file.name]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "nan" not in done.stdout.lower().split(), "an example shows a number"
