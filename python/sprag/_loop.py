"""The controller in closed loop with the plant, its sensors and its clutches."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Situation
from ._outcome import Outcome
from ._result import SceneResult, extra
from ._run import ErrorEstimate, Run, run_of
from ._scene import Scene
from .errors import InputError

if TYPE_CHECKING:
    import pandas


class Wish(IntEnum):
    """What a clutch law wants."""

    RELEASE = 0
    """Both clutches open."""
    RESIST = 1
    """The flywheel whose turn it is resists."""
    HOLD = 2
    """The first flywheel stays on the rack, whatever it does there."""


Law = Callable[[Situation], "Wish | bool | np.bool_"]


@dataclass(frozen=True, eq=False)
class ClosedLoop(SceneResult):
    """A controller run over a scene: truth, sensors, estimates and commands of every control tick.

    Attributes
    ----------
    device
        Name of the device.
    outcome
        How the block ends.
    peak_rotation
        max |θ|/α; None when overturned.
    error
        How accurate it is, where the scene asks for that.
    columns
        An array of each quantity, a value a tick; units are in the names. `wish` is a Wish; `command` and `engaged` are 0 for no clutch,
        1 for the first, 2 for the second, 3 for both; `ideal` is what the law would want of the true motion.
    decisions_digest
        Hash of all decisions, bit by bit.
    summary
        All figures of the run, as in summary.json of the command.
    warnings
        What looks like a mistake in the scene, its record files and its controller, a line each.
    ideal_pair
        The run of the ideal pair without a controller.
    scene
        The scene.
    """

    device: str
    outcome: Outcome
    peak_rotation: float | None
    error: ErrorEstimate | None
    columns: dict[str, npt.NDArray[Any]] = field(repr=False)
    decisions_digest: int
    summary: dict[str, Any] = field(repr=False)
    warnings: tuple[str, ...] = field(repr=False)
    ideal_pair: Run = field(repr=False)
    scene: Scene = field(repr=False)

    __hash__ = SceneResult.__hash__

    @property
    def t(self) -> npt.NDArray[np.float64]:
        """Times of the control ticks, s."""
        return self.columns["t"]

    def to_pandas(self) -> pandas.DataFrame:
        """The columns as a data frame."""
        frame: pandas.DataFrame = extra("pandas").DataFrame(self.columns)
        return frame


def number_of(scene: Scene, device: int | str | None) -> int | None:
    """The number of a device of a scene."""
    if isinstance(device, str):
        if device not in scene.devices:
            raise InputError(
                f"device is {device!r}, but must be one of {', '.join(scene.devices)}", "device", device, ", ".join(scene.devices)
            )
        return scene.devices.index(device)
    if device is not None and not 0 <= device < len(scene.devices):
        within = f"a whole number from 0 to {len(scene.devices) - 1}"
        raise InputError(f"device is {device}, but must be {within}", "device", device, within)
    return device


def seed_of(seed: int | None) -> int | None:
    """A seed that the native module has room for."""
    if seed is not None and not 0 <= seed < 2**64:
        within = "a whole number from 0 to 18446744073709551615"
        raise InputError(f"seed is {seed}, but must be {within}", "seed", seed, within)
    return seed


def loop_of(native: dict[str, Any], scene: Scene) -> ClosedLoop:
    """A closed loop as it comes from the native module."""
    summary = json.loads(native.pop("summary"))
    digest, ideal = native.pop("digest"), native.pop("ideal_pair")
    warnings = tuple(native.pop("warnings"))
    error = summary.get("error_estimate")
    return ClosedLoop(
        device=summary["device"],
        outcome=Outcome.named(summary["outcome"]),
        peak_rotation=summary["peak_rotation"],
        error=None if error is None else ErrorEstimate(**error),
        columns=native,
        decisions_digest=digest,
        summary=summary,
        warnings=warnings,
        ideal_pair=run_of(ideal, scene),
        scene=scene,
    )


def closed_loop(
    scene: Scene,
    *,
    device: int | str | None = None,
    law: Law | None = None,
    predicts: bool = True,
    seed: int | None = None,
) -> ClosedLoop:
    """Runs the controller of a scene in closed loop over one of its clutched pairs.

    Parameters
    ----------
    scene
        The scene; without a controller of its own it has the default one.
    device
        The pair, by number or name; the first one by default.
    law
        A function of the Situation at a control tick that returns a Wish, or whether to resist, in the place of the scene's law. It is
        called twice a tick, also for the true motion, by which its decisions are judged: let it depend on nothing else. Other
        threads of Python run only while it does.
    predicts
        Whether a law of one's own is asked about the instant at which its answer takes effect, and not about now.
    seed
        Seed of the sensors' errors and noise, in the place of the scene's; 0 to 2⁶⁴ − 1.

    Raises
    ------
    InputError
        For a scene without such a pair, or one that begins in motion.
    RunError
        For a motion that cannot be followed.
    """
    native = _core.closed_loop(scene._native, device=number_of(scene, device), seed=seed_of(seed), law=law, predicts=predicts)
    return loop_of(native, scene)
