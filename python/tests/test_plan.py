"""Studies in parts: always the bytes of a run that was not divided, whoever makes the parts and whatever is lost meanwhile."""

import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import distributed
import psutil
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sprag
import sprag.dask

PARTS = 8


def words(scenes: Path, out: Path, cells: int) -> list[str | Path]:
    """A map whose cells are simulated one by one."""
    sets = [f"map.x.cells={cells}", "map.y.cells=8", 'ground.0.motion="half-sine"']
    return ["map", scenes / "figure08.toml", *(word for change in sets for word in ("--set", change)), "--formats", "csv,svg", "--out", out]


def files(folder: Path) -> dict[str, bytes]:
    """What holds results: the summary has the command line."""
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in (".csv", ".svg")}


def whole(scenes: Path, folder: Path, cells: int) -> dict[str, bytes]:
    """The results of a run that was not divided."""
    subprocess.run([sys.executable, "-m", "sprag", *words(scenes, folder / "whole", cells)], check=True, capture_output=True)
    return files(folder / "whole")


def test_parts_in_any_order_are_the_map(scenes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    plan = sprag.plan("parts", words(scenes, Path("out"), 8), parts=3)
    assert plan == sprag.Plan.read(tmp_path / "parts") == sprag.plan("parts", words(scenes, Path("out"), 8), parts=3)
    assert (plan.parts, plan.rows, plan.working_folder) == (3, 3 * 8 * 8, tmp_path)
    # From any folder, even one with a module of the same name.
    (tmp_path / "sprag.py").write_text("raise RuntimeError")
    monkeypatch.chdir(scenes)
    with pytest.raises(sprag.InputError, match="3 of 3 parts are missing"):
        sprag.collect(plan.folder)
    assert not (tmp_path / "out").exists()
    assert [sprag.run_part(plan.folder, index, threads=1) for index in (3, 1, 3)] == [True, True, False]
    assert plan.missing() == [2]
    (plan.folder / "part-00002.parquet").write_text("no table")
    assert plan.missing() == [2]
    assert sprag.run_part(plan.folder, 2)
    sprag.collect(plan.folder)
    assert files(tmp_path / "out") == whole(scenes, tmp_path, 8)


def test_a_killed_worker_and_a_lost_part_cost_only_time(scenes: Path, tmp_path: Path) -> None:
    cells = 600
    plan = sprag.plan(tmp_path / "parts", words(scenes, tmp_path / "out", cells), parts=PARTS)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
        ThreadPoolExecutor() as pool,
    ):
        study = pool.submit(sprag.dask.run, client, plan.folder)
        while len(plan.missing()) == PARTS and not study.done():
            time.sleep(0.01)
        (_, worker), *_ = client.run(os.getpid).items()
        psutil.Process(worker).kill()
        assert plan.missing(), "it was killed too late"
        study.result(timeout=120)
        assert worker not in client.run(os.getpid).values()
        expected = whole(scenes, tmp_path, cells)
        assert files(tmp_path / "out") == expected

        lost = plan.folder / "part-00005.parquet"
        content, made = lost.read_bytes(), {path: path.stat().st_mtime_ns for path in plan.folder.glob("*.parquet")}
        lost.unlink()
        sprag.dask.run(client, plan.folder)
        assert lost.read_bytes() == content
        assert [path for path, when in made.items() if path.stat().st_mtime_ns != when] == [lost]
        assert files(tmp_path / "out") == expected


def test_a_plan_that_no_longer_holds_ends_the_driver(scenes: Path, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_bytes((scenes / "figure08.toml").read_bytes())
    plan = sprag.plan(tmp_path / "parts", ["map", scene, "--out", tmp_path / "out"], parts=2)
    scene.write_text(scene.read_text() + "\n[block]\n")
    with distributed.Client(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None) as client:
        with pytest.raises(sprag.InputError, match="scene"):
            sprag.dask.run(client, plan.folder)
        with pytest.raises(sprag.InputError, match=r"plan\.json"):
            sprag.dask.run(client, tmp_path / "nowhere")
    assert plan.missing() == [1, 2]
    assert not (tmp_path / "out").exists()


def test_what_cannot_be_planned_is_refused(scenes: Path, tmp_path: Path) -> None:
    command = ["map", scenes / "figure08.toml"]
    refused: list[tuple[list[str | Path], dict[str, float]]] = [
        ([], {}),
        (["simulate", scenes / "figure08.toml"], {}),
        (["map", tmp_path / "absent.toml"], {}),
        ([*command, "--shard", "1/2"], {}),
        (command, {"parts": 0}),
        (command, {"parts": 2, "part_seconds": 1.0}),
        (command, {"part_seconds": float("nan")}),
        (["cloud", scenes / "cloud.toml", "--records", tmp_path], {}),
    ]
    for line, options in refused:
        with pytest.raises(sprag.InputError) as raised:
            sprag.plan(tmp_path / "parts", line, **options)  # type: ignore[arg-type]
        assert "\n" not in str(raised.value)
    # Nothing is left of what was refused.
    assert not (tmp_path / "parts").exists()
    sprag.plan(tmp_path / "parts", command, parts=2)
    with pytest.raises(sprag.InputError, match="number of parts differs"):
        sprag.plan(tmp_path / "parts", command, parts=3)
    for index in (0, 3, -1):
        with pytest.raises(sprag.InputError) as raised:
            sprag.run_part(tmp_path / "parts", index)
        assert (raised.value.key, raised.value.value) == ("index", index)
    for threads in (0, -1):
        with pytest.raises(sprag.InputError, match="threads") as raised:
            sprag.run_part(tmp_path / "parts", 1, threads=threads)
        assert "--help" not in str(raised.value)
    assert sprag.Plan.read(tmp_path / "parts").missing() == [1, 2]


@given(st.text(max_size=12).filter(lambda name: "\n" not in name), st.integers())
def test_no_folder_has_a_plan_unasked(name: str, index: int) -> None:
    folder = f"absent/{name}"
    for call in [sprag.Plan.read, sprag.collect, lambda folder: sprag.run_part(folder, index)]:
        with pytest.raises(sprag.InputError) as raised:
            call(folder)
        assert "\n" not in str(raised.value)
