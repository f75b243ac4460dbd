"""Recordings: what is known of units, clocks and libraries goes with them; and results are pickled."""

from __future__ import annotations

import pathlib
import pickle
from typing import Any

import numpy as np
import pytest

import calibrant as cb


@pytest.fixture(scope="module")
def imu() -> Any:
    return cb.simulate("imu", seed=2).recording


def with_rate(recording: cb.Recording, **rate: float) -> cb.Recording:
    assert recording.accelerometer is not None and recording.gyroscope is not None
    return cb.recording(None, recording.accelerometer.values, recording.gyroscope.values, **rate)


def test_a_part_of_a_recording_knows_its_rate_as_well(imu: cb.Recording) -> None:
    name = "gyroscope.scale.x"
    whole = with_rate(imu, rate_hz=100.0)
    part = whole.between(-1.0, 1e9)
    for given in (part, pickle.loads(pickle.dumps(part))):
        assert cb.calibrate(given, "imu")[name].sd == pytest.approx(cb.calibrate(whole, "imu")[name].sd, rel=1e-6)
    exact = cb.calibrate(with_rate(imu, rate_hz=100.0, rate_sd_ppm=0.0), "imu")
    assert exact[name].sd < 0.1 * cb.calibrate(whole, "imu")[name].sd


def test_a_recording_that_validates_keeps_its_units(imu: cb.Recording) -> None:
    other = cb.simulate("imu", seed=2, recording=2).recording
    assert other.accelerometer is not None and other.gyroscope is not None
    scaled = cb.recording(
        other.accelerometer.t_s, other.accelerometer.values / 9.80665, np.rad2deg(other.gyroscope.values),
        accelerometer_unit="g", gyroscope_unit="deg/s",
    )  # fmt: skip
    one, two = (cb.calibrate(imu, "imu", validate=given) for given in (other, scaled))
    assert one.verdict == two.verdict and [d.code for d in one.diagnostics] == [d.code for d in two.diagnostics]
    assert one.data["validation"] is not None


def test_recordings_that_are_calibrated_together_keep_their_units() -> None:
    first, second = (cb.simulate("static-poses", seed=3, recording=number).recording for number in (1, 2))
    assert second.accelerometer is not None
    in_mg = cb.recording(second.accelerometer.t_s, second.accelerometer.values / 9.80665e-3, accelerometer_unit="mg")
    one, two = (cb.calibrate(first, "static-poses", together=[given]) for given in (second, in_mg))
    assert np.allclose(one.values, two.values, rtol=0.0, atol=1e-9)


def test_numbers_of_numpy_are_numbers(imu: cb.Recording) -> None:
    assert with_rate(imu, rate_hz=np.int64(100)).sha256 == with_rate(imu, rate_hz=100.0).sha256
    assert len(with_rate(imu, rate_hz=np.float32(100.0))) == len(imu)
    cb.design("stage", starts=np.int64(1), threads=np.int64(1))


@pytest.mark.parametrize(
    "call",
    [
        lambda: cb.design("stage", threads=1_000_000),
        lambda: cb.design("stage", threads=-1),
        lambda: cb.simulate("imu", seed=-1),
        lambda: cb.simulate("imu", recording=0),
        lambda: cb.study("report", sensors=-1),
        lambda: cb.design_poses("static-poses", -3),
        lambda: cb.Motion([0, 1], [[0, 0, 0], [1]]),  # type: ignore[list-item]
    ],
)
def test_a_number_that_makes_no_sense_is_named(call: Any) -> None:
    with pytest.raises(cb.CalibrantError, match="`(threads|seed|recording|sensors|poses|acceleration_mps2)`"):
        call()


def test_what_is_not_used_is_said(tmp_path: pathlib.Path) -> None:
    made = cb.simulate("static-poses")
    found = cb.calibrate(made.recording, "static-poses", motion=cb.Motion([0.0, 1.0], [0.0, 0.0]))
    assert [d.message for d in found.diagnostics if d.code == "setting-unused"] == [
        "`motion=` is not used: a [holds] experiment needs no motion"
    ]
    with pytest.raises(cb.ExperimentError, match="is read already"):
        cb.read_recording(made.recording, accelerometer_unit="g")


def test_results_are_pickled(tmp_path: pathlib.Path) -> None:
    made = cb.simulate("gantry", seed=4)
    again = pickle.loads(pickle.dumps(made))
    assert again.recording.sha256 == made.recording.sha256 and again.truth == made.truth
    pd = pytest.importorskip("pandas")
    frame = cb.simulate("imu").recording.to_frame()
    found = cb.calibrate(frame, "imu")
    copy = pickle.loads(pickle.dumps(found))
    assert copy == found and copy.diagnostics == found.diagnostics and isinstance(copy.to_frame(), pd.DataFrame)
    records = pickle.loads(pickle.dumps(cb.Records(tmp_path / "line.db")))
    records.add(cb.calibrate(cb.simulate("static-poses").recording, "static-poses", sensor="0012"))
    assert records.to_frame()["sensor"].tolist() == ["0012"] and records.to_frame()["id"].tolist() == [1]


def test_a_frame_without_names_and_a_calibration_that_was_changed_are_refused(tmp_path: pathlib.Path) -> None:
    pd = pytest.importorskip("pandas")
    with pytest.raises(cb.RecordingError, match="have no names"):
        cb.read_recording(pd.DataFrame(np.zeros((9, 4))))
    with pytest.raises(cb.RecordingError, match="cannot be read"):
        cb.read_recording(pd.DataFrame(np.zeros((9, 4)), columns=["t_s", "ax", "ax", "az"]))
    found = cb.calibrate(cb.simulate("static-poses").recording, "static-poses")
    path = tmp_path / "calibration.json"
    path.write_text(found.to_json().replace('"verdict": {', '"verdict": "ok", "other": {'), encoding="utf-8")
    with pytest.raises(cb.ExperimentError, match="changed, or is damaged"):
        cb.Calibration.load(path)
    with pytest.raises(cb.OutputError, match="cannot write"):
        cb.simulate("static-poses").save(path / "below")


def test_masked_values_are_missing() -> None:
    made = cb.simulate("static-poses").recording.accelerometer
    assert made is not None
    values = made.values.copy()
    values[100:110] = -999.0
    masked = np.ma.masked_values(values, -999.0)
    values[100:110] = np.nan
    one, two = (cb.calibrate(cb.recording(made.t_s, of), "static-poses") for of in (masked, values))
    assert np.array_equal(one.values, two.values)
    assert np.array_equal(one.correct(masked), two.correct(values), equal_nan=True)


def test_a_stage_of_one_axis_is_calibrated_in_memory(tmp_path: pathlib.Path) -> None:
    pd = pytest.importorskip("pandas")
    made = cb.simulate("stage", seed=3)
    made.save(tmp_path)
    (tmp_path / "stage.toml").write_text(cb.Experiment.preset("stage").to_toml(), encoding="utf-8")
    by_path = cb.calibrate(tmp_path / "recording.csv", tmp_path / "stage.toml", motion=tmp_path / "motion.csv")
    samples = made.recording.accelerometer
    assert samples is not None
    arrays = cb.recording(samples.t_s, samples.values[:, 0])
    table = pd.read_csv(tmp_path / "recording.csv", comment="#")
    for given in (made.recording, pickle.loads(pickle.dumps(made.recording)), arrays, table):
        found = cb.calibrate(given, "stage", motion=made.motion)
        assert np.array_equal(found.values, by_path.values) and np.array_equal(found.sd, by_path.sd)
    assert list(made.recording.to_frame().columns)[:2] == ["t_s", "ax_mps2"]


def test_a_missing_value_of_one_sensor_keeps_the_row(imu: cb.Recording) -> None:
    pytest.importorskip("pandas")
    frame = imu.to_frame()
    frame.iloc[3, 1] = np.nan
    found = cb.calibrate(imu, "imu")
    corrected, whole = found.apply(frame), found.apply(imu.to_frame())
    assert len(corrected) == len(frame) and corrected["ax_mps2"].isna().sum() == 1
    # the gyroscope feels the acceleration
    assert np.array_equal(corrected["gx_radps"].drop(3), whole["gx_radps"].drop(3))
    assert len(cb.read_recording(frame).to_frame()) == len(frame)


def test_dates_of_recording_and_log_are_of_one_clock() -> None:
    pd = pytest.importorskip("pandas")
    made = cb.simulate("mocap", seed=2)
    assert isinstance(made.log, cb.Poses)
    log = pd.DataFrame(np.column_stack([made.log.position_m, made.log.quaternion_wxyz]), columns=["px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz"])
    log["stamp"] = pd.Timestamp("2026-11-26 23:59:50Z") + pd.to_timedelta(np.round(1e9 * made.log.t_s).astype(np.int64), unit="ns")
    frame = made.recording.to_frame()
    frame["stamp"] = pd.Timestamp("2026-11-26 23:59:50Z") + pd.to_timedelta(np.round(1e9 * frame.pop("t_s")).astype(np.int64), unit="ns")
    for given in (frame, cb.read_recording(frame, columns={"time": "stamp"})):
        found = cb.calibrate(given, "mocap", log=log)
        truth = cb.calibrate(made.recording, "mocap", log=made.log)
        assert found["delay.accelerometer"].value == pytest.approx(truth["delay.accelerometer"].value, abs=1e-5)


def test_durations_and_the_index_of_a_frame_are_times(imu: cb.Recording) -> None:
    pd = pytest.importorskip("pandas")
    frame = imu.to_frame()
    assert imu.accelerometer is not None
    times = frame.pop("t_s")
    for index in (
        times.rename("t_s"),
        pd.to_timedelta(times, unit="s"),
        pd.Timestamp("2026-11-26 23:59:50Z") + pd.to_timedelta(times, unit="s").rename(None),
    ):
        indexed = frame.set_index(pd.Index(index, name=index.name))
        read = cb.read_recording(indexed).accelerometer
        assert read is not None
        assert np.diff(read.t_s) == pytest.approx(np.diff(imu.accelerometer.t_s), abs=1e-8)
    frame["time"] = pd.to_timedelta(times, unit="s")
    read = cb.read_recording(frame).accelerometer
    assert read is not None and read.t_s == pytest.approx(imu.accelerometer.t_s, abs=1e-8)


def test_orientations_of_counts_are_those_of_their_readings() -> None:
    made = cb.simulate(cb.Experiment.preset("static-poses-counts", sensor={"gain_counts_per_mps2": 1000.0, "noise_counts": 5.0})).recording
    assert made.accelerometer is not None and made.accelerometer.unit == "counts"
    assert made.inspect().missing_orientations == ()


def test_a_result_is_written_whole_or_not_at_all(tmp_path: pathlib.Path) -> None:
    found = cb.calibrate(cb.simulate("static-poses").recording, "static-poses")
    found.save(tmp_path / "calibration.json")
    found.save(tmp_path / "calibration.json")
    assert [path.name for path in tmp_path.iterdir()] == ["calibration.json"]
    with pytest.raises(cb.OutputError):
        found.save(tmp_path / "nowhere" / "calibration.json")
    with pytest.raises(cb.OutputError):
        found.save(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["calibration.json"]


def test_a_design_of_another_kind_names_the_function() -> None:
    for call, name in ((cb.design, "design_poses"), (cb.design_trajectory, "design_poses")):
        with pytest.raises(cb.ExperimentError, match=rf"use `{name}"):
            call("imu")


def test_recordings_without_samples_or_with_absurd_times_are_refused(imu: cb.Recording) -> None:
    for call in (lambda: imu.between(1e6, 2e6), lambda: cb.recording([], [])):
        with pytest.raises(cb.RecordingError, match="has 0 samples"):
            call()
    assert imu.accelerometer is not None
    absurd = cb.recording(1e-271 * np.arange(3000), imu.accelerometer.values[:3000])
    with pytest.raises(cb.NotIdentifiable, match="no hold was found"):
        cb.calibrate(absurd, "static-poses")


def test_the_shares_of_a_budget_add_up(imu: cb.Recording) -> None:
    found = cb.calibrate(imu, "imu")
    assert np.allclose(sum(found.budget.values()), 1.0, rtol=0.0, atol=1e-9)
    place = list(found).index("accelerometer.scale.x")
    # gravity is that of any place
    assert found.budget["gravity"][place] > 0.9


def test_a_table_of_averages_is_calibrated(tmp_path: pathlib.Path) -> None:
    simulated = cb.simulate(cb.Experiment.preset("static-poses"))
    whole = cb.calibrate(simulated.recording, gravity_mps2=9.80665)
    rows = [",".join(f"{mean:.7f}" for mean in hold["mean_mps2"]) for hold in whole.data["holds"]["table"]]
    path = tmp_path / "averages.txt"
    path.write_text("ax_mps2,ay_mps2,az_mps2\n" + "\n".join(rows) + "\n")
    found = cb.calibrate(path, "static-poses", gravity_mps2=9.80665, rows_are_holds=True)
    for name in ("accelerometer.bias.x", "accelerometer.scale.z"):
        assert abs(found[name].value - whole[name].value) < whole[name].sd
