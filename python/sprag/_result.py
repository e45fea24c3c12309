"""What all results have in common: they compare by value, arrays bit by bit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields
from hashlib import sha256
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core

if TYPE_CHECKING:
    from ._scene import Scene


class Result:
    """A result: compares and hashes by its values, arrays by their bits; its arrays cannot be written to."""

    def __post_init__(self) -> None:
        for array in arrays(self):
            array.setflags(write=False)

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Arrays of a pickle can be written to.
        self.__dict__.update(state)
        self.__post_init__()

    def digest(self) -> str:
        """SHA-256 of all its arrays, the same on every machine. Numbers outside of arrays, and texts, are not in it."""
        hashed = sha256()
        for array in arrays(self):
            hashed.update(np.ascontiguousarray(array).tobytes())
        return hashed.hexdigest()

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(same(getattr(self, field.name), getattr(other, field.name)) for field in fields(self))  # type: ignore[arg-type]

    def __hash__(self) -> int:
        return hash(self.digest())


class SceneResult(Result):
    """A result of a scene."""

    scene: Scene

    def provenance(self) -> dict[str, str]:
        """Version and scene, as attributes of data sets have them."""
        return {"sprag_version": _core.__version__, "scene": self.scene.to_toml(), "digest": self.digest()}


def arrays(value: Any) -> Iterator[npt.NDArray[Any]]:
    """All arrays in a result, in their order."""
    if isinstance(value, np.ndarray):
        yield value
    inner: Iterable[Any] = ()
    if isinstance(value, Result):
        inner = (getattr(value, field.name) for field in fields(value))  # type: ignore[arg-type]
    elif isinstance(value, (tuple, dict)):
        inner = value.values() if isinstance(value, dict) else value
    for item in inner:
        yield from arrays(item)


def same(one: Any, two: Any) -> bool:
    """Whether two values are the same, a NaN as itself."""
    if isinstance(one, np.ndarray) and isinstance(two, np.ndarray):
        return one.shape == two.shape and one.dtype == two.dtype and one.tobytes() == two.tobytes()
    if isinstance(one, tuple) and isinstance(two, tuple):
        return len(one) == len(two) and all(map(same, one, two))
    if isinstance(one, dict) and isinstance(two, dict):
        return one.keys() == two.keys() and all(same(one[key], two[key]) for key in one)
    return bool(one == two)


def extra(name: str) -> Any:
    """A package that is imported only when it is asked for.

    Raises
    ------
    ImportError
        With the command that installs it.
    """
    from importlib import import_module

    try:
        return import_module(name)
    except ImportError as error:
        package = name.split(".")[0]
        raise ImportError(f"this needs {package}: pip install {package}") from error
