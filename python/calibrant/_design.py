"""Designs: the motion, the poses or the trajectory whose recording determines the parameters best."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Array, Path, as_table, numbers, table
from ._calibrate import as_experiment
from ._calibration import Calibration, _write
from ._diagnostic import Diagnostic, diagnostics
from ._exceptions import experiment_error
from ._frames import frame, library_of
from ._motion import Joints, Motion, as_native_motion
from ._progress import Progress, Told

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class _Sheet:
    """What all designs have."""

    def __init__(self, found: _native.Design | _native.PoseDesign | _native.Trajectory) -> None:
        self.data: dict[str, Any] = json.loads(found.json())
        self._json, self._summary, self._html = found.json(), found.text(), found.html()
        self.diagnostics: tuple[Diagnostic, ...] = diagnostics(json.loads(found.notes()))

    def summary(self) -> str:
        """The sheet that the command line prints."""
        return self._summary

    def __str__(self) -> str:
        return self._summary

    def _repr_html_(self) -> str:
        from html import escape

        return f'<iframe srcdoc="{escape(self._html)}" style="width:100%;height:40em;border:0"></iframe>'

    def to_json(self) -> str:
        """The text of the JSON file of the command line."""
        return self._json

    def report(self, path: Path) -> None:
        """Write the report as one HTML file."""
        _write(path, self._html)


class Design(_Sheet):
    """The best motion, and how far from the best possible it is.

    Attributes
    ----------
    motion : Motion or None
        The best motion; ``None`` of an assessment where the limits admit none.
    value : float
        Its criterion, from the covariance that its recording will give.
    bound : float or None
        What no motion can beat, where a bound was wanted and found.
    gap : float or None
        How far the value is above the bound, as a share; for criterion D in nats.
    interrupted : bool
        Did Ctrl-C or the time end the search?
    diagnostics : tuple of Diagnostic
        What was noticed.
    data : dict
        All of it, as in ``design.json``.
    """

    def __init__(self, found: _native.Design) -> None:
        super().__init__(found)
        nodes, value = found.nodes(), found.value()
        self.motion = None if nodes is None else Motion(numbers(nodes[0]), table(nodes[1]))
        if self.motion is not None:
            self.motion.axes = int((self.data.get("setting") or {}).get("axes", 3))
        self.value, self.bound, self.gap, self.interrupted = value or (float("nan"), None, None, False)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the acceleration of the best motion over time; returns the axes."""
        from ._plots import motion

        return motion(self, ax)

    def __repr__(self) -> str:
        gap = "" if self.gap is None else f", gap {self.gap:.2g}"
        return f"Design(value {self.value:.6g}{gap})"


class PoseDesign(_Sheet):
    """The best poses.

    Attributes
    ----------
    directions : (n, 3) array
        The direction that is up in each pose: unit vectors in the sensor's axes, in the order in which to take them.
    efficiency : float or None
        At least this share of the best possible.
    data : dict
        All of it, as in ``design.json``.
    """

    def __init__(self, found: _native.PoseDesign) -> None:
        super().__init__(found)
        self.directions: Array = table(found.directions())
        self.efficiency: float | None = self.data.get("efficiency")

    def to_frame(self, like: Any = None) -> Any:
        """The poses as a frame: number, x, y, z."""
        columns: dict[str, Any] = {"pose": np.arange(1, len(self.directions) + 1)}
        columns.update({axis: self.directions[:, k] for k, axis in enumerate("xyz")})
        return frame(columns, None if like is None else library_of(like))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the directions: longitude and latitude in the sensor's axes; returns the axes."""
        from ._plots import poses

        return poses(self, ax)

    def __repr__(self) -> str:
        return f"PoseDesign({len(self.directions)} poses)"


class TrajectoryDesign(_Sheet):
    """The best trajectory of a machine.

    Attributes
    ----------
    joints : Joints
        Positions at the waypoints; cubic splines lead from one to the next.
    interrupted : bool
        Did Ctrl-C or the time end the search?
    data : dict
        All of it, as in ``design.json``.
    """

    def __init__(self, found: _native.Trajectory) -> None:
        super().__init__(found)
        self._found = found
        names, times, positions = found.waypoints()
        self.joints = Joints(numbers(times), dict(zip(names, table(positions, len(names)).T)))
        self.interrupted = found.interrupted()

    def save(self, directory: Path) -> list[str]:
        """Write ``trajectory.csv``, ``follow_joint_trajectory.yaml``, ``trajectory.script`` for arms of Universal Robots, and ``design.json``; returns the paths."""
        os.makedirs(directory, exist_ok=True)
        return [os.fspath(path) for path in self._found.write(os.fspath(directory))]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the positions of the joints over time; returns the axes."""
        from ._plots import joints

        return joints(self, ax)

    def __repr__(self) -> str:
        return f"TrajectoryDesign({self.joints!r})"


def design(
    experiment: Any,
    *,
    known: Sequence[Calibration] = (),
    criterion: str | None = None,
    gap: float | None = None,
    starts: int | None = None,
    seconds: float | None = None,
    seed: int | None = 1,
    certificate: bool = True,
    force: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> Design:
    """Find the motion whose recording determines the parameters best. Ctrl-C gives the best so far.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[motion]`` and ``[limits]``.
    known : list of Calibration
        Earlier calibrations of the sensor: their information counts.
    criterion : {"A", "D", "E", "M", "c", "I"}, optional
        What is minimised; that of the experiment by default.
    gap : float, optional
        The gap to the bound at which the search ends: 0.01 for 1 %.
    starts : int, optional
        Number of random starts.
    seconds : float, optional
        Time to search, s, in place of a number of starts.
    seed : int
        Seed of the starts.
    certificate : bool
        Find the bound that no motion can beat?
    force : bool
        Do it in spite of its size.
    threads : int, optional
        Number of threads; all cores by default. Results do not depend on it.
    progress : bool or callable
        ``True`` for a bar of tqdm, or a callable that takes steps done, steps in all, and what is done.

    Raises
    ------
    Infeasible
        Where the limits admit no motion.
    NotIdentifiable
        Where no motion within the limits determines the parameters.

    Examples
    --------
    >>> import calibrant as cb
    >>> best = cb.design("stage", starts=2)
    >>> best.bound <= best.value
    True
    """
    choice = _choice(known, criterion, gap, starts, seconds, seed, certificate, force)
    with Told(progress) as told:
        return Design(_native.design(as_experiment(experiment)._native, choice, threads=threads, progress=told))


def assess(
    experiment: Any,
    motion: Any,
    *,
    known: Sequence[Calibration] = (),
    criterion: str | None = None,
    starts: int | None = None,
    seconds: float | None = None,
    seed: int | None = 1,
    certificate: bool = True,
    force: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> Design:
    """Put a motion of your own beside the best one.

    `data` has the motion's criterion, covariance and use of limits, as in ``evaluation.json``; the rest is of the best motion.
    Parameters are those of :func:`design`; `motion` is a :class:`Motion`, a path or a frame.
    """
    choice = _choice(known, criterion, None, starts, seconds, seed, certificate, force)
    given = as_native_motion(motion)
    if given is None:
        raise experiment_error("there is no motion to assess", "give a Motion, a path or a frame")
    with Told(progress) as told:
        return Design(
            _native.assess(as_experiment(experiment)._native, given, choice, threads=threads, progress=told)
        )


def design_poses(
    experiment: Any,
    poses: int | None = None,
    *,
    known: Sequence[Calibration] = (),
    criterion: str | None = None,
    starts: int | None = None,
    seed: int | None = 1,
    force: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> PoseDesign:
    """Find the poses that determine the parameters best.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[holds]``.
    poses : int, optional
        Number of poses; that of the experiment by default.
    known : list of Calibration
        Earlier calibrations of the sensor: the poses are added to theirs.
    criterion, starts, seed, force, threads, progress
        As in :func:`design`.

    Examples
    --------
    >>> import calibrant as cb
    >>> cb.design_poses("static-poses", 12, starts=4).directions.shape
    (12, 3)
    """
    choice = _choice(known, criterion, None, starts, None, seed, True, force)
    made = as_experiment(experiment)
    with Told(progress) as told:
        return PoseDesign(_native.design_poses(made._native, poses, choice, threads=threads, progress=told))


def assess_poses(experiment: Any, directions: npt.ArrayLike, *, seed: int | None = 1) -> dict[str, Any]:
    """Put poses beside the best ones: their efficiency and what they determine, as in ``evaluation.json``.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[holds]``.
    directions : (n, 3) array
        The direction that is up in each pose, unit vectors in the sensor's axes.
    seed : int
        Seed of the search.
    """
    choice = _choice((), None, None, None, None, seed, True, False)
    given = as_table("directions", directions).tobytes()
    found: dict[str, Any] = json.loads(_native.assess_poses(as_experiment(experiment)._native, given, choice))
    return found


def design_trajectory(
    experiment: Any,
    *,
    criterion: str | None = None,
    starts: int | None = None,
    seconds: float | None = None,
    seed: int | None = 1,
    threads: int | None = None,
    progress: Progress = False,
) -> TrajectoryDesign:
    """Find the trajectory of a machine that determines the parameters best. Ctrl-C gives the best so far.

    `experiment` has ``[machine]``; the others are as in :func:`design`.
    """
    choice = _choice((), criterion, None, starts, seconds, seed, True, False)
    made = as_experiment(experiment)
    with Told(progress) as told:
        return TrajectoryDesign(_native.design_trajectory(made._native, choice, threads=threads, progress=told))


def _choice(
    known: Sequence[Calibration],
    criterion: str | None,
    gap: float | None,
    starts: int | None,
    seconds: float | None,
    seed: int | None,
    certificate: bool,
    force: bool,
) -> str:
    given = [known] if isinstance(known, Calibration) else known
    return json.dumps(
        {
            "known": [calibration.to_json() for calibration in given],
            "criterion": criterion,
            "gap": gap,
            "starts": starts,
            "seconds": seconds,
            "seed": seed,
            "without_certificate": not certificate,
            "force": force,
        }
    )
