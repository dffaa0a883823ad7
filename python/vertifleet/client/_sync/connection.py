# Written from ../_async/connection.py by python/tools/client_sync.py: do not edit.
"""The connection to a service: sends requests until they are answered, and reads the answers."""

from __future__ import annotations

import os
import ssl
import time as clock
from collections.abc import Generator, Iterator, Mapping
from typing import TypeVar, cast

import httpx

from vertifleet.client._errors import NoAnswerError, ServiceError, error_of, misunderstood, unanswered
from vertifleet.client._messages import Message, Messages
from vertifleet.client._requests import Request, changing, checked_url, pauses, trust_of

Answer = TypeVar("Answer", bound=Mapping[str, object])

CONNECT_S = 5.0
"""Time limit for a new connection."""

SILENCE_S = 15.0
"""A stream that is silent for this long is lost: the service sends a comment on it every 2 s."""


class Connection:
    """A connection to a service, which is opened at its first use, and again after a loss."""

    def __init__(
        self,
        url: str,
        token: str | None,
        timeout: float,
        retries: int,
        verify: bool | str | os.PathLike[str] | ssl.SSLContext,
        transport: httpx.BaseTransport | None,
    ) -> None:
        self.url = checked_url(url)
        self._retries = retries
        token = os.environ.get("VERTIFLEET_TOKEN") if token is None else token
        self._http = httpx.Client(
            base_url=self.url,
            headers={"Authorization": f"Bearer {token}"} if token else {},
            timeout=httpx.Timeout(timeout, connect=min(timeout, CONNECT_S)),
            verify=trust_of(verify),
            transport=transport,
        )

    def close(self) -> None:
        """Closes it."""
        self._http.close()

    def pauses(self) -> Iterator[float]:
        """Seconds to wait before each further try."""
        return pauses(self._retries)

    def object(self, kind: type[Answer], request: Request) -> Answer:
        """The object in the answer to a request."""
        answer = self.answer(request)
        try:
            found = answer.json()
        except ValueError:
            found = None
        if not isinstance(found, dict):
            raise misunderstood(answer, kind.__name__)
        return cast(Answer, found)

    def answer(self, request: Request) -> httpx.Response:
        """The answer to a request, which is repeated while the service cannot answer it.

        Raises:
            ServiceError: if the answer is an error, or if there is none.
        """
        pauses = self.pauses()
        tries = 0
        while True:
            tries += 1
            try:
                return self.answer_at_once(request)
            except ServiceError as error:
                error.tries = tries
                pause_s = next(pauses, None)
                if pause_s is None or not error.is_transient:
                    raise
                clock.sleep(pause_s)

    def remove(self, *path: str, if_match: int | None = None) -> None:
        """Removes the object at a path.

        Raises:
            ServiceError: if it cannot be removed, or does not exist at the first try.
        """
        try:
            self.answer(changing("DELETE", *path, if_match=if_match))
        except ServiceError as error:
            # An earlier try whose answer was lost may have removed it.
            if error.code != "V602" or error.tries == 1:
                raise

    def answer_at_once(self, request: Request) -> httpx.Response:
        """The answer to a request, which is sent once.

        Raises:
            ServiceError: if the answer is an error, or if there is none.
        """
        try:
            answer = self._http.send(self._as_http(request))
        except httpx.RequestError as failure:
            raise unanswered(self.url, failure) from failure
        if not answer.is_success:
            raise error_of(answer)
        return answer

    def messages(self, request: Request) -> Generator[Message, None, None]:
        """The messages of a stream, until it is lost.

        Raises:
            NoAnswerError: when it is lost, at the latest when the service stops.
            ServiceError: if the service refuses it.
        """
        asked = self._as_http(request, httpx.Timeout(SILENCE_S, connect=CONNECT_S))
        messages = Messages()
        try:
            answer = self._http.send(asked, stream=True)
            try:
                if not answer.is_success:
                    answer.read()
                    raise error_of(answer)
                for received in answer.iter_bytes():
                    for message in messages.read(received):
                        yield message
            finally:
                answer.close()
        except httpx.RequestError as failure:
            raise unanswered(self.url, failure) from failure
        raise NoAnswerError("V613", f"{self.url}: the stream has ended")

    def _as_http(self, request: Request, timeout: httpx.Timeout | None = None) -> httpx.Request:
        """A request in the form of the HTTP library."""
        return self._http.build_request(
            request.method,
            request.path,
            params=request.query,
            headers=request.headers,
            content=request.body,
            timeout=timeout or httpx.USE_CLIENT_DEFAULT,
        )
