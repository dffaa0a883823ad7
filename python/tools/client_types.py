"""Writes the types of the service's requests and answers, from the API's description, into client/types.py.

Run it with python/.venv/bin/python whenever docs/src/reference/openapi.json has changed. Objects become
TypedDicts, each after those that it refers to. Objects that differ in a member with one value, as events do
in ``type``, become a union of TypedDicts, one for each value.
"""

from __future__ import annotations

import itertools
import json
import keyword
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).resolve().parent.parent
DESCRIPTION = PACKAGE.parent / "docs/src/reference/openapi.json"
TYPES = PACKAGE / "vertifleet/client/types.py"
WIDTH, COMMENT_WIDTH = 110, 100

HEAD = '''"""The requests and answers of the dispatch service, as types for checkers and editors.

Written by python/tools/client_types.py from the description of the API (docs/src/reference/openapi.json): do
not edit. At run time all of these are plain dicts, so members that a newer service adds do no harm.
"""

from collections.abc import Mapping
from typing import Literal, TypeAlias

from typing_extensions import NotRequired, TypedDict
'''
PLAIN = {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}

Schema = dict[str, Any]


class Writer:
    """Writes a definition for every requested schema, and first for those that it refers to."""

    def __init__(self, schemas: dict[str, Schema]) -> None:
        self.schemas = schemas
        self.definitions: dict[str, str] = {}
        self._begun: dict[str, Schema] = {}

    def expression(self, schema: Schema, name: str) -> str:
        """The type of a schema as an expression; an object that has no name yet gets this one."""
        if "$ref" in schema:
            referred, found = self._referred(schema)
            self.define(referred, found)
            return referred
        for one_of in ("oneOf", "anyOf"):
            if one_of in schema:
                return self._union(schema[one_of], name)
        if "allOf" in schema:
            parts = schema["allOf"]
            return self._union(parts if len(parts) == 1 else self._objects(schema), name)
        if "const" in schema or "enum" in schema:
            values = schema.get("enum", [schema.get("const")])
            return f"Literal[{', '.join(map(repr, values))}]"
        kinds = schema.get("type", [])
        kinds = [kinds] if isinstance(kinds, str) else kinds
        return " | ".join(self._of_kind(kind, schema, name) for kind in kinds) or "object"

    def _referred(self, schema: Schema) -> tuple[str, Schema]:
        """The schema that a schema refers to, with its name.

        Raises:
            SystemExit: if there is no such schema.
        """
        name = str(schema["$ref"]).rpartition("/")[2]
        if name not in self.schemas:
            sys.exit(f"the description refers to {name}, which it does not have")
        return name, self.schemas[name]

    def _of_kind(self, kind: str, schema: Schema, name: str) -> str:
        """The type of a schema that is of one kind of JSON."""
        if kind == "array":
            return f"list[{self.expression(schema.get('items', {}), name)}]"
        if kind != "object":
            return PLAIN[kind]
        if "properties" in schema:
            self.define(name, schema)
            return name
        more = schema.get("additionalProperties")
        values = self.expression(more, name) if isinstance(more, dict) else "object"
        return f"Mapping[str, {values}]"

    def _union(self, schemas: list[Schema], name: str) -> str:
        """The union of several types; of a single one, that type."""
        if len(schemas) == 1:
            return self.expression(schemas[0], name)
        kinds = dict.fromkeys(self.expression(schema, variant_name(name, schema)) for schema in schemas)
        return " | ".join(sorted(kinds, key="None".__eq__))

    def _objects(self, schema: Schema) -> list[Schema]:
        """The objects that a schema describes: every combination of its alternatives."""
        if "$ref" in schema:
            return self._objects(self._referred(schema)[1])
        if "oneOf" in schema:
            return [found for each in schema["oneOf"] for found in self._objects(each)]
        if "allOf" not in schema:
            return [schema]
        choices = itertools.product(*(self._objects(part) for part in schema["allOf"]))
        return [merged(choice) for choice in choices]

    def define(self, name: str, schema: Schema) -> None:
        """Adds the definition of a name, once.

        Raises:
            SystemExit: if a schema contains itself, for which definitions have no order, or if two have the
                same name.
        """
        if name in self.definitions and self._begun[name] == schema:
            return
        if name in self._begun:
            sys.exit(f"{name} contains itself or is two things: client_types.py cannot write that")
        self._begun[name] = schema
        text = self._object(name, schema) if "properties" in schema else self._alias(name, schema)
        self.definitions[name] = text

    def _alias(self, name: str, schema: Schema) -> str:
        return f"{name}: TypeAlias = ({self.expression(schema, name)})\n{docstring(schema, name, 0)}"

    def _object(self, name: str, schema: Schema) -> str:
        members = [
            (member, self._member(schema, member, name), described(schema["properties"][member]))
            for member in ordered(schema)
        ]
        if all(member.isidentifier() and not keyword.iskeyword(member) for member, _, _ in members):
            lines = [f"class {name}(TypedDict):", docstring(schema, name, 4)]
            for member, kind, text in members:
                lines.append(f"    {member}: {kind}")
                lines += [docstring({"description": text}, member, 4)] if text else []
            return "\n".join(lines)
        # Only this form can have members such as "from", and it has no place for docstrings of
        # members.
        lines = [f'{name} = TypedDict("{name}", {{']
        for member, kind, text in members:
            wrapped = textwrap.wrap(text, COMMENT_WIDTH - 10)
            lines += [*(f"# {line}" for line in wrapped), f'"{member}": {kind},']
        return "\n".join([*lines, "})", docstring(schema, name, 0)])

    def _member(self, schema: Schema, member: str, name: str) -> str:
        kind = self.expression(schema["properties"][member], name + camel(member))
        return kind if member in schema.get("required", []) else f"NotRequired[{kind}]"


def merged(objects: tuple[Schema, ...]) -> Schema:
    """One object with the members of several, described by the first."""
    properties: Schema = {}
    required: list[str] = []
    for part in objects:
        properties |= part.get("properties", {})
        required += part.get("required", [])
    words = next((part["description"] for part in objects if "description" in part), "")
    return {"type": "object", "description": words, "properties": properties, "required": required}


def tags(schema: Schema) -> dict[str, str]:
    """Required members that have one value only, with those values."""
    found = {}
    for member in schema.get("required", []):
        known = schema.get("properties", {}).get(member, {})
        values = known.get("enum", [known["const"]] if "const" in known else [])
        if len(values) == 1:
            found[member] = str(values[0])
    return found


def ordered(schema: Schema) -> list[str]:
    """The members of an object: first those that distinguish it, then required ones, then the rest."""
    required = schema.get("required", [])
    return list(dict.fromkeys([*tags(schema), *required, *schema["properties"]]))


def variant_name(name: str, schema: Schema) -> str:
    """The name of one object of a union, from the members that distinguish it, or else from required ones."""
    tag = tags(schema)
    if tag:
        return "".join(map(camel, tag.values())) + name
    return name + "".join(map(camel, schema.get("required", [])))


def camel(text: str) -> str:
    """Words as a name of a class."""
    words = text.replace("-", "_").replace(".", "_").split("_")
    return "".join(word[:1].upper() + word[1:] for word in words)


def described(schema: Schema) -> str:
    """The description of a schema: its own, or else that of the schema that it refers to."""
    alternatives = [*schema.get("oneOf", []), *schema.get("anyOf", [])]
    said = [schema, *alternatives]
    return next((" ".join(part["description"].split()) for part in said if part.get("description")), "")


def docstring(schema: Schema, name: str, indent: int) -> str:
    """The description of a schema, as an indented docstring."""
    text = (described(schema) or f"{name}, as the service describes it.").replace("\\", "\\\\")
    lines = textwrap.wrap(text, WIDTH - indent - 6, break_long_words=False)
    if len(lines) > 1:
        lines = [*textwrap.wrap(text, WIDTH - indent - 3, break_long_words=False), ""]
    lines[0] = f'"""{lines[0]}'
    lines[-1] += '"""'
    return "\n".join(" " * indent + line for line in lines)


def contents(operation: Schema) -> Iterator[tuple[str, Schema]]:
    """The schemas of an operation's parameters, body and answers, with names for those that have none.

    Of the parameters only those that refer to a schema: the others are plain texts and numbers.
    """
    for parameter in operation.get("parameters", []):
        if "$ref" in parameter.get("schema", {}):
            yield parameter["name"], parameter["schema"]
    name = camel(operation["operationId"])
    bodies = [(f"{name}Body", operation.get("requestBody", {}))]
    answers = [(f"{name}Answer", answer) for answer in operation["responses"].values()]
    for what, content in bodies + answers:
        for kind in content.get("content", {}).values():
            if "schema" in kind:
                yield what, kind["schema"]


def written(api: Schema) -> str:
    """The module with the types of all requests and answers of the API."""
    writer = Writer(api["components"]["schemas"])
    for methods in api["paths"].values():
        for operation in methods.values():
            for name, schema in contents(operation):
                writer.expression(schema, name)
    source = "\n\n".join([HEAD, *writer.definitions.values()]) + "\n"
    # The blank lines behind imports depend on what comes first, which only the linter mends.
    for command in (["check", "--quiet", "--select", "I", "--fix"], ["format"]):
        ruff = [sys.executable, "-m", "ruff", *command, "--stdin-filename", str(TYPES), "-"]
        source = subprocess.run(ruff, input=source, capture_output=True, text=True, check=True).stdout
    return source


def main() -> None:
    """Writes the types, or with --check compares them with the generated ones."""
    source = written(json.loads(DESCRIPTION.read_text(encoding="utf-8")))
    if "--check" in sys.argv:
        is_same = TYPES.exists() and TYPES.read_text(encoding="utf-8") == source
        sys.exit(0 if is_same else "run python/tools/client_types.py")
    TYPES.write_text(source, encoding="utf-8")


if __name__ == "__main__":
    main()
