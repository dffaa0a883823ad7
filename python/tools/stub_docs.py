"""Writes the docstrings of the extension module into _native.pyi, where editors look for them.

Run it with python/.venv/bin/python, after `make python`, whenever a comment of python/src has changed.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

from vertifleet import _native

STUB = Path(__file__).resolve().parent.parent / "vertifleet/_native.pyi"
WIDTH = 110


def docs(thing: Any) -> str:
    """The docstring of a member of the extension module, unless it is the default of every object."""
    text = inspect.getdoc(thing) or ""
    return "" if text == inspect.getdoc(getattr(object, getattr(thing, "__name__", ""), None)) else text


def docstring(text: str, indent: int) -> list[str]:
    """The lines of a docstring, rewrapped."""
    room = WIDTH - indent
    paragraphs = [" ".join(part.split()) for part in text.split("\n\n")]
    wrapped = "\n\n".join(
        textwrap.fill(part, room - (6 if len(paragraphs) == 1 else 3), break_long_words=False)
        for part in paragraphs
    )
    lines = f'"""{wrapped}"""'.split("\n")
    if len(lines) > 1:
        lines[-1:] = [lines[-1].removesuffix('"""'), '"""']
    return [(" " * indent + line).rstrip() for line in lines]


def described(source: str) -> str:
    """The stub with docstrings; existing ones are replaced."""
    lines = source.splitlines()
    edits: list[tuple[int, int, int, str]] = []

    def visit(node: ast.ClassDef | ast.FunctionDef, owner: Any) -> None:
        thing = getattr(owner, node.name, None)
        text = docs(thing)
        body = node.body[0]
        value = (
            body.value.value if isinstance(body, ast.Expr) and isinstance(body.value, ast.Constant) else None
        )
        decorators = [decorator.lineno for decorator in getattr(body, "decorator_list", [])]
        first = min([body.lineno, *decorators])
        last = body.end_lineno if value is ... or isinstance(value, str) else first - 1
        if text and not node.name.startswith("__"):
            edits.append((first, last or first, node.col_offset + 4, text))
        if isinstance(node, ast.ClassDef):
            for member in node.body:
                if isinstance(member, ast.FunctionDef):
                    visit(member, thing)

    for node in ast.parse(source).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            visit(node, _native)
    for first, last, indent, text in sorted(edits, reverse=True):
        header = re.match(r"(.*:) \.\.\.(\s*#.*)?$", lines[first - 1])
        if header and last >= first:
            # The body is on the line of the function's head.
            lines[first - 1 : last] = [header[1] + (header[2] or ""), *docstring(text, indent)]
        else:
            lines[first - 1 : last] = docstring(text, indent)
    return "\n".join(lines) + "\n"


def main() -> None:
    """Writes the stub, or with --check compares it with the generated one."""
    source = STUB.read_text(encoding="utf-8")
    if "--check" in sys.argv:
        sys.exit(0 if described(source) == source else "run python/tools/stub_docs.py")
    STUB.write_text(described(source), encoding="utf-8")


if __name__ == "__main__":
    main()
