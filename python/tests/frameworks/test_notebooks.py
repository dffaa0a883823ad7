"""Every notebook runs from beginning to end, and the book shows its current output."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("torch")

ROOT = Path(__file__).resolve().parents[3]
NOTEBOOKS = sorted((ROOT / "python/examples/notebooks").glob("*.ipynb"))


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) == 5


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    client = nbclient.NotebookClient(notebook, timeout=None, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_the_book_shows_the_notebook(path: Path) -> None:
    page = (ROOT / f"docs/src/notebooks/{path.stem}.md").read_text(encoding="utf-8")
    shown = re.findall(r"^```python\n(.*?)\n```", page, re.M | re.S)
    cells = nbformat.read(path, as_version=4).cells
    assert shown == [cell.source for cell in cells if cell.cell_type == "code"], "run `make notebooks`"
    for cell in cells:
        assert cell.cell_type == "code" or cell.source in page, "run `make notebooks`"
