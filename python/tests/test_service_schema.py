"""The HTTP API of the dispatch service matches its description: Schemathesis makes requests from it.

The program receives valid and invalid ones for every operation of ``docs/src/reference/openapi.json``. Many
name existing days, aircraft, networks and policies. Each such day is made for one request, so no request
depends on earlier ones, and the tests can check that a request changes nothing else.
"""

from __future__ import annotations

import json
import re
import threading
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, nullcontext
from copy import deepcopy
from http import HTTPStatus
from http.client import HTTPConnection
from itertools import count
from typing import Any

import jsonschema
import pytest
import requests
import schemathesis
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from schemathesis import Case, CheckContext, Config, GenerationMode, HookContext, Response
from schemathesis.core.failures import Failure, FailureGroup
from schemathesis.specs.openapi.schemas import OpenApiSchema
from test_client import ROOT, Service

from vertifleet import Model, Network

DESCRIPTION = json.loads((ROOT / "docs/src/reference/openapi.json").read_text())
CODES = set(re.findall(r"^## (V\d{3}) ", (ROOT / "docs/src/reference/errors.md").read_text(), re.MULTILINE))
STREAM = "/v1/days/{day}/stream"

CONFIG = {
    "seed": 1,
    # Examples from earlier runs, answers and sources would make runs differ.
    "cache": {"enabled": False},
    "analysis": {"constants": {"enabled": False}},
    "phases": {
        "fuzzing": {"extra-data-sources": {"responses": False}, "error-feedback": {"enabled": False}},
        "stateful": {"enabled": False},
    },
    "checks": {
        # The rules of days and files are not in the description; 400, 409, 412 and 422 refuse what
        # breaks them. Of 400 see `what_is_described_is_understood` too.
        "positive_data_acceptance": {"expected-statuses": ["2xx", "400", "404", "409", "412", "422"]},
    },
    "operations": [{"include-path": STREAM, "max-stream-events": 1}],
}
SETTINGS = settings(
    max_examples=30,
    database=None,
    deadline=None,
    phases=[Phase.explicit, Phase.generate],
    report_multiple_bugs=False,
    suppress_health_check=list(HealthCheck),
)

NETWORK = Network("paper").toml.replace('name = "paper"', 'name = "uploaded"')
# The days of these tests last two hours, because each of about a thousand what-ifs plays a day to
# its end.
MORNING = (
    Network("paper")
    .toml.replace('name = "paper"', 'name = "morning"')
    .replace('end = "18:00:00"', 'end = "08:00:00"')
)
WEIGHTS = Model.shipped("gcaps-x").to_bytes()
# Existing names, by kind. The first stays in a request while everything else varies.
FORMATS: dict[str, list[Any]] = {
    "day": ["new", "dated", "archived"],
    "aircraft": ["A01", "A02", "A03"],
    "vertiport": ["V1", "V2", "V3"],
    "network": ["paper", "uploaded", "new-york"],
    "policy": ["greedy", "random", "uploaded", "prices"],
    "kept-network": ["uploaded", "paper"],
    "kept-policy": ["uploaded", "greedy"],
    "moment": ["06:00:00", "06:10:00", "07:00:00", "2026-11-23T06:30:00+01:00"],
    "date": ["2026-11-23"],
    "time-zone": ["Europe/Berlin", "America/New_York"],
    "network-file": [NETWORK],
    "weights": [WEIGHTS, WEIGHTS[:-1]],
}
PARAMETERS = {"day": "day", "aircraft": "aircraft", "policy": "policy", "time": "moment"}
PARAMETERS_OF_PATHS = {"/v1/networks/{network}": "kept-network", "/v1/policies/{policy}": "kept-policy"}
MEMBERS = {
    **dict.fromkeys(["from", "to", "at", "vertiport"], "vertiport"),
    "aircraft": "aircraft",
    "network": "network",
    "policy": "policy",
    "date": "date",
    "time_zone": "time-zone",
    "toml": "network-file",
}

# Rules that a schema cannot state, or only unreadably, by the service's message about them.
RULES_IN_WORDS = [
    "times can be written in ISO 8601 for days that have a date",
    "has a date, but the day has none",
    "name a `network` or give a `scenario`",
    "a study needs either network or toml",
    "`seed` goes with `network`",
    "only the service sets",
    "leads from a vertiport to itself",
    "`time_zone` goes with `date`",
    "a day with a `date` needs a `time_zone`",
    "is no time zone",
    # Invalid dates and times in a valid format: the 30th of February, midnight before the day.
    "is no date from 1970 to 2199",
    "is no time of the day",
    "expected a time as HH:MM:SS",
    "a time must lie before 100:00:00",
    "must be the number of an event",
    "the network is called",
    "this is the name of a policy that the program has",
    # In JSON Schema 2.0 is an integer. No known client writes integers so.
    r"floating point `-?\d+\.0`",
]
REFUSALS = re.compile("|".join(RULES_IN_WORDS))


def parts_of(schema: Any) -> Iterator[dict[str, Any]]:
    """A schema and all schemas within it."""
    if isinstance(schema, dict):
        yield schema
    if isinstance(schema, dict | list):
        for part in schema.values() if isinstance(schema, dict) else schema:
            yield from parts_of(part)


def load(description: dict[str, Any]) -> OpenApiSchema:
    """The description with formats, by which generated texts often name existing objects."""
    description = deepcopy(description)
    for path, operations in description["paths"].items():
        for parameter in (each for one in operations.values() for each in one.get("parameters", [])):
            if meaning := PARAMETERS_OF_PATHS.get(path, PARAMETERS.get(parameter["name"])):
                parameter["schema"]["format"] = meaning
    schemas = description["components"]["schemas"]
    schemas["Moment"]["format"] = "moment"
    schemas["Weights"]["format"] = "weights"
    for part in parts_of(schemas):
        for name, member in part.get("properties", {}).items():
            if name in MEMBERS and "string" in member.get("type", ()):
                member["format"] = MEMBERS[name]
    return schemathesis.openapi.from_dict(description, config=Config.from_dict(CONFIG))


for meaning, known in FORMATS.items():
    any_other = st.binary() if meaning == "weights" else st.text(max_size=12)
    # Two of three name existing objects.
    schemathesis.openapi.format(meaning, st.one_of(*[st.sampled_from(known)] * 2, any_other))
SCHEMA = load(DESCRIPTION)


class Days:
    """Days of a service, made when a request names them."""

    def __init__(self, url: str) -> None:
        self.url = url
        # Generated requests have another one, which they may invalidate.
        self.session, self.session_of_cases = requests.Session(), requests.Session()
        self.keys = count()

    def send(self, method: str, path: str, **parts: Any) -> Any:
        answer = self.session.request(method, self.url + path, **parts)
        assert answer.ok, answer.text
        return answer.json() if answer.content else None

    def make(self, kind: str) -> dict[str, Any]:
        """A day without events, one with a date and with decisions, or one that is archived."""
        dated = {"date": "2026-11-23", "time_zone": "Europe/Berlin"} if kind == "dated" else {}
        day = self.send("POST", "/v1/days", json={"network": "morning", "policy": "greedy", **dated})
        path = f"/v1/days/{day['id']}"
        if kind == "dated":
            for aircraft in ("A01", "A02"):
                self.send("POST", f"{path}/decisions", json={"aircraft": aircraft})
        if kind == "archived":
            self.send("POST", f"{path}/archive")
        return self.send("GET", path)

    def keep_uploads(self) -> None:
        """Uploads the network and the policy, which a request may have removed."""
        self.send("PUT", "/v1/networks/uploaded", json={"toml": NETWORK})
        self.send("PUT", "/v1/policies/uploaded", data=WEIGHTS)

    @contextmanager
    def going_on(self, day: str) -> Iterator[None]:
        """Adds events to a day, so that none of its streams stays silent."""
        is_over = threading.Event()

        def go_on() -> None:
            while not is_over.wait(0.02):
                requests.post(f"{self.url}/v1/days/{day}/events", json={"type": "clock"})

        thread = threading.Thread(target=go_on)
        thread.start()
        try:
            yield
        finally:
            is_over.set()
            thread.join()


@pytest.fixture(scope="module")
def days(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Days]:
    service = Service(tmp_path_factory.mktemp("service"))
    try:
        days = Days(service.url)
        days.send("PUT", "/v1/networks/morning", json={"toml": MORNING})
        days.keep_uploads()
        yield days
    finally:
        service.stop()


def validator(schema: dict[str, Any]) -> jsonschema.Draft202012Validator:
    """A validator of a schema in the description, including formats."""
    whole = {"components": DESCRIPTION["components"], **schema}
    return jsonschema.Draft202012Validator(whole, format_checker=KNOWN_FORMATS)


KNOWN_FORMATS = jsonschema.FormatChecker(["date"])
KNOWN_FORMATS.checks("int32")(lambda value: not isinstance(value, int) or value < 2**31)
KNOWN_FORMATS.checks("int64")(lambda value: not isinstance(value, int) or value < 2**63)
TAKEN_EVENT = validator({"$ref": "#/components/schemas/TakenEvent"})


def errors_are_problems(_: CheckContext, response: Response, __: Case) -> None:
    if response.status_code >= 400:
        problem = response.json()
        assert problem["status"] == response.status_code
        assert problem["title"] == HTTPStatus(response.status_code).phrase
        assert problem["code"] in CODES
        assert problem["type"] == f"urn:vertifleet:{problem['code']}"


def successes_are_described(_: CheckContext, response: Response, case: Case) -> None:
    """`default` describes errors, but would cover any other status too."""
    if response.status_code < 400:
        assert str(response.status_code) in case.operation.responses.status_codes


def what_is_described_is_understood(_: CheckContext, response: Response, case: Case) -> None:
    if response.status_code == 400 and case.meta and case.meta.generation.mode.is_positive:
        problem = response.json()
        assert problem["code"] != "V601" or REFUSALS.search(problem["detail"]), problem["detail"]


def streams_have_events(_: CheckContext, response: Response, case: Case) -> None:
    if case.operation.path == STREAM and response.status_code == 200:
        messages = re.findall(r"^data: (.*)$", response.text, re.MULTILINE)
        assert messages
        for message in messages:
            TAKEN_EVENT.validate(json.loads(message))


CHECKS_OF_OURS = [
    errors_are_problems,
    successes_are_described,
    what_is_described_is_understood,
    streams_have_events,
]


@SCHEMA.hook
def filter_failure(_: HookContext, failure: Failure, case: Case, __: Response) -> bool:
    """Whether something counts as a failure."""
    # OpenAPI 3.1 cannot describe streams; the schema here is that of each message: see
    # `streams_have_events`.
    return case.operation.path != STREAM or failure.title != "SSE event violates schema"


@SCHEMA.parametrize()
@SETTINGS
def test_the_service_does_what_its_description_says(case: Case, days: Days) -> None:
    path, day, before = case.operation.path, None, None
    if (named := case.path_parameters.get("day")) in FORMATS["day"]:
        # An archived day has no new events, so its streams may be silent.
        before = days.make("dated" if path == STREAM and named == "archived" else named)
        day = case.path_parameters["day"] = before["id"]
    if "uploaded" in case.path_parameters.values():
        days.keep_uploads()
    key = case.headers.get("Idempotency-Key")
    if isinstance(key, str) and 0 < len(key) < 100:
        case.headers["Idempotency-Key"] = f"{key}{next(days.keys)}"
    with days.going_on(day) if day and path == STREAM else nullcontext():
        response = case.call(base_url=days.url, session=days.session_of_cases)
    case.validate_response(response, additional_checks=CHECKS_OF_OURS)
    changes_nothing = case.method == "GET" or path.endswith("/what-if") or response.status_code >= 400
    if day and path != STREAM and changes_nothing:
        assert days.send("GET", f"/v1/days/{day}") == before


DECISION = "/v1/days/{day}/aircraft/A01/decision"
DECISIONS = "/v1/days/{day}/decisions"
EVENTS = "/v1/days/{day}/events"
WHAT_IF = "/v1/days/{day}/what-if"
# Requests that earlier versions interpreted differently from the description.
AGREED = {
    "days-limit": ("get", "/v1/days", {"params": {"limit": 2**31}}),
    "events-limit": ("get", EVENTS, {"params": {"limit": 2**31}}),
    "proposal-deadline": ("get", DECISION, {"params": {"deadline_ms": 2**63}}),
    "decision-deadline": ("post", DECISIONS, {"json": {"aircraft": "A01", "deadline_ms": 2**63}}),
    "no-events": ("post", EVENTS, {"json": []}),
    "event-member": ("post", EVENTS, {"json": {"type": "landed", "aircraft": "A01", "sky": "blue"}}),
    "routes-member": ("post", EVENTS, {"json": {"type": "closed", "routes": {"vertiport": "V1", "sky": 1}}}),
    "what-if-stands": ("post", WHAT_IF, {"json": {"stands": {"V1": 70_000}}}),
    "policy-name": ("put", "/v1/policies/{policy}", {"data": WEIGHTS}),
    "if-match": ("post", DECISIONS, {"json": {"aircraft": "A01"}, "headers": {"If-Match": "9" * 20}}),
    "day-name": ("post", "/v1/days", {"json": {"network": "paper", "name": ""}}),
    "day-date": ("post", "/v1/days", {"json": {"network": "new-york", "date": "soon"}}),
    "time-before-the-day": ("post", EVENTS, {"json": {"type": "clock", "time": -1}}),
    "time-after-the-day": ("post", EVENTS, {"json": {"type": "clock", "time": 360_000}}),
    "time-in-words": ("post", EVENTS, {"json": {"type": "clock", "time": "soon"}}),
    "stands": ("post", EVENTS, {"json": {"type": "stands", "vertiport": "V1", "stands": 70_000}}),
    "what-if-without-body": ("post", WHAT_IF, {}),
}


def is_described(method: str, path: str, parts: dict[str, Any]) -> bool:
    """Whether the description allows these parts of a request."""
    operation = DESCRIPTION["paths"][path.replace("A01", "{aircraft}")][method]
    values = {**parts.get("params", {}), **parts.get("headers", {}), "policy": "A B"}
    valid = [
        validator(parameter["schema"]).is_valid(values[parameter["name"]])
        for parameter in operation.get("parameters", [])
        if parameter["name"] in values
    ]
    if "json" in parts:
        content = operation["requestBody"]["content"]["application/json"]
        valid.append(validator(content["schema"]).is_valid(parts["json"]))
    elif "data" not in parts and "requestBody" in operation:
        valid.append(not operation["requestBody"].get("required", False))
    return all(valid)


@pytest.mark.parametrize(
    ("method", "path", "parts"), [pytest.param(*parts, id=name) for name, parts in AGREED.items()]
)
def test_requests_are_understood_if_they_are_described(
    days: Days, method: str, path: str, parts: dict[str, Any]
) -> None:
    place = path.format(day=days.make("new")["id"], policy="A B")
    answer = days.session.request(method, days.url + place, **parts)
    is_understood = answer.status_code != 400 or answer.json()["code"] != "V601"
    assert is_understood == is_described(method, path, parts)


def test_the_last_days_have_outlooks(days: Days) -> None:
    calendar = {"date": "9999-12-30", "time_zone": "America/New_York"}
    made = days.session.post(f"{days.url}/v1/days", json={"network": "paper", "policy": "greedy", **calendar})
    assert made.status_code in {201, 400}
    if made.ok:
        outlook = f"{days.url}/v1/days/{made.json()['id']}/outlook"
        assert days.session.get(outlook, params={"times": "iso"}).ok


def test_a_date_has_no_time(days: Days) -> None:
    calendar = {"date": "2026-11-23T07:00", "time_zone": "Europe/Berlin"}
    made = days.session.post(f"{days.url}/v1/days", json={"network": "paper", **calendar})
    assert made.status_code == 400 or made.json()["date"] == "2026-11-23"


@pytest.mark.parametrize("first", ["OPTIONS /v1/days", "POST /v1/nowhere", "POST /v1/days/x/what-if?x=1"])
def test_an_answer_before_the_body_says_that_the_connection_closes(days: Days, first: str) -> None:
    connection = HTTPConnection(days.url.removeprefix("http://"))
    with closing(connection):
        connection.putrequest(*first.split())
        connection.putheader("Content-Length", "2")
        connection.endheaders()
        with connection.getresponse() as answer:
            answer.read()
        if not answer.will_close:
            connection.send(b"{}")
            connection.request("GET", "/healthz")
            assert connection.getresponse().status == HTTPStatus.OK


def expect_another_status(description: dict[str, Any]) -> None:
    responses = description["paths"]["/v1/days/{day}"]["get"]["responses"]
    responses["202"] = responses.pop("200")


def expect_another_content_type(description: dict[str, Any]) -> None:
    response = description["paths"]["/v1/days/{day}"]["get"]["responses"]["200"]
    response["content"] = {"text/csv": {}}


def expect_another_member(description: dict[str, Any]) -> None:
    description["components"]["schemas"]["DayInfo"]["required"].append("weather")


def expect_another_header(description: dict[str, Any]) -> None:
    headers = description["paths"]["/v1/days/{day}"]["get"]["responses"]["200"]["headers"]
    headers["ETag"]["schema"]["pattern"] = "^W/"


def expect_fewer_errors(description: dict[str, Any]) -> None:
    description["components"]["schemas"]["Problem"]["properties"]["code"]["enum"] = ["V601"]


def forbid_what_the_service_takes(description: dict[str, Any]) -> None:
    description["paths"]["/v1/days/{day}"]["get"]["parameters"].append(
        {"name": "times", "in": "query", "required": True, "schema": {"type": "string"}}
    )


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (expect_another_status, "successes_are_described"),
        (expect_another_content_type, "Undocumented Content-Type"),
        (expect_another_member, '"weather" is a required property'),
        (expect_another_header, "Response header does not conform to the schema"),
        (expect_fewer_errors, "is not one of"),
        (forbid_what_the_service_takes, "Schema-violating request accepted"),
    ],
)
def test_a_wrong_description_is_noticed(
    days: Days, change: Callable[[dict[str, Any]], None], said: str
) -> None:
    wrong = deepcopy(DESCRIPTION)
    change(wrong)
    operation = load(wrong)["/v1/days/{day}"]["GET"]
    day = days.make("new")["id"]
    modes = [operation.as_strategy(generation_mode=mode) for mode in GenerationMode]

    @seed(1)
    @SETTINGS
    @given(case=st.one_of(modes))
    def send(case: Case) -> None:
        if case.path_parameters["day"] in FORMATS["day"]:
            case.path_parameters["day"] = day
        case.call_and_validate(days.url, days.session_of_cases, additional_checks=CHECKS_OF_OURS)

    with pytest.raises(FailureGroup, match=re.escape(said)):
        send()
