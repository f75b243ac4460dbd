"""Motions: commanded ones, and logs of machines."""

from __future__ import annotations

import os
from typing import Any, Mapping

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Array, Path, as_list, as_table, table
from ._exceptions import experiment_error, recording_error
from ._frames import columns_of, is_frame


class Motion:
    """A commanded motion. Its acceleration is linear between nodes.

    Parameters
    ----------
    t_s : (n,) array
        Times of the nodes, s, increasing.
    acceleration_mps2 : (n, 3) or (n,) array
        Acceleration at each node, m/s².

    Raises
    ------
    ExperimentError
        Where the times do not increase, or a number is not finite.

    Examples
    --------
    >>> import calibrant as cb
    >>> motion = cb.Motion([0.0, 1.0, 2.0], [[0, 0, 0], [1, 0, 0], [0, 0, 0]])
    >>> float(motion.velocity_mps[-1, 0])
    1.0
    """

    def __init__(self, t_s: npt.ArrayLike, acceleration_mps2: npt.ArrayLike) -> None:
        given: Any = acceleration_mps2
        self.axes = 3
        try:
            shape = np.shape(given)
        except ValueError:
            shape = ()  # rows of different lengths: refused below
        if len(shape) == 1 or shape[1:] == (1,):
            self.axes = 1
            one = as_list("acceleration_mps2", np.reshape(given, -1))
            given = np.column_stack([one, np.zeros((one.size, 2))])
        self.t_s: Array = as_list("t_s", t_s)
        self.acceleration_mps2: Array = as_table("acceleration_mps2", given)
        self._native = self._made()

    def _made(self) -> _native.Motion:
        if len(self.t_s) != len(self.acceleration_mps2):
            message = f"{len(self.t_s)} times for {len(self.acceleration_mps2)} nodes"
            raise experiment_error(message, "give a time for each node", code="motion-invalid")
        return _native.Motion.commanded(self.t_s.tobytes(), self.acceleration_mps2.tobytes())

    @property
    def velocity_mps(self) -> Array:
        """Velocity at each node, m/s, from rest: shape (n, 3)."""
        return table(self._native.states()[0])

    @property
    def displacement_m(self) -> Array:
        """Displacement at each node, m: shape (n, 3)."""
        return table(self._native.states()[1])

    def save(self, path: Path, rate_hz: float | None = None) -> None:
        """Write ``motion.csv``: the nodes, or samples at a rate in Hz with velocity and displacement."""
        self._native.write(os.fspath(path), self.axes, rate_hz)

    def __repr__(self) -> str:
        return f"Motion({len(self.t_s)} nodes, {self.t_s[-1] - self.t_s[0]:g} s)"

    def __getstate__(self) -> tuple[Array, Array, int]:
        return (self.t_s, self.acceleration_mps2, self.axes)

    def __setstate__(self, state: tuple[Array, Array, int]) -> None:
        self.t_s, self.acceleration_mps2, self.axes = state
        self._native = self._made()


class Poses:
    """The poses of the body that carries the sensor, as a tracker logs them. A row with NaN was not seen.

    Parameters
    ----------
    t_s : (n,) array
        Times, s.
    position_m : (n, 3) array
        Position in the world, m.
    quaternion_wxyz : (n, 4) array
        Rotation from the body's axes to the world's, w first.
    """

    def __init__(
        self, t_s: npt.ArrayLike, position_m: npt.ArrayLike, quaternion_wxyz: npt.ArrayLike
    ) -> None:
        self.t_s: Array = as_list("t_s", t_s)
        self.position_m: Array = as_table("position_m", position_m)
        self.quaternion_wxyz: Array = as_table("quaternion_wxyz", quaternion_wxyz, 4)

    def _as_native(self) -> _native.Motion:
        return _native.Motion.poses(self.t_s.tobytes(), self.position_m.tobytes(), self.quaternion_wxyz.tobytes())

    def __repr__(self) -> str:
        return f"Poses({len(self.t_s)} times)"


class Joints:
    """The positions of a machine's joints over time.

    Parameters
    ----------
    t_s : (n,) array
        Times, s.
    positions : dict of (n,) arrays
        Position of each joint by its name, rad or m.
    velocities : dict of (n,) arrays, optional
        Velocity of each joint, rad/s or m/s.
    knot_step_s : float, optional
        Distance of the knots of the cubic splines on which the machine moved, s, where it is known.
    """

    def __init__(
        self,
        t_s: npt.ArrayLike,
        positions: Mapping[str, npt.ArrayLike],
        velocities: Mapping[str, npt.ArrayLike] | None = None,
        *,
        knot_step_s: float | None = None,
    ) -> None:
        self.t_s: Array = as_list("t_s", t_s)
        self.names = tuple(positions)
        self.positions: Array = _side_by_side(self.names, positions)
        self.velocities: Array | None = None if velocities is None else _side_by_side(self.names, velocities)
        self.knot_step_s = knot_step_s

    def _as_native(self) -> _native.Motion:
        velocities = None if self.velocities is None else self.velocities.tobytes()
        times, positions = self.t_s.tobytes(), self.positions.tobytes()
        return _native.Motion.joints(list(self.names), times, positions, velocities, self.knot_step_s)

    def __repr__(self) -> str:
        return f"Joints({', '.join(self.names)}: {len(self.t_s)} times)"


def _side_by_side(names: tuple[str, ...], lists: Mapping[str, npt.ArrayLike]) -> Array:
    columns = [as_list(name, lists[name]) for name in names]
    lengths = {len(column) for column in columns}
    if len(lengths) > 1:
        raise recording_error(f"the joints have {sorted(lengths)} values", "give one for each time")
    return np.ascontiguousarray(np.column_stack(columns)) if columns else np.zeros((0, 0))


def as_native_motion(motion: Any, origin_ns: int | None = None) -> _native.Motion | None:
    """A motion of any kind: commanded, logged, a file, a frame of joints or poses. `origin_ns`: from when the times of a recording count whose times are dates."""
    if motion is None:
        return None
    if isinstance(motion, Motion):
        return motion._native
    if hasattr(motion, "_as_native"):
        made: _native.Motion = motion._as_native()
        return made
    if is_frame(motion):
        return _of_frame(dict(columns_of(motion, origin_ns)))
    if isinstance(motion, (str, os.PathLike)):
        return _native.Motion.file(os.fspath(motion))
    raise experiment_error(f"{type(motion).__name__} is no motion", "give a Motion, Poses, Joints, a frame or a path")


def _of_frame(columns: dict[str, Array]) -> _native.Motion:
    times = columns.pop("t_s", None)
    if times is None:
        raise recording_error("the log has no column t_s", "name the times t_s, in s", code="column-missing")
    if {"ax_mps2", "ay_mps2", "az_mps2"} <= columns.keys():
        nodes = np.column_stack([columns[f"a{axis}_mps2"] for axis in "xyz"])
        return Motion(times, nodes)._native
    place, turn = [f"p{axis}_m" for axis in "xyz"], ["qw", "qx", "qy", "qz"]
    if set(place + turn) <= columns.keys():
        table = np.column_stack([columns[name] for name in place + turn])
        return Poses(times, table[:, :3], table[:, 3:])._as_native()
    names = {name: name.removesuffix("_rad").removesuffix("_m") for name in columns}
    return Joints(times, {names[name]: values for name, values in columns.items()})._as_native()
