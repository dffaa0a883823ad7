"""The client covers the whole description of the API, and its generated files are up to date."""

from __future__ import annotations

import asyncio
import importlib
import inspect
import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest

import vertifleet
from vertifleet.client import AsyncClient, Client, ServiceError

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python/tools"))
client_types = importlib.import_module("client_types")
API = json.loads((ROOT / "docs/src/reference/openapi.json").read_text(encoding="utf-8"))

CALLS: dict[str, tuple[str, tuple[Any, ...]]] = {
    "list_days": ("client.days", ()),
    "make_day": ("client.make_day", ("paper",)),
    "read_day": ("client.day", ("d",)),
    "delete_day": ("day.delete", ()),
    "archive_day": ("day.archive", ()),
    "unarchive_day": ("day.unarchive", ()),
    "day_state": ("day.state", ()),
    "day_trace": ("day.trace_csv", ()),
    "list_events": ("day.events", ()),
    "add_events": ("day.report", ({"type": "clock"},)),
    "stream_events": ("day.stream", ()),
    "propose_decision": ("day.propose", ("A01",)),
    "take_decision": ("day.decide", ("A01",)),
    "day_outlook": ("day.outlook", ()),
    "what_if": ("day.what_if", ()),
    "day_demand": ("day.demand", ()),
    "day_ledger": ("day.ledger", ()),
    "day_scenario": ("day.scenario", ()),
    "list_networks": ("client.networks", ()),
    "read_network": ("client.network", ("paper",)),
    "put_network": ("client.put_network", (vertifleet.Network("paper"),)),
    "delete_network": ("client.delete_network", ("mine",)),
    "validate_network": ("client.validate_network", ("",)),
    "list_policies": ("client.policies", ()),
    "read_policy": ("client.policy", ("greedy",)),
    "put_policy": ("client.put_policy", ("mine", b"")),
    "delete_policy": ("client.delete_policy", ("mine",)),
    "validate_policy": ("client.validate_policy", (b"",)),
    "list_studies": ("client.studies", ()),
    "make_study": ("client.make_study", ("paper", ["greedy"], 1)),
    "read_study": ("client.study", ("s",)),
    "study_report": ("client.study_report", ("s",)),
    "study_replay": ("client.study_replay", ("s",)),
    "delete_study": ("client.delete_study", ("s",)),
    "service_info": ("client.info", ()),
    "healthz": ("client.is_running", ()),
    "readyz": ("client.is_ready", ()),
    "metrics": ("client.metrics", ()),
    "openapi": ("client.description", ()),
}
"""The method for each operation of the description, with arguments with which it can be called."""

CALLED = {
    "limit": "page_size",
    "If-Match": "if_match",
    "Idempotency-Key": "idempotency_key",
    "Last-Event-ID": "after",
    "toml": "network",
}
"""The names of parameters in Python, if they differ."""

OPERATIONS = {
    operation["operationId"]: (method.upper(), path, operation)
    for path, methods in API["paths"].items()
    for method, operation in methods.items()
}


def members(schema: dict[str, Any]) -> set[str]:
    """The members of a body."""
    if "$ref" in schema:
        schema = API["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    return set(schema.get("properties", {}))


def parameters(operation: dict[str, Any]) -> set[str]:
    """The parameters and body members of an operation, without those in its path."""
    said = {each["name"] for each in operation.get("parameters", []) if each["in"] != "path"}
    content = operation.get("requestBody", {}).get("content", {})
    for kind in content.values():
        said |= members(kind.get("schema", {}))
    return {CALLED.get(name, name) for name in said}


def method_of(client: Any, day: Any, name: str) -> Callable[..., Any]:
    owner, _, method = name.partition(".")
    found: Callable[..., Any] = getattr({"client": client, "day": day}[owner], method)
    return found


async def ended(outcome: Any) -> Any:
    """The final result of a call, of a client with or without asyncio."""
    if inspect.isasyncgen(outcome):
        return await anext(outcome)
    if inspect.isgenerator(outcome):
        return next(outcome)
    return await outcome if inspect.isawaitable(outcome) else outcome


def test_every_operation_of_the_api_has_a_method() -> None:
    assert set(CALLS) == set(OPERATIONS)


@pytest.mark.parametrize("kind", [Client, AsyncClient])
@pytest.mark.parametrize("operation", CALLS)
def test_a_method_asks_for_its_operation(kind: type[Client | AsyncClient], operation: str) -> None:
    sent: list[httpx.Request] = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append(request)
        if len(sent) == 1:
            return httpx.Response(200, json={"id": "d", "name": "paper-1"})
        problem = {"code": "V602", "detail": "none"}
        return httpx.Response(404, json=problem, headers={"content-type": "application/problem+json"})

    async def called() -> None:
        client = kind(transport=httpx.MockTransport(answer), token="vf_1")
        day = await ended(client.day("d"))
        name, arguments = CALLS[operation]
        method = method_of(client, day, name)
        assert parameters(OPERATIONS[operation][2]) <= set(inspect.signature(method).parameters)
        with pytest.raises(ServiceError, match="V602"):
            await ended(method(*arguments))

    asyncio.run(called())
    verb, path, described = OPERATIONS[operation]
    request = sent[-1]
    assert request.method == verb
    assert re.fullmatch(re.sub(r"\{\w+\}", "[^/]+", path), request.url.path)
    asked = {each["name"] for each in described.get("parameters", []) if each["in"] == "query"}
    assert set(request.url.params) <= asked
    assert request.headers["authorization"] == "Bearer vf_1"


def test_types_are_written_for_all_that_a_schema_can_be() -> None:
    integer, nothing = {"type": "integer"}, {"type": "null"}
    shapes = {
        "Phase": {"type": "string", "enum": ["standing", "in_the_air"]},
        "Move": {
            "oneOf": [
                {"type": "object", "required": ["kind"], "properties": {"kind": {"const": "fly"}}},
                {"type": "object", "required": ["from"], "properties": {"from": {"type": "string"}}},
            ]
        },
        "Timed": {"allOf": [{"$ref": "#/Move"}, {"type": "object", "properties": {"at": integer}}]},
        "All": {
            "type": "object",
            "description": "All of it.",
            "required": ["phase", "counts"],
            "properties": {
                "phase": {"$ref": "#/Phase"},
                "counts": {"type": "object", "additionalProperties": integer},
                "free": {"type": "object"},
                "any": {},
                "maybe": {"oneOf": [nothing, {"$ref": "#/Phase"}]},
                "inner": {"type": ["object", "null"], "properties": {"a": {"type": "number"}}},
                "moves": {"type": "array", "items": {"allOf": [{"$ref": "#/Timed"}]}},
            },
        },
    }
    body = {"content": {"application/json": {"schema": {"$ref": "#/All"}}}}
    operation = {"operationId": "ask", "responses": {"200": body}}
    source = client_types.written({"paths": {"/": {"get": operation}}, "components": {"schemas": shapes}})
    types: dict[str, Any] = {}
    exec(compile(source, "types.py", "exec", dont_inherit=True), types)
    assert types["All"].__required_keys__ == {"phase", "counts"}
    assert types["All"].__doc__ == "All of it."
    for line in (
        'Phase: TypeAlias = Literal["standing", "in_the_air"]',
        "    counts: Mapping[str, int]",
        "    free: NotRequired[Mapping[str, object]]",
        "    any: NotRequired[object]",
        "    maybe: NotRequired[Phase | None]",
        "    inner: NotRequired[AllInner | None]",
        "    moves: NotRequired[list[Timed]]",
        "Timed: TypeAlias = FlyTimed | TimedFrom",
        '    kind: Literal["fly"]',
    ):
        assert line in source.splitlines(), source
    shapes.pop("Phase")
    with pytest.raises(SystemExit, match="refers to Phase"):
        client_types.written({"paths": {"/": {"get": operation}}, "components": {"schemas": shapes}})


@pytest.mark.parametrize("tool", ["client_types.py", "client_sync.py"])
def test_the_written_files_are_up_to_date(tool: str, tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "python/tools" / tool), "--check"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
