"""What goes wrong with files and scenes."""

from __future__ import annotations

import warnings


class FormatError(ValueError):
    """A file that is damaged, of no known format, or cannot be written.

    ``file`` is its name; ``line`` or ``byte`` the place in it, if there is one, the line counted from 1; ``found`` and
    ``expected`` are what is there and what should be.
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
    """A mistake in a scene: ``file``, ``line``, counted from 1, and ``key`` say where."""

    def __init__(self, message: str, file: str = "", line: int | None = None, key: str = "") -> None:
        super().__init__(message, file, line, key)
        self.file = file
        self.line = line
        self.key = key

    def __str__(self) -> str:
        return str(self.args[0])


class GuessWarning(UserWarning):
    """Some of the answers of a material are guessed rather than measured."""


def warn_of_guess(message: str) -> None:
    """Called by the native module, whose functions have no frames."""
    warnings.warn(message, GuessWarning, stacklevel=2)
