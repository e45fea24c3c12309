"""Prints what the package costs beside the command. Run it with the installed wheel, on a machine that does nothing else."""

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import sprag

SCENES = Path(__file__).parents[2] / "scenes"


def seconds(work: Callable[[], object], times: int = 3) -> float:
    """The least time of a few."""
    found = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        found.append(time.perf_counter() - start)
    return min(found)


def command(side: int, threads: int) -> None:
    program = Path(sys.executable).parent / "sprag"
    sizes = ["--set", f"map.x.cells={side}", "--set", f"map.y.cells={side}", "--threads", str(threads)]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "--quiet", "map", SCENES / "figure08.toml", *sizes, "--out", folder], check=True, capture_output=True)


def main() -> None:
    own = seconds(lambda: subprocess.run([sys.executable, "-c", "import sprag"], check=True))
    bare = seconds(lambda: subprocess.run([sys.executable, "-c", "import numpy"], check=True))
    print(f"import sprag           {own:.3f} s, of which NumPy and Python {bare:.3f} s")

    side = 578  # A million cells of three devices.
    scene = sprag.Scene.read(SCENES / "figure08.toml").set("map.x.cells", side).set("map.y.cells", side)
    cells = 3 * side * side
    one, two = (seconds(lambda threads=threads: sprag.map(scene, threads=threads)) for threads in (1, 2))
    theirs = seconds(lambda: command(side, 1))
    print(f"map, one thread        {cells / one:,.0f} cells/s; the command with its files {cells / theirs:,.0f}")
    print(f"map, two threads       {one / two:.2f} times as fast")

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    large = scene.set("device", [{"kind": "none"}]).set("map.x.cells", 3163).set("map.y.cells", 3163)
    made = sprag.map(large)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    size = made.outcome.nbytes + made.peak_rotation.nbytes + made.peak_acceleration.nbytes
    print(f"ten million cells      {size / 1e6:.0f} MB of arrays; the process grew by {(after - before) / 1e3:.0f} MB at most")

    loop = sprag.Scene.read(SCENES / "controller.toml").set("controller.law", "resisting-predicted")
    rust = seconds(lambda: sprag.closed_loop(loop))
    python = seconds(lambda: sprag.closed_loop(loop, law=lambda at: at.push_sign == at.velocity_sign))
    ticks = len(sprag.closed_loop(loop).t)
    print(f"closed loop            {rust:.2f} s; by a law in Python {python:.2f} s, {1e6 * (python - rust) / (2 * ticks):.1f} µs a call")


if __name__ == "__main__":
    main()
