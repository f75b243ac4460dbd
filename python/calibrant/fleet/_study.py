"""Studies a fleet of simulated sensors: truth against estimate, a row for each sensor."""

from __future__ import annotations

import os
import pickle
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Mapping, Sequence

from .. import _native
from .._arrays import Path, as_json, whole
from .._calibrate import as_experiment
from .._exceptions import experiment_error
from .._experiment import Experiment
from .._motion import as_native_motion
from .._progress import Progress
from ._calibrate import as_row, columns, native_options
from ._hash import hash_of_files, seed_of, sha256
from ._result import Result
from ._run import run
from ._storage import anywhere, content
from ._task import Item, name_of, schema_of

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class StudyTask:
    """Draw a sensor, simulate its recording, and calibrate from it.

    Attributes
    ----------
    experiment : Experiment
        What all sensors have in common.
    seed : int
        Each sensor has a seed of its own: the first 8 bytes, the highest first, of the SHA-256 of ``"seed/item"``.
    options : dict
        ``allow``, as in :func:`study`.
    motion : Motion, Poses, Joints or path, optional
        The motion of all sensors.
    covariance : bool
        Keep the lower triangle of each covariance, and the errors that calibrations at one place share?
    """

    experiment: Experiment
    seed: int = 1
    options: dict[str, Any] = field(default_factory=dict)
    motion: Any = None
    covariance: bool = True
    storage_options: dict[str, Any] = field(default_factory=dict)
    what = "sensors"
    most = 50

    def schema(self) -> pa.Schema:
        """The columns of the data set."""
        import pyarrow as pa

        return schema_of("study", [("seed", pa.uint64()), ("truth", pa.list_(pa.float64())), *columns()])

    def opened(self, items: Sequence[Item]) -> list[int]:
        """The seed of each sensor."""
        return [seed_of(self.seed, name_of(item)) for item in items]

    def keys(self, items: Sequence[Item], opened: Sequence[int]) -> list[str | None]:
        """SHA-256 of program, options, experiment with the files that it names, motion and seed."""
        experiment, options = self.experiment, as_json({**self.options, "covariance": self.covariance})
        shared = sha256(_native.program(), options, experiment.sha256, hash_of_files(experiment), self._motion())
        return [sha256(shared, str(seed)).hex() for seed in opened]

    def rows(self, items: Sequence[Item], opened: Sequence[int], threads: int | None) -> list[dict[str, Any]]:
        """The columns of each sensor."""
        found = _native.study_each(
            self.experiment._native,
            [(name_of(item), seed) for item, seed in zip(items, opened)],
            native_options(self.experiment, self.options),
            motion=as_native_motion(self.motion),
            threads=threads,
        )
        rows = [as_row(row, error, self.experiment, self.covariance) for row, error in found]
        return [{**row, "seed": seed} for row, seed in zip(rows, opened)]

    def _motion(self) -> bytes:
        if not isinstance(self.motion, (str, os.PathLike)):
            return pickle.dumps(self.motion, protocol=5)
        read = content(os.fspath(self.motion), self.storage_options)
        if read is None:
            raise experiment_error(f"{self.motion} cannot be read", "check its name", code="file-unreadable")
        return read


def study(
    experiment: Any,
    output: Path,
    *,
    sensors: int,
    seed: int = 1,
    client: Any = None,
    motion: Any = None,
    per_task: int | Literal["auto"] = "auto",
    covariance: bool = True,
    on_error: Literal["row", "raise"] = "row",
    resume: bool = True,
    allow: Sequence[str] = (),
    storage_options: Mapping[str, Any] | None = None,
    progress: Progress = False,
) -> Result:
    """Simulate many sensors of an experiment, and calibrate each from its recording. Run it again to continue, also with more sensors.

    A row has the columns of :func:`calibrate`, the `seed` of the sensor, and the true value of each parameter, `truth`. `file` is the number of the sensor.

    Parameters
    ----------
    experiment : Experiment, path or str
        The experiment. Sensors are drawn from its datasheet.
    output : path
        Folder of the data set, or its URL.
    sensors : int
        Number of sensors.
    seed : int
        Seed of all. Results depend neither on the chunks nor on the engine, and ``calibrant.simulate`` with the `seed` of a row gives its recording.
    motion : Motion, Poses, Joints or path, optional
        The motion of all sensors; a random one for each by default.
    client, per_task, covariance, on_error, resume, allow, storage_options, progress
        As in :func:`calibrate`.

    Returns
    -------
    Result

    Raises
    ------
    ExperimentError
        Where the experiment, the motion or an argument makes no sense.
    """
    made, storage = as_experiment(experiment), dict(storage_options or {})
    task = StudyTask(made, whole("seed", seed, 0) or 0, {"allow": list(allow)}, anywhere(motion), covariance, storage)
    # nine digits, so that they are in order as texts, too
    items = [f"{number:09}" for number in range(1, (whole("sensors", sensors) or 0) + 1)]
    return run(
        task, items, output, client=client, per_task=per_task, on_error=on_error, resume=resume, progress=progress
    )
