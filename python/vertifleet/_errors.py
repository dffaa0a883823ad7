"""Expected errors, as the program and its documentation name them."""

from __future__ import annotations


class Error(Exception):
    """Something that the caller can put right.

    The error index of the documentation gives cause and fix of every code.
    """

    def __init__(self, code: str, message: str, hint: str | None = None) -> None:
        super().__init__(code, message, hint)
        self.code = code
        """The stable code, as ``V104``."""
        self.message = message
        """What is wrong, where and why."""
        self.hint = hint
        """What helps beside the message, where there is more to say."""

    def __str__(self) -> str:
        text = f"{self.code}: {self.message}"
        return text if self.hint is None else f"{text} (hint: {self.hint})"
