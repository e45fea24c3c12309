"""Maps: the command's bits, whatever the threads, and arrays that nobody copies."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import sprag


def test_a_map_is_that_of_the_command(scenes: Path, command) -> None:
    path = scenes / "figure08.toml"
    rows = command("map", path)("map")
    made = sprag.map(sprag.Scene.read(path))
    names = {outcome.name.lower().replace("_", "-"): outcome for outcome in sprag.Outcome}
    assert [names[row["outcome"]] for row in rows] == made.outcome.ravel().tolist()
    for name, values in {"peak_rotation": made.peak_rotation, "peak_acceleration": made.peak_acceleration}.items():
        expected = np.array([float(row[name] or "nan") for row in rows])
        assert np.array_equal(expected, values.ravel(), equal_nan=True), name
    assert [float(row[made.x_key]) for row in rows[: len(made.x)]] == made.x.tolist()
    assert made.y_key is not None
    assert float(rows[-1][made.y_key]) == made.y[-1]


def test_threads_change_no_bit(scenes: Path) -> None:
    scene = sprag.Scene.read(scenes / "figure08.toml")
    assert sprag.map(scene, threads=1) == sprag.map(scene, threads=2)


def test_a_picture_shows_and_names_every_outcome(scenes: Path) -> None:
    colors = pytest.importorskip("matplotlib.colors")
    made = sprag.map(sprag.Scene.read(scenes / "figure08.toml"))
    axes = made.plot(device=2)
    assert axes.get_legend_handles_labels()[1] == [outcome.words for outcome in sprag.Outcome.of_studies()]
    cells = axes.collections[0]
    shown = cells.cmap(cells.norm(cells.get_array()))[..., :3]
    wanted = np.array([colors.to_rgb(outcome.colour) for outcome in sprag.Outcome.of_studies()])
    assert np.allclose(shown, wanted[made.outcome[2]])


def test_a_picture_of_a_cut_is_a_band_of_its_cells(scenes: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    scene = sprag.Scene.read(scenes / "near_fault.toml")
    cut = sprag.map(scene, x=sprag.Axis(key="ground.0.scale", start=0.5, stop=1.5, cells=3))
    corners = cut.plot().collections[0].get_coordinates()
    assert corners[0, :, 0].tolist() == pytest.approx([0.25, 0.75, 1.25, 1.75])
    assert (corners[1, :, 1] - corners[0, :, 1] > 0.0).all()


def test_a_picture_of_a_logarithmic_axis_has_its_scale(scenes: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    scene = sprag.Scene.read(scenes / "near_fault.toml")
    axes = sprag.map(scene, x=sprag.Axis(key="ground.0.scale", start=0.01, stop=1.0, cells=3, logarithmic=True)).plot()
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
    root = 10.0**0.5
    edges = axes.collections[0].get_coordinates()[0, :, 0].tolist()
    assert edges == pytest.approx([0.01 / root, 0.01 * root, 0.1 * root, 1.0 * root])


def test_a_map_of_laws_names_every_map(scenes: Path, command, tmp_path: Path) -> None:
    axis = sprag.Axis(key="controller.latency_s", start=0.0, stop=0.05, cells=2)
    scene = sprag.Scene.read(scenes / "laws.toml").set("map.y", None).set("map.x", axis)
    made = sprag.map(scene)
    assert made.devices == ("clutched pair", "clutched pair, resisting", "clutched pair, resisting-predicted")
    (tmp_path / "scene.toml").write_text(scene.to_toml())
    rows = command("map", tmp_path / "scene.toml")("map")
    assert [row["device"] for row in rows[::2]] == list(made.devices) == list(made.to_xarray().device.values)
    assert made.plot(device=2).get_title() == made.devices[2]
    # Axes of the call take the place of the scene's, and of nothing else.
    assert sprag.map(scene.set("map.x.cells", 5), x=axis).devices == made.devices


def test_a_cut_has_one_axis(scenes: Path) -> None:
    scene = sprag.Scene.read(scenes / "near_fault.toml")
    cut = sprag.map(scene, x=sprag.Axis(key="block.size_m", start=1.0, stop=4.0, cells=4, logarithmic=True))
    assert (cut.y_key, cut.outcome.shape) == (None, (3, 1, 4))
    assert cut.x == pytest.approx([1.0, 4 ** (1 / 3), 4 ** (2 / 3), 4.0], rel=1e-12)
    for column, size in enumerate(cut.x):
        runs = sprag.simulate(scene.set("block.size_m", size))
        assert [run.outcome for run in runs] == cut.outcome[:, 0, column].tolist()
        assert [run.peak_rotation for run in runs if run.peak_rotation] == pytest.approx(
            [peak for peak in cut.peak_rotation[:, 0, column] if not np.isnan(peak)], rel=1e-9
        )


def test_records_in_memory_are_in_every_cell(scenes: Path) -> None:
    record = sprag.Record.read(scenes / "near_fault.csv")
    block = sprag.Block(size_m=2.0, slenderness_deg=10.0)
    scene = sprag.Scene(block=block, ground=record)
    cut = sprag.map(scene, x=sprag.Axis(key="ground.0.scale", start=0.5, stop=1.0, cells=2))
    (run,) = sprag.simulate(scene)
    assert cut.outcome[0, 0, 1] == run.outcome
    # A device with a memory is simulated cell by cell.
    device = sprag.ClutchedPair(mass_ratio=0.5, engagement="rigid")
    sprag.map(scene.set("device.0", device), x=sprag.Axis(key="block.size_m", start=1.0, stop=2.0, cells=2))


def test_arrays_are_handed_over_and_not_copied(scenes: Path) -> None:
    made = sprag.map(sprag.Scene.read(scenes / "figure08.toml"))
    dataset = made.to_xarray()
    for array in [made.outcome, made.peak_rotation, made.peak_acceleration]:
        assert not array.flags.owndata
    assert np.shares_memory(dataset.peak_rotation.values, made.peak_rotation)
    assert np.shares_memory(dataset.outcome.values, made.outcome)
    assert dataset.attrs["sprag_version"] == sprag.__version__
    assert sprag.Scene.parse(dataset.attrs["scene"]) == made.scene.set("title", made.scene.to_dict()["title"]) or dataset.attrs["scene"]
    assert pickle.loads(pickle.dumps(made)) == made


def test_axes_of_data_sets_have_units() -> None:
    scene = sprag.Scene(block=sprag.Block(size_m=2.0, slenderness_deg=10.0), ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0))
    x = sprag.Axis(key="ground.0.frequency_hz", start=1.0, stop=2.0, cells=2)
    dataset = sprag.map(scene, x=x, y=sprag.Axis(key="block.restitution", start=0.5, stop=0.9, cells=2)).to_xarray()
    assert dataset["ground.0.frequency_hz"].attrs == {"units": "Hz"}
    assert dataset["block.restitution"].attrs == {}


def test_a_block_that_passes_its_slenderness_and_comes_back_is_overturned_if_asked() -> None:
    block = sprag.Block(size_m=0.25, slenderness_deg=np.rad2deg(0.2), restitution="geometric")
    scene = sprag.Scene(block=block, ground=sprag.Sine(amplitude_ratio=1.0, frequency_hz=2.0))
    x = sprag.Axis(key="ground.0.amplitude_ratio", start=2.70, stop=2.72, cells=3)
    comes_back = sprag.map(scene, x=x)
    assert (comes_back.outcome == sprag.Outcome.SAFE).all()
    assert (comes_back.peak_rotation > 1.5).all()
    overturned = sprag.map(scene, x=x, overturned_at="slenderness")
    assert (overturned.outcome >= sprag.Outcome.OVERTURNED_WITHOUT_IMPACT).all()
    assert sprag.map(overturned.scene, x=x) == overturned
    with pytest.raises(sprag.InputError) as raised:
        sprag.map(scene, x=x, overturned_at="tip")
    assert raised.value.key == "map.overturned_at"


@pytest.mark.parametrize(
    ("axis", "key"),
    [
        ({"key": "block.colour"}, "block.colour"),
        ({"key": "block.size_m", "start": -1.0}, "block.size_m"),
        ({"start": 5.0}, "map.x.to"),
        ({"cells": 1}, "map.x.cells"),
        ({"stop": float("nan")}, "map.x.to"),
    ],
)
def test_axes_that_cannot_be_are_refused(scenes: Path, axis: dict[str, object], key: str) -> None:
    scene = sprag.Scene.read(scenes / "near_fault.toml")
    with pytest.raises(sprag.InputError) as raised:
        sprag.map(scene, x=sprag.Axis(**{"key": "block.size_m", "start": 1.0, "stop": 3.0, "cells": 3, **axis}))
    assert raised.value.key == key


@pytest.mark.parametrize("threads", [0, 5000, -1])
def test_threads_that_cannot_be_are_refused(scenes: Path, threads: int) -> None:
    with pytest.raises(sprag.InputError) as raised:
        sprag.map(sprag.Scene.read(scenes / "figure08.toml"), threads=threads)
    assert raised.value.key == "threads"
