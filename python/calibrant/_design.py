"""Designs of a motion: the best one, and one beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import numbers, table, thread_count
from ._calibrate import experiment_of_kind
from ._choice import Known, Reach, choice
from ._exceptions import experiment_error
from ._motion import Motion, as_native_motion
from ._page import Page
from ._progress import Progress, Told

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Design(Page):
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
        All of it, as in ``design.json``; of an assessment as in ``evaluation.json``.
    """

    def __init__(self, found: _native.Designed) -> None:
        page, best = found
        super().__init__(page)
        self.motion: Motion | None = None
        self.value, self.bound, self.gap, self.interrupted = float("nan"), None, None, False
        if best is not None:
            nodes, (self.value, self.bound, self.gap, self.interrupted) = best
            self.motion = Motion(numbers(nodes[0]), table(nodes[1]))
            self.motion.axes = int((self.data.get("setting") or {}).get("axes", 3))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the acceleration of the best motion over time; returns the axes."""
        from ._plots import motion

        return motion(self, ax)

    def __repr__(self) -> str:
        gap = "" if self.gap is None else f", gap {self.gap:.2g}"
        return f"Design(value {self.value:.6g}{gap})"


def design(
    experiment: Any,
    *,
    known: Known = (),
    criterion: str | None = None,
    gap: float | None = None,
    reach: Reach | None = None,
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
    known : Calibration or list of Calibration
        Earlier calibrations of the sensor: their information counts.
    criterion : {"A", "D", "E", "M", "c", "I"}, optional
        What is minimised; that of the experiment by default.
    gap : float, optional
        The gap to the bound at which the search ends: 0.01 for 1 %.
    reach : dict, optional
        Find the shortest motion with which each parameter has this standard deviation: a number in its unit, or a text such as
        ``{"scale.x": "50ppm", "bias.x": "0.2mg"}``. `data` then has the goals, and what is proved of them, under ``reach``.
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

    Returns
    -------
    Design

    Raises
    ------
    ExperimentError
        Where the experiment or an argument makes no sense.
    Infeasible
        Where the limits admit no motion, or no motion reaches the goals.
    NotIdentifiable
        Where no motion within the limits determines the parameters.

    Examples
    --------
    >>> import calibrant as cb
    >>> best = cb.design("stage", starts=2)
    >>> best.bound <= best.value
    True
    """
    chosen = choice(
        known=known,
        criterion=criterion,
        gap=gap,
        reach=reach,
        starts=starts,
        seconds=seconds,
        seed=seed,
        certificate=certificate,
        force=force,
    )
    made = experiment_of_kind(experiment, "motion")
    with Told(progress) as told:
        return Design(_native.design(made._native, chosen, threads=thread_count(threads), progress=told))


def assess(
    experiment: Any,
    motion: Any,
    *,
    known: Known = (),
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

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[motion]`` and ``[limits]``.
    motion : Motion, path or frame
        The motion.
    known, criterion, starts, seconds, seed, certificate, force, threads, progress
        As in :func:`design`.

    Returns
    -------
    Design
    """
    given = as_native_motion(motion)
    if given is None:
        raise experiment_error("there is no motion to assess", "give a Motion, a path or a frame")
    chosen = choice(
        known=known,
        criterion=criterion,
        starts=starts,
        seconds=seconds,
        seed=seed,
        certificate=certificate,
        force=force,
    )
    made = experiment_of_kind(experiment, "motion")
    with Told(progress) as told:
        return Design(_native.assess(made._native, given, chosen, threads=thread_count(threads), progress=told))
