"""Studies: many simulated sensors, truth against estimate."""

from __future__ import annotations

from typing import Any

from . import _native
from ._arrays import thread_count, whole
from ._calibrate import as_experiment
from ._motion import as_native_motion
from ._page import Page
from ._progress import Progress, Told


class Study(Page):
    """What a study found. `data` has all of it, as in ``study.json``; of a machine under ``rehearsal``, of a campaign under ``campaigns``."""


def study(
    experiment: Any = "report",
    *,
    motion: Any = None,
    sensors: int | None = None,
    starts: int | None = None,
    seed: int | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> Study:
    """Simulate many sensors, and compare estimates with the truth. Ctrl-C gives those that are finished.

    Of a ``[motion]`` experiment each sensor is calibrated on a random motion, then on the best one. With joints in ``[machine]`` it rehearses the
    machine: the best trajectory is designed, and each sensor is calibrated on a plain routine and on that trajectory. With ``[campaign]`` it rehearses the
    best campaign over temperature beside the usual ones in its time; Ctrl-C then gives nothing.

    Parameters
    ----------
    experiment : Experiment, path or str
        The experiment.
    motion : Motion, path or frame, optional
        The initial motion of every sensor; a random one for each by default. A rehearsal takes none.
    sensors, starts, seed : int, optional
        Number of sensors, starts of each design, seed; those of the experiment by default. Of a campaign 30 sensors by default, and no starts.
    force : bool
        Do it in spite of its size.
    threads : int, optional
        Number of threads; all cores by default. Results do not depend on it.
    progress : bool or callable
        As in :func:`design`.

    Returns
    -------
    Study
    """
    with Told(progress) as told:
        return Study(
            _native.study(
                as_experiment(experiment)._native,
                motion=as_native_motion(motion),
                sensors=whole("sensors", sensors),
                starts=whole("starts", starts),
                seed=whole("seed", seed, 0),
                force=force,
                threads=thread_count(threads),
                progress=told,
            )
        )
