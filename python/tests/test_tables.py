"""The tables of a scene: values that never change, and say what is wrong with them."""

import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sprag
from sprag._table import Table

TABLES = [getattr(sprag, name) for name in sprag.__all__ if isinstance(getattr(sprag, name), type)]
TABLES = [table for table in TABLES if issubclass(table, Table)]
EXAMPLES: list[Table] = [
    sprag.Block(size_m=2.0, slenderness_deg=10.0),
    sprag.NoDevice(name="bare"),
    sprag.ClutchedPair(mass_ratio=0.5, clutch=sprag.Clutch(capacity_ratio=0.3), rack=sprag.Rack(dry_friction_ratio=0.01)),
    sprag.Inerter(flywheels=[sprag.Flywheel(mass_kg=3.0, radius_m=0.4, pinion_radius_m=0.1)]),
    sprag.Sine(amplitude_g=0.3, frequency_hz=1.0),
    sprag.Accuracy(level="tight"),
    sprag.Controller(law="sign-table", sign_table=204, sensors=sprag.Sensors(gyroscope=sprag.Gyroscope(rate_hz=1000.0))),
]


@pytest.mark.parametrize("value", EXAMPLES, ids=lambda value: type(value).__name__)
def test_values_compare_hash_print_and_pickle(value: Table) -> None:
    copy = pickle.loads(pickle.dumps(value))
    assert copy == value
    assert hash(copy) == hash(value)
    assert eval(repr(value), vars(sprag)) == value
    with pytest.raises(dataclasses.FrozenInstanceError):
        value.name = "other"


def test_every_table_of_a_scene_has_a_class() -> None:
    assert len(TABLES) == 30
    assert {table._path.split(".")[0] for table in TABLES} == {
        "block",
        "device",
        "ground",
        "run",
        "accuracy",
        "checks",
        "controller",
        "output",
    }


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.__name__)
def test_every_number_of_every_table_is_refused_where_it_is_none(table: type[Any]) -> None:
    required = {"slenderness_deg": 10.0, "mass_kg": 1.0, "radius_m": 1.0, "pinion_radius_m": 1.0, "module_mm": 1.0, "teeth": 20}
    required |= {"face_width_mm": 1.0, "allowable_stress_mpa": 1.0, "holding_power_w": 1.0}
    required |= {"vertical_frequency_hz": 1.0, "damping_ratio": 0.1, "file": "record.csv"}
    names = {field.name: str(field.type) for field in dataclasses.fields(table)}
    base = {name: value for name, value in required.items() if name in names and "None" not in names[name]}
    numbers = [name for name, kind in names.items() if kind.startswith("float")]
    for name in numbers:
        # What words a key takes is seen with the other keys.
        for bad in [math.nan, math.inf, [1.0] if "Literal" in names[name] else "many"]:
            with pytest.raises(sprag.InputError) as raised:
                table(**{**base, name: bad})
            assert name in str(raised.value)
            assert "\n" not in str(raised.value)


@given(st.floats(), st.floats(), st.floats())
def test_a_block_is_within_its_ranges_or_refused(size: float, slenderness: float, restitution: float) -> None:
    allowed = 1e-3 <= size <= 1e4 and 0.0 < slenderness < 90.0 and 0.0 <= restitution <= 1.0
    try:
        sprag.Block(size_m=size, slenderness_deg=slenderness, restitution=restitution)
    except sprag.InputError as error:
        assert not allowed
        assert error.key in ("size_m", "slenderness_deg", "restitution")
        assert error.range is not None
        value = {"size_m": size, "slenderness_deg": slenderness, "restitution": restitution}[error.key]
        assert error.value == value or (math.isnan(value) and math.isnan(float(error.value or 0.0)))
    else:
        assert allowed


def test_numbers_of_numpy_are_numbers() -> None:
    block = sprag.Block(size_m=np.float32(2.0), slenderness_deg=np.int64(10))
    assert block == sprag.Block(size_m=2.0, slenderness_deg=10.0)


def test_an_array_of_one_number_is_that_number_for_good() -> None:
    size, seed = np.array(2.0), np.array(7)
    block = sprag.Block(size_m=size, slenderness_deg=10.0)
    sensors = sprag.Sensors(seed=seed)
    size[...], seed[...] = 5.0, 8
    for held, written in [(block, sprag.Block(size_m=2.0, slenderness_deg=10.0)), (sensors, sprag.Sensors(seed=7))]:
        assert held == written
        assert hash(held) == hash(written)
        assert repr(held) == repr(written)


@pytest.mark.parametrize("size", [2**70, -(2**70), 10**400, -(10**400)], ids=lambda size: f"{size.bit_length()} bits, {size > 0}")
def test_whole_numbers_of_any_length_are_within_a_range_or_not(size: int) -> None:
    with pytest.raises(sprag.InputError) as raised:
        sprag.Block(size_m=size, slenderness_deg=10.0)
    assert raised.value.key == "size_m"
    with pytest.raises(sprag.InputError) as raised:
        sprag.Sensors(seed=size)
    assert "seed" in str(raised.value)


@pytest.mark.parametrize(
    ("table", "name", "key"),
    [
        (lambda word: sprag.Block(size_m=2.0, slenderness_deg=10.0, restitution=word), "restitution", "restitution"),
        (lambda word: sprag.Sensors(suite=word), "suite", "sensors.suite"),
        (lambda word: sprag.Gyroscope(preset=word), "preset", "sensors.gyroscope.preset"),
        (lambda word: sprag.Accelerometer(preset=word), "preset", "sensors.block_accelerometer.preset"),
        (lambda word: sprag.Encoder(preset=word), "preset", "sensors.encoder.preset"),
    ],
)
def test_words_that_a_key_does_not_take_are_refused(table, name: str, key: str) -> None:
    with pytest.raises(sprag.InputError) as raised:
        table("foo")
    assert (raised.value.key, raised.value.value) == (key, "foo")
    known = "momentum-balance" if name == "restitution" else "ideal"
    assert known in str(raised.value.range)
    assert getattr(table(known), name) == known


def test_errors_pickle() -> None:
    with pytest.raises(sprag.InputError) as raised:
        sprag.Block(size_m=-1.0, slenderness_deg=10.0)
    copy = pickle.loads(pickle.dumps(raised.value))
    assert (str(copy), copy.key, copy.value, copy.range) == (
        "block: size_m is -1, but must be from 0.001 to 10000 m",
        "size_m",
        -1.0,
        "from 0.001 to 10000 m",
    )
