"""Studies over many records: the command's tables, fits of anybody's runs, and what is refused."""

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sprag

TEXT = """
scale = [1.0, 2.0]
bootstrap = { resamples = 20 }
[optimise]
laws = ["inerter", "clutched-pair"]
mass_ratio = { from = 0.1, to = 1.0, cells = 2 }
"""


def records(count: int) -> list[sprag.Record]:
    t = np.arange(0.0, 8.0, 0.01)
    shapes = [np.sin((2.0 + 0.3 * k) * t) * np.exp(-((t - 4.0) ** 2)) for k in range(count)]
    return [sprag.Record((3.0 + k) * shape, time_step_s=0.01, name=f"burst {k}") for k, shape in enumerate(shapes)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The study of the test, and its records as files."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "study.toml").write_text('records = ["records"]' + TEXT)
    (folder / "records").mkdir()
    for record in records(4):
        lines = [f"{k * 0.01!r},{float(a)!r}" for k, a in enumerate(record.acceleration_m_s2)]
        (folder / "records" / f"{record.name}.csv").write_text("time_s,acc_m_s2\n" + "\n".join(lines))
    return folder


@pytest.mark.parametrize(("name", "tables"), [("cloud", ["runs", "demand", "fragility", "ranking"]), ("optimise", ["designs", "motions"])])
def test_tables_are_those_of_the_command(folder: Path, command, same_table, name: str, tables: list[str]) -> None:
    study = sprag.Study.read(folder / "study.toml")
    found = getattr(sprag, name)(study)
    assert found == getattr(sprag, name)(study, threads=1)
    read = command(name, folder / "study.toml")
    for table in tables:
        same_table(read(table), getattr(found, table))


def test_records_in_memory_are_those_of_files(folder: Path) -> None:
    files = sprag.cloud(sprag.Study.read(folder / "study.toml"))
    memory = sprag.cloud(sprag.Study(TEXT.replace("scale", 'records = ["none"]\nscale', 1)).use(records(4)))
    assert np.array_equal(memory.runs["pgv"], files.runs["pgv"])
    assert memory.demand.columns.keys() == files.demand.columns.keys()
    assert np.array_equal(memory.demand["b"], files.demand["b"], equal_nan=True)
    # They are of a study, and of no scene.
    assert not any(hasattr(result, "provenance") for result in (memory, memory.runs))
    assert memory.runs.to_pandas()["record"].tolist()[0] == "burst 0"


def test_a_study_without_records_is_given_them(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(TEXT)
    with pytest.raises(sprag.InputError):
        sprag.Study.read(tmp_path / "study.toml")
    read = sprag.Study.read(tmp_path / "study.toml", records=folder / "records")
    assert sprag.cloud(read).runs.columns.keys() == sprag.cloud(sprag.Study.read(folder / "study.toml")).runs.columns.keys()
    study = sprag.Study(TEXT, records=records(4))
    assert study == pickle.loads(pickle.dumps(study)) == sprag.Study(TEXT, records=iter(records(4)))
    assert np.array_equal(sprag.cloud(study).runs["pgv"], sprag.cloud(read).runs["pgv"])
    # One alone, and not the letters of its name.
    (one,) = records(1)
    file = str(folder / "records" / "burst 0.csv")
    assert study.use(one) == study.use([one])
    assert study.use(file) == study.use([file]) == study.use(Path(file))
    assert sprag.cloud(study.use(file)).runs["pgv"].tolist() == sprag.cloud(study.use(one)).runs["pgv"].tolist()


def test_studies_are_values(folder: Path) -> None:
    study = sprag.Study.read(folder / "study.toml").set("block.size_m", 3.0)
    copy = pickle.loads(pickle.dumps(study))
    assert copy == study
    assert hash(copy) == hash(study)
    assert study != study.use(records(2)) == pickle.loads(pickle.dumps(study.use(records(2))))
    assert study.devices == ("none", "inerter", "clutched pair")
    with pytest.raises(AttributeError, match="never changes"):
        study.text = ""


@pytest.mark.parametrize("answer", [sprag.cloud, sprag.optimise])
def test_every_warning_about_records_is_said(answer) -> None:
    loud = [sprag.Record([0.0, 50.0 + k, 0.0], time_step_s=0.01, units="g", name=f"loud {k}") for k in range(9)]
    lines = {f"{record.name}: {warning}" for record in loud for warning in record.warnings}
    assert len(lines) > 8
    assert lines <= set(answer(sprag.Study(TEXT, records=loud)).warnings)


def test_studies_of_no_records_are_refused(folder: Path, tmp_path: Path) -> None:
    study = sprag.Study.read(folder / "study.toml")
    (tmp_path / "words.csv").write_text("none")
    with pytest.raises(sprag.InputError) as raised:
        study.use([])
    assert raised.value.key == "records"
    for files in [[tmp_path / "absent"], [tmp_path / "words.csv"], [tmp_path]]:
        for call in [sprag.cloud, sprag.optimise]:
            with pytest.raises(sprag.InputError) as raised:
                call(study.use(files))
            assert raised.value.key == "records"
    with pytest.raises(sprag.InputError):
        study.use([records(1)[0], "file.csv"])
    with pytest.raises(sprag.InputError) as raised:
        study.set("block.size_m", -1.0)
    assert raised.value.key == "block.size_m"
    with pytest.raises(sprag.InputError, match=r"study:1: "):
        sprag.Study("scales = [1]")


def test_a_demand_model_is_the_line_through_logarithms() -> None:
    # D = 2 IM^1.5, times e^±0.1 in pairs: the law is exact, and β² = 6·0.01/4.
    intensity = np.repeat([1.0, 2.0, 4.0], 2)
    demand = 2.0 * intensity**1.5 * np.exp([0.1, -0.1] * 3)
    model = sprag.demand(intensity=intensity, demand=demand)
    assert (model.a, model.b) == (pytest.approx(2.0, rel=1e-12), pytest.approx(1.5, rel=1e-12))
    assert model.dispersion == pytest.approx(math.sqrt(0.06 / 4), rel=1e-12)
    assert model.median([1.0, 4.0]) == pytest.approx([2.0, 16.0], rel=1e-12)
    low, high = model.median_band([2.0])
    # Student's t for 4 degrees of freedom at 95 % is 2.776; the mean of ln IM is there.
    assert high[0] / model.median([2.0])[0] == pytest.approx(math.exp(2.7764451 * model.dispersion / math.sqrt(6)), rel=1e-7)
    assert low[0] * high[0] == pytest.approx(model.median([2.0])[0] ** 2, rel=1e-12)
    assert model.prediction_band([2.0])[1][0] > high[0]
    assert pickle.loads(pickle.dumps(model)) == model
    with pytest.raises(sprag.InputError) as raised:
        sprag.demand(intensity=[1.0, 2.0, 0.0], demand=[1.0, 1.0, 1.0])
    assert raised.value.key == "intensity.2"


def test_a_fragility_is_that_of_its_likelihood() -> None:
    # Halves overturn at IM = 2, a share of Φ(−1) and Φ(1) half and twice there: μ = ln 2, β = ln 2.
    share = 0.15865525393145707
    runs = 100_000_000
    found = sprag.fragility(
        intensity=[1.0, 2.0, 4.0], overturned=[round(share * runs), runs // 2, round((1 - share) * runs)], of=[runs] * 3
    )
    assert found.median == pytest.approx(2.0, rel=1e-7)
    assert found.dispersion == pytest.approx(math.log(2.0), rel=1e-7)
    assert found.probability([1.0, 2.0]) == pytest.approx([share, 0.5], rel=1e-6)
    assert found.reason is None
    few = sprag.fragility(intensity=[1, 2, 3, 4, 5, 6], overturned=[False, True, False, True, False, True])
    assert pickle.loads(pickle.dumps(few)) == few
    assert few != found
    bands = few.bootstrap([2.0, 4.0], resamples=50)
    again = few.bootstrap([2.0, 4.0], resamples=50, threads=1)
    assert all(np.array_equal(bands[name], again[name]) for name in bands)
    assert (bands["low"] <= bands["high"]).all()
    wrong = [
        {"resamples": -1},
        {"resamples": 2**40},
        {"resamples": 2**70},
        {"threads": -(2**70)},
        {"threads": -1},
        {"seed": -1},
        {"seed": 2**64},
    ]
    for keywords, key in [(keywords, *keywords) for keywords in wrong]:
        with pytest.raises(sprag.InputError) as raised:
            few.bootstrap([2.0], **keywords)
        assert raised.value.key == key
    none = sprag.fragility(intensity=[1.0, 2.0], overturned=[0, 0])
    assert none.median is None
    assert str(none.reason).startswith("none of 2 runs overturned")
    empty = none.bootstrap([1.0, 2.0, 3.0], resamples=5)
    assert empty.pop("share_without_estimate") == 1.0
    assert all(column.shape == (3,) and np.isnan(column).all() for column in empty.values())
    with pytest.raises(sprag.RunError, match="none of 2 runs"):
        none.probability([1.0])


@given(st.lists(st.tuples(st.floats(), st.floats()), max_size=8))
def test_any_runs_have_fits_or_one_error(rows: list[tuple[float, float]]) -> None:
    intensity, other = [row[0] for row in rows], [row[1] for row in rows]
    for call, keywords in [(sprag.demand, {"demand": other}), (sprag.fragility, {"overturned": other})]:
        try:
            call(intensity=intensity, **keywords)
        except sprag.InputError as error:
            assert error.key is not None
            assert "\n" not in str(error)


def test_accuracy_is_a_table_of_methods(scenes: Path) -> None:
    scene = sprag.Scene.read(scenes / "figure05.toml")
    table = sprag.accuracy(scene, cells=0, smallest_step=0.05)
    assert len(table) > 3
    for keywords, key in [
        ({"cells": 65}, "cells"),
        ({"cells": 300}, "cells"),
        ({"cells": -1}, "cells"),
        ({"cells": 2**70}, "cells"),
        ({"smallest_step": math.nan}, "smallest_step"),
        ({"threads": 0}, "threads"),
        ({"threads": -1}, "threads"),
    ]:
        with pytest.raises(sprag.InputError) as raised:
            sprag.accuracy(scene, **keywords)
        assert raised.value.key == key
    with pytest.raises(sprag.InputError) as raised:
        sprag.accuracy(scene.set("device.0", sprag.ClutchedPair(mass_ratio=0.5, engagement="rigid")))
    assert raised.value.key == "device.0.engagement"
