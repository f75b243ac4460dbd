"""Campaigns over temperature: designed, simulated, calibrated, and a warm-up in one pose."""

from __future__ import annotations

import json
import pathlib
import pickle
import re
import subprocess
from typing import Any, Callable

import numpy as np
import pytest

import calibrant as cb

Cli = Callable[..., "subprocess.CompletedProcess[str]"]
GUIDE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md"

# short holds: soon simulated
SHORT: dict[str, Any] = {
    "campaign": {"budget_min": 110.0, "range_c": [0.0, 40.0], "hold_s": 2.5, "move_s": 1.5},
    "holds": {"rate_hz": 50.0},
}


@pytest.fixture(scope="module")
def short() -> cb.Experiment:
    return cb.Experiment.preset("campaign", **SHORT)


@pytest.fixture(scope="module")
def rehearsed(short: cb.Experiment) -> cb.SimulatedCampaign:
    return cb.simulate_campaign(short, seed=3)


@pytest.fixture(scope="module")
def found(short: cb.Experiment, rehearsed: cb.SimulatedCampaign) -> cb.Calibration:
    return cb.calibrate(rehearsed.recordings, short)


def test_a_design_has_soaks_a_bound_and_a_timetable(short: cb.Experiment) -> None:
    best = cb.design_campaign(short)
    assert best.bound <= best.value and best.gap == pytest.approx(best.value / best.bound - 1.0)
    assert set(best.sd) == {f"{sensor}.{part}" for sensor in ("accelerometer", "gyroscope") for part in ("bias", "scale")}
    assert {soak.direction for soak in best.soaks} == {"up", "down"} and best.soaks[-1].end_min <= 110.0
    assert all(0.0 <= soak.temperature_c <= 40.0 and soak.blocks >= 1 for soak in best.soaks)
    pytest.importorskip("pandas")
    table = best.to_frame()
    assert list(table["soak"]) == list(range(1, len(best.soaks) + 1)) and list(table["begin_min"]) == sorted(table["begin_min"])
    with pytest.raises(cb.Infeasible, match="give at least") as caught:
        cb.design_campaign(short, add_min=5.0)
    assert caught.value.key == "campaign.budget_min"


def test_a_chamber_turns_at_the_ends_of_its_range(short: cb.Experiment) -> None:
    pytest.importorskip("matplotlib").use("agg")
    best = cb.design_campaign(short)
    times, celsius = np.asarray(best.plot().lines[0].get_xydata()).T
    assert (times[0], celsius[0], celsius[-1]) == (0.0, 25.0, 25.0) and times[-1] <= 110.0 + 1e-9
    # at the rate of the ramp, or at rest; from end to end
    rates = np.abs(np.diff(celsius)) / np.maximum(np.diff(times), 1e-12)
    assert np.all(np.isclose(rates, 2.0) | (rates < 1e-9)), rates
    assert (celsius.min(), celsius.max()) == (0.0, 40.0)


def test_each_kind_of_experiment_names_its_own_design(short: cb.Experiment) -> None:
    with pytest.raises(cb.ExperimentError, match="design_campaign"):
        cb.design_poses(short)
    with pytest.raises(cb.ExperimentError, match=r'Experiment.preset\("campaign"\).*design_poses'):
        cb.design_campaign("imu")
    with pytest.raises(cb.ExperimentError, match="design_trajectory"):
        cb.simulate_campaign("arm")


def test_the_truth_is_within_the_standard_deviations(
    short: cb.Experiment, rehearsed: cb.SimulatedCampaign, found: cb.Calibration
) -> None:
    assert found.data["kind"] == "campaign-calibration" and found.verdict == "ok"
    assert [soak["name"] for soak in found.data["soaks"]] == [f"soak_{k:02}" for k in range(1, len(rehearsed.recordings) + 1)]
    biases = [of for of in found.parameters if ".bias" in of.name]
    off = [(of.value - rehearsed.truth[of.name]) / of.sd for of in biases]
    assert len(off) >= 18 and max(map(abs, off)) < 4.5, off
    again = pickle.loads(pickle.dumps(rehearsed))
    assert again.recordings[0].sha256 == rehearsed.recordings[0].sha256 and again.truth == rehearsed.truth


def test_it_shows_itself(found: cb.Calibration, tmp_path: pathlib.Path) -> None:
    assert "Over temperature" in found.text() and "soak_01" in found.text()
    found.report(tmp_path / "report.html")
    assert "Calibration over temperature" in (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "None" not in found.summary() and "accelerometer.bias_per_k.x" in found._repr_html_()
    assert np.allclose(np.diag(found.correlation), 1.0)
    with pytest.raises(cb.ExperimentError, match="over temperature has no residuals"):
        found.residuals()
    found.save(tmp_path / "calibration.json")
    loaded = cb.Calibration.load(tmp_path / "calibration.json")
    assert loaded == found and pickle.loads(pickle.dumps(found)) == found
    with pytest.raises(cb.CalibrantError, match="was loaded"):
        loaded.text()


def test_biases_are_drawn_over_temperature(found: cb.Calibration) -> None:
    pytest.importorskip("matplotlib").use("agg")
    for sensor in ("accelerometer", "gyroscope"):
        ax = found.plot_temperature(sensor=sensor)
        celsius, bias = np.asarray(ax.lines[0].get_xydata()).T
        # the correction of a reading of zero is that of the bias
        zeros = np.zeros((len(celsius), 3))
        corrected = found.correct(zeros, zeros, temperature_c=celsius)[0 if sensor == "accelerometer" else 1]
        matrix = np.array(found.data[sensor]["matrix"])
        assert np.corrcoef(-(corrected @ matrix.T)[:, 0], bias)[0, 1] > 0.999
    with pytest.raises(cb.ExperimentError, match="follows temperature"):
        cb.calibrate(cb.simulate("imu").recording, "imu").plot_temperature()


def test_the_second_stage_alone_gives_the_same(short: cb.Experiment, rehearsed: cb.SimulatedCampaign, found: cb.Calibration) -> None:
    soaks = [cb.calibrate(recording, short) for recording in rehearsed.recordings]
    again = cb.calibrate(soaks, short)
    assert np.array_equal(again.values, found.values) and np.array_equal(again.covariance, found.covariance)
    assert [soak["name"] for soak in again.data["soaks"]] == [soak["name"] for soak in found.data["soaks"]]
    with pytest.raises(cb.ExperimentError, match="some are calibrations"):
        cb.calibrate([soaks[0], rehearsed.recordings[1]], short)
    with pytest.raises(cb.RecordingError, match="count twice"):
        cb.calibrate([*soaks, soaks[0]], short)


def test_soaks_that_cannot_be_used_are_named(short: cb.Experiment, rehearsed: cb.SimulatedCampaign, found: cb.Calibration) -> None:
    first = rehearsed.recordings[0]
    assert first.accelerometer is not None and first.gyroscope is not None
    cold = cb.recording(first.accelerometer.t_s, first.accelerometer.values, first.gyroscope.values)
    with pytest.raises(cb.RecordingError, match="soak 1: .*the recording has none"):
        cb.calibrate([cold], short)
    # the others do
    left = cb.calibrate([cold, *rehearsed.recordings[1:]], short)
    (told,) = [of for of in left.diagnostics if of.code == "soak-left-out"]
    assert "soak 1" in told.message and len(left.data["soaks"]) == len(found.data["soaks"]) - 1


def test_lists_without_a_campaign_are_refused(short: cb.Experiment, rehearsed: cb.SimulatedCampaign) -> None:
    for experiment in ("imu", "auto"):
        with pytest.raises(cb.ExperimentError, match="together="):
            cb.calibrate(rehearsed.recordings[:2], experiment)
    with pytest.raises(cb.ExperimentError, match="`folds` is not for a campaign"):
        cb.calibrate(rehearsed.recordings, short, folds=3)
    with pytest.raises(cb.ExperimentError, match="there is no soak"):
        cb.calibrate([], short)
    for wrong in ([], [3], [{"temperature_c": 20.0}], [cb.Soak(20.0, "left", 1.0, 1)], [cb.Soak(20.0, "up", 1.0, 10**6)]):  # type: ignore[arg-type]
        with pytest.raises(cb.ExperimentError):
            cb.simulate_campaign(short, soaks=wrong)  # type: ignore[arg-type]


def test_all_of_it_is_as_on_the_command_line(short: cb.Experiment, cli: Cli, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(short.to_toml(), encoding="utf-8")
    best = cb.design_campaign(path)
    assert cli("design", path, "-o", tmp_path / "plan", "--json").stdout == best.to_json()
    cli("simulate", path, "--campaign", tmp_path / "plan" / "campaign.csv", "--seed", 3, "-o", tmp_path / "sim")
    cb.simulate_campaign(path, soaks=best, seed=3).save(tmp_path / "own")
    files = sorted((tmp_path / "sim").glob("soak_*.csv"))
    for file in [*files, tmp_path / "sim" / "truth.json"]:
        assert (tmp_path / "own" / file.name).read_bytes() == file.read_bytes()
    cli("calibrate", path, *files, "-o", tmp_path / "result")
    own = cb.calibrate(files, path)
    assert own.to_json() == (tmp_path / "result" / "calibration.json").read_text(encoding="utf-8")
    held_out = cli("calibrate", path, *files[1:], "--validate", files[0], "--no-report", "-o", tmp_path / "held", "--json")
    assert cb.calibrate(files[1:], path, validate=files[0]).to_json() == held_out.stdout
    own.report(tmp_path / "own.html")
    assert (tmp_path / "own.html").read_bytes() == (tmp_path / "result" / "report.html").read_bytes()
    printed = cli("design", path, "--from", tmp_path / "result" / "calibration.json", "--add-min", 60, "-o", tmp_path / "more", "--json")
    more = cb.design_campaign(path, known=own, add_min=60.0)
    assert more.to_json() == printed.stdout and more.value < best.value
    with pytest.raises(cb.ExperimentError, match="no calibration over temperature"):
        cb.design_campaign(path, known=cb.Calibration.load(tmp_path / "result" / "soak_01" / "calibration.json"))


def test_a_sweep_says_what_time_buys_as_on_the_command_line(short: cb.Experiment, cli: Cli, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(short.to_toml(), encoding="utf-8")
    swept = cb.sweep(path, "budget", [90, 150])
    assert cli("design", path, "--sweep", "budget=90,150", "-o", tmp_path / "sweep", "--json").stdout == swept.to_json()
    assert list(swept.values) == [90.0, 150.0] and swept.unit == "min" and swept.sd.shape == (2, 4)
    k = swept.parameters.index("accelerometer.bias")
    assert swept.sd[1, k] < swept.sd[0, k]
    for quantity, others in (("duration", {}), ("budget", {"starts": 3})):
        with pytest.raises(cb.ExperimentError, match="a campaign"):
            cb.sweep(path, quantity, [90, 150], **others)
    with pytest.raises(cb.Infeasible, match="give at least"):
        cb.sweep(path, "budget", [5])


def test_a_study_rehearses_the_campaign_as_on_the_command_line(short: cb.Experiment, cli: Cli, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(short.to_toml(), encoding="utf-8")
    steps: list[int] = []
    study = cb.study(path, sensors=3, seed=2, progress=lambda done, total, what: steps.append(done))
    assert cli("study", path, "--sensors", 3, "--seed", 2, "-o", tmp_path / "study", "--json").stdout == study.to_json()
    assert study.data["campaigns"][0]["name"] == "this campaign" and steps == [1, 2, 3]
    assert all(0.5 < of["coverage"] <= 1.0 for of in study.data["campaigns"][0]["quantities"])
    with pytest.raises(cb.ExperimentError, match="`starts` is not for a campaign"):
        cb.study(path, starts=3)


def warm_up(path: pathlib.Path) -> None:
    """A board that lies on its desk while it warms up."""
    rng = np.random.default_rng(1)
    t_s = np.arange(30_000) * 0.05
    celsius = 44.0 - 40.0 * np.exp(-t_s / 500.0)
    tau = celsius - 25.0
    force = np.column_stack([0.2 + 2e-3 * tau, -0.1 + 1e-3 * tau - 5e-5 * tau**2, 9.7 + 4e-3 * tau])
    rate = np.column_stack([1e-4 * tau, 0.01 - 2e-4 * tau, 2e-6 * tau**2])
    force += rng.normal(scale=0.02, size=force.shape)
    rate += rng.normal(scale=1e-3, size=rate.shape)
    cb.recording(t_s, force, rate, temperature_c=celsius).save(path)


WARM: dict[str, Any] = {"temperature": {"accelerometer_bias": 2, "gyroscope_bias": 2}}


def test_a_warm_up_in_one_pose_gives_biases_as_on_the_command_line(cli: Cli, tmp_path: pathlib.Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    warm_up(tmp_path / "warm.csv")
    experiment = tmp_path / "imu.toml"
    experiment.write_text(cb.Experiment.preset("imu", **WARM).to_toml(), encoding="utf-8")
    with pytest.warns(cb.CalibrationWarning, match="one-direction"):
        warm = cb.calibrate(tmp_path / "warm.csv", experiment)
    cli("calibrate", experiment, tmp_path / "warm.csv", "-o", tmp_path / "result", status=None)
    assert warm.to_json() == (tmp_path / "result" / "calibration.json").read_text(encoding="utf-8")
    assert warm.data["with_gain"] == "z" and "accelerometer.bias.x" not in warm
    for name, truth in (("accelerometer.bias_per_k.x", 2e-3), ("gyroscope.bias.y", 0.01), ("gyroscope.bias_per_k2.z", 2e-6)):
        assert abs(warm[name].value - truth) < 4.5 * warm[name].sd, str(warm[name])
    assert "less that at 25" in warm.plot_temperature().get_ylabel()
    # without orders there is nothing to find
    with pytest.raises(cb.NotIdentifiable):
        cb.calibrate(tmp_path / "warm.csv", "imu")


@pytest.mark.filterwarnings("ignore::calibrant.CalibrationWarning")
def test_the_guide_runs(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("agg")
    section = GUIDE.read_text(encoding="utf-8").split("## Over temperature")[1].split("\n## ")[0]
    code = "\n".join(re.findall(r"```python\n(.*?)```", section, re.S))
    warm_up(tmp_path / "warm-up.csv")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(compile(code, str(GUIDE), "exec"), names)
    assert names["more"].value < names["plan"].value and json.loads(names["warm"].to_json())["with_gain"] == "z"
