"""The errors of the client, with the codes of the error index."""

from __future__ import annotations

import ssl
from collections.abc import Iterator

import httpx

from vertifleet._errors import Error
from vertifleet.client.types import Problem

TRANSIENT = frozenset({408, 429, 502, 503, 504})
"""Statuses of temporary errors: the same request may succeed later."""


class ServiceError(Error):
    """An error that the service returned.

    ``str(error)`` has the code, the cause and the remedy. The subclass `NoAnswerError` is raised when there
    was no answer at all.
    """

    def __init__(self, code: str, message: str, hint: str | None = None, status: int | None = None) -> None:
        super().__init__(code, message, hint)
        # Exceptions are pickled by their arguments.
        self.args = (code, message, hint, status)
        self.status = status
        """The HTTP status, for example 412; ``None`` if there was no answer."""
        self.tries = 1
        """How often the request was sent."""

    @property
    def detail(self) -> str:
        """The cause: the member ``detail`` of the answer. The same as ``message``."""
        return self.message

    @property
    def is_transient(self) -> bool:
        """Whether the same request may succeed later, so that clients repeat it."""
        # V614: the first try of this request, whose answer was lost, is still in progress.
        return self.status in TRANSIENT or self.code == "V614"


class NoAnswerError(ServiceError):
    """The service did not answer: nothing listens there, the connection was lost, or it took too long (V613).

    A write that ends like this may or may not have been carried out. Sent again with the same
    ``idempotency_key``, it is not carried out twice.
    """

    @property
    def is_transient(self) -> bool:
        """Always true: the service may come back."""
        return True


def error_of(answer: httpx.Response) -> ServiceError:
    """The error in an answer whose body has been read."""
    try:
        problem: Problem = answer.json()
        return ServiceError(problem["code"], problem["detail"], problem.get("hint"), answer.status_code)
    except (ValueError, TypeError, KeyError):
        # Not from the service: perhaps from a proxy in front of it, or from another program at this
        # address.
        return stranger(answer)


def stranger(answer: httpx.Response) -> ServiceError:
    """The error for an answer that another program sent."""
    said = " ".join(answer.text.split())[:200]
    rule = f"{answer.url}: answered {answer.status_code} {answer.reason_phrase}: {said}"
    return ServiceError("V613", rule, "check the address, and proxies on the way", answer.status_code)


def misunderstood(answer: httpx.Response, expected: str) -> ServiceError:
    """The error for an answer that is successful but has another form."""
    rule = f"{answer.url}: the answer is no {expected} of a dispatch service"
    return ServiceError("V613", rule, "check the address, and proxies on the way", answer.status_code)


def unanswered(url: str, failure: httpx.RequestError) -> ServiceError:
    """The error for a request that got no answer."""
    said = str(failure) or type(failure).__name__
    if any(isinstance(cause, ssl.SSLCertVerificationError) for cause in causes(failure)):
        hint = "name the certificate of its authority: verify=PATH"
        return ServiceError("V613", f"{url}: the service's certificate is not trusted: {said}", hint)
    if isinstance(failure, httpx.TimeoutException):
        return NoAnswerError("V613", f"{url}: no answer in time ({said})", "see `timeout`")
    return NoAnswerError(
        "V613", f"{url}: {said}", "check the address, and that `vertifleet serve` runs there"
    )


def causes(failure: BaseException) -> Iterator[BaseException]:
    """An exception and those that it came from."""
    found: BaseException | None = failure
    while found is not None:
        yield found
        found = found.__cause__ or found.__context__
