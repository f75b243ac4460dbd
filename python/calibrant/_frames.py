"""Data frames of any library, by narwhals: what comes in goes out as the same kind."""

from __future__ import annotations

from typing import Any

import narwhals as nw
import numpy as np

from ._arrays import Array
from ._exceptions import experiment_error, recording_error


def is_frame(data: object) -> bool:
    """Is it a frame of pandas, polars, pyarrow or another library?"""
    try:
        nw.from_native(data, eager_only=True)  # type: ignore[call-overload]
    except TypeError:
        return False
    except nw.exceptions.NarwhalsError:
        pass  # it is one, and is refused where it is read
    return True


def _read(data: Any) -> Any:
    # the index of a frame of pandas: as a column where it has a name, or is a time
    index: Any = getattr(data, "index", None)
    if getattr(index, "name", None) is not None or type(index).__name__ in ("DatetimeIndex", "TimedeltaIndex"):
        if index.name not in data.columns:
            data = data.reset_index()
    try:
        return nw.from_native(data, eager_only=True)
    except nw.exceptions.NarwhalsError as error:
        raise recording_error(f"the frame cannot be read: {error}", "give each column a name of its own") from None


def library_of(data: object) -> Any:
    """The library of a frame, for :func:`frame`."""
    return nw.from_native(data, eager_only=True).implementation  # type: ignore[call-overload]


def first_date_ns(data: object) -> int | None:
    """The first time of a frame whose times are dates, ns."""
    series = _dates(_read(data))
    known = None if series is None or series.dtype == nw.Duration else series.drop_nulls()
    return None if known is None or len(known) == 0 else int(known.dt.timestamp("ns").to_numpy()[0])


def has_dates(data: object, name: str) -> bool:
    """Is this a column of dates or durations?"""
    return _dates(_read(data), name) is not None


def _dates(read: Any, name: str | None = None) -> Any:
    """The column of dates or durations that are times: the one of this name; else the first, where there is no `t_s`."""
    of_dates = [column for column in read.columns if isinstance(read.schema[column], (nw.Datetime, nw.Duration))]
    if name is not None:
        return read[name] if name in of_dates else None
    if "t_s" in read.columns:
        return read["t_s"] if "t_s" in of_dates else None
    return read[of_dates[0]] if of_dates else None


def columns_of(data: object, origin_ns: int | None = None, time: str | None = None) -> list[tuple[str, Array]]:
    """The columns of numbers. Dates, of the column `time` where that is given, become the seconds `t_s` since `origin_ns`, or since the first; durations become seconds."""
    read = _read(data)
    names = list(read.columns)
    if not all(isinstance(name, str) for name in names):
        raise recording_error("the columns have no names", "name them: t_s, ax, ay, az", code="column-missing")
    columns: list[tuple[str, Array]] = []
    for name in names:
        series = read[name]
        if series.dtype.is_numeric() or series.dtype == nw.Boolean:
            columns.append((name, np.ascontiguousarray(series.cast(nw.Float64).to_numpy(), dtype=np.float64)))
    dates = _dates(read, time)
    if dates is not None:
        missing = dates.is_null().to_numpy()
        is_duration = dates.dtype == nw.Duration
        since = 0 if is_duration else origin_ns if origin_ns is not None else first_date_ns(data) or 0
        # whole numbers first: seconds since 1970 have too many digits
        ns = dates.dt.total_nanoseconds() if is_duration else dates.dt.timestamp("ns")
        times = ns.fill_null(since).to_numpy().astype(np.int64)
        columns.insert(0, ("t_s", np.where(missing, np.nan, (times - since) / 1e9)))
    if not columns:
        raise recording_error("the frame has no column of numbers", "give times and readings", code="column-missing")
    return columns


def frame(columns: dict[str, Any], like: Any = None) -> Any:
    """A frame with these columns, of the library that `like` is of; by default of pandas, polars or pyarrow, the first that is there."""
    backends: list[Any] = ["pandas", "polars", "pyarrow"] if like is None else [like]
    for backend in backends:
        try:
            return nw.from_dict(columns, backend=backend).to_native()
        except (ImportError, ModuleNotFoundError):
            continue
    raise experiment_error("a frame needs pandas, polars or pyarrow", "install one of them")
