"""From a recording to a calibration."""

from __future__ import annotations

import os
import warnings
from typing import Any, Sequence

from . import _native
from ._arrays import Path, as_json, thread_count
from ._calibration import Calibration
from ._exceptions import CalibrationWarning, experiment_error
from ._experiment import Experiment, presets
from ._motion import as_native_motion
from ._progress import Progress, Told
from ._recording import Recording, as_readings, as_soak, as_source, like_of, origin_of, read_recording

AnyExperiment = Any
"""An :class:`Experiment`, a path of an experiment file, the name of a preset, or ``"auto"``."""


def calibrate(
    recording: Any,
    experiment: AnyExperiment = "auto",
    *,
    gravity_mps2: float | None = None,
    motion: Any = None,
    log: Any = None,
    validate: Any = None,
    validate_log: Any = None,
    folds: int | None = None,
    sections: Path | None = None,
    together: Sequence[Any] = (),
    rows_are_holds: bool = False,
    allow: Sequence[str] = (),
    accept: Path | None = None,
    sensor: str | None = None,
    sensor_from: str | None = None,
    sensor_key: str | None = None,
    station: str | None = None,
    threads: int | None = None,
    progress: Progress = False,
) -> Calibration:
    """Calibrate the sensors of a recording.

    The same input gives the same bits as the command line.

    Parameters
    ----------
    recording : path, bytes, frame or Recording; or a list of them
        The recording. What a file does not state goes to :func:`read_recording`, or to ``[columns]`` of the experiment.
        A list is of the soaks of a campaign over temperature, in the order of time, each a recording of its own: the experiment has ``[campaign]``, and the result is
        one calibration over temperature. Calibrations of the soaks do in place of their recordings.
    experiment : Experiment, path or str
        What is known of the sensor, and what was done with it: an :class:`Experiment`, an experiment file, the name of a preset,
        or ``"auto"``: turned by hand and held still, an accelerometer or an IMU, as the recording has it.
    gravity_mps2 : float, optional
        Gravity at your place, m/s², in place of what the experiment says.
    motion : Motion, path or frame, optional
        The commanded motion, which a ``[motion]`` experiment needs.
    log : Poses, Joints, path or frame, optional
        The log of the machine, which a ``[machine]`` experiment needs where the recording's file has none.
    validate : path, bytes, frame or Recording, optional
        Another recording of the sensor, on which the calibration is tried; of a campaign a ramp, or another soak.
    validate_log : Poses, Joints, path or frame, optional
        The log of the machine in that recording.
    folds : int, optional
        Number of blocks, each predicted by a calibration from the others.
    sections : path, optional
        The list of faces and turns of a session of imucal.
    together : list of recordings
        Further recordings of the same sensors, calibrated together with the first.
    rows_are_holds : bool
        Each row of the recording is the mean of a hold of an accelerometer, as in a table of averages.
    allow : list of str
        Codes of diagnostics that do not count for the verdict.
    accept : path, optional
        A file with ``[accept]``: the limits that a result must keep.
    sensor, sensor_from, sensor_key : str, optional
        The sensor's serial number; or the pattern of file names that has it, ``"{sensor}.csv"``; or the line or column that has it.
    station : str, optional
        Where it was recorded.
    threads : int, optional
        Number of threads; all cores by default. Results do not depend on it.
    progress : bool or callable
        ``True`` for a bar of tqdm, or a callable that takes steps done, steps in all, and what is done.

    Returns
    -------
    Calibration
        With a :exc:`CalibrationWarning` where its verdict is not ``ok``. A recording in one pose whose temperature changes gives the biases over temperature,
        where ``[temperature]`` has their orders.

    Raises
    ------
    ExperimentError
        Where experiment, motion or an argument makes no sense.
    RecordingError
        Where the recording cannot be used.
    NotIdentifiable
        Where the data do not determine the parameters: `groups` says which, why, and what would help.
    KeyboardInterrupt
        Where Ctrl-C came before there was a result.

    Examples
    --------
    >>> import calibrant as cb
    >>> simulated = cb.simulate(cb.Experiment.preset("static-poses"))
    >>> cal = cb.calibrate(simulated.recording, gravity_mps2=9.80665)
    >>> abs(cal["accelerometer.scale.x"].value - simulated.truth["accelerometer.scale.x"]) < 5 * cal["accelerometer.scale.x"].sd
    True
    """
    soaks = list(recording) if isinstance(recording, (list, tuple)) else None
    made = _experiment_of(recording, experiment) if soaks is None else _of_campaign(experiment)
    if gravity_mps2 is not None:
        made = made.replace(**{made.kind: {"gravity_mps2": gravity_mps2}})
    if motion is not None and log is not None:
        raise experiment_error("`motion` and `log` are both there", "leave one of them away", code="options-contradict")
    options: dict[str, Any] = {
        "experiment_file": made._path or "",
        "reading": {"rows_are_holds": rows_are_holds},
        "folds": folds,
        "accept": None if accept is None else os.fspath(accept),
        "allow": list(allow or ()),
        "sensor": sensor,
        "sensor_from": sensor_from,
        "sensor_key": sensor_key,
        "station": station,
        "report": True,
    }
    if soaks is not None:
        of_one = {
            "motion": motion, "log": log, "validate_log": validate_log, "folds": folds,
            "sections": sections, "together": together or None, "rows_are_holds": rows_are_holds or None, "accept": accept,
        }
        refused = [name for name, value in of_one.items() if value is not None]
        if refused:
            raise experiment_error(f"`{refused[0]}` is not for a campaign over temperature", "leave it away", code="options-contradict")
        return _judged(_over_temperature(soaks, made, options, validate, threads, progress))
    source, reading = as_source(recording, sections=sections, further=together)
    options["reading"].update(reading, rows_are_holds=rows_are_holds)
    other = None if validate is None else _native.Source(as_readings(validate))
    with Told(progress) as told:
        outcome = _native.calibrate(
            made._native,
            source,
            as_json(options),
            motion=as_native_motion(motion if log is None else log, origin_of(recording)),
            validate=other,
            validate_motion=as_native_motion(validate_log, origin_of(validate)),
            threads=thread_count(threads),
            progress=told,
        )
    return _judged(Calibration(outcome.json(), outcome, like=like_of(recording)))


def _judged(found: Calibration) -> Calibration:
    if found.verdict != "ok":
        codes = ", ".join((found.data.get("verdict") or {}).get("codes") or ())
        warnings.warn(f"the calibration is {found.verdict}: {codes}; see its diagnostics", CalibrationWarning, stacklevel=3)
    return found


def _of_campaign(experiment: AnyExperiment) -> Experiment:
    remedy = (
        "give the further recordings as `together=` where they are of one temperature, and an experiment with [campaign] "
        'where they are soaks: see `Experiment.preset("campaign")`'
    )
    if isinstance(experiment, str) and experiment == "auto":
        raise experiment_error("several recordings are given, and no experiment", remedy, code="experiment-unsuited")
    made = as_experiment(experiment)
    if not made._is_campaign:
        message = "several recordings are given, and the experiment has no [campaign]"
        raise experiment_error(message, remedy, code="experiment-unsuited")
    return made


def _over_temperature(
    soaks: list[Any], made: Experiment, options: dict[str, Any], validate: Any, threads: int | None, progress: Progress
) -> Calibration:
    other = None if validate is None else _native.Source(as_readings(validate))
    calibrated = [of for of in soaks if isinstance(of, Calibration)]
    if not soaks:
        raise experiment_error("there is no soak", "give the recordings of all soaks", code="recording-missing")
    if not calibrated:
        sources = [as_soak(of, number) for number, of in enumerate(soaks, 1)]
        with Told(progress) as told:
            outcome = _native.calibrate_campaign(
                made._native, sources, as_json(options), validate=other, threads=thread_count(threads), progress=told
            )
        return Calibration(outcome.json(), outcome, like=like_of(soaks[0]))
    if len(calibrated) < len(soaks):
        message = "some soaks are recordings, and some are calibrations"
        raise experiment_error(message, "give the recordings of all soaks, or the calibration of each", code="options-contradict")
    named = [(_name_of(of, number), of.to_json()) for number, of in enumerate(calibrated, 1)]
    outcome = _native.calibrate_soaks(made._native, named, as_json(options), validate=other)
    return Calibration(outcome.json(), outcome, like=calibrated[0]._like)


def _name_of(soak: Calibration, number: int) -> str:
    files = [of.get("file") for of in soak.data.get("inputs") or ()]
    return str(files[0]) if files and files[0] not in (None, "recording") else f"soak {number}"


def as_experiment(experiment: AnyExperiment) -> Experiment:
    """An experiment, a path, or the name of a preset."""
    if isinstance(experiment, Experiment):
        return experiment
    if isinstance(experiment, str) and experiment in presets():
        return Experiment.preset(experiment)
    if isinstance(experiment, (str, os.PathLike)):
        return Experiment.from_toml(experiment)
    raise experiment_error(
        f"{type(experiment).__name__} is no experiment", "give an Experiment, a path, or the name of a preset"
    )


_DESIGNS = {
    "holds": "`design_poses(…)`, or `assess_poses(…)` for what you have",
    "campaign": "`design_campaign(…)`",
    "motion": "`design(…)`, or `assess(…)` for what you have",
    "machine": "`design_trajectory(…)`, or `assess_trajectory(…)` for what you have",
}


def experiment_of_kind(experiment: AnyExperiment, kind: str) -> Experiment:
    """An experiment whose sensor is moved in this way: ``"holds"``, ``"campaign"``, ``"motion"`` or ``"machine"``."""
    made = as_experiment(experiment)
    own = "campaign" if made._is_campaign else made.kind
    if own != kind:
        message = f"the experiment has [{own}], and this is for [{kind}]"
        preset = 'see `Experiment.preset("campaign")`; for this one ' if kind == "campaign" else ""
        raise experiment_error(message, f"{preset}use {_DESIGNS[own]}", code="experiment-unsuited")
    return made


def _experiment_of(recording: Any, experiment: AnyExperiment) -> Experiment:
    if not (isinstance(experiment, str) and experiment == "auto"):
        return as_experiment(experiment)
    read = recording if isinstance(recording, Recording) else read_recording(recording)
    accelerometer, gyroscope = read.accelerometer, read.gyroscope
    counts = "-counts" if accelerometer is not None and accelerometer.unit == "counts" else ""
    if gyroscope is not None:
        return Experiment.preset(f"imu{counts}")
    # what the preset says of the datasheet is of its own sensor
    of_datasheet = ("noise_mps2", "noise_counts", "bias_sd_mps2", "scale_sd", "cross_axis_sd")
    return Experiment.preset(f"static-poses{counts}", sensor=dict.fromkeys(of_datasheet))
