"""A board with the firmware on it, or an emulator."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from . import _core
from ._columns import Columns
from ._loop import ClosedLoop, loop_of, number_of, seed_of
from ._result import Result
from ._scene import Scene
from .errors import InputError

Setting = float | int | bool | str


@dataclass(frozen=True, eq=False)
class BoardLoop(Result):
    """A closed loop in which a board was the controller, beside the one that the host's own controller closed.

    Attributes
    ----------
    board
        The board's loop.
    host
        The host's.
    differing
        Ticks at which the board decided otherwise than the host, to the last bit, or reported nothing.
    firmware
        The firmware, in words.
    """

    board: ClosedLoop = field(repr=False)
    host: ClosedLoop = field(repr=False)
    differing: int
    firmware: str

    __hash__ = Result.__hash__


@dataclass(frozen=True, kw_only=True)
class Board:
    """A place where a board is: every call finds it anew, and lets go of it.

    Attributes
    ----------
    port
        The system's name of a serial port, such as "/dev/ttyUSB0".
    image
        In its place the ELF file of a firmware for the emulator; every call starts a new one, which needs qemu-system-arm.

    Raises
    ------
    InputError
        For neither or both.
    """

    port: str | None = None
    image: str | os.PathLike[str] | None = None

    def __post_init__(self) -> None:
        if (self.port is None) == (self.image is None):
            raise InputError("a board needs either a port or an image", "port")

    def info(self) -> dict[str, Any]:
        """Who the board is and how it is: firmware, seal, jumper, state of its controller, fault, calibration.

        Raises
        ------
        BoardError
            For a board that does not answer; so all calls.
        """
        info: dict[str, Any] = json.loads(_core.board_info(self))
        return info

    def settings(self) -> dict[str, Setting]:
        """All settings, by their names."""
        settings: dict[str, Setting] = json.loads(_core.board_settings(self, [], False))
        return settings

    def change(self, changes: Mapping[str, Setting], *, store: bool = False) -> dict[str, Setting]:
        """Changes settings, and those that follow from them; gives all as they are then.

        Parameters
        ----------
        changes
            New values by names, such as {"model.size": 2.5}.
        store
            Whether the board keeps them in its flash.

        Raises
        ------
        InputError
            For a name that does not exist, and for values that cannot be or contradict each other.
        """
        texts = [(name, value if isinstance(value, str) else json.dumps(value)) for name, value in changes.items()]
        settings: dict[str, Setting] = json.loads(_core.board_settings(self, texts, store))
        return settings

    def log(self) -> Columns:
        """Its event log, oldest first."""
        return Columns(_core.board_log(self))

    def closed_loop(self, scene: Scene, *, device: int | str | None = None, seed: int | None = None) -> BoardLoop:
        """Closes the loop of a scene with the board in the place of the host's controller.

        It gets its settings from the scene, and is detached in the end.

        Parameters
        ----------
        scene, device, seed
            As of sprag.closed_loop.

        Raises
        ------
        InputError
            For a scene without a loop.
        """
        native = _core.board_loop(self, scene._native, number_of(scene, device), seed_of(seed))
        board, host = (loop_of(native.pop(name), scene) for name in ("board", "host"))
        return BoardLoop(board=board, host=host, **native)
