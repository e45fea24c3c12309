"""Parts lists: those of the command, and what is refused."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

import sprag

MASS_KG = 10000.0


@pytest.fixture(scope="module")
def scene(scenes: Path) -> sprag.Scene:
    return sprag.Scene.read(scenes / "near_fault.toml").set("block.mass_kg", MASS_KG)


def burst(peak_m_s2: float) -> sprag.Record:
    t = np.arange(0.0, 8.0, 0.01)
    return sprag.Record(peak_m_s2 * np.sin(8.0 * t) * np.exp(-((t - 4.0) ** 2)), time_step_s=0.01, name="burst")


def test_parts_are_those_of_the_command(scene: sprag.Scene, scenes: Path, command, same_table, tmp_path: Path) -> None:
    found = sprag.design(scene)
    assert found == sprag.design(scene, threads=1)
    read = command("design", scenes / "near_fault.toml", "--set", f"block.mass_kg={MASS_KG}")
    for table in ["parts", "motions", "delays"]:
        same_table(read(table), getattr(found, table))
    assert found.page == found._repr_markdown_() == (tmp_path / "out" / "design.md").read_text()
    assert found.findings == json.loads((tmp_path / "out" / "summary.json").read_text())["designs"]
    assert pickle.loads(pickle.dumps(found)) == found


def test_records_come_beside_the_motion_of_the_scene(scene: sprag.Scene) -> None:
    alone = sprag.design(scene, devices="clutched pair")
    assert alone == sprag.design(scene, devices=["clutched pair"])
    both = sprag.design(scene, devices=["clutched pair"], records=[burst(0.01), burst(4.0)])
    assert alone.motions["motion"] == ["own motion"]
    assert both.motions["motion"] == ["own motion", "burst", "burst (2)"]
    # What does not lift the block asks for nothing, and the scene's own motion for what it asks for alone.
    assert both.motions["peak_rotation"][0] == alone.motions["peak_rotation"][0]
    assert both.motions["peak_rotation"][1] == 0.0 < both.motions["peak_rotation"][2]


def test_one_record_may_stand_alone_and_what_is_none_is_refused(scene: sprag.Scene) -> None:
    devices, record = "clutched pair", burst(4.0)
    assert sprag.design(scene, devices=devices, records=record) == sprag.design(scene, devices=devices, records=[record])
    for wrong in (1, [1], [None], "record.at2", [record, "record.at2"]):
        with pytest.raises(sprag.InputError, match=r"sprag\.Record") as raised:
            sprag.design(scene, records=wrong)
        assert raised.value.key == "records"


def test_records_of_one_file_name_are_distinguished(scene: sprag.Scene) -> None:
    shaking = burst(4.0).acceleration_m_s2
    records = [sprag.Record(shaking, time_step_s=0.01, name=f"{folder}/a.csv") for folder in ["one", "other"]]
    found = sprag.design(scene, devices=["clutched pair"], records=records)
    assert found.motions["motion"] == ["own motion", "one/a.csv", "other/a.csv"]


def test_what_looks_wrong_of_records_is_said(scene: sprag.Scene) -> None:
    record = sprag.Record(burst(4.0).acceleration_m_s2 + 0.1, time_step_s=0.01, name="skewed")
    found = sprag.design(scene, devices=["clutched pair"], records=[record])
    assert record.warnings
    assert {f"skewed: {warning}" for warning in record.warnings} <= set(found.warnings)
    assert set(scene.warnings) <= set(found.warnings)


def test_parts_grow_with_what_is_assumed(scene: sprag.Scene) -> None:
    def chosen(**assumed: float) -> float:
        parts = sprag.design(scene, devices=["clutched pair"], **assumed).parts
        return float(parts["chosen"][parts["quantity"].index("travel to each side")])

    assert chosen(margin=2.0) > chosen(margin=1.0)


@pytest.mark.parametrize(
    ("assumed", "key"),
    [
        ({"margin": 0.5}, "margin"),
        ({"service_factor": 11.0}, "service_factor"),
        ({"teeth": 3}, "teeth"),
        ({"face_width_modules": 1.0}, "face_width_modules"),
        ({"allowable_stress_mpa": 0.0}, "allowable_stress_mpa"),
        ({"tolerance": float("nan")}, "tolerance"),
        ({"devices": ["pendulum"]}, "devices"),
        ({"threads": 0}, "threads"),
        ({"threads": 2**70}, "threads"),
        ({"margin": "a"}, "margin"),
        ({"tolerance": None}, "tolerance"),
        ({"teeth": -5}, "teeth"),
        ({"teeth": 2**40}, "teeth"),
        ({"teeth": 20.0}, "teeth"),
    ],
)
def test_what_cannot_be_assumed_is_refused(scene: sprag.Scene, assumed: dict[str, object], key: str) -> None:
    with pytest.raises(sprag.InputError) as raised:
        sprag.design(scene, **assumed)
    assert raised.value.key == key
    assert str(raised.value).startswith(f"{key} is {assumed[key]}" if key != "devices" else key)


def test_scenes_that_ask_for_no_size_are_refused(scene: sprag.Scene) -> None:
    with pytest.raises(sprag.InputError) as raised:
        sprag.design(scene.set("block.mass_kg", None))
    assert raised.value.key == "block.mass_kg"
    with pytest.raises(sprag.InputError, match="no device has a flywheel"):
        sprag.design(scene.set("device", [{"kind": "none"}]))
    vertical = scene.set("vertical", [{"motion": "sine", "amplitude_g": 0.1, "frequency_hz": 1.0}])
    with pytest.raises(sprag.InputError) as raised:
        sprag.design(vertical, records=[burst(4.0)])
    assert raised.value.key == "vertical"
    with pytest.raises(sprag.RunError, match="no motion lifts the block"):
        sprag.design(scene.set("ground.0.scale", 0.001))
    with pytest.raises(sprag.RunError, match="face_width_modules or allowable_stress_mpa has to be larger"):
        sprag.design(scene, allowable_stress_mpa=0.01)
