"""What tests share: the scenes of the repository, and the command of the wheel."""

import csv
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

import sprag

# A check does not fail by chance.
settings.register_profile("check", derandomize=True)
settings.load_profile("check")

Rows = list[dict[str, str]]
Command = Callable[..., Callable[[str], Rows]]


@pytest.fixture(scope="session")
def scenes() -> Path:
    return Path(__file__).parents[2] / "scenes"


@pytest.fixture(scope="session")
def same_table() -> Callable[[Rows, sprag.Columns], None]:
    """Asserts that a table that the command wrote is one of Python's."""

    def assert_same(rows: Rows, columns: sprag.Columns) -> None:
        assert list(rows[0]) == list(columns)
        assert len(rows) == len(columns)
        for column, values in columns.columns.items():
            texts = [row[column] for row in rows]
            if isinstance(values, np.ndarray):
                assert np.array_equal(np.array([float(text or "nan") for text in texts]), values.astype(float), equal_nan=True), column
            else:
                assert texts == [value or "" for value in values], column

    return assert_same


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
