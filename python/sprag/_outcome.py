"""How a block ends."""

from __future__ import annotations

from enum import IntEnum


class Outcome(IntEnum):
    """How a block ends."""

    NO_ROCKING = 0
    """It never uplifts."""
    SAFE = 1
    """It rocks and stays up."""
    OVERTURNED_WITHOUT_IMPACT = 2
    """It overturns before any impact."""
    OVERTURNED_AFTER_IMPACT = 3
    """It overturns after one impact or more."""

    @classmethod
    def named(cls, name: str) -> Outcome:
        """The outcome that the program calls so, such as "safe"."""
        return cls[name.upper().replace("-", "_")]

    @property
    def overturned(self) -> bool:
        """Whether the block lies down."""
        return self >= Outcome.OVERTURNED_WITHOUT_IMPACT
