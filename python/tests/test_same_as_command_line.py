"""The same input gives the same bits as the command line, for each kind of calibration."""

from __future__ import annotations

import json
import pathlib
import subprocess
from typing import Any, Callable

import numpy as np
import pytest
from conftest import log_of

import calibrant as cb

Cli = Callable[..., "subprocess.CompletedProcess[str]"]
KINDS = ["static-poses", "faces", "imu", "report", "report-noisy", "rate-table", "gantry"]


def of_command_line(cli: Cli, folder: pathlib.Path, output: pathlib.Path, *further: object) -> tuple[str, str]:
    motion = log_of(folder)
    options = [item for path in motion.values() for item in ("--motion", path)]
    cli("calibrate", folder / "experiment.toml", folder / "recording.csv", *options, *further, "-o", output, status=None)
    return (output / "calibration.json").read_text(encoding="utf-8"), (output / "report.html").read_text()


@pytest.mark.parametrize("preset", KINDS)
def test_a_file_gives_the_same_text(
    preset: str, simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path
) -> None:
    folder = simulated(preset)
    text, _ = of_command_line(cli, folder, tmp_path)
    found = cb.calibrate(folder / "recording.csv", folder / "experiment.toml", **log_of(folder))
    assert found.to_json() == text


def test_a_report_is_the_same(simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path) -> None:
    folder = simulated("imu")
    _, html = of_command_line(cli, folder, tmp_path)
    found = cb.calibrate(folder / "recording.csv", folder / "experiment.toml")
    found.report(tmp_path / "own.html")
    assert (tmp_path / "own.html").read_text(encoding="utf-8") == html


def without_origin(text: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(text)
    for key in ("inputs", "experiment", "sensor", "recorded", "motion_file"):
        data.pop(key, None)
    (data.get("machine") or {}).pop("log", None)
    return data


@pytest.mark.parametrize("preset", ["static-poses", "imu"])
def test_arrays_bytes_and_frames_give_the_same_numbers(preset: str, simulated: Callable[[str], pathlib.Path]) -> None:
    folder = simulated(preset)
    experiment = cb.Experiment.from_toml(folder / "experiment.toml")
    path = folder / "recording.csv"
    expected = without_origin(cb.calibrate(path, experiment).to_json())
    read = cb.read_recording(path)
    arrays: dict[str, Any] = {"accelerometer": read.accelerometer and read.accelerometer.values}
    if read.gyroscope is not None:
        arrays["gyroscope"] = read.gyroscope.values
    assert read.accelerometer is not None
    for given in (read, path.read_bytes(), read.to_frame(), cb.recording(read.accelerometer.t_s, **arrays)):
        assert without_origin(cb.calibrate(given, experiment).to_json()) == expected


@pytest.mark.parametrize("preset", ["rate-table", "report"])
def test_motions_from_arrays_give_the_same_numbers(preset: str, simulated: Callable[[str], pathlib.Path]) -> None:
    made = cb.simulate(preset)
    folder = simulated(preset)
    given = {"motion": made.motion} if made.motion is not None else {"log": made.log}
    one = cb.calibrate(made.recording, preset, **given)
    other = cb.calibrate(folder / "recording.csv", folder / "experiment.toml", **log_of(folder))
    assert np.array_equal(one.values, other.values)
    assert np.array_equal(one.covariance, other.covariance)


def test_options_are_those_of_the_command_line(
    simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path
) -> None:
    folder = simulated("imu")
    cli("simulate", folder / "experiment.toml", "--recording", 2, "-o", tmp_path / "second")
    second = tmp_path / "second" / "recording.csv"
    text, _ = of_command_line(cli, folder, tmp_path / "out", "--folds", 4, "--validate", second, "--sensor", "A17", "--station", "3")
    found = cb.calibrate(
        folder / "recording.csv", folder / "experiment.toml", folds=4, validate=second, sensor="A17", station="3"
    )
    assert found.to_json() == text and found.sensor == "A17"
    text, _ = of_command_line(cli, folder, tmp_path / "joined", second, "--together")
    assert cb.calibrate(folder / "recording.csv", folder / "experiment.toml", together=[second]).to_json() == text


def test_simulation_design_noise_and_comparison_are_the_same(
    simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path
) -> None:
    folder = simulated("imu")
    cli("simulate", folder / "experiment.toml", "-o", tmp_path)
    for name in ("recording.csv", "truth.json"):
        assert (folder / name).read_bytes() == (tmp_path / name).read_bytes()
    stage = tmp_path / "stage.toml"
    stage.write_text(cb.Experiment.preset("stage").to_toml(), encoding="utf-8")
    printed = cli("design", stage, "--starts", 2, "-o", tmp_path / "stage", "--json").stdout
    assert cb.design(stage, starts=2, seed=None).to_json() == printed
    at_rest = cb.Experiment.preset("imu", holds={"poses": 2, "hold_s": 60.0})
    cb.simulate(at_rest).save(tmp_path / "rest")
    printed = cli("noise", tmp_path / "rest" / "recording.csv", "--json").stdout
    assert cb.noise(tmp_path / "rest" / "recording.csv").to_json() == printed
    one = cb.calibrate(folder / "recording.csv", folder / "experiment.toml")
    one.save(tmp_path / "one.json")
    printed = cli("compare", tmp_path / "one.json", tmp_path / "one.json", "--json").stdout
    name = str(tmp_path / "one.json")
    assert cb.compare(one, one, names=(name, name)).to_json() == printed
    printed = cli("inspect", folder / "recording.csv", "--json").stdout
    assert cb.read_recording(folder / "recording.csv").inspect().data == json.loads(printed)


def test_a_correction_is_that_of_apply(simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path) -> None:
    folder = simulated("imu")
    found = cb.calibrate(folder / "recording.csv", folder / "experiment.toml")
    found.save(tmp_path / "calibration.json")
    cli("apply", tmp_path / "calibration.json", folder / "recording.csv", "-o", tmp_path / "corrected.csv")
    lines = [line for line in (tmp_path / "corrected.csv").read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    written = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    read = cb.read_recording(folder / "recording.csv")
    assert read.accelerometer is not None and read.gyroscope is not None
    force, rate = found.correct(read.accelerometer.values, read.gyroscope.values)
    names = lines[0].split(",")
    for letter, table, ending in (("a", force, "mps2"), ("g", rate, "radps")):
        column = names.index(f"{letter}x_{ending}")
        assert np.array_equal(written[:, column : column + 3], table)
