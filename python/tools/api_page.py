"""Writes the page of the book on the Python API from the docstrings of the package, which it parses.

Run it with any Python after a change of a docstring or a signature; --check only compares.
"""

from __future__ import annotations

import ast
import inspect
import itertools
import re
import sys
from pathlib import Path

PYTHON = Path(__file__).resolve().parent.parent
PAGE = PYTHON.parent / "docs/src/reference/python.md"
MODULES = (
    "vertifleet",
    "vertifleet.envs",
    "vertifleet.client",
    "vertifleet.pettingzoo",
    "vertifleet.torch",
    "vertifleet.sb3",
    "vertifleet.ray",
    "vertifleet.ray.rllib",
)
HEAD = """# Python API

All public names of the package, from their docstrings. [Python](../guide/python.md) is a guide to them.
The types of `vertifleet.client.types` are those of [the API of the service](api.md).
"""
SECTION = re.compile(r"(Args|Returns|Raises|Yields|Attributes):$")
ITEM = re.compile(r" {4}([\w*`., ]+): (.*)")


def source_of(module: str) -> Path:
    """The file of a module; of the extension module, its stub."""
    path = PYTHON / module.replace(".", "/")
    files = (path / "__init__.py", path.with_suffix(".py"), path.with_suffix(".pyi"))
    return next(file for file in files if file.exists())


def find(module: str, name: str) -> ast.stmt | None:
    """The definition of a name, also in modules that this one imports from; None for other objects."""
    for node in ast.parse(source_of(module).read_text(encoding="utf-8")).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name == name:
            return node
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("vertifleet"):
            for alias in node.names:
                if (alias.asname or alias.name) == name and node.module != module:
                    return find(node.module, alias.name)
    return None


def names(module: str) -> list[str]:
    """The public names of a module."""
    for node in ast.parse(source_of(module).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return [str(name) for name in ast.literal_eval(node.value)]
    raise SystemExit(f"{module} has no __all__")


def text(docstring: str | None) -> str:
    """A docstring as Markdown."""
    lines: list[str] = []
    in_section = False
    for line in inspect.cleandoc(docstring or "").splitlines():
        section, item = SECTION.match(line), ITEM.match(line)
        in_section = bool(section) or (in_section and line[:1] in ("", " "))
        if section:
            line = f"**{section[1]}**\n"
        elif in_section and item:
            line = f"- `{item[1].strip('`')}`: {item[2]}"
        elif in_section:
            line = re.sub(r"^ {6,}", "  ", line)
        else:
            line = re.sub(r"^::$", "", re.sub(r"(?<=\w)::$", ":", line))
        lines.append(re.sub(r":\w+:(`[^`]+`)", r"\1", line).replace("``", "`"))
    return "\n".join(lines).strip()


def call(function: ast.FunctionDef | ast.AsyncFunctionDef, name: str) -> str:
    """A call of a function with its parameters and types."""
    arguments = function.args
    for first in [*arguments.posonlyargs, *arguments.args][:1]:
        if first.arg in ("self", "cls"):
            (arguments.posonlyargs or arguments.args).remove(first)
    returned = ""
    if function.returns is not None and function.name not in ("__init__", "__new__"):
        returned = f" -> {ast.unparse(function.returns)}"
    return f"{name}({ast.unparse(arguments)}){returned}"


def signature(function: ast.FunctionDef | ast.AsyncFunctionDef, name: str) -> str:
    """A call of a function, as a block of code."""
    return f"```python\n{call(function, name)}\n```"


def class_of(node: ast.ClassDef, name: str) -> list[str]:
    """The parts of a class: its construction, fields and public methods."""
    parts: list[str] = []
    methods = [member for member in node.body if isinstance(member, (ast.FunctionDef, ast.AsyncFunctionDef))]
    is_copy_of_another = name.startswith("Async")
    for method in methods:
        if method.name in ("__init__", "__new__"):
            parts.append(signature(method, name))
    parts.append(text(ast.get_docstring(node)))
    if is_copy_of_another:
        return [*parts, f"It has the methods of `{name.removeprefix('Async')}`, to be awaited."]
    fields = [
        f"- `{ast.unparse(field.target)}`: {' '.join(text(ast.literal_eval(note.value)).split())}"
        for field, note in itertools.pairwise(node.body)
        if isinstance(field, ast.AnnAssign)
        and isinstance(note, ast.Expr)
        and isinstance(note.value, ast.Constant)
        and isinstance(note.value.value, str)
        and not ast.unparse(field.target).startswith("_")
    ]
    fields += [
        f"- `{method.name}`: {' '.join(text(ast.get_docstring(method)).split())}"
        for method in methods
        if is_property(method) and not method.name.startswith("_")
    ]
    if fields:
        parts.append("\n".join(fields))
    for method in methods:
        docstring = ast.get_docstring(method)
        is_for_pickle = (docstring or "").startswith("Restores a")
        if docstring and not method.name.startswith("_") and not is_property(method) and not is_for_pickle:
            parts.append(f"`{call(method, f'{name}.{method.name}')}`  \n{text(docstring)}")
    return parts


def is_property(method: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Whether a method is read like a field."""
    return any("property" in ast.unparse(decorator) for decorator in method.decorator_list)


def page() -> str:
    """The page."""
    parts = [HEAD.strip()]
    for module in MODULES:
        docstring = ast.get_docstring(ast.parse(source_of(module).read_text(encoding="utf-8")))
        parts += [f"## {module}", text(docstring)]
        for name in sorted(names(module)):
            node = find(module, name)
            if isinstance(node, ast.ClassDef):
                parts += [f"### {name}", *class_of(node, name)]
            elif isinstance(node, ast.FunctionDef):
                parts += [f"### {name}", signature(node, name), text(ast.get_docstring(node))]
    return "\n\n".join(part for part in parts if part) + "\n"


def main() -> None:
    """Writes the page, or with --check compares it."""
    if "--check" in sys.argv:
        sys.exit(0 if PAGE.read_text(encoding="utf-8") == page() else "run python/tools/api_page.py")
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
