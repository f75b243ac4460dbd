"""Calibrates a fleet into a Parquet data set."""

from __future__ import annotations

import json
import os
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Mapping, Sequence

from .. import _native
from .._arrays import Path, as_json
from .._calibrate import as_experiment
from .._exceptions import CalibrationWarning
from .._experiment import Experiment
from .._motion import as_native_motion
from .._progress import Progress
from ._hash import sha256
from ._result import Result
from ._run import run
from ._storage import anywhere, content, listed
from ._task import Item, failure, name_of, schema_of

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class CalibrationTask:
    """Calibrate from each recording.

    Attributes
    ----------
    experiment : Experiment
        What all recordings have in common.
    options : dict
        ``allow``, ``sensor_from``, ``sensor_key``, ``station``, as in :func:`calibrate`.
    motion : Motion, Poses, Joints or path, optional
        The motion that all recordings share.
    covariance : bool
        Keep the lower triangle of each covariance, and the errors that calibrations at one place share?
    storage_options : dict
        For paths that are URLs.
    """

    experiment: Experiment
    options: dict[str, Any] = field(default_factory=dict)
    motion: Any = None
    covariance: bool = True
    storage_options: dict[str, Any] = field(default_factory=dict)
    what = "recordings"
    most = 50

    def schema(self) -> pa.Schema:
        """The columns of the data set."""
        return schema_of("calibrate", columns())

    def opened(self, items: Sequence[Item]) -> list[Any]:
        """Paths, and the bytes of URLs."""
        return [_source(name_of(item), self.storage_options) for item in items]

    def keys(self, items: Sequence[Item], opened: Sequence[Any]) -> list[str | None]:
        """SHA-256 of program, options, experiment with the files that it names, motion and recording."""
        motion = as_native_motion(self.motion)
        found = _native.keys(self.experiment._native, list(opened), self._options(), motion=motion)
        return [of if of is None or self.covariance else sha256(of, "no covariance").hex() for of in found]

    def rows(self, items: Sequence[Item], opened: Sequence[Any], threads: int | None) -> list[dict[str, Any]]:
        """The columns of each recording."""
        found = _native.calibrate_each(
            self.experiment._native, opened, self._options(), motion=as_native_motion(self.motion), threads=threads
        )
        rows = [as_row(row, error, self.experiment, self.covariance) for row, error in found]
        failed = [number for number, row in enumerate(rows) if row["code"] is not None]
        for number, sha256 in zip(failed, _native.hashes([opened[number] for number in failed])):
            rows[number]["recording_sha256"] = sha256
        return rows

    def _options(self) -> str:
        return native_options(self.experiment, self.options)


def calibrate(
    items: Any,
    experiment: Any,
    output: Path,
    *,
    client: Any = None,
    motion: Any = None,
    per_task: int | Literal["auto"] = "auto",
    covariance: bool = True,
    on_error: Literal["row", "raise"] = "row",
    resume: bool = True,
    allow: Sequence[str] = (),
    sensor_from: str | None = None,
    sensor_key: str | None = None,
    station: str | None = None,
    storage_options: Mapping[str, Any] | None = None,
    progress: Progress = False,
) -> Result:
    """Calibrate many recordings of one experiment into a Parquet data set. Run it again to continue.

    Parameters
    ----------
    items : paths, glob or frame
        Paths or URLs; a pattern such as ``"line/*.csv"``; or a frame with a column ``file``.
    experiment : Experiment, path or str
        What all have in common.
    output : path
        Folder of the data set, or its URL.
    client : module ray, Client of Dask or Executor, optional
        What runs the chunks; threads of this process by default.
    motion : Motion, Poses, Joints or path, optional
        The motion that all recordings share.
    per_task : int or "auto"
        Items of a chunk: each chunk is one task and one part of the data set.
    covariance : bool
        Keep the lower triangle of each covariance, and the errors that calibrations at one place share?
    on_error : {"row", "raise"}
        An item without a calibration is a row with verdict ``none``; or it is an exception, after its chunk is written.
    resume : bool
        Leave out what the data set has, by name and key of each item. The key is the SHA-256 of program, options, experiment, motion and recording.
        ``False``: the data set must be empty.
    allow : list of str
        Codes of diagnostics that do not count for the verdict.
    sensor_from, sensor_key, station : str, optional
        As in :func:`calibrant.calibrate`.
    storage_options : dict, optional
        What fsspec needs for URLs; or ``{"filesystem": …}``, a file system of pyarrow.
    progress : bool or callable
        ``True`` for a bar of tqdm, or a callable that takes items done, items in all, and what is done.

    Returns
    -------
    Result

    Raises
    ------
    ExperimentError
        Where the experiment, the motion or an argument makes no sense.

    Warns
    -----
    CalibrationWarning
        Where items have the same bytes. :meth:`Result.copies` names them, over all chunks and calls.
    """
    storage = dict(storage_options or {})
    options = {"allow": list(allow), "sensor_from": sensor_from, "sensor_key": sensor_key, "station": station}
    task = CalibrationTask(as_experiment(experiment), options, anywhere(motion), covariance, storage)
    result = run(
        task, listed(items, storage), output,
        client=client, per_task=per_task, on_error=on_error, resume=resume, progress=progress,
    )  # fmt: skip
    copies = result.copies()
    if copies:
        message = f"{sum(map(len, copies))} items have the same bytes as others, and nobody knows of which sensor they are: see Result.copies()"
        warnings.warn(message, CalibrationWarning, stacklevel=2)
    return result


def columns() -> list[tuple[str, Any]]:
    """The columns of a calibration."""
    import pyarrow as pa

    text, number = pa.string(), pa.float64()
    texts, numbers = pa.list_(text), pa.list_(number)
    return [
        ("sensor", text),
        ("station", text),
        ("recorded", text),
        ("recording", text),
        ("recording_sha256", text),
        ("motion", text),
        ("motion_sha256", text),
        ("plan", text),
        ("verdict", text),
        ("codes", texts),
        ("status", text),
        ("chi2", number),
        ("degrees_of_freedom", number),
        ("p_value", number),
        ("samples", pa.int64()),
        ("rate_hz", number),
        ("names", texts),
        ("units", texts),
        ("values", numbers),
        ("sd", numbers),
        ("covariance", numbers),
        ("covariance_degrees", numbers),
        ("shared_sources", texts),
        ("shared_root", numbers),
        ("reference_c", number),
        ("range_c", numbers),
        ("model", text),
    ]


def as_row(row: str | None, error: str | None, experiment: Experiment, covariance: bool) -> dict[str, Any]:
    """The columns of a calibration, or of its error."""
    given: dict[str, Any] = json.loads(row) if row is not None else {"verdict": "none"}
    given.update(experiment_sha256=experiment.sha256, program=_native.program())
    given.update(failure(error))
    if not covariance:
        given.update(covariance=None, shared_sources=None, shared_root=None)
    return given


def native_options(experiment: Experiment, options: Mapping[str, Any]) -> str:
    """The options of a calibration as the native part takes them."""
    return as_json({**options, "experiment_file": experiment._path or "", "report": False})


def _source(name: str, storage: Mapping[str, Any]) -> _native.Source:
    """A path, or what is at a URL. One that cannot be read is left to the reader, which says so."""
    read = content(name, storage) if "://" in name else None
    if read is None:
        return _native.Source(_native.Readings.file(name))
    return _native.Source(_native.Readings.bytes(os.path.basename(name), read))
