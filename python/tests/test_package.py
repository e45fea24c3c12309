"""The package as a whole: what it imports, its command, and its documents."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import sprag

ROOT = Path(__file__).parents[2]


def test_nothing_is_imported_that_is_not_asked_for() -> None:
    heavy = ["pandas", "xarray", "matplotlib", "pyarrow", "dask", "distributed"]
    code = f"import sys, sprag; print([name for name in {heavy} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout == "[]\n"


def test_every_name_has_a_docstring() -> None:
    for name in sprag.__all__:
        value = getattr(sprag, name)
        assert name in ("__version__", "Ground", "Motion", "Device", "Law") or value.__doc__, name
        for member, own in vars(value).items() if isinstance(value, type) else ():
            if not member.startswith("_") and callable(own):
                assert own.__doc__, f"{name}.{member}"


def test_the_wheel_has_the_command() -> None:
    program = Path(sys.executable).parent / "sprag"
    shown = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
    assert shown == f"sprag {sprag.__version__}\n"
    wrong = subprocess.run([program, "simulate", "absent.toml"], check=False, capture_output=True, text=True)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert wrong.stderr.startswith("sprag: absent.toml:")
    assert wrong.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("page", "number", "picture"),
    [
        ("python", 2, "run.png"),
        ("start/researcher", 3, "out/figure10/history.svg"),
        ("start/structural-engineer", 6, "out/cloud-cloud/fragility.svg"),
    ],
)
def test_examples_of_a_page_run(tmp_path: Path, page: str, number: int, picture: str) -> None:
    text = (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")
    examples = re.findall(r"```(python|sh)\n(.*?)```", text, re.DOTALL)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for language, code in examples:
        words = [sys.executable, "-c"] if language == "python" else ["bash", "-euc"]
        subprocess.run([*words, code], check=True, cwd=tmp_path, env=os.environ | {"MPLBACKEND": "agg", "PATH": path})
    assert len(examples) == number
    assert (tmp_path / picture).stat().st_size > 10_000
