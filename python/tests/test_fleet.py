"""Fleets: errors are rows, nothing is lost, nothing is there twice, and the table is the same whatever runs it."""

from __future__ import annotations

import multiprocessing
import pathlib
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from typing import Callable

import numpy as np
import pytest

import calibrant as cb
from calibrant import fleet

pa = pytest.importorskip("pyarrow")


@pytest.fixture(scope="module")
def line(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Six recordings, and one that is broken."""
    folder = tmp_path_factory.mktemp("line")
    for seed in range(1, 7):
        cb.simulate("static-poses", seed=seed).recording.save(folder / f"{seed}.csv")
    (folder / "broken.csv").write_text("t_s,ax_mps2,ay_mps2,az_mps2\n0,0,0,x\n", encoding="utf-8")
    return folder


def test_errors_are_rows_and_numbers_are_those_of_one_call(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    result = fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path)
    assert (result.calibrated, result.failed, result.earlier) == (6, 1, 0)
    rows = {pathlib.Path(row["file"]).name: row for row in result.to_table().to_pylist()}
    assert rows["broken.csv"]["verdict"] == "none" and rows["broken.csv"]["code"] == "number-malformed"
    with pytest.raises(cb.RecordingError) as caught:
        cb.calibrate(line / "broken.csv", "static-poses")
    assert rows["broken.csv"]["error"] == str(caught.value)
    alone = cb.calibrate(line / "3.csv", "static-poses")
    assert rows["3.csv"]["values"] == list(alone.values) and rows["3.csv"]["names"] == list(alone)
    assert rows["3.csv"]["sensor"] == "3"
    count = len(alone)
    lower = [alone.covariance[i, j] for i in range(count) for j in range(i + 1)]
    assert rows["3.csv"]["covariance"] == lower


def test_a_second_call_takes_what_is_there(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    items = sorted(line.glob("*.csv"))
    first = fleet.calibrate(items[:4], "static-poses", tmp_path, per_task=2)
    again = fleet.calibrate(items, "static-poses", tmp_path, per_task=3)
    assert again.earlier == 4 and again.calibrated + again.failed == 3
    whole = fleet.calibrate(items, "static-poses", tmp_path / "whole")
    assert first.to_table().equals(whole.to_table())
    other = fleet.calibrate(items, cb.Experiment.preset("static-poses", holds={"gravity_mps2": 9.81}), tmp_path)
    assert other.earlier == 0, "another experiment is another result"


def test_a_part_that_was_not_finished_does_not_count(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path, per_task=3)
    parts = sorted(tmp_path.glob("part-*.parquet"))
    assert len(parts) == 3
    expected = fleet.Result(str(tmp_path), fleet.CalibrationTask(cb.Experiment.preset("static-poses")).schema(), (0, 0, 0), {}).to_table()
    parts[0].rename(tmp_path / f".{parts[0].stem}.ab.tmp")
    again = fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path, per_task=3)
    assert 0 < again.earlier < 7 and again.earlier + again.calibrated + again.failed == 7
    assert again.to_table().equals(expected)


def test_what_cannot_be_read_is_there_once_until_it_can(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    missing, output = tmp_path / "late.csv", tmp_path / "out"
    items = [line / "1.csv", missing]
    assert fleet.calibrate(items, "static-poses", output).failed == 1
    again = fleet.calibrate([*items, line / "2.csv"], "static-poses", output)
    assert (again.calibrated, again.failed, again.earlier) == (1, 0, 2)
    missing.write_bytes((line / "3.csv").read_bytes())
    late = fleet.calibrate(items, "static-poses", output)
    assert (late.calibrated, late.failed, late.earlier) == (1, 0, 1)


def test_a_key_is_of_contents_and_not_of_paths(
    line: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    pathlib.Path("e.toml").write_text(cb.Experiment.preset("static-poses").to_toml(), encoding="utf-8")
    assert fleet.calibrate([line / "1.csv"], "e.toml", "out").calibrated == 1
    assert fleet.calibrate([line / "1.csv"], tmp_path / "e.toml", "out").earlier == 1
    machine = "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/><limit lower='-3' upper='3' velocity='{}' effort='1'/></joint></robot>"
    table = cb.Experiment.preset("rate-table", machine={"urdf": str(tmp_path / "table.urdf"), "base": None, "tip": None})
    for velocity, done in ((1, 1), (1, 0), (2, 1)):
        pathlib.Path("table.urdf").write_text(machine.format(velocity), encoding="utf-8")
        assert fleet.study(table, "study", sensors=1).calibrated + fleet.study(table, "study", sensors=1).failed == done


def test_a_data_set_is_not_doubled_and_a_damaged_part_is_named(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    fleet.calibrate([line / "1.csv"], "static-poses", tmp_path, covariance=False)
    with pytest.raises(cb.ExperimentError, match="has results already"):
        fleet.calibrate([line / "1.csv"], "static-poses", tmp_path, resume=False)
    assert fleet.calibrate([line / "1.csv"], "static-poses", tmp_path).calibrated == 1, "with its covariance"
    (tmp_path / "part-0.parquet").write_bytes(b"PAR1")
    with pytest.raises(cb.ExperimentError, match="part-0.parquet cannot be read.*delete it"):
        fleet.calibrate([line / "1.csv"], "static-poses", tmp_path)


def test_a_path_is_no_pattern_where_there_is_such_a_file(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    odd = tmp_path / "1[2].csv"
    odd.write_bytes((line / "1.csv").read_bytes())
    assert fleet.calibrate(odd, "static-poses", tmp_path / "out").calibrated == 1
    with pytest.raises(cb.ExperimentError, match="nothing matches"):
        fleet.calibrate(f"{tmp_path}/*.txt", "static-poses", tmp_path / "out")


def test_an_error_may_be_an_exception_and_what_is_done_stays(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    with pytest.raises(cb.RecordingError, match="broken.csv"):
        fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path, on_error="raise")
    assert fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path).earlier == 7


@pytest.mark.parametrize("kind", ["threads", "spawn", "fork"])
def test_an_executor_gives_the_same_table(kind: str, line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    if kind not in ("threads", *multiprocessing.get_all_start_methods()):
        pytest.skip("this system does not fork")
    # after it, a process that forks has threads of the native part behind it
    expected = fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "own").to_table()
    context = None if kind == "threads" else multiprocessing.get_context(kind)
    executor = ThreadPoolExecutor(2) if context is None else ProcessPoolExecutor(2, mp_context=context)
    with executor:
        found = fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "pool", client=executor, per_task=2)
    assert found.to_table().equals(expected)


def test_copies_are_found_over_chunks_and_calls(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    copies = [tmp_path / "a.csv", tmp_path / "b.csv"]
    for copy in copies:
        copy.write_bytes((line / "1.csv").read_bytes())
    items = [line / "1.csv", line / "2.csv"]
    fleet.calibrate(items, "static-poses", tmp_path / "calls")
    with pytest.warns(cb.CalibrationWarning, match="3 items have the same bytes"):
        result = fleet.calibrate([*items, *copies], "static-poses", tmp_path / "calls")
    assert result.earlier == 2 and result.copies() == [sorted(map(str, [line / "1.csv", *copies]))]
    for per_task in (1, 10):
        chunked = fleet.calibrate([*items, *copies], "static-poses", tmp_path / str(per_task), per_task=per_task)
        assert chunked.to_table().equals(result.to_table()), "the table does not depend on the chunks"


def test_paths_may_be_urls(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    urls = f"{line.as_uri()}/[12].csv"
    result = fleet.calibrate(urls, "static-poses", f"{tmp_path.as_uri()}/out")
    assert (result.calibrated, result.failed) == (2, 0)
    assert fleet.calibrate(urls, "static-poses", f"{tmp_path.as_uri()}/out").earlier == 2
    here = fleet.calibrate(f"{line}/[12].csv", "static-poses", tmp_path / "here")
    assert here.to_table().drop(["file"]).equals(result.to_table().drop(["file"]))


def test_fsspec_opens_what_pyarrow_does_not(line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    fsspec = pytest.importorskip("fsspec")
    memory = fsspec.filesystem("memory")
    for name in ("1.csv", "2.csv", "broken.csv"):
        memory.pipe(f"/line/{name}", (line / name).read_bytes())
    memory.pipe("/line/deeper/3.csv", (line / "3.csv").read_bytes())
    result = fleet.calibrate("memory://line/*.csv", "static-poses", "memory://out")
    assert (result.calibrated, result.failed) == (2, 1)
    with ThreadPoolExecutor(2) as pool:
        again = fleet.calibrate("memory://line/**/*.csv", "static-poses", "memory://out", client=pool)
    assert (again.calibrated, again.earlier) == (1, 3)
    assert again.to_table()["values"].to_pylist()[0] == list(cb.calibrate(line / "1.csv", "static-poses").values)
    with pytest.raises(cb.ExperimentError, match="nowhere://a cannot be opened"):
        fleet.calibrate(["nowhere://a"], "static-poses", tmp_path)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"on_error": "stop"}, "`on_error` is 'stop'"),
        ({"per_task": 0}, "`per_task` is 0"),
        ({"client": 3}, "`client` is int"),
        ({"allow": ["nonsense"]}, "`allow` has"),
        ({"items": pa.table({"path": ["a"]})}, "no column `file`"),
    ],
)
def test_a_wrong_argument_is_named(change: dict[str, object], says: str, line: pathlib.Path, tmp_path: pathlib.Path) -> None:
    arguments = {"items": line / "1.csv", "experiment": "static-poses", "output": tmp_path / "out", **change}
    with pytest.raises(cb.ExperimentError, match=says):
        fleet.calibrate(**arguments)  # type: ignore[arg-type]


def test_a_chunk_is_a_function(line: pathlib.Path) -> None:
    task = fleet.CalibrationTask(cb.Experiment.preset("static-poses"), covariance=False)
    table = fleet.run_chunk([str(line / "1.csv"), str(line / "none.csv")], task)
    assert table["verdict"].to_pylist()[1] == "none" and len(table["key"].to_pylist()[1]) == 64
    assert table["covariance"].null_count == 2


def test_simulated_sensors_depend_neither_on_chunks_nor_on_the_engine(tmp_path: pathlib.Path) -> None:
    one = fleet.study("static-poses", tmp_path / "one", sensors=7, per_task=1)
    with ThreadPoolExecutor(2) as pool:
        two = fleet.study("static-poses", tmp_path / "two", sensors=4, per_task=3, client=pool)
        assert (two.done, two.failed, two.earlier) == (4, 0, 0)
        more = fleet.study("static-poses", tmp_path / "two", sensors=7, per_task=3, client=pool)
    assert more.earlier == 4 and more.to_table().equals(one.to_table())
    other = fleet.study("static-poses", tmp_path / "other", sensors=7, seed=2).to_table()
    assert set(other["seed"].to_pylist()).isdisjoint(one.to_table()["seed"].to_pylist())
    row = one.to_table().to_pylist()[2]
    made = cb.simulate("static-poses", seed=row["seed"])
    assert row["values"] == list(cb.calibrate(made.recording, "static-poses").values)
    assert dict(zip(row["names"], row["truth"])) == {name: made.truth[name] for name in row["names"]}
    z = np.concatenate([(np.array(r["values"]) - r["truth"]) / r["sd"] for r in one.to_table().to_pylist()])
    # 7 sensors of 9 parameters: one is beyond 5 sd once in 28 000 such studies
    assert np.abs(z).max() < 5 and np.abs(z).max() > 0.1


def test_a_seed_is_the_beginning_of_a_hash(tmp_path: pathlib.Path) -> None:
    import hashlib

    task = fleet.StudyTask(cb.Experiment.preset("static-poses"), seed=5)
    digest = hashlib.sha256(b"5/000000012").hexdigest()
    assert task.opened(["000000012"]) == [int(digest[:16], 16)]


@pytest.mark.parametrize("preset", ["report", "imu", "mocap"])
def test_sensors_of_any_kind_are_simulated(preset: str, tmp_path: pathlib.Path) -> None:
    short = {"machine": {"simulate": {"duration_s": 20.0}}} if preset == "mocap" else {}
    result = fleet.study(cb.Experiment.preset(preset, **short), tmp_path, sensors=2)
    assert (result.done, result.failed) == (2, 0)
    for row in result.to_table().to_pylist():
        assert None not in row["truth"][:3] and row["values"] != row["truth"]


def test_designs_are_those_of_one_call(tmp_path: pathlib.Path) -> None:
    stage, poses = cb.Experiment.preset("stage"), cb.Experiment.preset("static-poses", holds={"poses": 12})
    (tmp_path / "broken.toml").write_text("schema = 1\n[sensor]\nnoise = 1\n", encoding="utf-8")
    (tmp_path / "poses.toml").write_text(poses.to_toml(), encoding="utf-8")
    result = fleet.design(f"{tmp_path}/*.toml", tmp_path / "files", starts=2)
    assert (result.done, result.failed) == (1, 1)
    broken, found = result.to_table().to_pylist()
    assert broken["code"] == "key-unknown" and "broken.toml" in broken["error"]
    alone = cb.design_poses(poses, starts=2)
    assert found["design"] == alone.to_json() and found["track"] == list(alone.directions.ravel())
    assert found["plan"] == "holds" and found["bound"] <= found["value"]
    with ThreadPoolExecutor(2) as pool:
        given = {"slow": stage.replace(limits={"velocity_mps": 0.3}), "fast": stage}
        named = fleet.design(given, tmp_path / "named", starts=2, client=pool)
    fast, slow = named.to_table().to_pylist()
    assert fast["value"] == cb.design(stage, starts=2).value < slow["value"]
    assert fleet.design(given, tmp_path / "named", starts=2).earlier == 2
    with pytest.raises(cb.ExperimentError, match="fleet.design 1, not of fleet.calibrate 1"):
        fleet.calibrate([], "static-poses", tmp_path / "named")


def test_the_questions_of_the_guide_have_answers(
    line: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("polars")
    pytest.importorskip("duckdb")
    import re

    guide = (pathlib.Path(__file__).parents[2] / "docs/fleets.md").read_text(encoding="utf-8").split("## Ask it")[1]
    programs = re.findall(r"```python\n(.*?)```", guide, flags=re.DOTALL)
    assert len(programs) == 2
    fleet.calibrate(f"{line}/*.csv", "static-poses", tmp_path / "results")
    monkeypatch.chdir(tmp_path)
    for program in programs:
        exec(program, {})
    shown = capsys.readouterr().out
    assert "number-malformed" in shown and "accelerometer.scale.x" in shown


def test_records_import_a_data_set(
    simulated: Callable[[str], pathlib.Path], cli: Callable[..., object], tmp_path: pathlib.Path
) -> None:
    import csv

    for preset in ("static-poses", "imu", "mocap"):
        folder, here = simulated(preset), tmp_path / preset
        log = folder / "poses.csv" if preset == "mocap" else None
        recordings = [here / "a.csv", here / "b.csv"]
        here.mkdir()
        recordings[0].write_bytes((folder / "recording.csv").read_bytes())
        again = cb.simulate(cb.Experiment.from_toml(folder / "experiment.toml"), motion=log, recording=2)
        again.recording.save(recordings[1])
        experiment = cb.Experiment.from_toml(folder / "experiment.toml")
        result = fleet.calibrate([*recordings, here / "none.csv"], experiment, here / "set", motion=log, station="L1")
        assert (result.calibrated, result.failed) == (2, 1), result.to_table()["error"].to_pylist()
        cli("records", "import", here / "fleet.db", here / "set")
        said = cli("records", "import", here / "fleet.db", here / "set").stdout  # type: ignore[attr-defined]
        assert said.startswith("0 new calibrations, 2 replaced, 1 row without a calibration left out"), said
        options = ["--motion", log] if log else []
        arguments = ["calibrate", folder / "experiment.toml", *options, *recordings, "--station", "L1", "--no-report"]
        cli(*arguments, "-o", here / "out", "--records", here / "own.db", "--threads", "1", status=None)
        tables = []
        for name in ("fleet", "own"):
            cli("records", "export", here / f"{name}.db", "-o", here / f"{name}.csv")
            with open(here / f"{name}.csv", encoding="utf-8", newline="") as file:
                tables.append([{**row, "inserted": ""} for row in csv.DictReader(file)])
        assert tables[0] == tables[1] and len(tables[0]) == 2
        shown = [cli("records", "show", here / f"{name}.db", 1, "--json").stdout for name in ("fleet", "own")]  # type: ignore[attr-defined]
        assert _without_time(shown[0]) == _without_time(shown[1])


def test_records_leave_copies_out(line: pathlib.Path, cli: Callable[..., object], tmp_path: pathlib.Path) -> None:
    (tmp_path / "a.csv").write_bytes((line / "1.csv").read_bytes())
    fleet.calibrate([line / "1.csv", line / "2.csv", tmp_path / "a.csv"], "static-poses", tmp_path / "set")
    said = cli("records", "import", tmp_path / "r.db", tmp_path / "set").stdout  # type: ignore[attr-defined]
    assert said.startswith("1 new calibration, 0 replaced") and "have the same bytes" in said


def _without_time(text: str) -> dict[str, object]:
    import json

    found: dict[str, object] = json.loads(text)
    del found["inserted"]
    return found
