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

    @property
    def colour(self) -> str:
        """Colour in pictures, for colour-blind readers too."""
        return ("#ffffff", "#d9e6f2", "#3b3b5c", "#d9822b")[self]

    @property
    def words(self) -> str:
        """As a legend has it."""
        return self.name.lower().replace("_", " ")
