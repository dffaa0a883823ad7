# Written from ../_async/client.py by python/tools/client_sync.py: do not edit.
"""The client of a dispatch service: its days, its networks, its policies and its studies."""

from __future__ import annotations

import json
import os
import ssl
from collections.abc import Generator, Mapping, Sequence
from datetime import date as calendar_date
from types import TracebackType

import httpx

from vertifleet._native import Model, Network, Scenario
from vertifleet.client._errors import ServiceError
from vertifleet.client._requests import Request, asking, given, keeping, reading, writing
from vertifleet.client._sync.connection import Connection
from vertifleet.client._sync.day import Day
from vertifleet.client.types import (
    DayInfo,
    DayList,
    ForecastRow,
    NetworkInfo,
    NetworkList,
    PolicyInfo,
    PolicyList,
    ServiceInfo,
    StudyInfo,
    StudyList,
    StudyReplay,
    WeightsInfo,
)


class Client:
    """A client of a dispatch service that ``vertifleet serve`` runs.

    The client repeats a request, after growing pauses, if the connection is lost, if the service does not
    answer in time, or if it is temporarily unavailable. Every write carries an ``Idempotency-Key``, so that
    it happens once even if it is sent several times.

    Use ``with``, or close it at the end. Several tasks or threads may share it; it keeps their
    connections open for the next request.
    """

    def __init__(
        self,
        url: str = "http://127.0.0.1:8080",
        token: str | None = None,
        *,
        timeout: float = 35.0,
        retries: int = 5,
        verify: bool | str | os.PathLike[str] | ssl.SSLContext = True,
        transport: httpx.BaseTransport | None = None,
    ) -> None:
        """A client of the service at an address. Nothing is sent yet.

        Args:
            url: the address of the service, which it prints when it starts, or that of the proxy in front of
                it.
            token: the token, which begins with ``vf_``. The default is the environment variable
                ``VERTIFLEET_TOKEN``, as for ``vertifleet operate``. A service that has no tokens yet needs
                none.
            timeout: time limit for the answer and for each pause in it, seconds. The service gives a request
                up after 30 s.
            retries: how often a request is repeated: with 5, the pauses are about three seconds in all.
                Streams reconnect as often after each loss.
            verify: the path of a PEM file with trusted certificates, in place of those of the Python package
                certifi; or an SSL context, for example with a client certificate. False trusts every server,
                and protects against none.
            transport: a transport of httpx in place of its default: for tests, for proxies that need more
                than environment variables, or for Unix sockets.

        Raises:
            Error: V451 if the address is invalid, V624 if the certificates cannot be used.
        """
        self._connection = Connection(url, token, timeout, retries, verify, transport)

    @property
    def url(self) -> str:
        """The address of the service."""
        return self._connection.url

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.url!r})"

    def __enter__(self) -> Client:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Closes all connections. The client cannot be used any more."""
        self._connection.close()

    def make_day(
        self,
        network: str | None = None,
        *,
        seed: int | None = None,
        scenario: Scenario | Mapping[str, object] | None = None,
        policy: str | None = None,
        forecast: Sequence[ForecastRow] | None = None,
        aircraft: Mapping[str, str] | None = None,
        name: str | None = None,
        date: str | calendar_date | None = None,
        time_zone: str | None = None,
        idempotency_key: str | None = None,
    ) -> Day:
        """Makes a day, from a network or from a scenario. It begins in its expected state.

        Args:
            network: the name of a network, for example "paper".
            seed: the seed that draws the forecast and the places of aircraft, unless they are given; 1 by
                default.
            scenario: a whole day, in place of network and seed: a `vertifleet.Scenario`, or the content of a
                scenario file.
            policy: the default policy of its decisions; "gcaps-x" without it.
            forecast: the expected passengers, in place of drawn ones, for example ``{"period": "07:00:00",
                "from": "V1", "to": "V2", "passengers": 14}``. A pair without a row has no passengers.
            aircraft: the places of aircraft in the morning: ids of vertiports by ids of aircraft. The others
                stand where the network or the scenario places them.
            name: the display name of the day, at most 80 characters.
            date: its date, for example "2026-11-23". Times may then be in ISO 8601.
            time_zone: the time zone of its clock by its name in the IANA database; without it, that of the
                network.
            idempotency_key: a unique key of your choice, at most 128 characters, for a day that must be made
                only once even if this process ends before the answer arrives.

        Raises:
            ServiceError: V601 if the description of the day is invalid, V602 for an unknown network or
                policy, V603 for an unknown aircraft or vertiport; otherwise with the code of the error in the
                scenario or the seed.
        """
        origin = json.loads(scenario.to_json()) if isinstance(scenario, Scenario) else scenario
        members = {
            "network": network,
            "seed": seed,
            "scenario": origin,
            "policy": policy,
            "forecast": forecast,
            "aircraft": aircraft,
            "name": name,
            "date": None if date is None else str(date),
            "time_zone": time_zone,
        }
        asked = writing("days", body=given(members), idempotency_key=idempotency_key)
        return Day(self._connection, self._connection.object(DayInfo, asked))

    def day(self, day: str) -> Day:
        """The day with this id.

        Raises:
            ServiceError: V602 if there is none.
        """
        return Day(self._connection, self._connection.object(DayInfo, reading("days", day)))

    def days(
        self, *, after: str | None = None, page_size: int = 100, progress: bool = False
    ) -> Generator[Day, None, None]:
        """All days, in the order in which they were made.

        Args:
            after: the id of a day; only days that were made after it are listed.
            page_size: number of days in a request, at most 1,000.
            progress: whether the ``info`` of each day that is not archived has its ``progress``: the clock,
                the profit so far, how many aircraft wait for a decision, and whether the day is over.
        """
        while True:
            asked = reading("days", after=after, limit=page_size, progress="true" if progress else None)
            page = self._connection.object(DayList, asked)
            for info in page["days"]:
                yield Day(self._connection, info)
            after = page.get("next")
            if after is None:
                return

    def networks(self) -> list[NetworkInfo]:
        """The networks from which days can be made: those of the program, then those that were uploaded."""
        return (self._connection.object(NetworkList, reading("networks")))["networks"]

    def network(self, network: str) -> NetworkInfo:
        """The network with this name, with the text of its file as ``toml``.

        Raises:
            ServiceError: V602 if there is none.
        """
        return self._connection.object(NetworkInfo, reading("networks", network))

    def put_network(self, network: Network) -> NetworkInfo:
        """Stores a network under its name, and replaces one that was uploaded before.

        Existing days keep their network.

        Raises:
            ServiceError: V601 if a network of the program has this name, V612 if there are too many.
        """
        body = {"toml": network.toml}
        return self._connection.object(NetworkInfo, keeping("networks", network.name, body=body))

    def validate_network(self, network: str | Network) -> NetworkInfo:
        """The contents of a network, with ``warnings`` about unlikely settings. It is not stored.

        Args:
            network: the text of a network file, or a network.

        Raises:
            ServiceError: with the code of its error.
        """
        body = {"toml": network.toml if isinstance(network, Network) else network}
        return self._connection.object(NetworkInfo, asking("networks", "validate", body=body))

    def delete_network(self, network: str) -> None:
        """Removes a network that was uploaded. Existing days keep their network.

        Raises:
            ServiceError: V602 if none of this name was uploaded.
        """
        self._connection.remove("networks", network)

    def policies(self) -> list[PolicyInfo]:
        """The policies that can decide: those of the program, then those that were uploaded."""
        return (self._connection.object(PolicyList, reading("policies")))["policies"]

    def policy(self, policy: str) -> PolicyInfo:
        """Describes the policy with this name.

        Raises:
            ServiceError: V602 if there is none.
        """
        return self._connection.object(PolicyInfo, reading("policies", policy))

    def put_policy(self, policy: str, weights: Model | bytes) -> PolicyInfo:
        """Stores weights as a policy. Its name means these weights permanently.

        Args:
            policy: a new name: 1 to 40 letters a-z, digits, dots, dashes and underscores.
            weights: the weights, or the bytes of a weight file.

        Raises:
            ServiceError: V601 if the name is taken, V612 if there are too many policies; otherwise with the
                code of the error in the weights.
        """
        asked = keeping("policies", policy, body=bytes_of(weights))
        return self._connection.object(PolicyInfo, asked)

    def validate_policy(self, weights: Model | bytes) -> WeightsInfo:
        """Describes weights without storing them.

        Raises:
            ServiceError: with the code of the error in the weights.
        """
        asked = asking("policies", "validate", body=bytes_of(weights))
        return self._connection.object(WeightsInfo, asked)

    def delete_policy(self, policy: str) -> None:
        """Removes a policy that was uploaded. Days that it decides on keep it until the service starts again.

        Raises:
            ServiceError: V602 if none of this name was uploaded.
        """
        self._connection.remove("policies", policy)

    def make_study(
        self,
        network: str | Network,
        policies: Sequence[str],
        days: int,
        *,
        seed: int | None = None,
        split: str | None = None,
        bounds: bool | None = None,
        idempotency_key: str | None = None,
    ) -> StudyInfo:
        """Plays many days of a network with policies in the background, as ``vertifleet compare`` does.

        Poll it with `study` until its ``state`` is "finished" or "failed". The service keeps it until it
        stops.

        Args:
            network: the name of a network, or a `Network`, which is not stored.
            policies: names of policies, at most 10. The others are compared with the first.
            days: number of days, at most 1,000.
            seed: the seed of the first day; 1 without it.
            split: the purpose of the days: "comparison", or "validation".
            bounds: whether to prove an upper bound for every day.
            idempotency_key: a unique key of your choice, for a study that must be made only once even if this
                process ends before the answer arrives.

        Raises:
            ServiceError: V602 for an unknown network or policy, V612 if it is too large or too many wait;
                otherwise with the code of the error.
        """
        members = {
            "toml": network.toml if isinstance(network, Network) else None,
            "network": None if isinstance(network, Network) else network,
            "policies": list(policies),
            "days": days,
            "seed": seed,
            "split": split,
            "bounds": bounds,
        }
        asked = writing("studies", body=given(members), idempotency_key=idempotency_key)
        return self._connection.object(StudyInfo, asked)

    def studies(self) -> list[StudyInfo]:
        """All studies since the service began, the latest first, without their results."""
        return (self._connection.object(StudyList, reading("studies")))["studies"]

    def study(self, study: str) -> StudyInfo:
        """The study with this id: its progress, and its ``result`` once it has finished.

        Raises:
            ServiceError: V602 if there is none.
        """
        return self._connection.object(StudyInfo, reading("studies", study))

    def study_report(self, study: str) -> str:
        """The result of a study as a page in HTML, which also opens without the service.

        Raises:
            ServiceError: V602 if there is no such study, or if it has not finished.
        """
        return (self._connection.answer(reading("studies", study, "report"))).text

    def study_replay(self, study: str) -> StudyReplay:
        """The first days of a study as each policy played them: scenarios, with a trace for each policy.

        Raises:
            ServiceError: V602 if there is no such study, or if it has not finished.
        """
        return self._connection.object(StudyReplay, reading("studies", study, "replay"))

    def delete_study(self, study: str) -> None:
        """Ends a study if it plays or waits, and removes it.

        Raises:
            ServiceError: V602 if there is none.
        """
        self._connection.remove("studies", study)

    def info(self) -> ServiceInfo:
        """The properties of the service, and the rights of this client's token."""
        return self._connection.object(ServiceInfo, Request("GET", "/v1"))

    def is_running(self) -> bool:
        """Whether the service runs. The request is sent once, and needs no token."""
        return self._is_well("/healthz")

    def is_ready(self) -> bool:
        """Whether the store of the service accepts writes. The request is sent once, and needs no token."""
        return self._is_well("/readyz")

    def _is_well(self, path: str) -> bool:
        """Whether a health check succeeds."""
        try:
            self._connection.answer_at_once(Request("GET", path))
        except ServiceError as error:
            if not error.is_transient:
                raise
            return False
        return True

    def metrics(self) -> str:
        """The metrics of the service, in the text format of Prometheus."""
        return (self._connection.answer(Request("GET", "/metrics"))).text

    def description(self) -> Mapping[str, object]:
        """The service's description of its API (OpenAPI 3.1)."""
        return self._connection.object(dict[str, object], Request("GET", "/openapi.json"))


def bytes_of(weights: Model | bytes) -> bytes:
    """The bytes of a weight file."""
    return weights.to_bytes() if isinstance(weights, Model) else weights
