"""Simulated recordings."""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Iterator, Mapping

import numpy.typing as npt

from . import _native
from ._arrays import Path, as_table, numbers, table, whole
from ._calibrate import as_experiment
from ._diagnostic import Diagnostic, diagnostics
from ._motion import Joints, Motion, Poses, as_native_motion
from ._page import make_directory
from ._recording import Recording, Samples, of_samples


class Truth(Mapping[str, float]):
    """The true parameters of a simulated sensor, by the names of a calibration's. ``data`` has all of them, as in ``truth.json``."""

    def __init__(self, data: dict[str, Any]) -> None:
        self.data = data
        self._values = _values(data)

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"Truth({len(self)} parameters)"


class Simulation:
    """A simulated recording, with the truth behind it.

    Attributes
    ----------
    recording : Recording
        What the sensor would have reported.
    truth : Truth
        The true parameters.
    motion : Motion or None
        The commanded motion, of a ``[motion]`` experiment.
    log : Poses, Joints or None
        The log of the machine, of a ``[machine]`` experiment.
    seed : int
        The seed of the sensor.
    diagnostics : tuple of Diagnostic
        What was noticed.
    """

    def __init__(self, made: _native.Simulation, asked: dict[str, Any]) -> None:
        self._made, self._asked = made, asked
        self.truth = Truth(json.loads(made.truth()))
        about = json.loads(made.about())
        self.seed: int = about["seed"]
        self._axes: int = about["axes"]
        self.diagnostics: tuple[Diagnostic, ...] = diagnostics(about["notes"])
        nodes, log = made.motion(), made.log()
        self.motion = None if nodes is None else Motion(numbers(nodes[0]), table(nodes[1]))
        self.log: Poses | Joints | None = None
        if log is not None:
            kind, names, times, first, second = log
            if kind == "joints":
                positions, velocities = (
                    None if of is None else dict(zip(names, table(of, len(names)).T)) for of in (first, second)
                )
                step_s = about["knot_step_s"]
                self.log = Joints(numbers(times), positions or {}, velocities, knot_step_s=step_s)
            else:
                assert second is not None
                self.log = Poses(numbers(times), table(first), table(second, 4))

    @property
    def recording(self) -> Recording:
        """What the sensor would have reported."""
        return recording_of("recording", self._made.samples, self._made.temperature_c(), self._axes)

    def save(self, directory: Path) -> None:
        """Write the files of ``calibrant simulate``: ``recording.csv``, ``truth.json``, and ``motion.csv``, ``joints.csv`` or ``poses.csv``."""
        make_directory(directory)
        self._made.write(os.fspath(directory))

    def __reduce__(self) -> tuple[Any, ...]:
        # the same arguments give the same bits
        return (_simulated, (self._asked,))

    def __repr__(self) -> str:
        return f"Simulation(seed {self.seed})"


def recording_of(name: str, samples: Callable[[str], Any], temperature: Any, axes: int) -> Recording:
    """A simulated recording; `samples` gives those of a sensor by its name."""
    found: dict[str, Samples] = {}
    for sensor in ("accelerometer", "gyroscope"):
        of_sensor = Samples._of(samples(sensor))
        if of_sensor is not None:
            found[sensor] = of_sensor
    return of_samples(name, found, None if temperature is None else numbers(temperature), axes)


def simulate(
    experiment: Any,
    *,
    motion: Any = None,
    poses: npt.ArrayLike | None = None,
    seed: int | None = None,
    recording: int = 1,
    force: bool = False,
) -> Simulation:
    """Draw a sensor from the datasheet of an experiment, and simulate a recording of it.

    Parameters
    ----------
    experiment : Experiment, path or str
        The experiment, its file, or the name of a preset.
    motion : Motion, Poses, Joints, TrajectoryDesign, path or frame, optional
        The commanded motion, the log of a machine, or a trajectory that it follows; a random one by default.
    poses : (n, 3) array, optional
        The direction that is up in each hold of an accelerometer that is held by hand.
    seed : int, optional
        Seed of all random numbers; that of the experiment by default.
    recording : int
        Number of the recording, from 1: each has its own noise, poses and motion.
    force : bool
        Do it in spite of its size.

    Returns
    -------
    Simulation

    Examples
    --------
    >>> import calibrant as cb
    >>> cb.simulate("imu", seed=2)
    Simulation(seed 2)
    """
    return _simulated(
        {
            "experiment": as_experiment(experiment),
            "motion": motion,
            "poses": None if poses is None else as_table("poses", poses).tobytes(),
            "seed": whole("seed", seed, 0),
            "recording": whole("recording", recording),
            "force": force,
        }
    )


def _simulated(asked: dict[str, Any]) -> Simulation:
    arguments = {**asked, "motion": as_native_motion(asked["motion"])}
    return Simulation(_native.simulate(arguments.pop("experiment")._native, **arguments), asked)


def _values(data: dict[str, Any]) -> dict[str, float]:
    listed = data.get("parameters")
    if isinstance(listed, list):
        return {of["name"]: float(of["value"]) for of in listed}
    return {}
