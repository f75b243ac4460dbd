"""Studies: many simulated sensors, truth against estimate."""

from __future__ import annotations

import json
from typing import Any

from . import _native
from ._arrays import Path
from ._calibrate import as_experiment
from ._calibration import _write
from ._diagnostic import Diagnostic, diagnostics
from ._motion import as_native_motion
from ._progress import Progress, Told


class Study:
    """What a study found. ``data`` has all of it, as in ``study.json``."""

    def __init__(self, found: tuple[str, str, str, str]) -> None:
        self._json, notes, self._summary, self._html = found
        self.data: dict[str, Any] = json.loads(self._json)
        self.diagnostics: tuple[Diagnostic, ...] = diagnostics(json.loads(notes))

    def summary(self) -> str:
        """The sheet that the command line prints."""
        return self._summary

    def __str__(self) -> str:
        return self._summary

    def to_json(self) -> str:
        """The text of ``study.json``."""
        return self._json

    def report(self, path: Path) -> None:
        """Write the report as one HTML file."""
        _write(path, self._html)


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
    """Simulate many sensors of a ``[motion]`` experiment, and compare estimates with the truth. Ctrl-C gives those that are finished.

    Parameters
    ----------
    experiment : Experiment, path or str
        The experiment.
    motion : Motion, path or frame, optional
        The initial motion of every sensor; a random one for each by default.
    sensors, starts, seed : int, optional
        Number of sensors, starts of each design, seed; those of the experiment by default.
    force : bool
        Do it in spite of its size.
    threads : int, optional
        Number of threads; all cores by default. Results do not depend on it.
    progress : bool or callable
        As in :func:`design`.
    """
    with Told(progress) as told:
        return Study(
            _native.study(
                as_experiment(experiment)._native,
                motion=as_native_motion(motion),
                sensors=sensors,
                starts=starts,
                seed=seed,
                force=force,
                threads=threads,
                progress=told,
            )
        )
