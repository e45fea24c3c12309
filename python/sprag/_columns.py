"""Tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._result import Result, extra

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False, repr=False)
class Columns(Result):
    """A table: an array or a list of texts by the name of each column, as the command writes it.

    Attributes
    ----------
    columns
        The columns; a number that is not there is NaN, a text None.
    """

    columns: dict[str, Any]

    __hash__ = Result.__hash__

    def __getitem__(self, name: str) -> Any:
        return self.columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __repr__(self) -> str:
        return f"<Columns: {len(self)} rows of {', '.join(self)}>"

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a data frame."""
        frame: pandas.DataFrame = extra("pandas").DataFrame(self.columns)
        return frame
