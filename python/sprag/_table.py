"""What all tables of a scene have in common."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import Any, ClassVar, Literal, get_args, get_origin, get_type_hints

from . import _core
from .errors import InputError

# What a table of the scene needs so that one inside it can be checked.
NEEDED: dict[str, dict[str, Any]] = {"block": {"slenderness_deg": 10.0}, "device": {"kind": "clutched-pair"}}

# Those of tables that had texts before.
WORDS: dict[type[Table], dict[str, list[str]]] = {}


class Table:
    """A table of a scene: checked when it is made, and the same wherever it is used."""

    _path: ClassVar[str]
    _fixed: ClassVar[dict[str, str]] = {}

    def __post_init__(self) -> None:
        keys: Any = self._keys()
        first, *inner = self._path.split(".")
        for name in reversed(inner):
            keys = [keys] if name == "0" else {name: keys}
        _core.check_table(first, NEEDED.get(first, {}) | keys)
        hold(self)
        texts = {name: value for name, value in vars(self).items() if isinstance(value, str)}
        known = words(type(self)) if texts else {}
        for name, value in texts.items():
            if value not in known.get(name, [value]):
                key, allowed = ".".join([*inner, name]), f"one of {', '.join(map(json.dumps, known[name]))}"
                raise InputError(f"{first}: {key} is {json.dumps(value)}, but must be {allowed}", key, value, allowed)

    def _keys(self) -> dict[str, Any]:
        """The keys as a scene has them."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]
        return self._fixed | {name: plain(value) for name, value in given.items() if value is not None}

    def __repr__(self) -> str:
        given = ((field.name, getattr(self, field.name)) for field in fields(self))  # type: ignore[arg-type]
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in given if value is not None)})"


def hold(table: Any) -> None:
    """Makes tuples of the lists of a checked table, and a number of an array of one: these do not change, and have a hash."""
    for field in fields(table):
        value = getattr(table, field.name)
        if isinstance(value, list):
            object.__setattr__(table, field.name, tuple(value))
        elif getattr(value, "shape", None) == () and hasattr(value, "__len__"):
            object.__setattr__(table, field.name, value.item())


def words(table: type[Table]) -> dict[str, list[str]]:
    """The words that keys of a table take, where they take no other text: those that the native module looks up in a whole scene only."""
    if table not in WORDS:
        kinds = {name: get_args(hint) for name, hint in get_type_hints(table).items()}
        known = {name: [word for kind in of if get_origin(kind) is Literal for word in get_args(kind)] for name, of in kinds.items()}
        WORDS[table] = {name: found for name, found in known.items() if found}
    return WORDS[table]


def plain(value: Any) -> Any:
    """A value of a scene, tables as dicts."""
    if isinstance(value, Table):
        return value._keys()
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value
