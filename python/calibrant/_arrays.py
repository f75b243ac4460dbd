"""Arrays as the native part takes them."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Union

import numpy as np
import numpy.typing as npt

from ._exceptions import recording_error

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

Array: TypeAlias = npt.NDArray[np.float64]
Path: TypeAlias = Union[str, "os.PathLike[str]"]


def numbers(buffer: bytearray) -> Array:
    """The numbers that the native part gives, (n,)."""
    return np.frombuffer(buffer, dtype=np.float64)


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


def _of_shape(name: str, values: npt.ArrayLike, dimensions: int, shape: str) -> Array:
    try:
        found: Any = np.asarray(values)
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
