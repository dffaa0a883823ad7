# Written from ../_async/client.py by python/tools/client_sync.py: do not edit.
"""A dispatch service, as a client sees it: its days, its networks, its policies and its studies."""

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
    """A client of a dispatch service, which ``vertifleet serve`` runs.

    Every request is sent again, after growing pauses, if the connection is lost, if the service does not
    answer in time, or if it says that it cannot answer now. Every write carries an ``Idempotency-Key``, so
    that it happens once, however often it was sent.

    Use ``with``, or close it in the end. It may be used by several tasks or threads at once, and keeps
    their connections open for the next request.
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
            url: the address of the service, as it says itself when it starts, or that of the proxy before it.
            token: the token, which begins with ``vf_``. Without it, the environment variable
                ``VERTIFLEET_TOKEN`` has it, as for ``vertifleet operate``. A service that has no tokens yet
                needs none.
            timeout: seconds within which an answer must come, or go on coming. The service itself gives a
                request up after 30 s.
            retries: how often a request is sent again: the pauses before 5 times are about three seconds in
                all. Streams come back as often after each loss.
            verify: the path of a PEM file with the certificates that are trusted, in place of those of the
                Python package certifi, or a context of your own, for example with a certificate of the
                client. False trusts every server, and so protects against none.
            transport: a transport of httpx in place of its usual one: for tests, for proxies that need more
                than environment variables say, or for Unix sockets.

        Raises:
            Error: V451 if the address is none, V624 if the certificates cannot be used.
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
        """Makes a day, from a network or from a scenario. It begins as it is expected to be.

        Args:
            network: the name of a network, for example "paper".
            seed: the seed that forecast and places of aircraft are drawn with, where they are not given; 1
                without it.
            scenario: a whole day, in place of network and seed: a `vertifleet.Scenario`, or what a scenario
                file has.
            policy: the policy that decides when none is asked for; "gcaps-x" without it.
            forecast: who is expected to fly, in place of what is drawn, for example ``{"period": "07:00:00",
                "from": "V1", "to": "V2", "passengers": 14}``. A pair without a row has no passengers.
            aircraft: where aircraft stand in the morning: ids of vertiports by ids of aircraft. The others
                stand where the network or the scenario has them.
            name: what people call the day, at most 80 characters.
            date: its date, for example "2026-11-23". Times may then be in ISO 8601.
            time_zone: the time zone of its clock by its name in the IANA database; without it, that of the
                network.
            idempotency_key: a key of your own, for a day that must be made only once even if this process
                ends before the answer comes: at most 128 characters that no other request to the service has.

        Raises:
            ServiceError: V601 if the day is not described well, V602 for an unknown network or policy, V603
                for an unknown aircraft or vertiport; otherwise with the code of what is wrong with the
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
            page_size: how many days are asked for at once, at most 1,000.
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
        """Keeps a network under its name, in the place of one that was uploaded before.

        Days that were made stay as they are.

        Raises:
            ServiceError: V601 if a network of the program has this name, V612 if there are too many.
        """
        body = {"toml": network.toml}
        return self._connection.object(NetworkInfo, keeping("networks", network.name, body=body))

    def validate_network(self, network: str | Network) -> NetworkInfo:
        """What a network has in it, and what is hardly meant in it (``warnings``). It is not kept.

        Args:
            network: the text of a network file, or a network.

        Raises:
            ServiceError: with the code of what is wrong with it.
        """
        body = {"toml": network.toml if isinstance(network, Network) else network}
        return self._connection.object(NetworkInfo, asking("networks", "validate", body=body))

    def delete_network(self, network: str) -> None:
        """Removes a network that was uploaded. Days that were made from it stay as they are.

        Raises:
            ServiceError: V602 if none of this name was uploaded.
        """
        self._connection.remove("networks", network)

    def policies(self) -> list[PolicyInfo]:
        """The policies that can decide: those of the program, then those that were uploaded."""
        return (self._connection.object(PolicyList, reading("policies")))["policies"]

    def policy(self, policy: str) -> PolicyInfo:
        """What is known of the policy with this name.

        Raises:
            ServiceError: V602 if there is none.
        """
        return self._connection.object(PolicyInfo, reading("policies", policy))

    def put_policy(self, policy: str, weights: Model | bytes) -> PolicyInfo:
        """Keeps weights as a policy. Its name means these weights for good.

        Args:
            policy: a name of your own: 1 to 40 letters a-z, digits, dots, dashes and underscores.
            weights: the weights, or the bytes of a weight file.

        Raises:
            ServiceError: V601 if the name means something else already, V612 if there are too many policies;
                otherwise with the code of what is wrong with the weights.
        """
        asked = keeping("policies", policy, body=bytes_of(weights))
        return self._connection.object(PolicyInfo, asked)

    def validate_policy(self, weights: Model | bytes) -> WeightsInfo:
        """What the service would know of these weights. They are not kept.

        Raises:
            ServiceError: with the code of what is wrong with the weights.
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
        """Lets policies play many days of a network in the background, as ``vertifleet compare`` does.

        Ask for it with `study` until its ``state`` is "finished" or "failed". The service keeps it until it
        stops.

        Args:
            network: the name of a network, or a network of your own, which is not kept.
            policies: names of policies, at most 10. The others are measured against the first.
            days: how many days are played, at most 1,000.
            seed: the seed of the first day; 1 without it.
            split: whose days are played: "comparison", or "validation".
            bounds: whether every day gets an upper bound.
            idempotency_key: a key of your own, for a study that must be made only once even if this process
                ends before the answer comes.

        Raises:
            ServiceError: V602 for an unknown network or policy, V612 if it is too large or too many wait;
                otherwise with the code of what is wrong.
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
        """The study with this id: how far it is, and its ``result`` once it has finished.

        Raises:
            ServiceError: V602 if there is none.
        """
        return self._connection.object(StudyInfo, reading("studies", study))

    def study_report(self, study: str) -> str:
        """The result of a study as a page in HTML, which opens without the service too.

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
        """Ends a study if it plays or waits, and forgets it.

        Raises:
            ServiceError: V602 if there is none.
        """
        self._connection.remove("studies", study)

    def info(self) -> ServiceInfo:
        """What the service is, and what the token of this client permits."""
        return self._connection.object(ServiceInfo, Request("GET", "/v1"))

    def is_running(self) -> bool:
        """Whether the service runs. This is asked once, and needs no token."""
        return self._is_well("/healthz")

    def is_ready(self) -> bool:
        """Whether the service can answer: whether its store does. This is asked once, and needs no token."""
        return self._is_well("/readyz")

    def _is_well(self, path: str) -> bool:
        """Whether a sign of life comes."""
        try:
            self._connection.answer_at_once(Request("GET", path))
        except ServiceError as error:
            if not error.is_transient:
                raise
            return False
        return True

    def metrics(self) -> str:
        """What the service measures about itself, in the text format of Prometheus."""
        return (self._connection.answer(Request("GET", "/metrics"))).text

    def description(self) -> Mapping[str, object]:
        """The description of the API that the service has (OpenAPI 3.1)."""
        return self._connection.object(dict[str, object], Request("GET", "/openapi.json"))


def bytes_of(weights: Model | bytes) -> bytes:
    """The bytes of a weight file."""
    return weights.to_bytes() if isinstance(weights, Model) else weights
