"""What the package raises."""

from __future__ import annotations


class InputError(ValueError):
    """Input that is refused before any work.

    Attributes
    ----------
    key
        What is wrong, such as "block.size_m"; None where no key is.
    value
        Its value; None where there is none.
    range
        What it may be; None where there is no range.
    """

    def __init__(self, message: str, key: str | None = None, value: float | str | None = None, range: str | None = None) -> None:
        super().__init__(message, key, value, range)
        self.key = key
        self.value = value
        self.range = range

    def __str__(self) -> str:
        return str(self.args[0])


class RunError(RuntimeError):
    """Valid input from which no result came: a motion that could not be followed."""


class BoardError(RuntimeError):
    """A board or an emulator that does not answer, or refuses."""
