"""Packages of Python that a comparison needs, in a virtual environment of its own where the machine lacks them."""

from __future__ import annotations

import importlib
import subprocess
import sys
import venv
from pathlib import Path

UNAVAILABLE = 3


def ensure_packages(folder: Path, requirements: tuple[str, ...], modules: tuple[str, ...]) -> None:
    """Goes on when `modules` can be had; otherwise installs `requirements` into the virtual environment `folder` and runs this
    command there, and where that is not possible ends with the code 3."""
    try:
        for module in modules:
            importlib.import_module(module)
    except ImportError:
        if Path(sys.prefix).resolve() == folder.resolve():
            raise
        places = (folder / "bin/python", folder / "Scripts/python.exe")
        try:
            if not any(path.exists() for path in places):
                venv.create(folder, with_pip=True)
            python = next(path for path in places if path.exists())
            subprocess.run([python, "-m", "pip", "install", "--quiet", *requirements], check=True)
        except (OSError, StopIteration, subprocess.CalledProcessError) as error:
            print(f"{', '.join(requirements)} cannot be installed: {error}", file=sys.stderr)
            sys.exit(UNAVAILABLE)
        sys.exit(subprocess.run([python, *sys.argv], check=False).returncode)
