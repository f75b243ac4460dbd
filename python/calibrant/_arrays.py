"""Arrays as the native part takes them."""

from __future__ import annotations

import json
import operator
import os
from typing import TYPE_CHECKING, Any, Mapping, Union

import numpy as np
import numpy.typing as npt

from ._exceptions import experiment_error, recording_error

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

Array: TypeAlias = npt.NDArray[np.float64]
Path: TypeAlias = Union[str, "os.PathLike[str]"]


def numbers(buffer: bytearray) -> Array:
    """The numbers that the native part gives, (n,)."""
    return np.frombuffer(buffer, dtype=np.float64)


def number(value: float | None) -> float:
    """A number; NaN where there is none."""
    return float("nan") if value is None else float(value)


def table(buffer: bytearray, columns: int = 3) -> Array:
    """The table that the native part gives, (n, columns)."""
    return np.frombuffer(buffer, dtype=np.float64).reshape(-1, columns)


def as_list(name: str, values: npt.ArrayLike) -> Array:
    """One number for each sample."""
    return _of_shape(name, values, 1, "(n,)")


def as_table(name: str, values: npt.ArrayLike, columns: int | None = 3) -> Array:
    """A row for each sample."""
    shape = "(n, m)" if columns is None else f"(n, {columns})"
    table = _of_shape(name, values, 2, shape)
    if columns is not None and table.shape[1] != columns:
        raise _unlike(name, table, shape)
    return table


def whole(name: str, value: Any, least: int = 1, most: int = 2**64 - 1) -> int | None:
    """A whole number, of Python or of numpy; ``None`` where there is none."""
    if value is None:
        return None
    try:
        number = operator.index(value)
    except TypeError:
        number = least - 1
    if not least <= number <= most:
        upto = "" if most == 2**64 - 1 else f" to {most}"
        raise experiment_error(f"`{name}` is {value!r}", f"give a whole number from {least}{upto}")
    return number


def thread_count(threads: Any) -> int | None:
    """A number of threads; ``None`` for all cores."""
    return whole("threads", threads, most=1024)


def as_json(value: Any) -> str:
    """JSON, also of arrays and numbers of numpy, of paths and mappings. Its texts, numbers and lists are arguments."""
    try:
        return json.dumps(value, default=plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise experiment_error(f"an argument makes no sense: {error}", "give numbers, texts, lists or dicts") from None


def plain(value: Any) -> Any:
    """What JSON has for it."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"{type(value).__name__} is no number, text, list or dict")


def _of_shape(name: str, values: npt.ArrayLike, dimensions: int, shape: str) -> Array:
    try:
        found: Any = np.asanyarray(values)
        if isinstance(found, np.ma.MaskedArray):
            found = np.ma.filled(found.astype(np.float64), np.nan)
        if found.dtype.kind not in "fiub":
            found = found.astype(np.float64) if found.dtype.kind == "O" else None
        if found is None:
            raise TypeError
        # f32 becomes f64 here: the numbers stay the same
        array: Array = np.ascontiguousarray(found, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        message = f"`{name}` is no array of numbers"
        raise recording_error(message, f"give numbers of shape {shape}") from None
    if array.ndim != dimensions:
        raise _unlike(name, array, shape)
    return array


def _unlike(name: str, array: Array, shape: str) -> Exception:
    return recording_error(f"`{name}` has shape {array.shape}", f"give numbers of shape {shape}")
