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
    return True


def library_of(data: object) -> Any:
    """The library of a frame, for :func:`frame`."""
    return nw.from_native(data, eager_only=True).implementation  # type: ignore[call-overload]


def columns_of(data: object) -> list[tuple[str, Array]]:
    """The columns of numbers. Dates become seconds since the first."""
    read = nw.from_native(data, eager_only=True)  # type: ignore[call-overload]
    columns: list[tuple[str, Array]] = []
    for name in read.columns:
        series = read[name]
        if series.dtype.is_numeric() or series.dtype == nw.Boolean:
            columns.append((name, np.ascontiguousarray(series.cast(nw.Float64).to_numpy(), dtype=np.float64)))
        elif isinstance(series.dtype, nw.Datetime) and not any(known == "t_s" for known, _ in columns):
            times = series.dt.timestamp("ns").to_numpy().astype(np.int64)
            first = times[0] if len(times) else 0
            columns.append(("t_s", (times - first) / 1e9))
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
