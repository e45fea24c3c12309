"""Boards: what is refused, and the firmware in the emulator, which decides to the last bit as the host does."""

import os
import pickle
from pathlib import Path

import pytest

import sprag


def test_a_board_is_somewhere() -> None:
    for places in [{}, {"port": "/dev/ttyUSB0", "image": "firmware.elf"}]:
        with pytest.raises(sprag.InputError):
            sprag.Board(**places)
    board = sprag.Board(port="/dev/ttyUSB0")
    assert pickle.loads(pickle.dumps(board)) == board


def test_what_is_no_board_is_one_error(tmp_path: Path, scenes: Path) -> None:
    (tmp_path / "words.elf").write_text("words")
    scene = sprag.Scene.read(scenes / "controller.toml")
    for board in [
        sprag.Board(port=str(tmp_path / "absent")),
        sprag.Board(image=tmp_path / "absent.elf"),
        sprag.Board(image=tmp_path / "words.elf"),
    ]:
        for call in [board.info, board.settings, board.log, lambda board=board: board.closed_loop(scene)]:
            with pytest.raises(sprag.BoardError) as raised:
                call()
            assert "\n" not in str(raised.value)


@pytest.fixture
def emulator() -> sprag.Board:
    image = os.environ.get("SPRAG_FIRMWARE_ELF")
    if image is None:
        pytest.skip("SPRAG_FIRMWARE_ELF names no firmware for the emulator")
    return sprag.Board(image=image)


def test_an_emulated_board_says_what_it_is(emulator: sprag.Board) -> None:
    info = emulator.info()
    assert info["firmware"]
    assert info["phase"] in ("Boot", "Fault")
    settings = emulator.settings()
    assert len(settings) == info["settings"]
    changed = emulator.change({"model.size": 2.5, "law": "passive"})
    assert (changed["model.size"], changed["law"]) == (2.5, "passive")
    assert changed["model.frequency"] != settings["model.frequency"]
    for changes in [{"model.siz": 2.5}, {"model.size": -1.0}, {"law": 3}]:
        with pytest.raises(sprag.InputError):
            emulator.change(changes)
    log = emulator.log()
    assert len(log) == len(log["what"]) > 0
    times = log["time_s"]
    assert 0.0 <= times[0] < 1.0
    assert (times[1:] >= times[:-1]).all()


def test_the_firmware_decides_as_the_host_does(emulator: sprag.Board, scenes: Path) -> None:
    scene = sprag.Scene.read(scenes / "controller.toml").set("run.free_time_s", 0.5)
    loop = emulator.closed_loop(scene)
    assert loop.differing == 0
    assert loop.board.decisions_digest == loop.host.decisions_digest == sprag.closed_loop(scene).decisions_digest
    assert loop.host == sprag.closed_loop(scene)
