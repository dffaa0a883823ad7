#!/usr/bin/env python3
"""Refuses words that hide who acts. Sentences name the simulator, the service, the user or the caller.

Checks every file of the repository that people read, but for vendored, generated and binary ones.
"""

import re
import subprocess
import sys
from pathlib import Path

BANNED = re.compile(r"\b(whoever|somebody|everybody|nobody)\b", re.IGNORECASE)
SUFFIXES = {".rs", ".py", ".pyi", ".md", ".ts", ".svelte", ".ipynb", ""}
LEFT_OUT = ("web/dist/", "docs/src/images/", "LICENSE", "python/tools/words.py")


def main() -> int:
    """Prints the lines with such words; 1 if there are any."""
    ls_files = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(ls_files, capture_output=True, text=True, check=True).stdout.splitlines()
    found = 0
    for name in names:
        path = Path(name)
        if name.startswith(LEFT_OUT) or path.suffix not in SUFFIXES or not path.is_file():
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            if word := BANNED.search(line):
                print(f"{name}:{number}: {word.group()}: name who acts", file=sys.stderr)
                found += 1
    return int(found > 0)


if __name__ == "__main__":
    sys.exit(main())
