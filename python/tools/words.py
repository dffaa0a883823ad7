#!/usr/bin/env python3
"""Refuses words that hide who acts. Sentences name the simulator, the service, the user or the caller.

Checks every file of the repository that people read, but for what is built, installed or drawn.
"""

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BANNED = re.compile(r"\b(whoever|somebody|everybody|nobody)\b", re.IGNORECASE)
SUFFIXES = {".rs", ".py", ".pyi", ".md", ".ts", ".svelte", ".ipynb"}
FOLDERS = ["benches", "crates", "docs/src", "fuzz", "networks", "packaging", "python", "scripts", "web"]
LEFT_OUT = {"target", "node_modules", "dist", "images", "test-results", "playwright-report"}


def files() -> Iterator[Path]:
    """The files that are checked."""
    yield from ROOT.glob("*.md")
    for folder in FOLDERS:
        for path, folders, names in os.walk(ROOT / folder):
            folders[:] = [name for name in folders if name not in LEFT_OUT and not name.startswith(".")]
            yield from (Path(path, name) for name in names if Path(name).suffix in SUFFIXES)


def main() -> int:
    """Prints the lines with such words; 1 if there are any."""
    found = 0
    for path in files():
        if path == Path(__file__).resolve():
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            if word := BANNED.search(line):
                print(f"{path.relative_to(ROOT)}:{number}: {word.group()}: name who acts", file=sys.stderr)
                found += 1
    return int(found > 0)


if __name__ == "__main__":
    sys.exit(main())
