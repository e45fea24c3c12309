"""What all tables of a scene have in common."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar

from . import _core

# What a table of the scene needs so that one inside it can be checked.
NEEDED: dict[str, dict[str, Any]] = {"block": {"slenderness_deg": 10.0}, "device": {"kind": "clutched-pair"}}


class Table:
    """A table of a scene: checked when it is made, and the same wherever it is used."""

    _path: ClassVar[str]
    _fixed: ClassVar[dict[str, str]] = {}

    def __post_init__(self) -> None:
        for field in fields(self):  # type: ignore[arg-type]
            value = getattr(self, field.name)
            if isinstance(value, list):
                object.__setattr__(self, field.name, tuple(value))
        keys: Any = self._keys()
        first, *inner = self._path.split(".")
        for name in reversed(inner):
            keys = [keys] if name == "0" else {name: keys}
        _core.check_table(first, NEEDED.get(first, {}) | keys)

    def _keys(self) -> dict[str, Any]:
        """The keys as a scene has them."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]
        return self._fixed | {name: plain(value) for name, value in given.items() if value is not None}

    def __repr__(self) -> str:
        given = ((field.name, getattr(self, field.name)) for field in fields(self))  # type: ignore[arg-type]
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in given if value is not None)})"


def plain(value: Any) -> Any:
    """A value of a scene, tables as dicts."""
    if isinstance(value, Table):
        return value._keys()
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value
