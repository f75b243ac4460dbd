"""Fleets: nothing lost, nothing twice, the same table whatever runs it."""

from __future__ import annotations

import pathlib
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import pytest

import calibrant as cb

pytest.importorskip("pyarrow")


@pytest.fixture(scope="module")
def line(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Six recordings, and one that is broken."""
    folder = tmp_path_factory.mktemp("line")
    for seed in range(1, 7):
        cb.simulate("static-poses", seed=seed).recording.save(folder / f"{seed}.csv")
    (folder / "broken.csv").write_text("t_s,ax_mps2,ay_mps2,az_mps2\n0,0,0,x\n", encoding="utf-8")
    return folder


def test_errors_are_rows_and_numbers_are_those_of_one_call(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    result = cb.fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path)
    assert (result.calibrated, result.failed, result.earlier) == (6, 1, 0)
    rows = {pathlib.Path(row["file"]).name: row for row in result.to_table().to_pylist()}
    assert rows["broken.csv"]["verdict"] == "none" and rows["broken.csv"]["code"] == "number-malformed"
    alone = cb.calibrate(line / "3.csv", "static-poses")
    assert rows["3.csv"]["values"] == list(alone.values) and rows["3.csv"]["names"] == list(alone)
    assert rows["3.csv"]["sensor"] == "3"
    count = len(alone)
    assert len(rows["3.csv"]["covariance"]) == count * (count + 1) // 2


def test_a_second_call_takes_what_is_there(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    items = sorted(line.glob("*.csv"))
    first = cb.fleet.calibrate(items[:4], "static-poses", tmp_path, per_task=2)
    again = cb.fleet.calibrate(items, "static-poses", tmp_path, per_task=3)
    assert again.earlier == 4 and again.calibrated + again.failed == 3
    whole = cb.fleet.calibrate(items, "static-poses", tmp_path / "whole")
    assert first.to_table().equals(whole.to_table())
    other = cb.fleet.calibrate(items, cb.Experiment.preset("static-poses", holds={"gravity_mps2": 9.81}), tmp_path)
    assert other.earlier == 0, "another experiment is another result"


@pytest.mark.parametrize("kind", ["threads", "processes"])
def test_an_executor_gives_the_same_table(kind: str, line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    import multiprocessing

    spawn = multiprocessing.get_context("spawn")
    expected = cb.fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "own").to_table()
    executor = ThreadPoolExecutor(2) if kind == "threads" else ProcessPoolExecutor(2, mp_context=spawn)
    with executor:
        found = cb.fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "pool", client=executor, per_task=2)
    assert found.to_table().equals(expected)


def test_ray_gives_the_same_table(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, log_to_driver=False, include_dashboard=False)
    try:
        found = cb.fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "ray", client=ray, per_task=2)
    finally:
        ray.shutdown()
    expected = cb.fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "own")
    assert found.to_table().equals(expected.to_table())


def test_dask_gives_the_same_table(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            found = cb.fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "dask", client=client, per_task=2)
    expected = cb.fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "own")
    assert found.to_table().equals(expected.to_table())


def test_copies_are_found_over_all_chunks(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    (tmp_path / "a.csv").write_bytes((line / "1.csv").read_bytes())
    result = cb.fleet.calibrate([line / "1.csv", tmp_path / "a.csv"], "static-poses", tmp_path / "out", per_task=1)
    assert len(result.copies()) == 1


def test_paths_may_be_urls(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    result = cb.fleet.calibrate(f"file://{line}/[12].csv", "static-poses", f"file://{tmp_path}/out")
    assert (result.calibrated, result.failed) == (2, 0)
    again = cb.fleet.calibrate(f"file://{line}/[12].csv", "static-poses", f"file://{tmp_path}/out")
    assert again.earlier == 2
