"""Responses: the command's bits, events, errors, and numbers found in another way."""

import math
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import sprag


def test_histories_are_those_of_the_command(scenes: Path, command) -> None:
    path = scenes / "near_fault.toml"
    rows = command("simulate", path)("history")
    for run in sprag.simulate(sprag.Scene.read(path)):
        own = [row for row in rows if row["device"] == run.device]
        columns = {
            "time_s": run.t,
            "ground_m_s2": run.ground_m_s2,
            "rotation_rad": run.rotation_rad,
            "velocity_rad_s": run.velocity_rad_s,
            "acceleration_rad_s2": run.acceleration_rad_s2,
            "force_ratio_first": run.force_ratio[0],
            "force_ratio_second": run.force_ratio[1],
        }
        for name, values in columns.items():
            assert np.array([float(row[name]) for row in own]).tobytes() == values.tobytes(), name
        assert [int(row["engaged"]) for row in own] == run.engaged.tolist()


def test_the_ledger_is_that_of_the_command_and_closes(scenes: Path, command) -> None:
    path = scenes / "near_fault.toml"
    rows = command("simulate", path, "--set", "output.energy=true")("energy")
    for run in sprag.simulate(sprag.Scene.read(path).set("output", sprag.Output(energy=True))):
        assert run.energy is not None
        for name, values in run.energy.columns.items():
            assert [float(row[name]) for row in rows if row["device"] == run.device] == values.tolist(), name
        assert abs(run.energy["residual"]).max() < 1e-9


def test_a_slender_block_falls_back_when_the_cosine_says_so() -> None:
    # Free rocking of a slender block from rest at θ0: θ = α − (α − θ0) cosh pt, Housner (1963).
    block = sprag.Block(frequency_parameter_1_s=2.0, slenderness_deg=10.0, geometry="slender", initial_rotation_ratio=0.5)
    (run,) = sprag.simulate(sprag.Scene(block=block), accuracy="tight")
    assert run.impacts_s[0] == pytest.approx(math.acosh(1 / 0.5) / 2.0, rel=1e-12)
    assert run.outcome is sprag.Outcome.SAFE
    assert run.peak_rotation == 0.5
    assert run.error is not None
    assert run.error.outcome_certain
    assert 0.0 <= run.error.first_impact_time < 1e-9
    # Just after an impact θ is 0, and θ̇ is 0.85 of what it was.
    index = np.searchsorted(run.t, run.impacts_s[0])
    assert abs(run.y_events[0][0, 0]) < 1e-12
    assert run.y_events[0][0, 1] == pytest.approx(0.85 * run.velocity_rad_s[index], rel=1e-9)
    assert len(run.y_events[0]) == len(run.t_events[0])


@pytest.mark.parametrize("events", ["located", "step-end"])
def test_switches_are_events_wherever_they_take_place(events: str) -> None:
    block = sprag.Block(size_m=2.0, slenderness_deg=10.0)
    ground = sprag.Sine(amplitude_g=0.4, frequency_hz=1.0)
    scene = sprag.Scene(block=block, device=sprag.ClutchedPair(mass_ratio=0.5), ground=ground, output=sprag.Output(interval_s=0.001))
    method = sprag.Accuracy(method="runge-kutta-4", step_s=0.001, events=events)
    (run,) = sprag.simulate(scene.set("accuracy", method))
    assert len(run.t_events[1]) == len(run.y_events[1]) == run.summary["clutch_switches"] > 0


def test_arrays_are_handed_over_and_not_copied() -> None:
    (run,) = sprag.simulate(sprag.Scene(block=sprag.Block(size_m=1.0, slenderness_deg=10.0, initial_rotation_ratio=0.5)))
    assert not run.t.flags.owndata
    assert not run.y.flags.owndata
    assert np.shares_memory(run.rotation_rad, run.y)
    assert np.shares_memory(run.to_xarray().rotation.values, run.y)
    assert run.to_xarray().rotation.attrs["units"] == "rad"
    assert run.to_xarray().attrs["digest"] == run.digest()


def test_data_sets_have_the_slide_of_the_base() -> None:
    block = sprag.Block(size_m=2.0, slenderness_deg=30.0, friction_coefficient=0.3, restitution=0.5)
    (run,) = sprag.simulate(sprag.Scene(block=block, ground=sprag.Ricker(amplitude_g=0.9, frequency_hz=1.0)))
    slide = run.to_xarray().displacement
    assert slide.attrs["units"] == "m"
    assert np.array_equal(slide.values, run.displacement_m)
    assert abs(slide).max() > 0.0


def test_arrays_of_results_cannot_be_written() -> None:
    block = sprag.Block(size_m=1.0, slenderness_deg=10.0, initial_rotation_ratio=0.5)
    (run,) = sprag.simulate(sprag.Scene(block=block, output=sprag.Output(energy=True)))
    for same in (run, pickle.loads(pickle.dumps(run))):
        assert same.energy is not None
        for array in (same.t, same.y, same.rotation_rad, same.t_events[0], same.y_events[1], same.energy["residual"]):
            assert not array.flags.writeable


def test_runs_compare_hash_and_pickle() -> None:
    scene = sprag.Scene(block=sprag.Block(size_m=1.0, slenderness_deg=10.0), ground=sprag.Sine(amplitude_g=0.4, frequency_hz=1.0))
    (run,), (again,) = sprag.simulate(scene), sprag.simulate(scene)
    assert run == again == pickle.loads(pickle.dumps(run))
    assert hash(run) == hash(again)
    (other,) = sprag.simulate(scene.set("ground.0.scale", 0.5))
    assert run != other
    assert "array" not in repr(run)


@pytest.mark.parametrize("accuracy", ["sloppy", -1.0, math.nan, True])
def test_an_accuracy_that_cannot_be_meant_is_refused(accuracy: object) -> None:
    scene = sprag.Scene(block=sprag.Block(size_m=1.0, slenderness_deg=10.0, initial_rotation_ratio=0.5))
    with pytest.raises(sprag.InputError) as raised:
        sprag.simulate(scene, accuracy=accuracy)
    assert str(raised.value.key).startswith("accuracy")
    assert "untagged" not in str(raised.value)


def test_a_record_that_is_gone_is_one_error(tmp_path: Path) -> None:
    record = tmp_path / "record.csv"
    record.write_text("time_s,acc_g\n0,0\n0.1,0.5\n0.2,0\n")
    text = "block={size_m=1,slenderness_deg=10}\ndevice=[{kind='none'}]\nground=[{motion='record',file='record.csv'}]"
    scene = sprag.Scene.parse(text, folder=tmp_path)
    assert len(sprag.simulate(scene)) == 1
    record.unlink()
    with pytest.raises(sprag.InputError, match=r"record\.csv"):
        sprag.simulate(scene)


LONG = "import sprag; sprag.map(sprag.Scene.read({scene!r}), x=sprag.Axis(key='block.size_m', start=1, stop=3, cells=9999), threads=1)"


def test_ctrl_c_ends_a_long_call(scenes: Path) -> None:
    # Of a process in the background a shell may have it ignored.
    heeded = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    long = LONG.format(scene=str(scenes / "near_fault.toml"))
    with subprocess.Popen(
        [sys.executable, "-c", f"{heeded}; print(flush=True); {long}"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        # The call itself takes minutes.
        _, errors = process.communicate(timeout=30)
    assert b"KeyboardInterrupt" in errors
    assert process.returncode != 0


def test_other_threads_run_during_a_long_call(scenes: Path) -> None:
    ticks, ended = 0, threading.Event()

    def count() -> None:
        nonlocal ticks
        while not ended.wait(0.001):
            ticks += 1

    thread = threading.Thread(target=count)
    thread.start()
    start = time.monotonic()
    sprag.map(sprag.Scene.read(scenes / "near_fault.toml"), x=sprag.Axis(key="block.size_m", start=1, stop=3, cells=60), threads=1)
    seconds = time.monotonic() - start
    ended.set()
    thread.join()
    # Held, the lock would be given up not once.
    assert ticks > 20 * seconds
