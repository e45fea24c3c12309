"""Arrays and files of any kind: a result, or one exception that says what is wrong; and nothing of the caller's is changed."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import sprag

MODEL = sprag.demand(intensity=[1.0, 2.0, 4.0], demand=[1.0, 3.0, 5.0])
CURVE = sprag.fragility(intensity=[1, 2, 3, 4, 5, 6], overturned=[0, 1, 0, 1, 0, 1])

TAKERS: dict[str, Callable[[Any], Any]] = {
    "record": lambda array: sprag.Record(array, time_step_s=0.01).acceleration_m_s2,
    "demand": lambda array: [sprag.demand(intensity=array, demand=array).a],
    "fragility": lambda array: sprag.fragility(intensity=array, overturned=array) and [0.0],
    "of": lambda array: sprag.fragility(intensity=[1.0, 2.0], overturned=[0, 1], of=array) and [0.0],
    "median": MODEL.median,
    "median_band": MODEL.median_band,
    "prediction_band": MODEL.prediction_band,
    "probability": CURVE.probability,
    "band": CURVE.band,
    "bootstrap": lambda array: CURVE.bootstrap(array, resamples=3, threads=1)["low"],
}

NOT_REAL = [
    np.array([1 + 1j, 2]),
    np.array([1, 2], dtype="M8[s]"),
    ["1", "2"],
    [1.0, None],
    [1.0, "2"],
    [[1.0], [2.0, 3.0]],
    {1.0: 2.0},
    np.array(["1", "2"], dtype=object),
    np.array([b"1", bytearray(b"2")], dtype=object),
    np.array([1 + 1j, 2.0], dtype=object),
    np.array([np.complex64(1 + 1j), 2.0], dtype=object),
    np.array([np.timedelta64(1, "s"), 2.0], dtype=object),
    np.array([np.datetime64(1, "s"), 2.0], dtype=object),
    np.ma.array([1.0, 9999.0], mask=[False, True]),
]


@given(st.sampled_from(sorted(TAKERS)), st.data())
def test_any_array_has_a_result_or_one_error(name: str, data: st.DataObject) -> None:
    dtype = data.draw(st.one_of(arrays.scalar_dtypes(), arrays.floating_dtypes(sizes=(64,))))
    array = data.draw(arrays.arrays(dtype, arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5)))
    if array.ndim and data.draw(st.booleans()):
        array = array[:: data.draw(st.sampled_from([-1, 2]))]
    array.flags.writeable = data.draw(st.booleans())
    before = array.tobytes()
    try:
        found = TAKERS[name](array)
    except (sprag.InputError, sprag.RunError) as error:
        assert "\n" not in str(error)
    else:
        assert array.ndim == 1
        assert array.dtype.kind in "biuf", "a number is real"
        assert not np.isnan(found).any()
    assert array.tobytes() == before


@pytest.mark.parametrize("name", TAKERS)
@pytest.mark.parametrize("array", NOT_REAL)
def test_what_is_no_real_number_is_refused(name: str, array: object) -> None:
    with pytest.raises(sprag.InputError) as raised:
        TAKERS[name](array)
    assert raised.value.key is not None


def test_files_that_are_open_or_closed_are_no_paths(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.touch()
    with path.open() as file:
        for _ in ("open", "closed"):
            for read in [sprag.Record.read, sprag.Scene.read, sprag.Study.read, sprag.Plan.read]:
                with pytest.raises(TypeError):
                    read(file)
            file.close()
    for read in [sprag.Record.read, sprag.Scene.read, sprag.Study.read, sprag.Plan.read]:
        for name in [tmp_path, path, tmp_path / "absent", "\0", ""]:
            with pytest.raises(sprag.InputError) as raised:
                read(name)
            assert "\n" not in str(raised.value)
