"""Trajectories of a machine, and designs for several values: the same as the command line, from files and from arrays."""

from __future__ import annotations

import json
import pathlib
import pickle
import subprocess
from typing import Any, Callable

import numpy as np
import pytest

import calibrant as cb

Cli = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A rate table of one joint, for 8 s."""
    path = tmp_path_factory.mktemp("table") / "table.toml"
    text = cb.Experiment.preset("rate-table", machine={"design": {"duration_s": 8.0}}).to_toml()
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def best(table: pathlib.Path) -> cb.TrajectoryDesign:
    return cb.design_trajectory(table, starts=2, seed=None)


def test_a_trajectory_is_that_of_the_command_line(
    table: pathlib.Path, best: cb.TrajectoryDesign, cli: Cli, tmp_path: pathlib.Path
) -> None:
    printed = cli("design", table, "--starts", 2, "-o", tmp_path / "cli", "--json").stdout
    assert best.to_json() == printed
    own = [pathlib.Path(path) for path in best.save(tmp_path / "own")]
    assert {"trajectory.csv", "follow_joint_trajectory.yaml", "plain_trajectory.csv", "design.json"} == {p.name for p in own}
    for path in own:
        assert path.read_bytes() == (tmp_path / "cli" / path.name).read_bytes()
    again = pickle.loads(pickle.dumps(best))
    assert again.to_json() == best.to_json() and np.array_equal(again.joints.positions, best.joints.positions)
    for path in again.save(tmp_path / "again"):
        name = pathlib.Path(path).name
        assert pathlib.Path(path).read_bytes() == (tmp_path / "cli" / name).read_bytes()
    assert "Predicted standard deviations" in best.summary() and best.plain is not None and not best.interrupted
    best.report(tmp_path / "report.html")


def test_a_trajectory_is_assessed_from_a_file_and_from_arrays(
    table: pathlib.Path, best: cb.TrajectoryDesign, cli: Cli, tmp_path: pathlib.Path
) -> None:
    best.save(tmp_path)
    path = tmp_path / "trajectory.csv"
    printed = cli("design", table, "--starts", 2, "--evaluate", path, "-o", tmp_path / "cli", "--json").stdout
    found = cb.assess_trajectory(table, path, starts=2, seed=None)
    assert found.to_json() == printed and found.is_proved and found.best is not None
    sd = np.array(found.data["evaluation"]["sd"])
    # velocities give the accelerations to rounding
    for given in (best, best.joints):
        other = cb.assess_trajectory(table, given, starts=2, seed=None)
        assert np.allclose(other.data["evaluation"]["sd"], sd, rtol=1e-6, atol=0.0)
    with pytest.raises(cb.RecordingError, match="cubic spline"):
        cb.assess_trajectory(table, cb.Joints(best.joints.t_s, {"table": best.joints.positions[:, 0]}))


def test_a_simulation_follows_a_trajectory(table: pathlib.Path, best: cb.TrajectoryDesign) -> None:
    made = cb.simulate(table, motion=best, seed=3)
    assert isinstance(made.log, cb.Joints) and made.log.knot_step_s is not None
    assert cb.calibrate(made.recording, table, log=made.log).verdict == "ok"
    # positions and velocities at the knots are the same motion
    again = cb.simulate(table, motion=best.joints, seed=3).recording
    for other, wanted in ((again.accelerometer, made.recording.accelerometer), (again.gyroscope, made.recording.gyroscope)):
        assert other is not None and wanted is not None and np.allclose(other.values, wanted.values, rtol=0.0, atol=1e-9)


def test_a_slow_run_is_the_same_path(table: pathlib.Path, best: cb.TrajectoryDesign, cli: Cli, tmp_path: pathlib.Path) -> None:
    printed = cli("design", table, "--starts", 2, "--slow", 4, "-o", tmp_path, "--json").stdout
    slow = cb.design_trajectory(table, starts=2, seed=None, slow=4)
    assert slow.to_json() == printed
    assert np.allclose(slow.joints.positions, best.joints.positions, rtol=0.0, atol=1e-12)
    assert slow.joints.t_s[-1] == pytest.approx(4.0 * best.joints.t_s[-1])


def test_durations_are_swept_and_goals_are_reached(table: pathlib.Path, cli: Cli, tmp_path: pathlib.Path) -> None:
    printed = cli("design", table, "--starts", 2, "--sweep", "duration=6,24", "-o", tmp_path, "--json").stdout
    swept = cb.sweep(table, "duration", [6, 24], starts=2, seed=None)
    assert swept.to_json() == printed and swept.unit == "s"
    place = swept.parameters.index("gyroscope.bias.z")
    goal = float(np.sqrt(swept.sd[:, place].prod()))
    reach = f"gyroscope.bias.z={goal!r}"
    printed = cli("design", table, "--starts", 2, "--reach", reach, "-o", tmp_path, "--json").stdout
    found = cb.design_trajectory(table, starts=2, seed=None, reach={"gyroscope.bias.z": goal})
    assert found.to_json() == printed and found.data["reach"]["goals"][0]["sd"] == goal
    found.report(tmp_path / "reached.html")
    assert "none was found in 2 starts" in (tmp_path / "reached.html").read_text(encoding="utf-8")
    with pytest.raises(cb.ExperimentError, match="`reach=`.*skale"):
        cb.design_trajectory(table, starts=2, reach={"skale": "1ppm"})


def test_a_design_begins_with_the_machine_that_was_found(
    table: pathlib.Path, cli: Cli, tmp_path: pathlib.Path
) -> None:
    cb.simulate(table, seed=2).save(tmp_path)
    found = cb.calibrate(tmp_path / "recording.csv", table, log=tmp_path / "joints.csv")
    found.save(tmp_path / "calibration.json")
    arguments = ("--from", tmp_path / "calibration.json", "--starts", 2, "-o", tmp_path / "cli", "--json")
    printed = cli("design", table, *arguments).stdout
    assert cb.design_trajectory(table, known=found, starts=2, seed=None).to_json() == printed
    static = cb.calibrate(cb.simulate("static-poses").recording, "static-poses")
    with pytest.raises(cb.ExperimentError, match="not of a sensor on a machine"):
        cb.design_trajectory(table, known=static)


def test_a_rehearsal_is_that_of_the_command_line(table: pathlib.Path, cli: Cli, tmp_path: pathlib.Path) -> None:
    printed = cli("study", table, "--sensors", 3, "--starts", 2, "-o", tmp_path, "--json").stdout
    found = cb.study(table, sensors=3, starts=2)
    assert found.to_json() == printed and found.data["rehearsal"] is not None
    with pytest.raises(cb.ExperimentError, match="rehearsal designs the motions"):
        cb.study(table, motion=cb.Motion([0.0, 1.0], [[0.0] * 3] * 2))


def test_motions_and_poses_reach_goals_and_are_swept(cli: Cli, tmp_path: pathlib.Path) -> None:
    experiments = {}
    for name in ("stage", "static-poses"):
        experiments[name] = tmp_path / f"{name}.toml"
        experiments[name].write_text(cb.Experiment.preset(name).to_toml(), encoding="utf-8")

    def of_cli(name: str, *arguments: object) -> str:
        return cli("design", experiments[name], "--starts", 2, *arguments, "-o", tmp_path / "out", "--json").stdout

    stage, poses = experiments["stage"], experiments["static-poses"]
    found: Any = cb.design(stage, starts=2, seed=None, reach={"scale.x": "300ppm"})
    assert found.to_json() == of_cli("stage", "--reach", "scale.x=300ppm")
    found.report(tmp_path / "reached.html")
    assert "reaches scale.x to 300ppm" in (tmp_path / "reached.html").read_text(encoding="utf-8")
    found = cb.design_poses(poses, starts=2, seed=None, reach={"scale.x": "100ppm"})
    assert found.to_json() == of_cli("static-poses", "--reach", "scale.x=100ppm")
    found = cb.sweep(stage, "velocity", [0.2, 0.4], starts=2, seed=None)
    assert found.to_json() == of_cli("stage", "--sweep", "velocity=0.2,0.4")
    assert found.sd.shape == (2, 2) and found.parameters == ("bias.x", "scale.x")


def test_the_holds_of_a_recording_are_assessed(
    simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path
) -> None:
    folder = simulated("static-poses")
    experiment, recording = folder / "experiment.toml", folder / "recording.csv"
    printed = cli("design", experiment, "--evaluate", recording, "-o", tmp_path, "--json").stdout
    found = cb.assess_poses(experiment, recording, seed=None)
    assert found.to_json() == printed and found.efficiency is not None
    again = cb.assess_poses(experiment, found.directions, seed=None)
    # of the poses alone: the recording also has its noise and its estimate
    assert again.efficiency is not None and 0.5 < again.efficiency <= 1.0
    assert np.array_equal(again.directions, found.directions)


def test_logs_and_machines_are_inspected(simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path) -> None:
    folder = simulated("gantry")
    printed = json.loads(cli("inspect", folder / "joints.csv", "--json").stdout)
    assert cb.inspect(folder / "joints.csv").data == printed
    log = cb.simulate("gantry").log
    own = cb.inspect(log).data
    assert "Noticed" not in cb.inspect(log)._repr_html_()
    assert own["joints"] == printed["joints"] and own["sampling"] == printed["sampling"]
    assert cb.inspect(folder / "recording.csv").data == json.loads(cli("inspect", folder / "recording.csv", "--json").stdout)
    machine = tmp_path / "arm.urdf"
    machine.write_text(
        "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/><child link='b'/>"
        "<limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>"
    )
    assert cb.inspect(machine).data == json.loads(cli("inspect", machine, "--json").stdout)
    with pytest.raises(cb.ExperimentError, match="`base`"):
        cb.inspect(folder / "recording.csv", base="a")


def test_codes_are_explained(cli: Cli) -> None:
    listed = cb.codes()
    # some codes are of a diagnostic and of an error
    assert len({of.code for of in listed}) > 100
    assert all("option `" not in str(of) and " --" not in str(of) for of in listed)
    found = cb.explain("hold-moved") if any(of.code == "hold-moved" for of in listed) else listed[0]
    text = " ".join(cli("explain", found.code).stdout.split())
    assert " ".join(found.meaning.split()) in text
    with pytest.raises(cb.ExperimentError, match="did you mean 'unit-unknown'"):
        cb.explain("unit-unknow")


def test_a_conversion_is_that_of_the_command_line(
    simulated: Callable[[str], pathlib.Path], cli: Cli, tmp_path: pathlib.Path
) -> None:
    folder = simulated("imu")
    found = cb.calibrate(folder / "recording.csv", folder / "experiment.toml")
    found.save(tmp_path / "calibration.json")
    for place in ("cli", "own"):
        (tmp_path / place).mkdir()
    cb.simulate(cb.Experiment.preset("imu", holds={"poses": 2, "hold_s": 60.0})).save(tmp_path / "rest")
    noise = tmp_path / "noise.json"
    cb.noise(tmp_path / "rest" / "recording.csv").save(noise)
    for name, options, changes in (
        ("a.yaml", ["--noise", noise, "--gauge", "lower"], {"noise": [noise], "gauge": "lower"}),
        ("b.h", ["--sensor", "accelerometer"], {"sensor": "accelerometer"}),
        ("c.calib", ["--drop-g-sensitivity", "--gauge", "upper"], {"drop_g_sensitivity": True, "gauge": "upper"}),
    ):
        cli("convert", tmp_path / "calibration.json", tmp_path / "cli" / name, *options)
        converted = found.convert(tmp_path / "own" / name, **changes)
        for path in converted.paths:
            other = tmp_path / "cli" / pathlib.Path(path).name
            assert pathlib.Path(path).read_bytes() == other.read_bytes()
    assert found.convert(tmp_path / "d.h", temperature_c=20.0).diagnostics[0].code == "setting-unused"
