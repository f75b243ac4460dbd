"""Fleets on Ray and Dask: a worker is killed, the driver is killed, and nothing is lost, nothing is there twice. They are left out where the engine is not installed."""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import sys
import time
from typing import Any, Callable, Iterator

import pytest

import calibrant as cb
from calibrant import fleet

pa = pytest.importorskip("pyarrow")

COUNT = 60

# runs a fleet on a cluster that is there, and is killed when six items are done
DRIVER = """
import os, signal, sys
import calibrant as cb
engine, address, pattern, output, last = sys.argv[1:]
if engine == "ray":
    import ray as client
    client.init(address=address, log_to_driver=False)
else:
    import distributed
    client = distributed.Client(address)
def told(done, total, text):
    if done >= int(last):
        os.kill(os.getpid(), signal.SIGKILL)
cb.fleet.calibrate(pattern, "static-poses", output, client=client, per_task=2, progress=told)
"""


@pytest.fixture(scope="module")
def line(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Recordings of many sensors, two of them broken."""
    folder = tmp_path_factory.mktemp("line")
    for seed in range(1, COUNT - 1):
        cb.simulate("static-poses", seed=seed).recording.save(folder / f"{seed:03}.csv")
    for name in ("a.csv", "b.csv"):
        (folder / name).write_text(f"t_s,ax_mps2,ay_mps2,az_mps2\n0,0,0,{name}\n", encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def expected(line: pathlib.Path, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The table of this process."""
    return fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path_factory.mktemp("own")).to_table()


class Cluster:
    """Two local workers: what a fleet takes, where a driver finds them, and which processes are at work."""

    def __init__(self, name: str, client: Any, address: str, busy: Callable[[], list[int]]) -> None:
        self.name, self.client, self.address, self.busy = name, client, address, busy


@pytest.fixture(scope="module", params=["ray", "dask"])
def cluster(request: pytest.FixtureRequest) -> Iterator[Cluster]:
    """Each engine with two workers of its own."""
    if request.param == "ray":
        ray = pytest.importorskip("ray", reason="Ray is not installed: pip install ray")
        ray.init(num_cpus=2, log_to_driver=False, include_dashboard=False)
        try:
            yield Cluster("ray", ray, ray.get_runtime_context().gcs_address, lambda: _descendants("ray::work"))
        finally:
            ray.shutdown()
    else:
        distributed = pytest.importorskip("distributed", reason="Dask is not installed: pip install distributed")
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as workers:
            with distributed.Client(workers) as client:
                yield Cluster("dask", client, client.scheduler.address, lambda: list(client.run(os.getpid).values()))


def _descendants(title: str) -> list[int]:
    """The processes below this one whose title begins so."""
    parents: dict[int, int] = {}
    titles: dict[int, str] = {}
    for place in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            titles[int(place.name)] = (place / "cmdline").read_text(errors="replace")
            parents[int(place.name)] = int((place / "stat").read_text(errors="replace").rsplit(")", 1)[1].split()[1])
        except OSError:
            pass
    below, before = {os.getpid()}, 0
    while len(below) > before:
        before = len(below)
        below |= {process for process, parent in parents.items() if parent in below}
    return [process for process in below if titles.get(process, "").startswith(title)]


def _is_whole(result: fleet.Result, expected: Any) -> None:
    table = result.to_table()
    assert len(table) == COUNT and len(set(table["file"].to_pylist())) == COUNT
    assert table.equals(expected)


def test_an_engine_gives_the_same_table(cluster: Cluster, line: pathlib.Path, expected: Any, tmp_path: pathlib.Path) -> None:
    result = fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path, client=cluster.client)
    assert (result.calibrated, result.failed, result.earlier) == (COUNT - 2, 2, 0)
    _is_whole(result, expected)


def test_a_killed_worker_costs_nothing(cluster: Cluster, line: pathlib.Path, expected: Any, tmp_path: pathlib.Path) -> None:
    killed: list[int] = []

    def told(done: int, total: int, text: str) -> None:
        if not killed:
            for process in cluster.busy()[:1]:
                os.kill(process, signal.SIGKILL)
                killed.append(process)

    result = fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path, client=cluster.client, per_task=2, progress=told)
    assert killed, "no worker was found"
    assert (result.calibrated, result.failed) == (COUNT - 2, 2)
    _is_whole(result, expected)


def test_a_killed_driver_is_run_again(cluster: Cluster, line: pathlib.Path, expected: Any, tmp_path: pathlib.Path) -> None:
    call = [sys.executable, "-c", DRIVER, cluster.name, cluster.address, f"{line}/*.csv", str(tmp_path), "6"]
    driver = subprocess.run(call, capture_output=True, timeout=300)
    assert driver.returncode == -signal.SIGKILL, driver.stderr.decode()
    result = fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path, client=cluster.client, per_task=2)
    assert 6 <= result.earlier < COUNT, f"{result.earlier} were there when the driver was killed"
    assert result.earlier + result.calibrated + result.failed == COUNT
    # what the killed driver had begun may still come
    time.sleep(2)
    _is_whole(result, expected)


def test_what_all_items_share_is_refused_before_the_work(cluster: Cluster, line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    with pytest.raises(cb.ExperimentError, match="`allow` has"):
        fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path, client=cluster.client, allow=["nonsense"])
    with pytest.raises(cb.RecordingError, match="a.csv"):
        fleet.calibrate(f"{line}/a.csv", "static-poses", tmp_path, client=cluster.client, on_error="raise")
