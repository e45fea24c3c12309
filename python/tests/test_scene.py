"""Scenes: from pieces, from TOML, changed, and what is refused."""

import dataclasses
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sprag

PIER = sprag.Block(size_m=2.0, slenderness_deg=10.0)


def test_pieces_are_the_toml_that_says_the_same() -> None:
    pieces = sprag.Scene(
        block=PIER,
        device=[sprag.NoDevice(), sprag.ClutchedPair(mass_ratio=0.5)],
        ground=sprag.Ricker(amplitude_g=0.5, frequency_hz=1.2),
        duration=sprag.Duration(free_time_s=1.0),
    )
    text = """
    block = { size_m = 2.0, slenderness_deg = 10.0 }
    device = [{ kind = "none" }, { kind = "clutched-pair", mass_ratio = 0.5 }]
    ground = [{ motion = "ricker", amplitude_g = 0.5, frequency_hz = 1.2 }]
    run = { free_time_s = 1.0 }
    """
    parsed = sprag.Scene.parse(text)
    assert [run.digest() for run in sprag.simulate(pieces)] == [run.digest() for run in sprag.simulate(parsed)]
    assert sprag.Scene.parse(pieces.to_toml()).to_dict() == pieces.to_dict() == parsed.to_dict()
    assert pieces.devices == ("none", "clutched pair")


def test_every_scene_of_the_repository_is_read(scenes: Path) -> None:
    for path in scenes.glob("*.toml"):
        if path.stem not in ("cloud", "optimise"):
            scene = sprag.Scene.read(path)
            copy = pickle.loads(pickle.dumps(scene))
            assert copy == scene
            assert hash(copy) == hash(scene)
            assert scene.set("title", "other") != scene


def test_a_scene_is_changed_by_making_another() -> None:
    scene = sprag.Scene(block=PIER, ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0))
    larger = scene.set("block.size_m", 3.0)
    assert (scene.size_m, larger.size_m) == (2.0, 3.0)
    assert scene.set("device.1", sprag.Inerter(mass_ratio=0.5)).devices == ("none", "inerter")
    assert larger.set("block.mass_kg", 1.0).set("block.mass_kg", None) == larger
    assert scene.set("title", 'a "quoted"\nname').to_dict()["title"] == 'a "quoted"\nname'
    with pytest.raises(AttributeError, match="never changes"):
        scene.title = "other"


def test_scenes_of_equal_tables_are_equal() -> None:
    whole = sprag.Block(size_m=2, slenderness_deg=10, inertia_ratio=4 / 3)
    assert sprag.Block(size_m=2, slenderness_deg=10) == PIER
    ground = sprag.Sine(amplitude_g=0.3, frequency_hz=1.0)
    one, two = (sprag.Scene(block=block, ground=ground) for block in (PIER, whole))
    assert one == two
    assert hash(one) == hash(two)
    assert one != two.set("block.size_m", 3)


def test_records_in_memory_shake_as_their_files_do(scenes: Path) -> None:
    scene = sprag.Scene.read(scenes / "near_fault.toml")
    record = sprag.Record.read(scenes / "near_fault.csv")
    scale = scene.to_dict()["ground"][0]["scale"]
    given = scene.set("ground.0", sprag.RecordedMotion(record=record, scale=scale))
    assert [run.digest() for run in sprag.simulate(given)] == [run.digest() for run in sprag.simulate(scene)]
    copy = pickle.loads(pickle.dumps(given))
    assert sprag.simulate(copy) == sprag.simulate(given)
    # Two records of one name are two records.
    sum_of_two = sprag.Scene(block=PIER, ground=[sprag.Record([0, 1, 0], time_step_s=0.1), sprag.Record([0, 2, 0], time_step_s=0.1)])
    (run,) = sprag.simulate(sum_of_two.set("output.interval_s", 1e-4))
    assert run.ground_m_s2.max() == pytest.approx(3.0, rel=1e-3)


def shaking_m_s2(scene: sprag.Scene) -> float:
    """Largest horizontal ground acceleration."""
    (run,) = sprag.simulate(scene.set("output.interval_s", 1e-3))
    return float(abs(run.ground_m_s2).max())


def triangle(peak_m_s2: float, name: str = "array") -> sprag.Record:
    return sprag.Record([0.0, peak_m_s2, 0.0], time_step_s=0.1, name=name)


@pytest.mark.parametrize("name", ["rec.csv", "./rec.csv", "rec.csv/", "rec.csv (2)"])
def test_a_record_in_memory_leaves_files_of_its_name_alone(tmp_path: Path, name: str) -> None:
    (tmp_path / "rec.csv").write_text("time_s,acc_m_s2\n0,0\n0.1,5\n0.2,0\n")
    text = "block={size_m=2,slenderness_deg=10}\ndevice=[{kind='none'}]\nground=[{motion='record',file='rec.csv'}]"
    scene = sprag.Scene.parse(text, folder=tmp_path)
    changed = scene.set("vertical", [triangle(0.1, name)])
    assert shaking_m_s2(changed) == shaking_m_s2(scene) == pytest.approx(5.0, rel=1e-2)
    assert shaking_m_s2(pickle.loads(pickle.dumps(changed))) == shaking_m_s2(scene)
    # What the value itself names is a file too, and what it replaces is none any more.
    file = {"motion": "record", "file": "rec.csv"}
    assert shaking_m_s2(scene.set("vertical", [file, triangle(0.1, name)])) == shaking_m_s2(scene)
    assert scene.set("ground", [triangle(1.0, name)]).to_dict()["ground"][0]["file"] == name


def test_records_whose_names_are_one_path_are_two_records() -> None:
    # Their sum would be 2 or 6 of one record twice.
    for names in [("r/a", "r//a"), ("r/a", "r/./a"), ("r/a", "r/a/"), ("a", "a")]:
        ground = [triangle(peak, name) for peak, name in zip((3.0, 1.0), names, strict=True)]
        assert shaking_m_s2(sprag.Scene(block=PIER, ground=ground)) == pytest.approx(4.0, rel=1e-2)
        assert shaking_m_s2(sprag.Scene(block=PIER, ground=ground[0]).set("ground.1", ground[1])) == pytest.approx(4.0, rel=1e-2)


def test_a_scene_holds_the_records_that_it_names_and_no_others() -> None:
    first, second = triangle(1.0, "first"), triangle(2.0, "second")
    fresh = sprag.Scene(block=PIER, ground=[second])
    for changed in [
        sprag.Scene(block=PIER, ground=first).set("ground", [second]),
        sprag.Scene(block=PIER, ground=first).set("ground.0", second),
        sprag.Scene(block=PIER, ground=[second], vertical=first).set("vertical", None),
    ]:
        assert changed == fresh
        assert len(pickle.dumps(changed)) == len(pickle.dumps(fresh))
    # A record of the name of the one that it replaces has that name.
    other = triangle(2.0, "first")
    assert sprag.Scene(block=PIER, ground=first).set("ground", [other]) == sprag.Scene(block=PIER, ground=[other])
    # Records are kept that other motions name, or the value by their names.
    both = sprag.Scene(block=PIER, ground=[first], vertical=second)
    assert shaking_m_s2(both.set("vertical", None).set("block.size_m", 3.0)) == pytest.approx(1.0, rel=1e-2)
    assert both.set("ground", both.to_dict()["ground"]).set("ground.0.scale", 2.0).set("ground.0.file", "first") == both.set(
        "ground", both.set("ground.0.scale", 2.0).to_dict()["ground"]
    )
    assert both == sprag.Scene(block=PIER, ground=[triangle(9.0)], vertical=second).set("ground", [first])


def test_results_say_what_looks_wrong_of_records() -> None:
    record = sprag.Record([0.0, 50.0, 0.0], time_step_s=0.01, units="g", name="loud")
    pair = sprag.ClutchedPair(mass_ratio=0.5, engagement="rigid")
    scene = sprag.Scene(block=PIER, ground=[record, record], device=pair, controller=sprag.Controller())
    expected = (*scene.warnings, *(f"loud: {warning}" for warning in record.warnings))
    assert any("check the units" in line for line in expected)
    loop = sprag.closed_loop(scene)
    axis = sprag.Axis(key="block.size_m", start=1.0, stop=2.0, cells=2)
    for result in (*sprag.simulate(scene), sprag.map(scene, x=axis), loop, loop.ideal_pair):
        assert result.warnings == expected, type(result).__name__


@pytest.mark.parametrize(
    ("key", "value", "refused"),
    [
        ("block.size_m", -1.0, "block.size_m"),
        ("block.siz_m", 1.0, "block.siz_m"),
        ("block.size_m", "large", "block.size_m"),
        ("device.0.mass_ratio", 0.5, "device.0.mass_ratio"),
        ("ground.5.scale", 2.0, "ground.5.scale"),
        ("ground", [], "ground"),
        ("a=b", 1, "key"),
        ("block..size_m", 1, "key"),
        pytest.param(".".join("a" * 100_000), 1, ".".join("a" * 16), id="without end"),
        ("", 1, "key"),
    ],
)
def test_changes_that_cannot_be_are_refused_by_key(key: str, value: object, refused: str) -> None:
    scene = sprag.Scene(block=PIER, ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0))
    with pytest.raises(sprag.InputError) as raised:
        scene.set(key, value)
    assert raised.value.key == refused


@pytest.mark.parametrize(
    ("key", "value", "shown", "allowed"),
    [
        ("block.size_m", "large", '"large"', "a number"),
        ("block.size_m", [2.0], "a list", "a number"),
        ("run", 3, 3.0, "a table"),
        ("output.energy", 1.5, 1.5, "true or false"),
        ("title", True, "true", "a text in quotes"),
    ],
)
def test_a_value_of_another_kind_is_named_with_what_it_may_be(key: str, value: object, shown: object, allowed: str) -> None:
    scene = sprag.Scene(block=PIER, ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0))
    with pytest.raises(sprag.InputError) as raised:
        scene.set(key, value)
    assert (raised.value.key, raised.value.value, raised.value.range) == (key, shown, allowed)


@pytest.mark.parametrize(
    "value",
    [np.complex128(2 + 3j), np.complex64(2), np.array(2 + 3j), np.timedelta64(2, "ns"), np.array(2, "M8[ns]"), np.array("2")],
    ids=repr,
)
def test_what_is_no_real_number_of_numpy_is_refused(value: Any) -> None:
    scene = sprag.Scene(block=PIER, ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0))
    for make in (lambda: scene.set("block.size_m", value), lambda: sprag.Block(size_m=value, slenderness_deg=10.0)):
        with pytest.raises(TypeError, match="a value of a scene is"):
            make()


def test_errors_say_nothing_of_the_command() -> None:
    scene = sprag.Scene(block=PIER, ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0), device=sprag.Inerter(mass_ratio=0.5))
    structures = "".join(f"[[structure]]\nname='{k}'\nset={{'block.size_m'={k}}}\n" for k in (1, 2))
    study = sprag.Study(structures, records=triangle(1.0))
    for call, key in [
        (lambda: scene.set("block.frequency_parameter_1_s", 2.0), "block.size_m"),
        (lambda: scene.set("ground", "x"), "ground"),
        (lambda: sprag.map(scene), "map.x"),
        (lambda: sprag.design(scene), "block.mass_kg"),
        (lambda: study.set("block.size_m", 3.0), "block.size_m"),
        (lambda: sprag.Study(structures), "records"),
    ]:
        with pytest.raises(sprag.InputError) as raised:
            call()
        assert raised.value.key == key
        assert "--" not in str(raised.value)
        assert str(raised.value)[-1].isalnum() or str(raised.value)[-1] in ")]"


def test_a_text_is_refused_with_its_line() -> None:
    with pytest.raises(sprag.InputError, match=r"scene:3: .*`size_m`"):
        sprag.Scene.parse("\n[block]\nsiz_m = 2.0\nslenderness_deg = 10.0\n")
    with pytest.raises(sprag.InputError):
        sprag.Scene.read("absent.toml")


SIMPLE = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
VALUES = st.recursive(
    SIMPLE, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3), max_leaves=6
)
KEYS = st.sampled_from(
    ["block", "block.size_m", "device", "device.0", "device.0.kind", "ground.0.scale", "run", "output.interval_s", "map"]
)


@given(KEYS, VALUES)
def test_any_value_is_taken_or_refused_in_one_way(key: str, value: Any) -> None:
    scene = sprag.Scene(block=PIER, ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0))
    try:
        changed = scene.set(key, value)
    except (sprag.InputError, TypeError) as error:
        assert "\n" not in str(error)
    else:
        assert sprag.Scene.parse(changed.to_toml()).to_dict() == changed.to_dict()


@given(st.text(alphabet=st.sampled_from("[]{}=.,'\"# \nabckdemv0123\x00é"), max_size=60))
def test_any_text_is_a_scene_a_study_or_one_error(text: str) -> None:
    for read in [sprag.Scene.parse, sprag.Study]:
        with pytest.raises(sprag.InputError) as raised:
            read(text)
        assert "\n" not in str(raised.value)


@given(st.text(max_size=8), st.floats(), st.floats(), st.integers(-5, 200_000), st.booleans())
def test_any_axis_is_refused_or_made(key: str, start: float, stop: float, cells: int, logarithmic: bool) -> None:
    scene = sprag.Scene(block=PIER, ground=sprag.Sine(amplitude_g=0.3, frequency_hz=1.0))
    axis = sprag.Axis(key=key, start=start, stop=stop, cells=min(cells, 3), logarithmic=logarithmic)
    for whose in [axis, dataclasses.replace(axis, key="block.size_m")]:
        try:
            made = sprag.map(scene, x=whose, threads=1)
        except sprag.InputError as error:
            assert "\n" not in str(error)
        else:
            assert made.outcome.shape == (1, 1, whose.cells)
