"""Designs of poses: the best ones, and others beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._arrays import Array, as_json, as_table, table, thread_count, whole
from ._calibrate import experiment_of_kind
from ._choice import Known, Reach, choice
from ._frames import frame, is_frame, library_of
from ._page import Page
from ._progress import Progress, Told
from ._recording import Recording, as_source, is_path_or_bytes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class PoseDesign(Page):
    """Poses: the best ones, or those that were assessed.

    Attributes
    ----------
    directions : (n, 3) array
        The direction that is up in each pose: unit vectors in the sensor's axes, in the order in which to take them.
    efficiency : float or None
        At least this share of the best possible.
    diagnostics : tuple of Diagnostic
        What was noticed.
    data : dict
        All of it, as in ``design.json``; of an assessment as in ``evaluation.json``.
    """

    def __init__(self, found: _native.Posed) -> None:
        page, directions = found
        super().__init__(page)
        self.directions: Array = table(directions)
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


def design_poses(
    experiment: Any,
    poses: int | None = None,
    *,
    known: Known = (),
    criterion: str | None = None,
    reach: Reach | None = None,
    starts: int | None = None,
    seed: int | None = 1,
    force: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> PoseDesign:
    """Find the poses that determine the parameters best. Ctrl-C gives the best so far.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[holds]``.
    poses : int, optional
        Number of poses; that of the experiment by default. With `known`, those to add.
    known : Calibration or list of Calibration
        Earlier calibrations of the sensor: the poses are added to theirs.
    reach : dict, optional
        Find the fewest poses with which each parameter has this standard deviation: as in :func:`design`.
    criterion, starts, seed, force, threads, progress
        As in :func:`design`.

    Returns
    -------
    PoseDesign

    Examples
    --------
    >>> import calibrant as cb
    >>> cb.design_poses("static-poses", 12, starts=4).directions.shape
    (12, 3)
    """
    chosen = choice(known=known, criterion=criterion, reach=reach, starts=starts, seed=seed, force=force)
    made = experiment_of_kind(experiment, "holds")
    with Told(progress) as told:
        return PoseDesign(_native.design_poses(made._native, whole("poses", poses), chosen, threads=thread_count(threads), progress=told))


def assess_poses(experiment: Any, poses: Any, *, seed: int | None = 1, threads: int | None = None) -> PoseDesign:
    """Put poses beside the best ones: their efficiency, and what they determine.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[holds]``.
    poses : (n, 3) array, or a recording
        The direction that is up in each pose, unit vectors in the sensor's axes. Of a recording (a path, bytes, a frame or a
        :class:`Recording`) its holds are taken.
    seed : int
        Seed of the search.
    threads : int, optional
        Number of threads; all cores by default.

    Returns
    -------
    PoseDesign

    Examples
    --------
    >>> import calibrant as cb
    >>> faces = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    >>> 0.0 < cb.assess_poses(cb.Experiment.preset("static-poses", sensor={"model": "scale-bias"}), faces).efficiency <= 1.0
    True
    """
    chosen = choice(seed=seed)
    native = experiment_of_kind(experiment, "holds")._native
    if isinstance(poses, Recording) or is_path_or_bytes(poses) or is_frame(poses):
        source, reading = as_source(poses)
        return PoseDesign(
            _native.assess_poses(native, chosen, source=source, reading=as_json(reading), threads=thread_count(threads))
        )
    directions = as_table("poses", poses).tobytes()
    return PoseDesign(_native.assess_poses(native, chosen, directions=directions, threads=thread_count(threads)))
