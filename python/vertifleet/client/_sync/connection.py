# Written from ../_async/connection.py by python/tools/client_sync.py: do not edit.
"""The connection to a service: requests are sent until they are answered, and answers are read."""

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
"""A connection must be made within this time."""

SILENCE_S = 15.0
"""The service sends a sign of life every 2 s on a stream: one that is silent for this long is lost."""


class Connection:
    """A connection to a service, which is made when it is first needed, and again when it was lost."""

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
        """The object that answers a request, as `answer` has it."""
        answer = self.answer(request)
        try:
            found = answer.json()
        except ValueError:
            found = None
        if not isinstance(found, dict):
            raise misunderstood(answer, kind.__name__)
        return cast(Answer, found)

    def answer(self, request: Request) -> httpx.Response:
        """The answer to a request, which is sent again while the service cannot answer it.

        Raises:
            ServiceError: if it is answered by an error, or not at all.
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
        """Removes what a path names.

        Raises:
            ServiceError: if it cannot be removed, or is not there when it is first asked to be.
        """
        try:
            self.answer(changing("DELETE", *path, if_match=if_match))
        except ServiceError as error:
            # A sending whose answer did not come may have removed it.
            if error.code != "V602" or error.tries == 1:
                raise

    def answer_at_once(self, request: Request) -> httpx.Response:
        """The answer to a request, which is sent once.

        Raises:
            ServiceError: if it is answered by an error, or not at all.
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
        """A request as the HTTP library has it."""
        return self._http.build_request(
            request.method,
            request.path,
            params=request.query,
            headers=request.headers,
            content=request.body,
            timeout=timeout or httpx.USE_CLIENT_DEFAULT,
        )
