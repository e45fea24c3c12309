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
    LIFTED_OFF = 4
    """The toe of a block that slides leaves the ground, where the run ends; no study has it."""

    @classmethod
    def named(cls, name: str) -> Outcome:
        """The outcome that the program calls so, such as "safe"."""
        return cls[name.upper().replace("-", "_")]

    @classmethod
    def of_studies(cls) -> tuple[Outcome, ...]:
        """Those of maps and other studies."""
        return tuple(outcome for outcome in cls if outcome is not cls.LIFTED_OFF)

    @property
    def overturned(self) -> bool:
        """Whether the block lies down."""
        return self in (Outcome.OVERTURNED_WITHOUT_IMPACT, Outcome.OVERTURNED_AFTER_IMPACT)

    @property
    def colour(self) -> str:
        """Colour in pictures, for colour-blind readers too."""
        return ("#ffffff", "#d9e6f2", "#3b3b5c", "#d9822b", "#999999")[self]

    @property
    def words(self) -> str:
        """As a legend has it."""
        return self.name.lower().replace("_", " ")
