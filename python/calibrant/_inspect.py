"""What a recording, a log of a machine's motion, or a machine contains."""

from __future__ import annotations

import os
from typing import Any, Sequence

from . import _native
from ._arrays import Path
from ._exceptions import RecordingError, experiment_error
from ._motion import Joints, Poses
from ._page import Page
from ._recording import Recording, read_recording

_MACHINES = (".urdf", ".xacro", ".xml")


def inspect(
    source: Any,
    *,
    base: str | None = None,
    tip: str | None = None,
    packages: Sequence[Path] = (),
    **reading: Any,
) -> Page:
    """What a recording, a log of joints or poses, or a machine (``.urdf``) contains, before you calibrate from it.

    Parameters
    ----------
    source : path, bytes, frame, Recording, Joints or Poses
        What to look at. A path may be that of a recording, of a log or of a machine.
    base, tip : str, optional
        Links of a machine: the one that does not move, and the one that carries the sensor.
    packages : list of paths
        Directories in which the packages of a machine's meshes lie; missing meshes are found then.
    **reading
        What a file does not state: arguments of :func:`read_recording`; of a log `time_unit` and `topic`.

    Returns
    -------
    Inspection or Page
        `data` is as ``calibrant inspect --json`` writes it; ``summary()`` is the sheet.

    Examples
    --------
    >>> import calibrant as cb
    >>> log = cb.Joints([0.0, 1.0, 2.0], {"elbow": [0.0, 0.5, 1.0]})
    >>> cb.inspect(log).data["joints"][0]["most"]
    1.0
    """
    is_path = isinstance(source, (str, os.PathLike))
    if is_path and os.fspath(source).lower().endswith(_MACHINES):
        places = [os.fspath(of) for of in packages]
        return Page(_native.inspect_machine(os.fspath(source), base, tip, places))
    if base is not None or tip is not None or packages:
        raise experiment_error("`base`, `tip` and `packages` are for machines", "give a path that ends in .urdf, or leave them away")
    if isinstance(source, (Joints, Poses)):
        return Page(_native.inspect_log(source._as_native()))
    if isinstance(source, Recording):
        return source.inspect()
    try:
        return read_recording(source, **reading).inspect()
    except RecordingError:
        of_log = {"time_unit": reading.get("time_unit"), "topic": reading.get("topic")}
        others = {key for key, value in reading.items() if value is not None} - of_log.keys()
        if not is_path or others or not _native.is_log(os.fspath(source), **of_log):
            raise
    return Page(_native.inspect_log(_native.Motion.file(os.fspath(source)), **of_log))
