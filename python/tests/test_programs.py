"""The ten programs, on simulated data."""

from __future__ import annotations

import pathlib
import runpy
from typing import Callable

import numpy as np
import pytest

import calibrant as cb

PROGRAMS = pathlib.Path(__file__).parent / "programs"
Folder = Callable[[str], pathlib.Path]


def sensors(recording: cb.Recording) -> tuple[cb.Samples, cb.Samples]:
    force, rate = recording.accelerometer, recording.gyroscope
    assert force is not None and rate is not None
    return force, rate


def one(folder: Folder) -> None:
    pathlib.Path("recording.csv").write_bytes((folder("imu") / "recording.csv").read_bytes())


def two(folder: Folder) -> None:
    pl = pytest.importorskip("polars")
    force, rate = sensors(cb.simulate("imu").recording)
    columns = {f"acc{axis.upper()}": force.values[:, k] / 9.80665 for k, axis in enumerate("xyz")}
    columns.update({f"gyr_{axis}": np.rad2deg(rate.values[:, k]) for k, axis in enumerate("xyz")})
    pl.DataFrame(columns).write_parquet("walk.parquet")


def three(folder: Folder) -> None:
    force, rate = sensors(cb.simulate("imu").recording)
    for name, values in (("t", force.t_s), ("f", force.values / 9.80665), ("w", np.rad2deg(rate.values))):
        np.save(f"{name}.npy", values)


def four(folder: Folder) -> None:
    force, rate = sensors(cb.simulate("imu").recording)
    for name, of in (("Accelerometer", force), ("Gyroscope", rate)):
        table = np.column_stack([of.t_s, of.values])
        np.savetxt(f"{name}.csv", table, delimiter=",", header="seconds_elapsed,x,y,z", comments="", fmt="%.17g")


def five(folder: Folder) -> None:
    pytest.importorskip("matplotlib").use("Agg")


def six(folder: Folder) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    made = cb.simulate(cb.Experiment.preset("mocap", machine={"simulate": {"duration_s": 20.0}}))
    made.save("simulated")
    pathlib.Path("simulated/recording.csv").rename("imu.csv")
    assert isinstance(made.log, cb.Poses)
    np.savez("mocap.npz", t=made.log.t_s, p=made.log.position_m, q=made.log.quaternion_wxyz)


def seven(folder: Folder) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    cb.simulate(cb.Experiment.preset("imu", holds={"poses": 2, "hold_s": 120.0})).save("night")
    pathlib.Path("night/recording.csv").rename("night.csv")


def eight(folder: Folder) -> None:
    recording = cb.simulate("imu").recording
    cb.calibrate(recording, "imu").save("calibration.json")
    force, rate = sensors(recording)
    pathlib.Path("raw.f64").write_bytes(np.hstack([force.values, rate.values]).tobytes())


def nine(folder: Folder) -> None:
    pytest.importorskip("pyarrow")
    experiment = cb.Experiment.preset("imu")
    pathlib.Path("imu.toml").write_text(experiment.to_toml(), encoding="utf-8")
    pathlib.Path("line").mkdir()
    for seed in (1, 2, 3):
        cb.simulate(experiment, seed=seed).recording.save(f"line/{seed}.csv")
    pathlib.Path("line/broken.csv").write_text("t_s,ax_mps2\n", encoding="utf-8")


def ten(folder: Folder) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    for year, number in ((2025, 1), (2026, 2)):
        recording = cb.simulate("imu", recording=number).recording
        cb.calibrate(recording, "imu", sensor="A17").save(f"{year}.json")


PREPARED = {
    "p01_csv": one,
    "p02_frame": two,
    "p03_arrays": three,
    "p04_phone": four,
    "p05_design": five,
    "p06_machine": six,
    "p07_allan": seven,
    "p08_stream": eight,
    "p09_fleet": nine,
    "p10_records": ten,
}


@pytest.mark.parametrize("program", sorted(PREPARED))
def test_a_program_runs(
    program: str,
    simulated: Folder,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    PREPARED[program](simulated)
    runpy.run_path(str(PROGRAMS / f"{program}.py"))
    # a stream prints nothing, and a phone only diagnostics
    assert capsys.readouterr().out or program in ("p04_phone", "p08_stream")
