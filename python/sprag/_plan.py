"""Studies divided into parts for many machines."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from . import _core
from .errors import InputError, RunError


@dataclass(frozen=True)
class Plan:
    """A map or cloud that is divided into parts, each of which is a file in a folder.

    Attributes
    ----------
    folder
        The folder of the plan and its parts.
    key
        SHA-256 of what the rows come from: scene or study, contents of every record, version, number of parts.
    parts
        Number of parts.
    rows
        Number of rows of all parts.
    working_folder
        The folder that paths of the command are relative to.
    """

    folder: Path
    key: str
    parts: int
    rows: int
    working_folder: Path

    @classmethod
    def read(cls, folder: str | os.PathLike[str]) -> Plan:
        """The plan in a folder.

        Raises
        ------
        InputError
            Where there is none.
        """
        place = Path(folder).absolute()
        return cls(place, *_core.plan(place))

    def missing(self) -> list[int]:
        """Numbers of the parts that are not there now."""
        return _core.missing_parts(self.folder)


def plan(
    folder: str | os.PathLike[str],
    command: Sequence[str | os.PathLike[str]],
    *,
    parts: int | None = None,
    part_seconds: float | None = None,
) -> Plan:
    """Divides a map or cloud into parts, which any number of machines may make in any order.

    Parameters
    ----------
    folder
        Folder for the plan and its parts, which every machine sees.
    command
        The words of the command after `sprag`: `["map", "scene.toml", "--out", "out"]`.
    parts
        Number of parts.
    part_seconds
        Length of a part on one core by a rough rate of rows, in the place of `parts`; 30 s by default.

    Raises
    ------
    InputError
        For a command that cannot be divided, or another plan in the folder.
    """
    place = Path(folder).absolute()
    options = [("--parts", parts), ("--part-seconds", part_seconds)]
    words = [word for name, value in options if value is not None for word in (name, str(value))]
    _command(["plan", place, *words, "--", *command], Path.cwd())
    return Plan.read(place)


def run_part(folder: str | os.PathLike[str], index: int, *, threads: int | None = None) -> bool:
    """Makes a part of a plan, unless it is there: then the answer is False.

    Its file comes into place when it is whole. Whoever else makes it meanwhile makes the same bytes.

    Parameters
    ----------
    folder
        Folder of the plan.
    index
        Number of the part, from 1.
    threads
        Threads; one a core by default. Rows do not depend on it.

    Raises
    ------
    InputError
        For a part that there is none of, and a scene, record or program that has changed since.
    RunError
        For a process that was ended before the part was made.
    """
    planned = Plan.read(folder)
    if not 1 <= index <= planned.parts:
        within = f"a whole number from 1 to {planned.parts}"
        raise InputError(f"index is {index}, but must be {within}", "index", index, within)
    options = [] if threads is None else [f"--threads={threads}"]
    said = _command(["part", planned.folder, str(index), *options], planned.working_folder)
    return said == f"part {index}: made\n"


def collect(folder: str | os.PathLike[str]) -> None:
    """Puts all parts of a plan together to what its command writes, to the bytes of a run that was not divided.

    Raises
    ------
    InputError
        For parts that are missing, and a scene, record or program that has changed since.
    """
    planned = Plan.read(folder)
    _command(["collect", planned.folder], planned.working_folder)


def _command(words: Sequence[str | os.PathLike[str]], working_folder: Path) -> str:
    """What the command prints. It has a process of its own, since it works in the folder of the plan and takes signals for itself."""
    # Without modules of the working folder that are called alike.
    environment = os.environ | {"PYTHONSAFEPATH": "1"}
    try:
        done = subprocess.run(
            [sys.executable, "-m", "sprag", *words],
            cwd=working_folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            check=False,
        )
    except (OSError, ValueError) as error:
        # No such folder; a word that no process can be given.
        raise InputError(str(error)) from error
    if done.returncode == 0:
        return done.stdout
    said = done.stderr.splitlines() or [f"`sprag {words[0]!s}` ended with {done.returncode}"]
    message = re.sub(r"; see sprag [\w -]*--help$", "", said[-1].removeprefix("sprag: "))
    raise (InputError if done.returncode == 2 else RunError)(message)
