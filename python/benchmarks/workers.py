"""Prints what a second Dask worker is worth for a map in parts. Run it with the installed wheel, on a machine that does nothing else."""

import tempfile
import time
from pathlib import Path

import distributed

import sprag.dask

SCENE = Path(__file__).parents[2] / "scenes/figure08.toml"
PARTS = 8


def seconds(workers: int, cells: int) -> float:
    """The time of a map of so many times 512 cells of three devices, each simulated by itself."""
    sizes = ["--set", f"map.x.cells={cells}", "--set", "map.y.cells=512", "--set", 'ground.0.motion="half-sine"']
    with (
        tempfile.TemporaryDirectory() as folder,
        distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        command = ["map", SCENE, *sizes, "--formats", "csv", "--out", f"{folder}/out"]
        plan = sprag.plan(f"{folder}/parts", command, parts=PARTS)
        start = time.perf_counter()
        sprag.dask.run(client, plan.folder)
        return time.perf_counter() - start


def main() -> None:
    cells = 512
    one, two = (seconds(workers, cells) for workers in (1, 2))
    print(f"{PARTS} parts of {3 * 512 * cells} rows: one worker {one:.1f} s, two {two:.1f} s, {one / two:.2f} times as fast")


if __name__ == "__main__":
    main()
