"""Requests of the API as plain values, which are made once and may be sent several times."""

from __future__ import annotations

import json
import os
import random
import ssl
import uuid
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from urllib.parse import quote, urlsplit

from vertifleet._errors import Error

FIRST_PAUSE_S = 0.1
"""A request without an answer is repeated after this time, then after twice as long, and so on."""

LONGEST_PAUSE_S = 5.0
"""The longest pause between two tries."""


@dataclass(frozen=True)
class Request:
    """A request. A repeated one has the same bytes, so that the service recognises it by its key."""

    method: str
    path: str
    query: Mapping[str, str] = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)
    body: bytes | None = None


def path_of(*segments: str) -> str:
    """The path of these segments, each of which may be any text."""
    return "/v1/" + "/".join(quote(segment, safe="") for segment in segments)


def reading(*path: str, **query: int | str | None) -> Request:
    """A request that reads, with those parameters that are given."""
    return Request("GET", path_of(*path), {name: str(value) for name, value in given(query).items()})


def asking(*path: str, body: object, **query: str | None) -> Request:
    """A request with a body that changes nothing."""
    asked = reading(*path, **query)
    return replace(asked, method="POST", headers=header_of(body), body=written(body))


def keeping(*path: str, body: object) -> Request:
    """A request that stores an object under a name; it is idempotent."""
    return Request("PUT", path_of(*path), headers=header_of(body), body=written(body))


def writing(
    *path: str, body: object, if_match: int | None = None, idempotency_key: str | None = None
) -> Request:
    """A request that writes, with a key by which the service recognises a repeated one."""
    key = {"Idempotency-Key": idempotency_key or str(uuid.uuid4())}
    headers = {**header_of(body), **key, **matching(if_match)}
    return Request("POST", path_of(*path), headers=headers, body=written(body))


def changing(method: str, *path: str, if_match: int | None = None) -> Request:
    """A request that changes the object at its path; it is idempotent."""
    return Request(method, path_of(*path), headers=matching(if_match))


def matching(if_match: int | None) -> dict[str, str]:
    """The header that makes a request fail if the day has changed since an event."""
    return {} if if_match is None else {"If-Match": f'"{if_match}"'}


def given(members: Mapping[str, object]) -> dict[str, object]:
    """The members that are given."""
    return {name: value for name, value in members.items() if value is not None}


def header_of(body: object) -> dict[str, str]:
    """The header with the type of a body."""
    return {"Content-Type": "application/octet-stream" if isinstance(body, bytes) else "application/json"}


def written(body: object) -> bytes:
    """A body as bytes: unchanged, or else as JSON."""
    if isinstance(body, bytes):
        return body
    # Mappings need not be dicts.
    return json.dumps(body, separators=(",", ":"), default=dict).encode()


def pauses(retries: int) -> Iterator[float]:
    """Seconds to wait before each of this many repetitions, each about twice as long as the last.

    They are random, so that clients that lost their service together do not all come back at once.
    """
    for attempt in range(retries):
        yield min(FIRST_PAUSE_S * 2**attempt, LONGEST_PAUSE_S) * random.uniform(0.5, 1.0)


def checked_url(url: str) -> str:
    """An address of a service.

    Raises:
        Error: V451 if it is invalid.
    """
    try:
        parts = urlsplit(url)
        is_address = parts.scheme in ("http", "https") and parts.hostname and parts.port != 0
    except ValueError:
        is_address = False
    if not is_address:
        raise Error("V451", f"url must be http:// or https:// and a host, found {url!r}")
    return url.rstrip("/")


def trust_of(verify: bool | str | os.PathLike[str] | ssl.SSLContext) -> bool | ssl.SSLContext:
    """How certificates are verified; a path is that of a file with certificates of authorities.

    Raises:
        Error: V624 if the file cannot be used as such.
    """
    if isinstance(verify, (bool, ssl.SSLContext)):
        return verify
    try:
        return ssl.create_default_context(cafile=verify)
    except OSError as error:
        raise Error("V624", f"{os.fspath(verify)}: {error}", "name a PEM file with certificates") from error
