"""What tests share: the scenes of the repository, and the command of the wheel."""

import csv
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

# A check does not fail by chance.
settings.register_profile("check", derandomize=True)
settings.load_profile("check")

Rows = list[dict[str, str]]
Command = Callable[..., Callable[[str], Rows]]


@pytest.fixture(scope="session")
def scenes() -> Path:
    return Path(__file__).parents[2] / "scenes"


@pytest.fixture
def command(tmp_path: Path) -> Command:
    """Runs the command `sprag`, and gives a function that reads one of the tables that it wrote."""

    def run(*words: str | Path) -> Callable[[str], Rows]:
        program, folder = Path(sys.executable).parent / "sprag", tmp_path / "out"
        subprocess.run([program, *words, "--formats", "csv", "--out", folder], check=True, capture_output=True)

        def read(table: str) -> Rows:
            with (folder / f"{table}.csv").open(newline="") as file:
                return list(csv.DictReader(file))

        return read

    return run
