"""Studies over many records."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _core
from ._columns import Columns
from ._core import Record
from ._result import Result
from ._scene import Scene, named
from ._table import plain
from .errors import InputError

RecordLike = Record | str | os.PathLike[str]


def _listed(records: RecordLike | Iterable[RecordLike]) -> tuple[Record | str, ...]:
    """Records, and files by their paths; one alone is a list of one."""
    items = [records] if isinstance(records, (Record, str, os.PathLike)) else records
    return tuple(item if isinstance(item, Record) else os.fspath(item) for item in items)


class Study:
    """Records, structures, devices and what is asked of them. It never changes; `set` and `use` make another one.

    Studies are TOML, as the command reads them; `sprag new study` writes one to start from.

    Parameters
    ----------
    text
        The study as TOML.
    folder
        Folder that the paths of the text are relative to.
    origin
        Its name in messages.
    records
        Records in the place of its own, as `use` takes them; a study without records of its own needs them.

    Raises
    ------
    InputError
        With the line and the key that is wrong.
    """

    __slots__ = ("_changes", "_folder", "_native", "_origin", "_records", "_text")
    _text: str
    _folder: str
    _origin: str
    _changes: tuple[str, ...]
    _records: tuple[Record | str, ...] | None
    _native: _core.Study

    def __init__(
        self,
        text: str,
        *,
        folder: str | os.PathLike[str] = "",
        origin: str = "study",
        records: RecordLike | Iterable[RecordLike] | None = None,
        _changes: tuple[str, ...] = (),
    ) -> None:
        given = None if records is None else _listed(records)
        memory = [record for record in given or () if isinstance(record, Record)]
        files = [record for record in given or () if not isinstance(record, Record)]
        if memory and files:
            raise InputError("records must be all in memory or all files", "records")
        native = _core.Study(
            text,
            folder=os.fspath(folder),
            origin=origin,
            changes=list(_changes),
            files=files,
            records=None if given is None or files else named(memory),
        )
        values = {"_text": text, "_folder": os.fspath(folder), "_origin": origin, "_changes": _changes, "_records": given}
        for name, value in {**values, "_native": native}.items():
            object.__setattr__(self, name, value)

    @classmethod
    def read(cls, path: str | os.PathLike[str], *, records: RecordLike | Iterable[RecordLike] | None = None) -> Study:
        """The study of a TOML file; with `records` in the place of its own, as `use` takes them.

        Raises
        ------
        InputError
            With the line and the key that is wrong.
        """
        return cls(_core.Study.text(path), folder=Path(path).parent, origin=str(path), records=records)

    def _like(self, **values: Any) -> Study:
        given = {"folder": self._folder, "origin": self._origin, "_changes": self._changes, "records": self._records}
        return Study(self._text, **{**given, **values})

    def set(self, key: str, value: Any) -> Study:
        """The study with `value` for a key of its scene, such as "block.size_m"."""
        return self._like(_changes=(*self._changes, _core.change(key, plain(value))))

    def use(self, records: RecordLike | Iterable[RecordLike]) -> Study:
        """The study with these records in the place of its own: all in memory, or all files and folders of files; one may stand alone."""
        return self._like(records=records)

    @property
    def devices(self) -> tuple[str, ...]:
        """Names of the devices."""
        return tuple(self._native.devices)

    @property
    def structures(self) -> tuple[str, ...]:
        """Names of the structures."""
        return tuple(self._native.structures)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What looks like a mistake, a line each."""
        return tuple(self._native.warnings)

    def _values(self) -> tuple[Any, ...]:
        return self._text, self._folder, self._origin, self._changes, self._records

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("a study never changes: use set or use")

    def __eq__(self, other: object) -> bool:
        return self._values() == other._values() if isinstance(other, Study) else NotImplemented

    def __hash__(self) -> int:
        return hash((self._text, self._changes))

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, self._values()

    def __repr__(self) -> str:
        return f"<Study {self._origin!r}: {', '.join(self.structures)}; {', '.join(self.devices)}>"


def _restored(text: str, folder: str, origin: str, changes: tuple[str, ...], records: tuple[Record | str, ...] | None) -> Study:
    return Study(text, folder=folder, origin=origin, _changes=changes, records=records)


@dataclass(frozen=True, eq=False)
class Cloud(Result):
    """Demands and fragilities over many records.

    Attributes
    ----------
    runs, demand, fragility, ranking
        The tables that the command writes.
    findings
        All that was found, as in summary.json of the command.
    accuracy
        The least accurate of the runs, where that was asked for.
    warnings, unreadable, left_out
        What to know of the records and runs, a line each.
    study
        The study.
    """

    runs: Columns
    demand: Columns
    fragility: Columns
    ranking: Columns
    findings: dict[str, Any] = field(repr=False)
    accuracy: dict[str, Any] | None
    warnings: tuple[str, ...] = field(repr=False)
    unreadable: tuple[str, ...]
    left_out: tuple[str, ...]
    study: Study

    __hash__ = Result.__hash__


@dataclass(frozen=True, eq=False)
class Optimum(Result):
    """The device that overturns least within its limits.

    Attributes
    ----------
    best
        The device to choose; None where none respects the limits.
    designs, motions
        The tables that the command writes.
    findings
        All that was found, as in summary.json of the command.
    accuracy
        The least accurate of the runs, where that was asked for.
    warnings, unreadable, left_out
        What to know of the records and runs, a line each.
    study
        The study.
    """

    best: dict[str, Any] | None
    designs: Columns
    motions: Columns
    findings: dict[str, Any] = field(repr=False)
    accuracy: dict[str, Any] | None
    warnings: tuple[str, ...] = field(repr=False)
    unreadable: tuple[str, ...]
    left_out: tuple[str, ...]
    study: Study

    __hash__ = Result.__hash__


def answer(native: dict[str, Any], lines: tuple[str, ...] = ("warnings", "unreadable", "left_out")) -> dict[str, Any]:
    """What comes from the native module, in the types of results: texts, `lines`, and else tables."""
    texts = {name: json.loads(native.pop(name)) for name in ("findings", "accuracy")}
    said = {name: tuple(native.pop(name)) for name in lines}
    return texts | said | {name: Columns(columns) for name, columns in native.items()}


def cloud(study: Study, *, threads: int | None = None) -> Cloud:
    """Runs every structure of a study under every record with every device: demand models and fragilities (Eq. 24-26).

    Parameters
    ----------
    study
        The study.
    threads
        Threads; one a core by default. Results do not depend on it.

    Raises
    ------
    InputError
        For a study without a record that can be read.
    """
    return Cloud(study=study, **answer(_core.cloud(study._native, threads=threads)))


def optimise(study: Study, *, threads: int | None = None) -> Optimum:
    """Finds the device of a study that overturns least within its limits.

    Parameters
    ----------
    study
        The study, with a table `[optimise]`.
    threads
        Threads; one a core by default. Results do not depend on it.

    Raises
    ------
    InputError
        For a study without a record that can be read.
    RunError
        Where no device could be tried.
    """
    found = answer(_core.optimise(study._native, threads=threads))
    return Optimum(best=found["findings"]["best"], study=study, **found)


def accuracy(scene: Scene, *, cells: int = 12, smallest_step: float = 1e-4, threads: int | None = None) -> Columns:
    """What methods, steps and precisions cost and err over a scene of ideal devices.

    Parameters
    ----------
    scene
        The scene.
    cells
        Cells along each side of the grid of pulses that wrong outcomes are counted over; 0 to 64.
    smallest_step
        Smallest fixed step, in 1/p; 3e-5 to 0.1.
    threads
        Threads; one a core by default. Only times depend on it.

    Raises
    ------
    InputError
        For a scene with anything but ideal devices over horizontal ground.
    """
    return Columns(_core.accuracy(scene._native, cells=cells, smallest_step=smallest_step, threads=threads))
