"""The controller in closed loop, by its own laws and by functions of Python."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import sprag


@pytest.fixture(scope="module")
def scene(scenes: Path) -> sprag.Scene:
    return sprag.Scene.read(scenes / "controller.toml").set("controller.law", "resisting-predicted")


@pytest.fixture(scope="module")
def own(scene: sprag.Scene) -> sprag.ClosedLoop:
    return sprag.closed_loop(scene)


def resisting(at: sprag.Situation) -> bool:
    """Eq. 10: engaged while acceleration and velocity of the terminals have one sign."""
    return at.push_sign == at.velocity_sign


def test_histories_are_those_of_the_command(scene: sprag.Scene, own: sprag.ClosedLoop, scenes: Path, command) -> None:
    rows = command("loop", scenes / "controller.toml", "--set", "controller.law=resisting-predicted")("history")
    columns = own.columns
    for name in ["ground_m_s2", "rotation_rad", "velocity_rad_s", "push_1_s2"]:
        assert [float(row[name]) for row in rows] == columns[name].tolist(), name
    for name in ["rotation_estimated_rad", "velocity_estimated_rad_s", "push_estimated_1_s2"]:
        assert np.array([row[name] for row in rows], dtype=np.float32).tolist() == columns[name].tolist(), name
    for name in ["command", "engaged", "ideal", "fault"]:
        assert [int(row[name]) for row in rows] == columns[name].tolist(), name
    assert [row["wish"] for row in rows] == [sprag.Wish(wish).name.lower() for wish in columns["wish"]]
    assert [float(row["time_s"]) for row in rows] == own.t.tolist()


def test_a_law_of_python_is_the_law_that_it_says(scene: sprag.Scene, own: sprag.ClosedLoop) -> None:
    ours = sprag.closed_loop(scene, law=resisting)
    assert ours.decisions_digest == own.decisions_digest
    assert ours.digest() == own.digest()
    assert (ours.summary["law"], own.summary["law"]) == ("python", "resisting-predicted")
    now = sprag.closed_loop(scene, law=resisting, predicts=False)
    assert now.decisions_digest == sprag.closed_loop(scene.set("controller.law", "resisting")).decisions_digest
    assert now.decisions_digest != own.decisions_digest
    for law, name in [(lambda _: sprag.Wish.HOLD, "always-engaged"), (lambda _: False, "passive")]:
        theirs = sprag.closed_loop(scene.set("controller.law", name))
        assert sprag.closed_loop(scene, law=law, predicts=False).decisions_digest == theirs.decisions_digest


def test_a_law_answers_with_a_bool_of_numpy(scene: sprag.Scene, own: sprag.ClosedLoop) -> None:
    # Under NumPy 1 its type is called otherwise.
    older = type("bool_", (), {"__init__": lambda self, value: setattr(self, "value", value), "__bool__": lambda self: bool(self.value)})
    for boolean in (np.bool_, older):
        assert sprag.closed_loop(scene, law=lambda at, boolean=boolean: boolean(resisting(at))).decisions_digest == own.decisions_digest


def test_a_law_works_at_any_accuracy(scene: sprag.Scene) -> None:
    closer = scene.set("accuracy", {"level": "fast"})
    ours, theirs = sprag.closed_loop(closer, law=resisting), sprag.closed_loop(closer)
    assert ours.digest() == theirs.digest()
    assert ours.error == theirs.error
    assert ours.error is not None


def test_what_a_law_raises_ends_the_loop(scene: sprag.Scene) -> None:
    def failing(at: sprag.Situation) -> bool:
        raise ZeroDivisionError(at.standing)

    with pytest.raises(ZeroDivisionError, match="True"):
        sprag.closed_loop(scene, law=failing)
    for answer in [None, "resist", 3, -1, 0.5]:
        with pytest.raises(TypeError, match="a clutch law returns"):
            sprag.closed_loop(scene, law=lambda _, answer=answer: answer)
    with pytest.raises(TypeError):
        sprag.closed_loop(scene, law=lambda: True)


def test_a_law_that_closes_loops_by_itself_ends_like_any_recursion(scene: sprag.Scene) -> None:
    def endless(_: sprag.Situation) -> bool:
        return sprag.closed_loop(scene, law=endless).outcome.overturned

    def inner(at: sprag.Situation) -> bool:
        if not seen:
            seen.append(sprag.closed_loop(scene, law=resisting).digest())
        return resisting(at)

    seen: list[str] = []
    with pytest.raises(RecursionError, match="clutch laws"):
        sprag.closed_loop(scene, law=endless)
    assert [sprag.closed_loop(scene, law=inner).digest()] == seen


def test_situations_compare_hash_print_and_pickle(scene: sprag.Scene) -> None:
    seen: list[sprag.Situation] = []

    def watched(at: sprag.Situation) -> bool:
        seen.append(at)
        return resisting(at)

    sprag.closed_loop(scene, law=watched)
    first, moving = seen[0], max(seen, key=lambda at: abs(at.rotation_rad))
    copy = pickle.loads(pickle.dumps(moving))
    assert copy == moving != first
    assert hash(copy) == hash(moving) != hash(first)
    assert repr(copy) == repr(moving)
    assert str(np.float32(moving.rotation_rad)) in repr(moving)
    names = [name for name in dir(moving) if not name.startswith("_")]
    assert [getattr(copy, name) for name in names] == [getattr(moving, name) for name in names]
    assert len(names) == 17


def test_seeds_are_other_specimens(scene: sprag.Scene) -> None:
    first, second = sprag.closed_loop(scene, seed=1), sprag.closed_loop(scene, seed=2)
    assert not np.array_equal(first.columns["gyroscope_rad_s"], second.columns["gyroscope_rad_s"])
    assert first == sprag.closed_loop(scene, seed=1) == pickle.loads(pickle.dumps(first))
    assert len(first.to_pandas()) == len(first.t)


def test_scenes_without_a_loop_are_refused(scene: sprag.Scene) -> None:
    for key, value, refused in [
        ("device", [{"kind": "none"}], "device"),
        ("block.initial_rotation_ratio", 0.5, "block.initial_rotation_ratio"),
    ]:
        with pytest.raises(sprag.InputError) as raised:
            sprag.closed_loop(scene.set(key, value))
        assert raised.value.key == refused
    for device in [7, "absent", -1, 2**70]:
        with pytest.raises(sprag.InputError) as raised:
            sprag.closed_loop(scene, device=device)
        assert raised.value.key == "device"
    for seed in [-1, 2**64]:
        with pytest.raises(sprag.InputError) as raised:
            sprag.closed_loop(scene, seed=seed)
        assert (raised.value.key, raised.value.value) == ("seed", seed)
