"""Writes the client without asyncio (client/_sync) from the one for asyncio (client/_async).

Run it with python/.venv/bin/python whenever a file of python/vertifleet/client/_async has changed. The two
differ only in words: the script drops every ``await``, and replaces names by their counterparts. So each
method is written, typed and documented once.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

CLIENT = Path(__file__).resolve().parent.parent / "vertifleet/client"
NOTE = "# Written from ../_async/{name} by python/tools/client_sync.py: do not edit.\n"

WORDS = {
    r"\basync (def|with|for)\b": r"\1",
    r"\bawait ": "",
    r"\bAsyncGenerator\[(.+), None\]": r"Generator[\1, None, None]",
    r"\bAsync([A-Z]\w+)": r"\1",
    r"\b__a(enter|exit)__\b": r"__\1__",
    r"\ba(closing|close|read|iter_bytes)\b": r"\1",
    r"\b_async\b": "_sync",
    r"\basyncio\.sleep\b": "clock.sleep",
    r"\bimport asyncio\b": "import time as clock",
    r"The client for asyncio\..*": 'The client that waits for every answer."""',
}
"""Patterns, and their replacements."""


def counterpart(path: Path) -> str:
    """The file without asyncio for one with it."""
    source = path.read_text(encoding="utf-8")
    for pattern, word in WORDS.items():
        source = re.sub(pattern, word, source)
    written = CLIENT / "_sync" / path.name
    for command in (["check", "--fix", "--quiet", "--select", "I"], ["format"]):
        ruff = [sys.executable, "-m", "ruff", *command, "--stdin-filename", str(written), "-"]
        done = subprocess.run(ruff, input=source, capture_output=True, text=True, check=True)
        source = done.stdout
    return NOTE.format(name=path.name) + source


def main() -> None:
    """Writes the files, or with --check compares them with the generated ones."""
    for path in sorted((CLIENT / "_async").glob("*.py")):
        written = CLIENT / "_sync" / path.name
        source = counterpart(path)
        if "--check" not in sys.argv:
            written.parent.mkdir(exist_ok=True)
            written.write_text(source, encoding="utf-8")
        elif not written.exists() or written.read_text(encoding="utf-8") != source:
            sys.exit("run python/tools/client_sync.py")


if __name__ == "__main__":
    main()
