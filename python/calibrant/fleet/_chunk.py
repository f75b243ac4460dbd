"""One chunk of a fleet: a pure function from items to a table. It may run anywhere."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Callable, Sequence

from .. import _native
from .._experiment import Experiment
from .._motion import as_native_motion

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class Task:
    """What all items share. It can be pickled.

    Attributes
    ----------
    experiment : Experiment
        The experiment.
    options : str
        Options of each calibration, as JSON.
    motion : Motion, Poses, Joints or path, optional
        The motion that all recordings share.
    covariance : bool
        Keep the lower triangle of each covariance?
    storage_options : dict
        For paths that are URLs.
    """

    experiment: Experiment
    options: str
    motion: Any = None
    covariance: bool = True
    storage_options: dict[str, Any] = field(default_factory=dict)


def schema() -> pa.Schema:
    """The columns of a data set."""
    import pyarrow as pa

    texts, numbers = pa.list_(pa.string()), pa.list_(pa.float64())
    return pa.schema(
        [
            ("key", pa.string()),
            ("file", pa.string()),
            ("sensor", pa.string()),
            ("station", pa.string()),
            ("recorded", pa.string()),
            ("recording_sha256", pa.string()),
            ("experiment_sha256", pa.string()),
            ("program", pa.string()),
            ("kind", pa.string()),
            ("verdict", pa.string()),
            ("codes", texts),
            ("status", pa.string()),
            ("chi2", pa.float64()),
            ("degrees_of_freedom", pa.float64()),
            ("p_value", pa.float64()),
            ("samples", pa.int64()),
            ("rate_hz", pa.float64()),
            ("names", texts),
            ("units", texts),
            ("values", numbers),
            ("sd", numbers),
            ("covariance", numbers),
            ("code", pa.string()),
            ("error", pa.string()),
            ("error_json", pa.string()),
        ],
        metadata={"calibrant": "fleet 1"},
    )


def keys_of(items: Sequence[str], task: Task) -> list[str | None]:
    """The key of each item: SHA-256 of program, options, experiment, motion and recording. ``None`` where a file cannot be read."""
    sources = [_source(item, task) for item in items]
    found: list[str | None] = _native.keys(
        task.experiment._native, sources, task.options, motion=as_native_motion(task.motion)
    )
    return found


def run_chunk(
    items: Sequence[str],
    task: Task,
    *,
    threads: int | None = 1,
    progress: Callable[[int, int, str], object] | None = None,
) -> pa.Table:
    """Calibrate each item; an error is a row with verdict ``none``.

    Parameters
    ----------
    items : list of str
        Paths, or URLs that pyarrow opens.
    task : Task
        What they share.
    threads : int, optional
        Threads of this chunk; ``None`` for all cores.
    progress : callable, optional
        Takes items done, items in all, and what is done.

    Returns
    -------
    pyarrow.Table
        A row for each item, with the columns of :func:`schema`.
    """
    import pyarrow as pa

    sources = [_source(item, task) for item in items]
    found = _native.calibrate_each(
        task.experiment._native,
        sources,
        task.options,
        motion=as_native_motion(task.motion),
        threads=threads,
        progress=progress,
    )
    rows = [_row(item, of, task) for item, of in zip(items, found)]
    return pa.Table.from_pylist(rows, schema=schema())


def _row(item: str, found: tuple[str | None, str | None, str | None, str | None], task: Task) -> dict[str, Any]:
    key, sha256, text, error = found
    row: dict[str, Any] = {
        "key": key,
        "file": item,
        "recording_sha256": sha256,
        "experiment_sha256": task.experiment.sha256,
        "program": _native.program(),
        "verdict": "none",
    }
    if error is not None:
        data = json.loads(error)
        row.update(code=data["code"], error=data["text"], error_json=error)
        return row
    data = json.loads(text or "{}")
    fit, inputs, judged = data.get("fit") or {}, data.get("inputs") or [{}], data.get("verdict") or {}
    parameters = data.get("parameters") or []
    covariance = data.get("covariance")
    row.update(
        sensor=data.get("sensor"),
        station=data.get("station"),
        recorded=data.get("recorded"),
        kind=data.get("kind"),
        verdict=judged.get("usability"),
        codes=judged.get("codes"),
        status=data.get("status"),
        chi2=fit.get("chi2"),
        degrees_of_freedom=fit.get("degrees_of_freedom"),
        p_value=fit.get("p_value"),
        samples=inputs[0].get("samples"),
        rate_hz=inputs[0].get("rate_hz"),
        names=[of["name"] for of in parameters],
        units=[of.get("unit") for of in parameters],
        values=[of.get("value") for of in parameters],
        sd=[of.get("sd") for of in parameters],
    )
    if task.covariance and covariance is not None:
        row["covariance"] = [covariance[i][j] for i in range(len(covariance)) for j in range(i + 1)]
    return row


def _source(item: str, task: Task) -> _native.Source:
    """A path, or what is at a URL. One that cannot be read is left to the reader, which says so."""
    if "://" not in item:
        return _native.Source(_native.Readings.file(item))
    system, path = filesystem(item, task.storage_options)
    try:
        with system.open_input_stream(path) as stream:
            content = stream.read()
    except OSError:
        return _native.Source(_native.Readings.file(item))
    return _native.Source(_native.Readings.bytes(os.path.basename(path), content))


def filesystem(url: str, options: dict[str, Any]) -> tuple[Any, str]:
    """The file system of a URL or a path, and the path in it."""
    import pyarrow.fs as fs

    if options.get("filesystem") is not None:
        return options["filesystem"], url.split("://", 1)[-1]
    if "://" not in url:
        return fs.LocalFileSystem(), os.path.abspath(url)
    system, path = fs.FileSystem.from_uri(url)
    return system, path
