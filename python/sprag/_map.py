"""Overturning maps."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._outcome import Outcome
from ._result import SceneResult, extra
from ._scene import Axis, Scene

if TYPE_CHECKING:
    import matplotlib.axes
    import xarray

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Map(SceneResult):
    """Outcomes and peaks of blocks over one key of a scene, or two.

    Attributes
    ----------
    devices
        Names of what is mapped: the devices, then the clutched pairs by each law of `map.laws`, such as "clutched pair, resisting".
    x_key, y_key
        Keys of the axes; `y_key` is None for a cut along x.
    x, y
        Values of the axes; one that is NaN for a cut.
    outcome
        An Outcome by device, y and x.
    peak_rotation
        max |θ|/α by device, y and x; NaN where overturned.
    peak_acceleration
        max |θ̈|/(p²α) by device, y and x; NaN where overturned.
    warnings
        What looks like a mistake in the scene and its record files, a line each.
    scene
        The scene.
    """

    devices: tuple[str, ...]
    x_key: str
    y_key: str | None
    x: Floats = field(repr=False)
    y: Floats = field(repr=False)
    outcome: npt.NDArray[np.uint8] = field(repr=False)
    peak_rotation: Floats = field(repr=False)
    peak_acceleration: Floats = field(repr=False)
    warnings: tuple[str, ...] = field(repr=False)
    scene: Scene = field(repr=False)

    __hash__ = SceneResult.__hash__

    def to_xarray(self) -> xarray.Dataset:
        """The map with its axes as coordinates, with units and where it comes from; arrays are not copied, but axes."""
        dimensions = ("device", self.y_key or "cut", self.x_key)
        codes = {outcome.name.lower().replace("_", "-"): int(outcome) for outcome in Outcome.of_studies()}
        variables = {
            "outcome": (dimensions, self.outcome, {"flag_values": list(codes.values()), "flag_meanings": " ".join(codes)}),
            "peak_rotation": (dimensions, self.peak_rotation, {"units": "1", "long_name": "max |θ|/α"}),
            "peak_acceleration": (dimensions, self.peak_acceleration, {"units": "1", "long_name": "max |θ̈|/(p²α)"}),
        }
        units = [{} if unit is None else {"units": unit} for unit in (None, _core.unit(self.y_key or ""), _core.unit(self.x_key))]
        axes = zip(dimensions, (list(self.devices), self.y, self.x), units, strict=True)
        coordinates = {name: (name, values, attributes) for name, values, attributes in axes}
        dataset: xarray.Dataset = extra("xarray").Dataset(variables, coords=coordinates, attrs=self.provenance())
        return dataset

    def plot(self, ax: matplotlib.axes.Axes | None = None, *, device: int = 0) -> matplotlib.axes.Axes:
        """Draws the outcomes of a device, each in its colour and named for a legend (`ax.legend()`)."""
        if ax is None:
            ax = extra("matplotlib.pyplot").subplots()[1]
        assert ax is not None
        axes = self.scene._table()["map"]
        logarithmic = {name: axes.get(name, {}).get("scale") == "logarithmic" for name in ("x", "y")}
        # A cut is a band: it has no height of its own.
        y = _edges(self.y, logarithmic["y"]) if self.y_key else np.array([0.0, 1.0])
        colours = extra("matplotlib.colors").ListedColormap([outcome.colour for outcome in Outcome.of_studies()])
        ax.pcolormesh(_edges(self.x, logarithmic["x"]), y, self.outcome[device], cmap=colours, vmin=0, vmax=3, shading="flat")
        if logarithmic["x"]:
            ax.set_xscale("log")
        if logarithmic["y"]:
            ax.set_yscale("log")
        if self.y_key is None:
            ax.set_yticks([])
        for outcome in Outcome.of_studies():
            # A square that is nowhere: the legend's.
            ax.scatter([], [], marker="s", color=outcome.colour, edgecolors="0.6", label=outcome.words)
        ax.set_xlabel(self.x_key)
        ax.set_ylabel(self.y_key or "")
        ax.set_title(self.devices[device])
        return ax


def _edges(values: Floats, logarithmic: bool) -> Floats:
    """Edges of cells about `values`: halfway between them, by the scale, and as far beyond the ends."""
    if logarithmic:
        return np.exp(_edges(np.log(values), logarithmic=False))
    between = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - between[0]], between, [2 * values[-1] - between[-1]]])


def map(
    scene: Scene,
    *,
    x: Axis | None = None,
    y: Axis | None = None,
    overturned_at: Literal["no-return", "slenderness"] | None = None,
    threads: int | None = None,
) -> Map:
    """Outcomes and peaks of every device of a scene, and of its clutched pairs by every law of `map.laws`, over one of its keys, or two.

    Parameters
    ----------
    scene
        The scene.
    x, y
        Axes across and up, in the place of the scene's; with `x` alone the map is a cut.
    overturned_at
        Rotation |θ| at which a block counts as overturned, in the place of the scene's: where the ground can no longer bring it back
        ("no-return", the default of scenes), or α ("slenderness").
    threads
        Threads; one a core by default. Results do not depend on it.

    Raises
    ------
    InputError
        For a key that does not exist, or a value outside its range.
    RunError
        For a motion that cannot be followed, with the cell.
    """
    if x is not None:
        kept = {name: value for name, value in scene._table().get("map", {}).items() if name not in ("x", "y")}
        scene = scene.set("map", kept | {"x": x._keys()} | ({} if y is None else {"y": y._keys()}))
    elif y is not None:
        scene = scene.set("map.y", y)
    if overturned_at is not None:
        scene = scene.set("map.overturned_at", overturned_at)
    native = _core.overturning_map(scene._native, threads=threads)
    devices, warnings = (tuple(native.pop(name)) for name in ("devices", "warnings"))
    return Map(devices=devices, warnings=warnings, scene=scene, **{"y": np.full(1, np.nan), "y_key": None, **native})
