"""Parses the messages of a stream from its bytes: server-sent events (HTML Living Standard, 9.2)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Message:
    """A message of a stream."""

    kind: str
    """``message`` for an event of the day, ``behind``, or ``comment`` for an empty line."""
    id: str
    """The number of its event; empty if it has none."""
    text: str
    """Its data."""


class Messages:
    """Assembles messages.

    Lines end with line feeds, as the service writes them. A general splitter of lines would also cut a text
    in two at characters such as U+2028, which JSON does not escape.
    """

    def __init__(self) -> None:
        self._rest = b""
        self._fields: dict[str, str] = {}

    def read(self, received: bytes) -> Iterator[Message]:
        """The messages that are complete with these bytes."""
        *lines, self._rest = (self._rest + received).split(b"\n")
        for line in lines:
            text = line.removesuffix(b"\r").decode()
            name, _, value = text.partition(":")
            value = value.removeprefix(" ")
            if not text:
                yield from self._complete()
            elif not name:
                yield Message("comment", "", value)
            elif name == "data" and "data" in self._fields:
                self._fields["data"] += "\n" + value
            else:
                self._fields[name] = value

    def _complete(self) -> Iterator[Message]:
        """The message that an empty line ends; none without data."""
        found, self._fields = self._fields, {}
        if "data" in found:
            yield Message(found.get("event", "message"), found.get("id", ""), found["data"])
