"""Trajectories of a machine: the best one, and one beside it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import Path, numbers, table, thread_count
from ._calibrate import experiment_of_kind
from ._calibration import Calibration
from ._choice import Reach, choice
from ._exceptions import experiment_error
from ._motion import Joints, as_native_motion
from ._page import Page, make_directory, write
from ._progress import Progress, Told

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class TrajectoryDesign(Page):
    """The best trajectory of a machine. It is a motion, too: :func:`simulate` and :func:`assess_trajectory` take it.

    Attributes
    ----------
    joints : Joints
        Positions and velocities at the knots; cubic splines lead from one to the next.
    log : Joints
        What a machine logs that follows it: positions at and between the knots.
    plain : Joints or None
        The plain routine of the same duration, as an engineer would write it.
    interrupted : bool
        Did Ctrl-C or the time end the search?
    diagnostics : tuple of Diagnostic
        What was noticed.
    data : dict
        All of it, as in ``design.json``.
    """

    def __init__(self, page: _native.Page, found: _native.Trajectory) -> None:
        super().__init__(page)
        self._found: _native.Trajectory | None = found
        self._texts: dict[str, str] = {}
        self.joints = _joints(found.knots())
        plain = found.plain()
        self.plain = None if plain is None else _joints(plain)
        (_, names, times, positions, _), step_s = found.log()
        columns = dict(zip(names, table(positions, len(names)).T))
        self.log = Joints(numbers(times), columns, knot_step_s=step_s)
        self.interrupted = found.interrupted()

    def save(self, directory: Path) -> list[str]:
        """Write ``trajectory.csv``, ``follow_joint_trajectory.yaml``, ``trajectory.script`` for arms of Universal Robots, ``plain_trajectory.csv`` and ``design.json``; returns the paths."""
        place = os.fspath(directory)
        make_directory(place)
        if self._found is not None:
            return [os.fspath(path) for path in self._found.write(place)]
        for name, text in self._texts.items():
            write(os.path.join(place, name), text)
        return [os.path.join(place, name) for name in self._texts]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the positions of the joints over time; returns the axes."""
        from ._plots import joints

        return joints(self.log, ax)

    def _as_native(self) -> _native.Motion:
        return self.log._as_native()

    def __getstate__(self) -> dict[str, Any]:
        import tempfile

        texts = self._texts
        if self._found is not None:
            with tempfile.TemporaryDirectory() as place:
                texts = {os.path.basename(path): _read(os.fspath(path)) for path in self._found.write(place)}
        return {**self.__dict__, "_found": None, "_texts": texts}

    def __repr__(self) -> str:
        return f"TrajectoryDesign({self.joints!r})"


class TrajectoryAssessment(Page):
    """A trajectory beside the best one.

    Attributes
    ----------
    is_proved : bool
        Is it proved that it keeps all limits, at all times?
    best : Joints or None
        The best trajectory, at its knots; ``None`` where none was found.
    diagnostics : tuple of Diagnostic
        What was noticed.
    data : dict
        All of it, as in ``evaluation.json``.
    """

    def __init__(self, page: _native.Page, is_proved: bool, best: Joints | None) -> None:
        super().__init__(page)
        self.is_proved, self.best = is_proved, best


def design_trajectory(
    experiment: Any,
    *,
    known: Calibration | None = None,
    criterion: str | None = None,
    reach: Reach | None = None,
    slow: float | None = None,
    starts: int | None = None,
    seconds: float | None = None,
    seed: int | None = 1,
    threads: int | None = None,
    progress: Progress = False,
) -> TrajectoryDesign:
    """Find the trajectory of a machine that determines the parameters best. Ctrl-C gives the best so far.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[machine]`` and joints.
    known : Calibration, optional
        An earlier calibration on this machine. It gives geometry, mount, delays and noise.
    criterion : {"A", "D", "c", "I"}, optional
        What is minimised; that of the experiment by default.
    reach : dict, optional
        Find the shortest duration, within 6 %, with which each parameter has this standard deviation: as in :func:`design`. A name without
        sensor or axis is of all that it fits: ``{"scale": "50ppm", "gyroscope.bias": "1deg/h"}``.
    slow : float, optional
        The same path this many times slower, for the first run: 1 to 1000.
    starts, seconds, seed, threads, progress
        As in :func:`design`.

    Returns
    -------
    TrajectoryDesign

    Raises
    ------
    ExperimentError
        Where the experiment or an argument makes no sense, or `known` is of another machine.
    Infeasible
        Where the limits admit no motion in that duration, or none reaches the goals.
    """
    chosen = choice(
        known=() if known is None else known,
        criterion=criterion,
        reach=reach,
        starts=starts,
        seconds=seconds,
        seed=seed,
    )
    made = experiment_of_kind(experiment, "machine")
    with Told(progress) as told:
        found = _native.design_trajectory(made._native, chosen, slow=slow, threads=thread_count(threads), progress=told)
    return TrajectoryDesign(*found)


def assess_trajectory(
    experiment: Any,
    trajectory: Any,
    *,
    known: Calibration | None = None,
    criterion: str | None = None,
    starts: int | None = None,
    seconds: float | None = None,
    seed: int | None = 1,
    threads: int | None = None,
    progress: Progress = False,
) -> TrajectoryAssessment:
    """Put a trajectory of your own beside the best one: what it determines, and which limits it keeps.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[machine]`` and joints.
    trajectory : Joints, TrajectoryDesign or path
        Positions and velocities of the joints at even times, the knots of cubic splines; or a ``trajectory.csv``.
    known, criterion, starts, seconds, seed, threads, progress
        As in :func:`design_trajectory`.

    Returns
    -------
    TrajectoryAssessment
    """
    given = as_native_motion(trajectory.joints if isinstance(trajectory, TrajectoryDesign) else trajectory)
    if given is None:
        raise experiment_error("there is no trajectory to assess", "give Joints with velocities, or a path")
    chosen = choice(
        known=() if known is None else known, criterion=criterion, starts=starts, seconds=seconds, seed=seed
    )
    made = experiment_of_kind(experiment, "machine")
    with Told(progress) as told:
        page, is_proved, best = _native.assess_trajectory(
            made._native, given, chosen, threads=thread_count(threads), progress=told
        )
    return TrajectoryAssessment(page, is_proved, None if best is None else _joints(best))


def _joints(knots: _native.Knots) -> Joints:
    names, times, positions, velocities = knots
    by_name = [dict(zip(names, table(of, len(names)).T)) for of in (positions, velocities)]
    times_s = numbers(times)
    return Joints(times_s, *by_name, knot_step_s=float(times_s[1] - times_s[0]))


def _read(path: str) -> str:
    with open(path, encoding="utf-8", newline="") as file:
        return file.read()
