"""Manners: errors with data, threads, signals, pickles, forks, nothing printed."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import threading
import time
from typing import Any, Callable

import numpy as np
import pytest
from hostile import hostile

import calibrant as cb


@pytest.fixture(scope="module")
def imu() -> cb.Calibration:
    return cb.calibrate(cb.simulate("imu").recording, "imu")


def test_an_error_has_code_remedy_and_answers() -> None:
    text = b"t_s,ax,ay,az\n" + b"".join(b"%f,0,0,%f\n" % (k / 100, 1 + 1e-3 * (k % 7)) for k in range(400))
    with pytest.raises(cb.RecordingError) as caught:
        cb.read_recording(text)
    error = caught.value
    assert error.code == "unit-unknown" and isinstance(error, ValueError)
    assert "accelerometer_unit" in [answer.argument for answer in error.answers]
    assert "--" not in str(error) and "option `" not in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert (again.code, again.answers, str(again)) == (error.code, error.answers, str(error))


def test_what_is_not_determined_is_named() -> None:
    flat = np.tile([0.0, 0.0, 9.81], (3000, 1)) + 0.01 * np.random.default_rng(1).standard_normal((3000, 3))
    with pytest.raises(cb.NotIdentifiable) as caught:
        cb.calibrate(cb.recording(np.arange(3000) / 100, flat), gravity_mps2=9.81)
    assert caught.value.groups and caught.value.parameters and caught.value.groups[0].remedy
    assert pickle.loads(pickle.dumps(caught.value)).groups == caught.value.groups


def test_a_wrong_experiment_names_its_key() -> None:
    with pytest.raises(cb.ExperimentError) as caught:
        cb.Experiment.preset("imu", holds={"gravitty_mps2": 9.8})
    assert caught.value.key == "holds.gravitty_mps2" and caught.value.line is None
    with pytest.raises(cb.ExperimentError) as caught:
        cb.Experiment.from_toml(b"schema = 1\n[sensor]\nkind = 3\n")
    assert caught.value.line == 3


def test_a_verdict_can_be_raised(imu: cb.Calibration) -> None:
    assert imu.raise_for_verdict("ok") is imu
    data = imu.to_json().replace('"usability": "ok"', '"usability": "bad"')
    with pytest.raises(cb.BadCalibration) as caught:
        cb.Calibration(data).raise_for_verdict()
    assert caught.value.calibration.verdict == "bad"


def test_everything_pickles(imu: cb.Calibration) -> None:
    assert pickle.loads(pickle.dumps(imu)) == imu
    experiment = cb.Experiment.preset("arm")
    assert pickle.loads(pickle.dumps(experiment)) == experiment
    made = cb.simulate("rate-table")
    assert pickle.loads(pickle.dumps(made.recording)).sha256 == made.recording.sha256
    assert isinstance(pickle.loads(pickle.dumps(made.log)), cb.Joints)


def test_frames_come_back_as_they_went_in(imu: cb.Calibration) -> None:
    recording = cb.simulate("imu").recording
    for library in ("pandas", "polars", "pyarrow"):
        module = pytest.importorskip(library)
        columns = {"t_s": recording.accelerometer.t_s}  # type: ignore[union-attr]
        for letter, of in (("a", recording.accelerometer), ("g", recording.gyroscope)):
            assert of is not None
            unit = "mps2" if letter == "a" else "radps"
            columns.update({f"{letter}{axis}_{unit}": of.values[:, k] for k, axis in enumerate("xyz")})
        given = module.table(columns) if library == "pyarrow" else module.DataFrame(columns)
        kind = type(given)
        assert isinstance(cb.calibrate(given, "imu").to_frame(), kind)
        assert isinstance(imu.apply(given, sd=True), kind)


def test_other_threads_run_meanwhile() -> None:
    ticks, stop = 0, threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not stop.is_set():
            ticks += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    cb.design("stage", starts=4)
    stop.set()
    thread.join()
    assert ticks > 20


def interrupted(call: Callable[[], Any], after_s: float = 1.0) -> tuple[Any, float]:
    """What a call gives, or None after KeyboardInterrupt, where Ctrl-C comes in its midst; and how long it took to end, s."""
    asked: list[float] = []

    def ask() -> None:
        asked.append(time.monotonic())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(after_s, ask)
    found = None
    # a shell that runs the tests in the background makes them deaf
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer.start()
    try:
        found = call()
    except KeyboardInterrupt:
        pass
    finally:
        signal.signal(signal.SIGINT, before)
    ended = time.monotonic()
    assert asked, "it ended before Ctrl-C came"
    return found, ended - asked[0]


# 0.5 s, and a machine that has other work
SOON_S = 1.5


def test_ctrl_c_gives_the_best_motion_so_far() -> None:
    best, took_s = interrupted(lambda: cb.design("stage", starts=100_000, force=True))
    assert best.interrupted and best.motion is not None and took_s < SOON_S


def test_ctrl_c_gives_the_best_poses_so_far() -> None:
    best, took_s = interrupted(lambda: cb.design_poses("static-poses", 30, starts=100_000, force=True))
    assert best.data["status"] == "interrupted" and len(best.directions) == 30 and took_s < SOON_S


def test_ctrl_c_gives_the_best_trajectory_so_far() -> None:
    best, took_s = interrupted(lambda: cb.design_trajectory("rate-table", starts=100_000), 4.0)
    assert best is None or best.interrupted and len(best.joints.t_s) > 2
    assert took_s < SOON_S


def test_ctrl_c_gives_the_values_that_are_finished() -> None:
    durations = np.linspace(5.0, 10.0, 900)
    swept, took_s = interrupted(lambda: cb.sweep("stage", "duration", durations, force=True), 2.0)
    assert swept is None or 0 < len(swept.values) < 900
    assert took_s < SOON_S


def test_ctrl_c_gives_the_sensors_that_are_finished() -> None:
    # each finished sensor is a row of the result: 20 000 are finished in a second, and their pages take another
    found, took_s = interrupted(lambda: cb.study("report", sensors=1_000_000, force=True), 0.5)
    assert found is None or found.data["kind"] == "study"
    assert took_s < SOON_S


def test_ctrl_c_ends_noise_and_a_calibration_on_a_machine() -> None:
    long = cb.recording(None, np.random.default_rng(1).normal(size=(3_000_000, 3)) + [0.0, 0.0, 9.81], rate_hz=1000.0)
    found, took_s = interrupted(lambda: [cb.noise(long) for _ in range(100)], 0.5)
    assert found is None and took_s < SOON_S
    made = cb.simulate("gantry")
    found, took_s = interrupted(lambda: [cb.calibrate(made.recording, "gantry", log=made.log) for _ in range(100)], 0.5)
    assert found is None and took_s < SOON_S


def test_progress_is_told_and_may_stop_the_work() -> None:
    told: list[tuple[int, int, str]] = []
    cb.design("stage", starts=3, progress=lambda done, total, text: told.append((done, total, text)))
    assert told and told[-1][0] <= told[-1][1]

    def refuse(done: int, total: int, text: str) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        cb.design("stage", starts=200, progress=refuse)


def _values(queue: Any) -> None:
    queue.put(cb.calibrate(cb.simulate("static-poses").recording, "static-poses").values)


@pytest.mark.parametrize("method", ["fork", "forkserver", "spawn"])
def test_other_processes_give_the_same(method: str) -> None:
    if method not in multiprocessing.get_all_start_methods():
        pytest.skip(f"there is no {method}")
    expected = cb.calibrate(cb.simulate("static-poses").recording, "static-poses").values
    context: Any = multiprocessing.get_context(method)
    queue = context.Queue()
    process = context.Process(target=_values, args=(queue,))
    process.start()
    assert np.array_equal(queue.get(timeout=60), expected)
    process.join()


def test_threads_change_nothing() -> None:
    recording = cb.simulate("imu").recording
    one, two = (cb.calibrate(recording, "imu", threads=count) for count in (1, 2))
    assert one == two


def test_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    cb.calibrate(cb.simulate("imu").recording, "imu").summary()
    with pytest.raises(cb.CalibrantError):
        cb.recording([0.0, 1.0], [[0.0, 0.0, 1.0]])
    captured = capfd.readouterr()
    assert captured.out == "" and captured.err == ""


def test_hostile_input_is_refused_or_used() -> None:
    """A short part of hostile.py."""
    classes, failed = hostile(120, 40, seed=7)
    assert not failed, "\n".join(failed)
    assert sum(classes.values()) == 160 and classes["array: accepted"] and classes["array: RecordingError"]
