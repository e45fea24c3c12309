"""Records: from files and arrays, their measures, and what is refused."""

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import sprag


def test_measures_are_those_of_closed_forms() -> None:
    # 2 m/s² for 1 s: Arias π/(2g) 4, CAV 2, D5-95 0.9 s.
    record = sprag.Record(np.full(11, 2.0), time_step_s=0.1)
    assert record.pga_m_s2 == 2.0
    assert record.arias_m_s == pytest.approx(math.pi / (2 * 9.80665) * 4, rel=1e-12)
    assert record.cav_m_s == pytest.approx(2.0, rel=1e-12)
    assert record.d5_95_s == pytest.approx(0.9, rel=1e-12)
    assert record.uniform_duration_s(threshold_m_s2=1.9) == pytest.approx(1.0, rel=1e-12)
    assert (record.duration_s, len(record), record.format) == (1.0, 11, "array")
    # One cycle of a sine, A = 3 m/s², 1 Hz: the velocity is A/ω (1 − cos ωt), less its straight line.
    t = np.linspace(0.0, 1.0, 4001)
    sine = sprag.Record(3.0 * np.sin(2 * np.pi * t), time_step_s=t[1])
    assert sine.pgv_m_s == pytest.approx(3.0 / (2 * np.pi), rel=1e-3)


def test_a_file_is_the_array_that_it_holds(scenes: Path) -> None:
    file = sprag.Record.read(scenes / "near_fault.csv")
    array = sprag.Record(file.acceleration_m_s2, time_step_s=file.time_step_s, name=file.name, units="m/s2")
    assert np.array_equal(array.acceleration_m_s2, file.acceleration_m_s2)
    assert (array.pga_m_s2, array.pgd_m) == (file.pga_m_s2, file.pgd_m)
    assert file.format == "table"
    assert file.units in ("g", "m/s2")


@pytest.mark.parametrize(
    "of", [lambda scenes: sprag.Record.read(scenes / "near_fault.csv"), lambda _: sprag.Record([0, 1, 0], time_step_s=0.1)]
)
def test_records_compare_hash_and_pickle(scenes: Path, of) -> None:
    record = of(scenes)
    copy = pickle.loads(pickle.dumps(record))
    assert copy == record
    assert hash(copy) == hash(record)
    assert (copy.format, copy.warnings, copy.units) == (record.format, record.warnings, record.units)
    # What the file says of itself: studies take the earthquake from it.
    assert copy.__reduce__()[1][-1] == record.__reduce__()[1][-1]
    assert copy != sprag.Record([0, 2, 0], time_step_s=0.1)


def test_samples_are_handed_over_once_and_cannot_be_written() -> None:
    record = sprag.Record(np.arange(5.0), time_step_s=0.1, units="g")
    samples = record.acceleration_m_s2
    assert samples is record.acceleration_m_s2
    assert not samples.flags.writeable
    assert not samples.flags.owndata
    assert samples[1] == 9.80665


def test_any_array_of_numbers_will_do() -> None:
    whole = sprag.Record([0.0, 2.0, 4.0], time_step_s=0.1)
    frozen = np.array([0.0, 2.0, 4.0])
    frozen.flags.writeable = False
    objects, unmasked = np.array([0, 2.0, np.float32(4)], dtype=object), np.ma.array([0.0, 2.0, 4.0], mask=[False] * 3)
    assert all(sprag.Record(samples, time_step_s=0.1) == whole for samples in (objects, unmasked))
    others = [frozen, np.arange(5.0)[::2], np.array([0, 2, 4]), np.array([0, 2, 4], dtype=np.float32), (0, 2, 4)]
    others[1] = np.arange(6.0)[::2]
    assert all(sprag.Record(samples, time_step_s=0.1) == whole for samples in others)


@pytest.mark.parametrize(
    ("samples", "key"),
    [
        ([], "acceleration"),
        ([1.0], "acceleration"),
        ([[1.0, 2.0]], "acceleration"),
        (1.0, "acceleration"),
        ([0.0, math.nan], "acceleration.1"),
        ([math.inf, 0.0], "acceleration.0"),
        ([0.0, 1e6], "acceleration.1"),
        (["a", "b"], "acceleration"),
        (None, "acceleration"),
    ],
)
def test_what_is_no_record_is_refused(samples: object, key: str) -> None:
    with pytest.raises(sprag.InputError) as raised:
        sprag.Record(samples, time_step_s=0.01)
    assert raised.value.key == key


def test_what_cannot_be_read_is_refused(tmp_path: Path) -> None:
    (tmp_path / "words.csv").write_text("no numbers")
    (tmp_path / "one.csv").write_text("time_s,acc_g\n0,0\n")
    (tmp_path / "bare.txt").write_text("0 1 0")
    for name in ["absent.csv", "", "words.csv", "one.csv", "bare.txt"]:
        with pytest.raises(sprag.InputError) as raised:
            sprag.Record.read(tmp_path / name)
        assert "\n" not in str(raised.value)
    with (tmp_path / "bare.txt").open() as closed:
        pass
    with pytest.raises(TypeError):
        sprag.Record.read(closed)
    with pytest.raises(sprag.InputError) as raised:
        sprag.Record.read(tmp_path / "bare.txt", units="furlongs")
    assert raised.value.key == "units"
    assert sprag.Record.read(tmp_path / "bare.txt", units="g", time_step_s=0.01).pga_m_s2 == 9.80665


def test_what_is_said_of_records_names_arguments_and_no_options(tmp_path: Path) -> None:
    block = sprag.Block(size_m=2.0, slenderness_deg=10.0)
    rows = "".join(f"{time},{1 + index % 2},2\n" for index, time in enumerate([0.0, 0.01, 0.02, 0.05, 0.06]))
    for name, text, key in [
        ("bare.txt", "0 1 0", "time_step_s"),
        ("bare.txt", "0 1 0", "units"),
        ("uneven.csv", f"time_s,acc_g\n{rows}".replace(",2\n", "\n"), "resample_to_s"),
        ("several.csv", f"time_s,north_g,east_g\n{rows}", "component"),
    ]:
        (tmp_path / name).write_text(text)
        others = {"time_step_s": 0.01, "units": "g", "resample_to_s": 0.01, "component": "east"}
        del others[key]
        file = {"motion": "record", "file": tmp_path / name}
        scene = sprag.Scene(block=block, ground=sprag.Sine(amplitude_g=0.1, frequency_hz=1.0)).set("ground.0", file | others)
        said: list[str] = []
        for read in (lambda: sprag.Record.read(tmp_path / name, **others), lambda: sprag.simulate(scene)[0]):  # noqa: B023
            try:
                said.extend(read().warnings)
            except sprag.InputError as error:
                assert str(error.key).endswith(key)
                said.append(str(error))
        assert any(key in line for line in said), said
        assert not any("--" in line for line in said), said
    for step in (0.0, 2.0, math.nan):
        with pytest.raises(sprag.InputError) as raised:
            sprag.Record.read(tmp_path / "bare.txt", units="g", time_step_s=0.01, resample_to_s=step)
        assert raised.value.key == "resample_to_s"


@given(arrays.arrays(np.float64, st.integers(0, 20)), st.floats(), st.sampled_from(["g", "m/s2", "gal", "", "parsec"]))
def test_any_array_gives_a_record_or_one_error(samples: np.ndarray, step: float, units: str) -> None:
    try:
        record = sprag.Record(samples, time_step_s=step, units=units)
    except sprag.InputError as error:
        assert "\n" not in str(error)
    else:
        assert np.isfinite([record.pga_m_s2, record.pgv_m_s, record.pgd_m, record.arias_m_s, record.d5_95_s, record.cav_m_s]).all()
