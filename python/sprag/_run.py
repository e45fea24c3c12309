"""Responses of a block to ground motion."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._columns import Columns
from ._outcome import Outcome
from ._result import SceneResult, extra
from ._scene import Scene

if TYPE_CHECKING:
    import matplotlib.axes
    import xarray

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ErrorEstimate:
    """Absolute errors of a result, from the same motion followed more closely.

    Attributes
    ----------
    peak_rotation
        Of max |θ|/α.
    peak_acceleration
        Of max |θ̈|/(p²α).
    first_impact_time
        Of the time of the first impact, s.
    outcome_certain
        Whether no closer look changed the outcome.
    tolerance
        Size of the last terms of the series over the rotation that matters.
    as_wanted
        False where the error that was asked for cannot be had.
    """

    peak_rotation: float
    peak_acceleration: float
    first_impact_time: float
    outcome_certain: bool
    tolerance: float
    as_wanted: bool


@dataclass(frozen=True, eq=False)
class Run(SceneResult):
    """The response of a block with one device. Names are those of scipy.integrate.solve_ivp.

    At a discontinuity, an impact or a switch of the clutch, two samples share their time: the left limit, then the right one. An impact
    whose later bounces are summed up to rest has the left one only; the next sample is that of rest.

    Attributes
    ----------
    device
        Name of the device.
    outcome
        How the block ends.
    t
        Times, s.
    y
        θ in rad and θ̇ in rad/s, a row each.
    acceleration_rad_s2
        θ̈, rad/s².
    ground_m_s2
        Horizontal ground acceleration, m/s².
    force_ratio
        Force of each flywheel over the block's weight, a row each.
    engaged
        The flywheels that are engaged: 0 none, 1 the first, 2 the second, 3 both.
    displacement_m
        Displacement of the base over the ground, m; 0 where it cannot slide.
    t_events
        Times of all impacts and of all switches of the clutch, s.
    y_events
        y just after them, a row each; just before an impact whose later bounces are summed.
    peak_rotation
        max |θ|/α; None when overturned or lifted off.
    peak_acceleration
        max |θ̈|/(p²α); None when overturned or lifted off.
    end_time_s
        Rest, overturning or the end of the run, s.
    error
        How accurate it is, where that was asked for.
    energy
        Where the energy is and went over time, over the barrier mgR(1 − cos α) that a block must pass to overturn; None where the scene
        keeps no ledger (Output).
    summary
        All figures of the run, as in summary.json of the command.
    warnings
        What looks like a mistake in the scene and its record files, a line each.
    scene
        The scene.
    """

    device: str
    outcome: Outcome
    t: Floats = field(repr=False)
    y: Floats = field(repr=False)
    acceleration_rad_s2: Floats = field(repr=False)
    ground_m_s2: Floats = field(repr=False)
    force_ratio: Floats = field(repr=False)
    engaged: npt.NDArray[np.uint8] = field(repr=False)
    displacement_m: Floats = field(repr=False)
    t_events: tuple[Floats, Floats] = field(repr=False)
    y_events: tuple[Floats, Floats] = field(repr=False)
    peak_rotation: float | None
    peak_acceleration: float | None
    end_time_s: float
    error: ErrorEstimate | None
    energy: Columns | None = field(repr=False)
    summary: dict[str, Any] = field(repr=False)
    warnings: tuple[str, ...] = field(repr=False)
    scene: Scene = field(repr=False)

    __hash__ = SceneResult.__hash__

    @property
    def rotation_rad(self) -> Floats:
        """θ, rad."""
        return self.y[0]  # type: ignore[no-any-return]

    @property
    def velocity_rad_s(self) -> Floats:
        """θ̇, rad/s."""
        return self.y[1]  # type: ignore[no-any-return]

    @property
    def impacts_s(self) -> Floats:
        """Times of all impacts, s."""
        return self.t_events[0]

    @property
    def status(self) -> int:
        """1 where overturning ended the run, 0 otherwise."""
        return int(self.outcome.overturned)

    @property
    def success(self) -> bool:
        """True: a motion that cannot be followed raises RunError."""
        return True

    @property
    def message(self) -> str:
        """How the block ends, in words."""
        return str(self.summary["outcome"])

    def to_xarray(self) -> xarray.Dataset:
        """The history over time, with units and where it comes from; arrays are not copied, but times."""
        quantities = {
            "rotation": (self.rotation_rad, "rad"),
            "velocity": (self.velocity_rad_s, "rad/s"),
            "acceleration": (self.acceleration_rad_s2, "rad/s2"),
            "ground": (self.ground_m_s2, "m/s2"),
            "force_first": (self.force_ratio[0], "1"),
            "force_second": (self.force_ratio[1], "1"),
            "engaged": (self.engaged, "1"),
            "displacement": (self.displacement_m, "m"),
        }
        variables = {name: ("time", values, {"units": unit}) for name, (values, unit) in quantities.items()}
        attributes = self.provenance() | {"device": self.device, "outcome": self.message}
        dataset: xarray.Dataset = extra("xarray").Dataset(variables, coords={"time": ("time", self.t, {"units": "s"})}, attrs=attributes)
        return dataset

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws θ/α over time."""
        if ax is None:
            ax = extra("matplotlib.pyplot").subplots()[1]
        assert ax is not None
        ax.plot(self.t, self.rotation_rad / self.scene.slenderness_rad, label=self.device)
        ax.set_xlabel("t (s)")
        ax.set_ylabel("θ/α")
        ax.legend()
        return ax


def run_of(native: dict[str, Any], scene: Scene) -> Run:
    """A run as it comes from the native module."""
    summary = json.loads(native["summary"])
    t, y, engaged = native["t"], native["y"], native["engaged"]
    switches = np.flatnonzero(engaged[1:] != engaged[:-1]) + 1
    impacts = native["impacts_s"]
    after = np.searchsorted(t, impacts, side="right") - 1
    error = summary.get("error_estimate")
    return Run(
        device=summary["device"],
        outcome=Outcome.named(summary["outcome"]),
        t=t,
        y=y,
        acceleration_rad_s2=native["acceleration_rad_s2"],
        ground_m_s2=native["ground_m_s2"],
        force_ratio=native["force_ratio"],
        engaged=engaged,
        displacement_m=native["displacement_m"],
        t_events=(impacts, t[switches]),
        y_events=(y[:, after].T, y[:, switches].T),
        peak_rotation=summary["peak_rotation"],
        peak_acceleration=summary["peak_acceleration"],
        end_time_s=summary["end_time_s"],
        error=None if error is None else ErrorEstimate(**error),
        energy=None if native["energy"] is None else Columns(native["energy"]),
        summary=summary,
        warnings=tuple(native["warnings"]),
        scene=scene,
    )


def simulate(scene: Scene, *, accuracy: str | float | None = None) -> tuple[Run, ...]:
    """Runs every device of a scene.

    Parameters
    ----------
    scene
        The scene.
    accuracy
        "fast", "normal", "tight", or the relative error wanted of the peak rotation, in the place of what the scene says; results then
        come with their errors.

    Returns
    -------
    tuple of Run
        One a device, in their order.

    Raises
    ------
    InputError
        For a record that cannot be read, or an accuracy that cannot be meant.
    RunError
        For a motion that cannot be followed.
    """
    if accuracy is not None:
        scene = scene.set("accuracy", {"level": accuracy})
    return tuple(run_of(native, scene) for native in _core.simulate(scene._native))
