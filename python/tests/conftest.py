"""What tests share: the scenes of the repository, and the command of the wheel."""

import csv
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

Command = Callable[..., list[dict[str, str]]]


@pytest.fixture(scope="session")
def scenes() -> Path:
    return Path(__file__).parents[2] / "scenes"


@pytest.fixture
def command(tmp_path: Path) -> Command:
    """Runs the command `sprag`, and reads the table that it writes."""

    def run(table: str, *words: str | Path) -> list[dict[str, str]]:
        program = Path(sys.executable).parent / "sprag"
        subprocess.run([program, *words, "--out", tmp_path / "out"], check=True, capture_output=True)
        with (tmp_path / "out" / table).open(newline="") as file:
            return list(csv.DictReader(file))

    return run
