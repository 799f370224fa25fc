"""Errors and warnings of files and scenes."""

from __future__ import annotations

import warnings


class FormatError(ValueError):
    """A file is damaged, of no known format, or cannot be written.

    ``file`` is its name; ``line``, counted from 1, or ``byte`` is the place in it, if there is one; ``found`` and
    ``expected`` describe the actual and the expected content.
    """

    def __init__(
        self,
        message: str,
        file: str = "",
        line: int | None = None,
        byte: int | None = None,
        found: str = "",
        expected: str = "",
    ) -> None:
        super().__init__(message, file, line, byte, found, expected)
        self.file = file
        self.line = line
        self.byte = byte
        self.found = found
        self.expected = expected

    def __str__(self) -> str:
        return str(self.args[0])


class SceneError(ValueError):
    """A mistake in a scene; ``file``, ``line``, counted from 1, and ``key`` are its place."""

    def __init__(self, message: str, file: str = "", line: int | None = None, key: str = "") -> None:
        super().__init__(message, file, line, key)
        self.file = file
        self.line = line
        self.key = key

    def __str__(self) -> str:
        return str(self.args[0])


class GuessWarning(UserWarning):
    """Some values of a material are guessed and not measured."""


def warn_of_guess(message: str) -> None:
    """Warns; called by the native module, whose functions have no stack frames."""
    warnings.warn(message, GuessWarning, stacklevel=2)
