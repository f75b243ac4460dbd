"""Calibrates a fleet into a Parquet data set."""

from __future__ import annotations

import glob
import hashlib
import json
import os
import uuid
from typing import TYPE_CHECKING, Any, Iterable, Iterator, Literal, Mapping, Sequence

from .._arrays import Path
from .._calibrate import as_experiment
from .._exceptions import CalibrantError, experiment_error, of_json
from .._frames import is_frame
from .._progress import Progress, Told
from ._chunk import Task, filesystem, keys_of, run_chunk, schema
from ._engines import engine_of

if TYPE_CHECKING:
    import pyarrow as pa


Call = tuple[Sequence[str], Task, Iterable[str], str]


class Result:
    """The data set of a fleet, after a call.

    Attributes
    ----------
    calibrated, failed, earlier : int
        Items that this call calibrated, those that have no calibration, and those that were there already.
    output : str
        Where the data set is.
    """

    def __init__(
        self, output: str, calibrated: int, failed: int, earlier: int, storage_options: Mapping[str, Any] | None = None
    ) -> None:
        self.output, self.calibrated, self.failed, self.earlier = output, calibrated, failed, earlier
        self._storage = dict(storage_options or {})

    def scan(self) -> Any:
        """The data set as a relation of DuckDB where that is installed, or else as a lazy frame of polars, or as a table of pyarrow."""
        system, path = filesystem(self.output, self._storage)
        files = _parts(system, path)
        local = type(system).__name__ == "LocalFileSystem"
        if local and files:
            try:
                import duckdb

                return duckdb.read_parquet(files)
            except ImportError:
                pass
            try:
                import polars as pl

                return pl.scan_parquet(files)
            except ImportError:
                pass
        return self.to_table()

    def to_table(self) -> pa.Table:
        """The data set as a table of pyarrow, in the order of the items."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        system, path = filesystem(self.output, self._storage)
        tables = [pq.read_table(file, filesystem=system) for file in _parts(system, path)]
        table = pa.concat_tables(tables) if tables else schema().empty_table()
        return table.sort_by([("file", "ascending"), ("key", "ascending")])

    def to_frame(self) -> Any:
        """The data set as a frame of pandas or polars, or else as a table of pyarrow."""
        table = self.to_table()
        try:
            return table.to_pandas()
        except ImportError:
            pass
        try:
            import polars as pl

            return pl.from_arrow(table)
        except ImportError:
            return table

    def copies(self) -> list[list[str]]:
        """Items with the same bytes: nobody knows which sensor they are of."""
        import pyarrow.compute as pc

        table = self.to_table().select(["file", "recording_sha256"])
        groups: dict[str, list[str]] = {}
        for row in table.filter(pc.is_valid(table["recording_sha256"])).to_pylist():
            groups.setdefault(row["recording_sha256"], []).append(row["file"])
        return [files for files in groups.values() if len(files) > 1]

    def __repr__(self) -> str:
        return f"Result({self.calibrated} calibrated, {self.failed} failed, {self.earlier} earlier: {self.output})"


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
        Keep the lower triangle of each covariance?
    on_error : {"row", "raise"}
        An item without a calibration is a row with verdict ``none``; or it is an exception, after its chunk is written.
    resume : bool
        Leave out what the data set has, by the key of each item: SHA-256 of program, options, experiment, motion and recording.
    allow : list of str
        Codes of diagnostics that do not count for the verdict.
    sensor_from, sensor_key, station : str, optional
        As in :func:`calibrant.calibrate`.
    storage_options : dict, optional
        ``{"filesystem": …}``: a file system of pyarrow, in place of that of the URL.
    progress : bool or callable
        ``True`` for a bar of tqdm, or a callable that takes items done, items in all, and what is done.

    Returns
    -------
    Result

    Raises
    ------
    ExperimentError
        Where the experiment, the motion or an argument makes no sense.

    Notes
    -----
    Two items with the same bytes are refused within a chunk. Over all chunks :meth:`Result.copies` finds them.
    """
    if on_error not in ("row", "raise"):
        raise experiment_error(f"`on_error` is {on_error!r}", "give 'row' or 'raise'")
    options = {
        "allow": list(allow),
        "sensor_from": sensor_from,
        "sensor_key": sensor_key,
        "station": station,
        "report": False,
    }
    storage = dict(storage_options or {})
    task = Task(as_experiment(experiment), json.dumps(options), motion, covariance, storage)
    place = os.fspath(output)
    system, path = filesystem(place, storage)
    system.create_dir(path, recursive=True)
    listed = sorted(set(_listed(items, storage)))
    kept = _kept(system, path) if resume else {}
    size = _size(per_task, len(listed), client)
    chunks = [listed[at : at + size] for at in range(0, len(listed), size)]
    calls: list[Call] = [(chunk, task, _of_chunk(kept, chunk), path) for chunk in chunks]
    calibrated = failed = earlier = done = 0
    first_error: CalibrantError | None = None
    with Told(progress) as told:
        for new, bad, old, error in _results(client, calls):
            calibrated, failed, earlier, done = calibrated + new, failed + bad, earlier + old, done + new + bad + old
            if told is not None:
                told(done, len(listed), "recordings")
            if error is not None and first_error is None:
                first_error = of_json(error)
                if on_error == "raise":
                    raise first_error
    return Result(place, calibrated, failed, earlier, storage)


def _results(client: Any, calls: list[Call]) -> Iterator[tuple[int, int, int, str | None]]:
    if client is None:
        # chunks one after the other, each on all cores
        return (work(*call, threads=None) for call in calls)
    return engine_of(client)(work, calls)


def work(
    chunk: Sequence[str], task: Task, kept: Iterable[str], path: str, threads: int | None = 1
) -> tuple[int, int, int, str | None]:
    """Calibrate what a data set lacks of a chunk, and write its part. Returns how many were calibrated, failed and there, and the first error."""
    import pyarrow.parquet as pq

    keys, there = keys_of(chunk, task), set(kept)
    items = [item for item, key in zip(chunk, keys) if key is None or key not in there]
    earlier = len(chunk) - len(items)
    if not items:
        return 0, 0, earlier, None
    table = run_chunk(items, task, threads=threads)
    verdicts, errors = table["verdict"].to_pylist(), table["error_json"].to_pylist()
    failed = sum(verdict == "none" for verdict in verdicts)
    # two items with the same bytes have the same key
    named = sorted(f"{item} {key}" for item, key in zip(chunk, keys) if key is None or key not in there)
    name = hashlib.sha256("\n".join(named).encode()).hexdigest()[:32]
    system, _ = filesystem(path, task.storage_options) if "://" in path else (None, path)
    target = f"{path}/part-{name}.parquet"
    if task.storage_options.get("filesystem") is not None:
        system = task.storage_options["filesystem"]
    if system is None:
        beside = f"{path}/.part-{name}.{uuid.uuid4().hex}.tmp"
        pq.write_table(table, beside, compression="zstd")
        os.replace(beside, target)
    else:
        # an object store shows a file when it is whole
        with system.open_output_stream(target) as stream:
            pq.write_table(table, stream, compression="zstd")
    return len(items) - failed, failed, earlier, next((error for error in errors if error), None)


def _listed(items: Any, storage: dict[str, Any]) -> list[str]:
    if isinstance(items, (str, os.PathLike)):
        text = os.fspath(items)
        if any(sign in text for sign in "*?["):
            return _matching(text, storage)
        return [text]
    if is_frame(items):
        import narwhals as nw

        read = nw.from_native(items, eager_only=True)
        if "file" not in read.columns:
            raise experiment_error("the frame has no column `file`", "name the paths `file`", code="column-missing")
        return [str(item) for item in read["file"].to_list()]
    return [os.fspath(item) for item in items]


def _matching(pattern: str, storage: dict[str, Any]) -> list[str]:
    if "://" not in pattern:
        return glob.glob(pattern, recursive=True)
    import fnmatch

    import pyarrow.fs as fs

    scheme = pattern.split("://", 1)[0]
    fixed = pattern[: min(pattern.index(sign) for sign in "*?[" if sign in pattern)].rsplit("/", 1)[0]
    system, folder = filesystem(fixed, storage)
    _, whole = filesystem(pattern, storage) if storage.get("filesystem") is not None else (None, pattern.split("://", 1)[1])
    files = system.get_file_info(fs.FileSelector(folder, recursive=True, allow_not_found=True))
    return [f"{scheme}://{of.path}" for of in files if of.is_file and fnmatch.fnmatch(of.path, whole)]


def _parts(system: Any, path: str) -> list[str]:
    import pyarrow.fs as fs

    found = system.get_file_info(fs.FileSelector(path, allow_not_found=True))
    return sorted(of.path for of in found if of.base_name.startswith("part-") and of.base_name.endswith(".parquet"))


# above it a chunk is told of its own items only, so that a call stays small; a recording with another name is then calibrated again
_MOST_KEYS = 10_000


def _kept(system: Any, path: str) -> dict[str, set[str]]:
    """The keys that the data set has, by item."""
    import pyarrow.parquet as pq

    kept: dict[str, set[str]] = {}
    for part in _parts(system, path):
        columns = pq.read_table(part, columns=["file", "key"], filesystem=system)
        for file, key in zip(columns["file"].to_pylist(), columns["key"].to_pylist()):
            if key is not None:
                kept.setdefault(file, set()).add(key)
    return kept


def _of_chunk(kept: dict[str, set[str]], chunk: Sequence[str]) -> frozenset[str]:
    files = chunk if len(kept) > _MOST_KEYS else kept
    return frozenset(key for file in files for key in kept.get(file, ()))


def _size(per_task: int | Literal["auto"], count: int, client: Any) -> int:
    if per_task != "auto":
        if not isinstance(per_task, int) or per_task < 1:
            raise experiment_error(f"`per_task` is {per_task!r}", "give a number from 1, or 'auto'")
        return per_task
    # so few that a killed worker loses seconds, so many that the engine's own share is small
    return 100 if client is None else max(1, min(50, -(-count // 20)))
