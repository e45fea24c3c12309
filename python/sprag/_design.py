"""Parts lists."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from . import _core
from ._columns import Columns
from ._core import Record
from ._result import SceneResult
from ._scene import Scene, named
from ._study import answer
from .errors import InputError


@dataclass(frozen=True, eq=False)
class Design(SceneResult):
    """Parts of every device of a scene that has a flywheel.

    Attributes
    ----------
    parts, motions, delays
        The tables that the command writes.
    page
        The page to hand on, Markdown.
    findings
        What was found of each device, as the designs in summary.json of the command.
    accuracy
        The least accurate of the runs that parts are sized by, where that was asked for.
    warnings, failed, left_out
        What looks like a mistake in the scene and its records, runs that failed, and what could not be found out; a line each.
    scene
        The scene.
    """

    parts: Columns
    motions: Columns
    delays: Columns
    page: str = field(repr=False)
    findings: list[dict[str, Any]] = field(repr=False)
    accuracy: dict[str, Any] | None
    warnings: tuple[str, ...] = field(repr=False)
    failed: tuple[str, ...]
    left_out: tuple[str, ...]
    scene: Scene = field(repr=False)

    __hash__ = SceneResult.__hash__

    def _repr_markdown_(self) -> str:
        """The page, for notebooks."""
        return self.page


def design(
    scene: Scene,
    *,
    records: Record | Sequence[Record] = (),
    devices: str | Sequence[str] = (),
    margin: float = 1.25,
    service_factor: float = 1.5,
    teeth: int = 20,
    face_width_modules: float = 10.0,
    allowable_stress_mpa: float | None = None,
    tolerance: float = 0.05,
    threads: int | None = None,
) -> Design:
    """Sizes the parts of every device of a scene that has a flywheel: support, rack, pinion, clutches, flywheels, coils, sensors.

    Parameters
    ----------
    scene
        The scene; its block has a mass.
    records
        Records, each in the place of the scene's, beside its own motion; one may stand alone.
    devices
        Name of the device to design, or names of several; all that have a flywheel without it.
    margin
        Factor on force, travel and readings of sensors; 1 to 10.
    service_factor
        Factor on the torque of a clutch, and on the load of teeth where no clutch limits it; 1 to 10.
    teeth
        Teeth of the pinion; 12 to 200.
    face_width_modules
        Face width of the gear over its module; 4 to 20.
    allowable_stress_mpa
        Bending stress that teeth may bear by Lewis's formula, MPa; that of the scene's checks or else 200 without it.
    tolerance
        Share by which the largest rotation may grow through late clutches; above 0, to 1.
    threads
        Threads; one a core by default. Results do not depend on it.

    Raises
    ------
    InputError
        For an assumption outside its range, a block without a mass, devices that there are not, and what is no record.
    RunError
        Where no device has a list: no motion lifts the block, or no standard gear bears the load.
    """
    basis = {
        "margin": margin,
        "service_factor": service_factor,
        "teeth": teeth,
        "face_width_modules": face_width_modules,
        "allowable_stress_mpa": allowable_stress_mpa,
        "tolerance": tolerance,
    }
    names = [devices] if isinstance(devices, str) else list(devices)
    given = list(records) if isinstance(records, Iterable) else [records]
    if not all(isinstance(record, Record) for record in given):
        raise InputError("records must be sprag.Record, as sprag.Record.read gives them", "records")
    native = _core.design(scene._native, records=named(given), devices=names, basis=basis, threads=threads)
    page = native.pop("page")
    return Design(scene=scene, page=page, **answer(native, ("warnings", "failed", "left_out")))
