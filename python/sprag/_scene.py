"""Scenes: a block, its devices, the ground motion and how accurately to follow them."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from . import _core
from ._core import Record
from ._table import hold, plain
from ._tables import Accuracy, Block, Checks, Controller, Device, Duration, Motion, NoDevice, Output
from .errors import InputError


@dataclass(frozen=True, kw_only=True)
class RecordedMotion:
    """A record as ground motion, scaled and begun later.

    Attributes
    ----------
    record
        The record.
    scale
        Factor on the whole motion; from -1000 to 1000.
    start_s
        Start; from 0 to 1e4.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    record: Record
    scale: float = 1.0
    start_s: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.record, Record):
            raise InputError("record must be a sprag.Record", "record")
        _core.check_table("ground", self._keys("record"))
        hold(self)

    def _keys(self, name: str) -> dict[str, Any]:
        return {"motion": "record", "file": name, "scale": self.scale, "start_s": self.start_s}


Ground = Motion | Record | RecordedMotion


@dataclass(frozen=True, kw_only=True)
class Axis:
    """An axis of a map: a numeric key of the scene, and the values that it takes.

    Attributes
    ----------
    key
        Key with dots, such as "ground.0.frequency_ratio".
    start
        Value of the first cell.
    stop
        Value of the last cell, above `start`.
    cells
        Cells, both ends included; from 2 to 100000.
    logarithmic
        Whether cells are equal factors apart, not equal steps.
    """

    key: str
    start: float
    stop: float
    cells: int
    logarithmic: bool = False

    def _keys(self) -> dict[str, Any]:
        scale = "logarithmic" if self.logarithmic else "linear"
        return {"key": self.key, "from": self.start, "to": self.stop, "cells": self.cells, "scale": scale}


def _place(name: str) -> tuple[str, ...]:
    """What is equal for names that the native module takes for one path; for some others too, whose records then have other names."""
    return tuple(part for part in name.replace("\\", "/").split("/") if part not in ("", "."))


def _files(value: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """Keys and values of every `file` in a value of a scene: a file, or a record in memory by its name."""
    if isinstance(value, (str, os.PathLike)):
        if key.rpartition(".")[2] == "file":
            yield key, os.fsdecode(value)
        return
    value = plain(value)
    inner: Iterable[tuple[Any, Any]] = ()
    if isinstance(value, dict):
        inner = value.items()
    elif isinstance(value, (list, tuple)):
        inner = enumerate(value)
    for name, item in inner:
        yield from _files(item, f"{key}.{name}" if key else str(name))


class _Records:
    """Records in memory under names that differ as paths do, from each other and from `files`: else one would take the place of another."""

    def __init__(self, records: Iterable[tuple[str, Record]] = (), files: Iterable[str] = ()) -> None:
        self.named = dict(records)
        self._taken = {_place(name) for name in [*self.named, *files]}

    def name(self, record: Record) -> str:
        number = 1
        name = record.name
        while (held := self.named.get(name)) != record:
            if held is None and _place(name) not in self._taken:
                self.named[name] = record
                self._taken.add(_place(name))
                break
            number += 1
            name = f"{record.name} ({number})"
        return name

    def keys(self, value: Any) -> Any:
        """A value of a scene, with records by their names."""
        if isinstance(value, Record):
            value = RecordedMotion(record=value)
        if isinstance(value, RecordedMotion):
            return value._keys(self.name(value.record))
        if isinstance(value, Axis):
            return value._keys()
        if isinstance(value, (list, tuple)):
            return [self.keys(item) for item in value]
        return plain(value)


def named(records: Iterable[Record]) -> list[tuple[str, Record]]:
    """Records with names that differ."""
    names = _Records()
    for record in records:
        names.name(record)
    return list(names.named.items())


def _listed(value: Any) -> list[Any]:
    return list(value) if isinstance(value, (list, tuple)) else [value]


class Scene:
    """A block, its devices and the ground motion, every value within its range. It never changes; `set` makes another one.

    Parameters
    ----------
    block
        The block that rocks.
    ground
        Horizontal ground motions, which are summed; none for free rocking.
    device
        Devices, one run each; up to 16.
    vertical
        Vertical ground motions, positive upwards, which are summed.
    duration, accuracy, checks, controller, output
        How long and how accurately the motion is followed, and what is asked beside it.
    title
        Title of pictures and tables.

    Raises
    ------
    InputError
        With the key that is wrong, its value and what it may be.
    """

    __slots__ = ("_native",)
    _native: _core.Scene

    def __init__(
        self,
        *,
        block: Block,
        ground: Ground | Sequence[Ground] = (),
        device: Device | Sequence[Device] = NoDevice(),  # noqa: B008 - it never changes
        vertical: Ground | Sequence[Ground] = (),
        duration: Duration | None = None,
        accuracy: Accuracy | None = None,
        checks: Checks | None = None,
        controller: Controller | None = None,
        output: Output | None = None,
        title: str = "",
    ) -> None:
        given = {
            "title": title or None,
            "block": block,
            "device": _listed(device),
            "ground": _listed(ground),
            "vertical": _listed(vertical) or None,
            "run": duration,
            "accuracy": accuracy,
            "checks": checks,
            "controller": controller,
            "output": output,
        }
        records = _Records(files=(file for _, file in _files(given)))
        keys = {name: records.keys(value) for name, value in given.items() if value is not None}
        self._hold(_core.Scene(keys, records=list(records.named.items())))

    def _hold(self, native: _core.Scene) -> None:
        object.__setattr__(self, "_native", native)

    @classmethod
    def _of(cls, native: _core.Scene) -> Scene:
        scene = cls.__new__(cls)
        scene._hold(native)
        return scene

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Scene:
        """The scene of a TOML file, as the command `sprag` reads it.

        Raises
        ------
        InputError
            With the line and the key that is wrong.
        """
        return cls._of(_core.Scene.read(path))

    @classmethod
    def parse(cls, text: str, *, folder: str | os.PathLike[str] = "") -> Scene:
        """The scene of a TOML text; record files are relative to `folder`.

        Raises
        ------
        InputError
            With the line and the key that is wrong.
        """
        return cls._of(_core.Scene.parse(text, folder=folder))

    def set(self, key: str, value: Any) -> Scene:
        """The scene with `value` for a key with dots, such as "device.1.mass_ratio"; None leaves the key out.

        The value may be a number, a text, a table such as sprag.Inerter, or a record.

        Raises
        ------
        InputError
            For a key that does not exist, with the one that was probably meant, or a value outside its range.
        """
        kept = [file for of, file in _files(self._table()) if of != key and not of.startswith(f"{key}.")]
        files = [*kept, *(file for _, file in _files(value, key))]
        # A record that the scene no longer names would be carried along for ever.
        places = {_place(file) for file in files}
        records = _Records(((name, record) for name, record in self._native.records if _place(name) in places), files)
        keys = records.keys(value)
        return Scene._of(self._native.set(key, keys, list(records.named.items())))

    def _table(self) -> dict[str, Any]:
        """The keys of the scene as they were written."""
        table: dict[str, Any] = json.loads(self._native.written())
        return table

    @property
    def devices(self) -> tuple[str, ...]:
        """Names of the devices."""
        return tuple(self._native.devices)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What looks like a mistake, a line each."""
        return tuple(self._native.warnings)

    @property
    def size_m(self) -> float:
        """Size R of the block, m."""
        return self._native.size_m

    @property
    def slenderness_rad(self) -> float:
        """Slenderness α of the block, rad."""
        return self._native.slenderness_rad

    @property
    def frequency_parameter_1_s(self) -> float:
        """Frequency parameter p = √(g/(λR)) of the block, 1/s."""
        return self._native.frequency_parameter_1_s

    @property
    def uplift_threshold_g(self) -> float:
        """Ground acceleration at which the block uplifts, g: tan α, or α of the slender model."""
        return self._native.uplift_threshold_g

    def to_toml(self) -> str:
        """The scene as TOML, which `sprag` reads; records in memory are named there, and not written."""
        return self._native.text()

    def to_dict(self) -> dict[str, Any]:
        """The keys of the scene with their defaults filled in."""
        keys: dict[str, Any] = json.loads(self._native.resolved())
        return keys

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a scene never changes: use scene.set({name!r}, ...)")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        one, two = self._native, other._native
        return one.resolved() == two.resolved() and one.folder == two.folder and dict(one.records) == dict(two.records)

    def __hash__(self) -> int:
        return hash(self._native.resolved())

    def __reduce__(self) -> tuple[Any, ...]:
        native = self._native
        return _restored, (native.text(), native.records, native.folder, native.origin)

    def __repr__(self) -> str:
        return f"<Scene {self._native.origin!r}: {', '.join(self.devices)}>"


def _restored(text: str, records: list[tuple[str, Record]], folder: str, origin: str) -> Scene:
    return Scene._of(_core.Scene.parse(text, records=records, folder=folder, origin=origin))
