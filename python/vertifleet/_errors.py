"""Expected errors, with the codes of the program and its documentation."""

from __future__ import annotations


class Error(Exception):
    """An error that the caller can fix.

    The error index of the documentation gives cause and fix of every code.
    """

    def __init__(self, code: str, message: str, hint: str | None = None) -> None:
        super().__init__(code, message, hint)
        self.code = code
        """The stable code, for example ``V104``."""
        self.message = message
        """The error, its place and its cause."""
        self.hint = hint
        """How to fix it, if the message does not contain that already."""

    def __str__(self) -> str:
        text = f"{self.code}: {self.message}"
        return text if self.hint is None else f"{text} (hint: {self.hint})"
